"""Emulated devices as real GATT servers, each on its own virtual controller, and a central that reaches them.

`virtual_link` is for one process; tcp.py connects other processes to the same medium."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from functools import partial
from typing import TypeVar

from bumble import att, core, data_types, hci
from bumble.device import Connection, Device, DeviceConfiguration
from bumble.gatt import Characteristic, CharacteristicValue, Service
from bumble.host import Host
from bumble.transport.common import AsyncPipeSink, Transport

from ...ble.scanning import Backend
from ..devices import attributes as emulated
from ..devices.attributes import AttError
from ..devices.peripheral import Peripheral
from .central import backend_of
from .controller import VirtualController, VirtualMedium
from .radio import VirtualRadio, enable_just_works, end_link

_T = TypeVar("_T")

ADVERTISING_INTERVAL = 62.5
"""Advertising interval given to bumble's host, ms: 100 HCI units. Its controller takes a unit for 1 ms: 100 ms."""


@asynccontextmanager
async def virtual_link(peripherals: Iterable[Peripheral], mtu: int = 247) -> AsyncIterator[Backend]:
    """Serve the devices in this process, by the clock of its event loop, and yield a Backend that reaches them.

    `mtu` is the ATT MTU that the central requests; a device may accept less."""
    medium = VirtualMedium()
    controller = VirtualController("central", medium)

    async def reach() -> Transport:
        return Transport(controller, AsyncPipeSink(controller))

    async with advertise_devices(peripherals, medium):
        radio = VirtualRadio(reach, "the virtual controller", mtu)
        try:
            yield backend_of(radio)
        finally:
            await radio.close()
            medium.leave(controller)


@asynccontextmanager
async def advertise_devices(peripherals: Iterable[Peripheral], medium: VirtualMedium) -> AsyncIterator[None]:
    """Let the devices advertise and serve on this medium until the block is left."""
    servers = [Server(device, medium) for device in peripherals]
    try:
        for server in servers:
            await server.start()
        yield
    finally:
        for server in servers:
            await server.stop()


