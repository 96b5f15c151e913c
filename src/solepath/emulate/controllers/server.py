"""Emulated devices as true GATT servers, each on a virtual controller of its own, and a central to reach them with.

`virtual_air` is for one process; tcp.py carries the same air to other processes.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from functools import partial
from typing import TypeVar

from bumble import att, hci
from bumble.device import Connection, Device, DeviceConfiguration
from bumble.gatt import (
    GATT_CHARACTERISTIC_USER_DESCRIPTION_DESCRIPTOR,
    Characteristic,
    CharacteristicValue,
    Descriptor,
    Service,
)
from bumble.host import Host
from bumble.profiles.gap import GenericAccessService
from bumble.transport.common import AsyncPipeSink, Transport

from ...ble.scanning import Backend
from ..devices import attributes as emulated
from ..devices.attributes import AttError
from ..devices.peripheral import Peripheral
from .central import backend_of
from .controller import VirtualAir, VirtualController
from .gatt import AttributeServer, advertisement, short_or_long
from .radio import VirtualRadio, end_link, just_works

_T = TypeVar("_T")

ADVERTISING = 62.5
"""ms between advertisements: bumble's controller reads the 0.625 ms units of HCI as milliseconds, so it is 100 ms."""
_CENTRAL = "C0:50:1E:9A:74:01"
_STANDARD = ("0000180a", "0000180f")
"""Services that the Bluetooth SIG describes: their characteristics need no description."""


@asynccontextmanager
async def virtual_air(
    peripherals: Iterable[Peripheral], mtu: int = 247, interval: float | None = None
) -> AsyncIterator[Backend]:
    """The devices on the air and a Backend that reaches them, in this process and on this loop's time.

    `mtu`: the ATT MTU that the central asks for; a device may agree to less. `interval`: s between the connection
    events of each link, when everything goes that is ready, requests and their answers too (0.0075 to 4 s on a real
    one, often 0.03); None: nothing waits.
    """
    link = VirtualAir(interval)
    controller = VirtualController("central", link)

    async def reach() -> Transport:
        return Transport(controller, AsyncPipeSink(controller))

    async with on_air(peripherals, link):
        radio = VirtualRadio(reach, "the virtual controller", mtu, _CENTRAL)
        try:
            yield backend_of(radio)
        finally:
            await radio.close()
            link.leave(controller)


@asynccontextmanager
async def on_air(peripherals: Iterable[Peripheral], link: VirtualAir) -> AsyncIterator[None]:
    """The devices advertise and serve on this link."""
    servers = [Server(device, link) for device in peripherals]
    try:
        for server in servers:
            await server.start()
        yield
    finally:
        for server in servers:
            await server.stop()


