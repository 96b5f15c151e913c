"""The virtual air across processes: every TCP connection is one virtual controller, spoken to in HCI (H4).

    async with serve(peripherals, "127.0.0.1", 9735) as (host, port): ...      # one process
    async with reach("tcp:127.0.0.1:9735") as backend: ...                      # any number of others

Whatever speaks HCI over TCP may connect, such as bumble's own tools with `tcp-client:HOST:PORT`. There is no
authentication: whoever can open the port can use the devices.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager
from typing import cast

from bumble import core, hci
from bumble.transport import open_transport
from bumble.transport.common import PacketParser, StreamPacketSink, Transport

from ...ble.scanning import Backend
from ..devices.peripheral import Peripheral
from .central import backend_of
from .controller import VirtualAir, VirtualController
from .radio import VirtualRadio
from .server import on_air

_SCHEME = "tcp:"
_BACKLOG = 1 << 20
"""Bytes that a client may leave unread; it is dropped then, as a link is that is not answered on."""


@asynccontextmanager
async def serve(peripherals: Iterable[Peripheral], host: str, port: int) -> AsyncIterator[tuple[str, int]]:
    """Serves the devices until the block is left; yields the address that it listens at (port 0 takes a free one).

    Several clients may come at once and one after another; a device is connected to one of them at a time. When a
    client goes away its links are lost as by a supervision timeout, and its devices advertise again. OSError when the
    address cannot be listened at.
    """
    link = VirtualAir()
    clients: set[_TcpClient] = set()
    async with on_air(peripherals, link):
        listening = await asyncio.get_running_loop().create_server(lambda: _TcpClient(link, clients), host, port)
        try:
            address = listening.sockets[0].getsockname()
            yield address[0], address[1]
        finally:
            listening.close()
            for client in list(clients):
                client.drop()
            await listening.wait_closed()


class _TcpClient(asyncio.Protocol):
    """One client's controller, at the other end of its TCP connection."""

    def __init__(self, link: VirtualAir, clients: set[_TcpClient]) -> None:
        self._air = link
        self._clients = clients
        self._parser = PacketParser(self)
        self._transport: asyncio.Transport | None = None
        self._controller: VirtualController | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.Transport, transport)
        self._transport.set_write_buffer_limits(high=_BACKLOG)
        self._controller = VirtualController("client", self._air)
        self._controller.host = StreamPacketSink(self._transport)
        self._clients.add(self)

    def data_received(self, data: bytes) -> None:
        try:
            self._parser.feed_data(data)
        except core.InvalidPacketError:
            self.drop()  # whoever that is does not speak HCI

    def on_packet(self, packet: bytes) -> None:
        """A whole HCI packet; called by the parser."""
        if self._controller is None:
            return
        try:
            self._controller.on_hci_packet(hci.HCI_Packet.from_bytes(packet))
        except Exception:  # bumble trusts hosts, and raises whatever comes of bytes that make no sense
            self.drop()

    def pause_writing(self) -> None:
        self.drop()

    def connection_lost(self, error: Exception | None) -> None:
        self.drop()

    def drop(self) -> None:
        """Ends the connection and takes the controller out of the air."""
        controller, self._controller = self._controller, None
        if controller is None or self._transport is None:
            return
        self._clients.discard(self)
        controller.host = None
        self._air.leave(controller)
        self._transport.abort()


def address_of(where: str) -> tuple[str, int]:
    """Host and port of "tcp:HOST:PORT"; an IPv6 host may stand in brackets. ValueError."""
    host, colon, port = where.removeprefix(_SCHEME).rpartition(":")
    if not where.startswith(_SCHEME) or not colon or not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ValueError(f"{where!r} is not tcp:HOST:PORT")
    return host.removeprefix("[").removesuffix("]"), int(port)


@asynccontextmanager
async def reach(where: str, mtu: int = 247) -> AsyncIterator[Backend]:
    """A Backend whose Bluetooth is what `serve` has at "tcp:HOST:PORT".

    ValueError when `where` is nothing of the kind, BleakError naming it when nobody answers there. When the connection
    is lost every client's disconnected callback is called; scanning and connecting then try to reach it again
    (BleakError if they cannot), and a scan that goes on hears the devices as soon as it is back.
    """
    host, port = address_of(where)

    async def opened() -> Transport:
        return await open_transport(f"tcp-client:{host}:{port}")

    radio = VirtualRadio(opened, where, mtu)
    try:
        await radio.device()
        yield backend_of(radio)
    finally:
        await radio.close()