class Server:
    """The GATT server of one Peripheral: it polls the device when values are due, and sends them."""

    def __init__(self, peripheral: Peripheral, medium: VirtualMedium) -> None:
        self.peripheral, self.medium = peripheral, medium
        self._loop = asyncio.get_running_loop()
        self._link: Connection | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._link_end: asyncio.Future[bytes] | None = None  # never gets a result; cancelled when the link ends
        self._controller = VirtualController(
            peripheral.name, medium, lambda: self._advertised() if peripheral.visible(self._loop.time()) else None
        )
        config = DeviceConfiguration(name=peripheral.name, address=hci.Address(peripheral.address))
        self._device = Device(config=config, host=Host(self._controller, AsyncPipeSink(self._controller)))
        enable_just_works(self._device, lambda: self.peripheral.accepts_pairing(self._loop.time()))
        self._served: dict[str, Characteristic[bytes]] = {}
        for service in peripheral.services:
            found = {one.channel: self._characteristic(one) for one in service.characteristics}
            self._device.add_service(Service(_uuid(service.uuid), list(found.values())))
            self._served |= found
        self._device.on(Device.EVENT_CONNECTION, self._connected)

    def _characteristic(self, attribute: emulated.Characteristic) -> Characteristic[bytes]:
        properties = Characteristic.Properties(0)
        for name in attribute.properties:
            properties |= Characteristic.Properties[name.upper().replace("-", "_")]
        served: Characteristic[bytes] = Characteristic(
            _uuid(attribute.uuid),
            properties,
            att.Attribute.READABLE | att.Attribute.WRITEABLE,  # the Peripheral itself rejects what is not permitted
            CharacteristicValue(
                read=partial(self.read, attribute.channel), write=partial(self.write, attribute.channel)
            ),
        )
        subscribed: Callable[[Connection, bool, bool], None] = partial(self.subscribe, attribute.channel)
        served.on(Characteristic.EVENT_SUBSCRIPTION, subscribed)
        return served

    async def start(self) -> None:
        """Start the controller and advertise."""
        await self._device.power_on()
        self.peripheral.on_change = self._arm
        await self._device.start_advertising(
            auto_restart=True,
            advertising_data=self._advertised(),
            advertising_interval_min=ADVERTISING_INTERVAL,
            advertising_interval_max=ADVERTISING_INTERVAL,
        )

    async def stop(self) -> None:
        """End the link and leave the medium."""
        if self._link is not None:
            await end_link(self._link)
        self._disarm()
        self.peripheral.on_change = None
        await self._device.power_off()
        self.medium.leave(self._controller)

    def _advertised(self) -> bytes:
        """Return the advertisement: services and name, without flags (Core supplement, A 1.3: they may be left out)."""
        uuids = [_uuid(uuid) for uuid in self.peripheral.advertised]
        short = [uuid for uuid in uuids if len(uuid.uuid_bytes) == 2]
        long = [uuid for uuid in uuids if len(uuid.uuid_bytes) == 16]
        entries: list[core.DataType] = [data_types.CompleteLocalName(self.peripheral.name)]
        entries += [data_types.IncompleteListOf16BitServiceUUIDs(short)] if short else []
        entries += [data_types.IncompleteListOf128BitServiceUUIDs(long)] if long else []
        return bytes(core.AdvertisingData(entries))

    def _connected(self, link: Connection) -> None:
        self._link = link
        self._link_end = self._loop.create_future()
        self._device.gatt_server.max_mtu = self.peripheral.mtu
        link.on(Connection.EVENT_DISCONNECTION, partial(self._disconnected, link))
        link.on(Connection.EVENT_CONNECTION_ATT_MTU_UPDATE, lambda: self._update_link_state(link))
        link.on(Connection.EVENT_CONNECTION_ENCRYPTION_CHANGE, lambda: self._update_link_state(link))
        self.peripheral.connected(self._loop.time(), link.att_mtu)
        self._arm()

    def _update_link_state(self, link: Connection) -> None:
        if self._link is link:
            self.peripheral.agreed_mtu, self.peripheral.is_encrypted = link.att_mtu, link.is_encrypted

    def _disconnected(self, link: Connection, reason: int) -> None:
        if self._link is not link:
            return
        self._link = None
        self._disarm()
        if self._link_end is not None:
            self._link_end.cancel()
        self.peripheral.disconnected(self._loop.time())

    # requests; `_characteristic` binds the first argument, the channel

    async def read(self, channel: str, link: Connection) -> bytes:
        """Return the value of a channel."""
        value = self._request(partial(self.peripheral.read, channel))
        return value if value is not None else await self._no_answer()

    async def write(self, channel: str, link: Connection, value: bytes) -> None:
        """Write a value to a channel."""
        if not self._request(partial(self.peripheral.write, channel, value)):
            await self._no_answer()

    def subscribe(self, channel: str, link: Connection, notify: bool, indicate: bool) -> None:
        """Start or stop the notifications of a channel; no device indicates."""
        self._request(partial(self.peripheral.subscribe, channel, notify))

    def _request(self, request: Callable[[float], _T]) -> _T:
        """Return the device's answer, or raise its error as an ATT error; then set the timer (`_arm`)."""
        try:
            return request(self._loop.time())
        except AttError as error:
            raise att.ATT_Error(error.code) from None
        finally:
            self._arm()

    async def _no_answer(self) -> bytes:
        """Wait instead of an answer until the end of the link cancels the wait."""
        if self._link_end is None:
            raise att.ATT_Error(att.ATT_UNLIKELY_ERROR_ERROR)
        return await asyncio.shield(self._link_end)

    def _disarm(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _arm(self) -> None:
        """Set the timer for the device's next value or fault."""
        self._disarm()
        due = self.peripheral.next_due() if self._link is not None else None
        if due is not None:
            self._timer = self._loop.call_at(due, self._send)

    def _send(self) -> None:
        link = self._link
        if link is None:
            return
        now = self._loop.time()
        for outgoing in self.peripheral.poll(now):
            served = self._served[outgoing.channel]
            pdu = att.ATT_Handle_Value_Notification(
                attribute_handle=served.handle,
                # Longer values are cut without an error, as GATT servers do.
                attribute_value=outgoing.value[: link.att_mtu - emulated.ATT_HEADER_SIZE],
            )
            self._device.gatt_server.send_gatt_pdu(link, bytes(pdu))
        if self.peripheral.must_hang_up(now):
            for connection in list(self._controller.le_connections.values()):
                self.medium.lose(self._controller, connection)
        else:
            self._arm()


def _uuid(uuid: str) -> core.UUID:
    """Return the UUID, with 16 bits if the Bluetooth SIG assigned it."""
    return core.UUID(uuid[4:8] if emulated.is_short(uuid) else uuid)