class Server:
    """Serves one Peripheral: asks it at the times it names, and obeys it."""

    def __init__(self, peripheral: Peripheral, air: VirtualAir) -> None:
        self.peripheral, self.air = peripheral, air
        self._loop = asyncio.get_running_loop()
        self._link: Connection | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._due = 0.0
        self._silence: asyncio.Future[bytes] | None = None
        self._restart: asyncio.Task[None] | None = None
        self._stopped = False
        self._controller = VirtualController(
            peripheral.name, air, lambda: self._advertised() if peripheral.visible(self._loop.time()) else None
        )
        config = DeviceConfiguration(
            name=self.peripheral.name,
            address=hci.Address(self.peripheral.address),
            gap_service_enabled=False,
            gatt_service_enabled=False,
        )
        self._device = Device(config=config, host=Host(self._controller, AsyncPipeSink(self._controller)))
        just_works(self._device, lambda: self.peripheral.agrees_to_pair(self._loop.time()))
        self._device.gatt_server = AttributeServer(self._device)
        self._device.add_service(GenericAccessService(peripheral.name))
        self._served: dict[str, Characteristic[bytes]] = {}
        for service in peripheral.services:
            described = not service.uuid.startswith(_STANDARD)
            found = {each.channel: self._characteristic(each, described) for each in service.characteristics}
            self._device.add_service(Service(short_or_long(service.uuid), list(found.values())))
            self._served |= found
        self._device.on(Device.EVENT_CONNECTION, self._connected)

    def _characteristic(self, said: emulated.Characteristic, described: bool) -> Characteristic[bytes]:
        properties = Characteristic.Properties(0)
        for name in said.properties:
            properties |= Characteristic.Properties[name.upper().replace("-", "_")]
        description = Descriptor(
            GATT_CHARACTERISTIC_USER_DESCRIPTION_DESCRIPTOR, att.Attribute.READABLE, said.channel.encode()
        )
        served: Characteristic[bytes] = Characteristic(
            short_or_long(said.uuid),
            properties,
            att.Attribute.READABLE | att.Attribute.WRITEABLE,  # the device itself says what is not permitted
            CharacteristicValue(read=partial(self.read, said.channel), write=partial(self.write, said.channel)),
            [description] if described else [],
        )
        subscribed: Callable[[Connection, bool, bool], None] = partial(self.subscribe, said.channel)
        served.on(Characteristic.EVENT_SUBSCRIPTION, subscribed)
        return served

    async def start(self) -> None:
        """Goes on the air and advertises."""
        await self._device.power_on()
        self.peripheral.changed = self._arm
        await self._advertise()

    async def stop(self) -> None:
        """Ends the link and leaves the air."""
        self._stopped = True
        if self._link is not None:
            await end_link(self._link)
        if self._restart is not None:
            await self._restart
        self._disarm()
        self.peripheral.changed = None
        await self._device.power_off()
        self.air.leave(self._controller)

    async def _advertise(self) -> None:
        await self._device.start_advertising(
            advertising_data=self._advertised(),
            advertising_interval_min=ADVERTISING,
            advertising_interval_max=ADVERTISING,
        )

    def _advertised(self) -> bytes:
        return advertisement(self.peripheral.name, self.peripheral.advertised)

    def _connected(self, link: Connection) -> None:
        self._link = link
        self._silence = self._loop.create_future()
        self._device.gatt_server.max_mtu = self.peripheral.mtu
        link.on(Connection.EVENT_DISCONNECTION, partial(self._disconnected, link))
        link.on(Connection.EVENT_CONNECTION_ATT_MTU_UPDATE, lambda: self._tell(link))
        link.on(Connection.EVENT_CONNECTION_ENCRYPTION_CHANGE, lambda: self._tell(link))
        self.peripheral.connected(self._loop.time(), link.att_mtu)
        self._arm()

    def _tell(self, link: Connection) -> None:
        if self._link is link:
            self.peripheral.agreed_mtu, self.peripheral.is_encrypted = link.att_mtu, link.is_encrypted

    def _disconnected(self, link: Connection, reason: int) -> None:
        if self._link is not link:
            return
        self._link = None
        self._disarm()
        if self._silence is not None:
            self._silence.cancel()
        self.peripheral.disconnected(self._loop.time())
        if not self._stopped:
            self._restart = self._loop.create_task(self._advertise())

    # requests; the channel comes first, since it is bound when the table of attributes is made

    async def read(self, channel: str, link: Connection) -> bytes:
        value = self._ask(partial(self.peripheral.read, channel))
        return value if value is not None else await self._never()

    async def write(self, channel: str, link: Connection, value: bytes) -> None:
        if not self._ask(partial(self.peripheral.write, channel, value)):
            await self._never()

    def subscribe(self, channel: str, link: Connection, notify: bool, indicate: bool) -> None:
        self._ask(partial(self.peripheral.subscribe, channel, notify))

    def _ask(self, request: Callable[[float], _T]) -> _T:
        """The device's answer, or its refusal as an ATT error; afterwards it may have something to send sooner."""
        try:
            return request(self._loop.time())
        except AttError as refusal:
            raise att.ATT_Error(refusal.code) from None
        except Exception as error:
            self._loop.call_exception_handler({"message": f"{self.peripheral.name} failed", "exception": error})
            raise att.ATT_Error(att.ATT_UNLIKELY_ERROR_ERROR) from error
        finally:
            self._arm()

    async def _never(self) -> bytes:
        """An answer that never comes; it is given up with the link."""
        if self._silence is None:
            raise att.ATT_Error(att.ATT_UNLIKELY_ERROR_ERROR)
        return await asyncio.shield(self._silence)

    def _disarm(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _arm(self) -> None:
        self._disarm()
        due = self.peripheral.next_due() if self._link is not None else None
        if due is not None:
            self._due = due
            self._timer = self._loop.call_at(due, self._send)

    def _send(self) -> None:
        link = self._link
        if link is None:
            return
        now = max(self._loop.time(), self._due)  # a timer may fire a clock's resolution early
        for outgoing in self.peripheral.poll(now):
            pdu = att.ATT_Handle_Value_Notification(
                attribute_handle=self._served[outgoing.channel].handle,
                attribute_value=outgoing.value[: link.att_mtu - 3],  # longer ones are cut without an error, as is usual
            )
            self._device.gatt_server.send_gatt_pdu(link, bytes(pdu))
        if self.peripheral.hang_up(now):
            for connection in list(self._controller.le_connections.values()):
                self.air.lose(self._controller, connection)
        else:
            self._arm()
