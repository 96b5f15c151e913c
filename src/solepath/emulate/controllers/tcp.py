"""The virtual medium across processes: every TCP connection is one virtual controller that speaks HCI (H4).

    async with serve(peripherals, "127.0.0.1", 9735) as (host, port): ...      # one process
    async with reach("tcp:127.0.0.1:9735") as backend: ...                      # any number of others

Any program that speaks HCI over TCP may connect, for example bumble's own tools with `tcp-client:HOST:PORT`. There is
no authentication: any program that can open the port can use the devices."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager
from typing import cast

from bleak.exc import BleakError
from bumble import core, hci
from bumble.transport import open_transport
from bumble.transport.common import PacketParser, StreamPacketSink, Transport

from ...ble.scanning import Backend
from ...ble.trouble import BluetoothError
from ..devices.peripheral import Peripheral
from .central import backend_of
from .controller import VirtualController, VirtualMedium
from .radio import VirtualRadio
from .server import advertise_devices

_SCHEME = "tcp:"
_MAX_UNREAD_SIZE = 1 << 20
"""Number of bytes that a client may leave unread before it is disconnected (assumed)."""


@asynccontextmanager
async def serve(peripherals: Iterable[Peripheral], host: str, port: int) -> AsyncIterator[tuple[str, int]]:
    """Serve the devices until the block is left; yield the address of the server (port 0 takes a free one).

    Several clients may connect at the same time; a device is connected to one of them at a time. When a client
    disconnects, its links are lost as by a supervision timeout, and the devices at their other ends advertise again.
    An address that cannot be used raises OSError."""
    medium = VirtualMedium()
    clients: set[_TcpClient] = set()
    async with advertise_devices(peripherals, medium):
        listening = await asyncio.get_running_loop().create_server(lambda: _TcpClient(medium, clients), host, port)
        try:
            address = listening.sockets[0].getsockname()
            yield address[0], address[1]
        finally:
            listening.close()
            for client in list(clients):
                client.drop()
            await listening.wait_closed()


class _TcpClient(asyncio.Protocol):
    """The TCP connection of one client, and the virtual controller that it drives."""

    def __init__(self, medium: VirtualMedium, clients: set[_TcpClient]) -> None:
        self._medium = medium
        self._clients = clients
        self._parser = PacketParser(self)
        self._transport: asyncio.Transport | None = None
        self._controller: VirtualController | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.Transport, transport)
        self._transport.set_write_buffer_limits(high=_MAX_UNREAD_SIZE)
        self._controller = VirtualController("client", self._medium)
        self._controller.host = StreamPacketSink(self._transport)
        self._clients.add(self)

    def data_received(self, data: bytes) -> None:
        try:
            self._parser.feed_data(data)
        except core.InvalidPacketError:
            self.drop()  # the client does not speak HCI

    def on_packet(self, packet: bytes) -> None:
        """Handle a complete HCI packet from the parser."""
        if self._controller is None:
            return
        try:
            self._controller.on_hci_packet(hci.HCI_Packet.from_bytes(packet))
        except Exception:  # bumble does not check a host's packets: invalid bytes raise any exception
            self.drop()

    def pause_writing(self) -> None:
        self.drop()

    def connection_lost(self, error: Exception | None) -> None:
        self.drop()

    def drop(self) -> None:
        """End the connection and remove the controller from the medium."""
        controller, self._controller = self._controller, None
        if controller is None or self._transport is None:
            return
        self._clients.discard(self)
        controller.host = None
        self._medium.leave(controller)
        self._transport.abort()


def address_of(where: str) -> tuple[str, int]:
    """Return host and port of "tcp:HOST:PORT"; raise ValueError for any other text.

    An IPv6 host may stand in brackets."""
    host, colon, port = where.removeprefix(_SCHEME).rpartition(":")
    if not where.startswith(_SCHEME) or not colon or not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ValueError(f"{where!r} is not tcp:HOST:PORT")
    return host.removeprefix("[").removesuffix("]"), int(port)


@asynccontextmanager
async def reach(where: str, mtu: int = 247) -> AsyncIterator[Backend]:
    """Yield a Backend that reaches the devices of `serve` at "tcp:HOST:PORT".

    `mtu` is the ATT MTU that clients request, bytes. Any other `where` raises ValueError; a server that does not answer
    raises a BluetoothError that names it. When the TCP connection is lost, every client's disconnected callback is
    called. The next scan or connection opens it again, or raises BleakError; a running scan continues by itself."""
    host, port = address_of(where)

    async def open_connection() -> Transport:
        return await open_transport(f"tcp-client:{host}:{port}")

    radio = VirtualRadio(open_connection, where, mtu)
    try:
        try:
            await radio.device()
        except BleakError as error:
            raise BluetoothError(f"{error}: start `solepath emulate`") from None
        yield backend_of(radio)
    finally:
        await radio.close()
