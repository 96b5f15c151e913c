"""Requests of a device's setup, done through bleak, and the notifications of one established connection."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from attrs import define, field
from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.exc import BleakDBusError, BleakError, BleakGATTProtocolError

from ..link.profile import Channel
from ..link.setup.device_setup import ANSWER_TIMEOUT, DeviceSetup, GattCharacteristic, Operation, Request
from .inbox import Emitter
from .trouble import bleak_call, describe_error

MIN_CHECK_INTERVAL = 0.01
"""Shortest interval between two checks, s: rounding of the loop's clock must not make it zero."""


@define(eq=False)
class Client:
    """One established connection; it does what `setup` requests, and passes notifications on.

    `disconnected` is set when the connection is lost."""

    client: BleakClient
    setup: DeviceSetup
    emitter: Emitter
    disconnected: asyncio.Event
    closed: bool = field(default=False, init=False)
    """True when further notifications are not passed on."""

    async def set_up(self) -> None:
        """Do all requests of the setup. Raises FAILURES."""
        self.emitter.emit(self.setup.start(_now()))
        await self._do_requests()

    async def listen(self) -> None:
        """Check the streams until the connection is lost, or the setup ends it. Raises FAILURES."""
        while not self.disconnected.is_set() and self.setup.end is None:
            next_check_at = self.setup.next_check_at()
            with suppress(TimeoutError):
                async with asyncio.timeout(
                    None if next_check_at is None else max(MIN_CHECK_INTERVAL, next_check_at - _now())
                ):
                    await self.disconnected.wait()
            if not self.disconnected.is_set():
                self.emitter.emit(self.setup.check(_now()))
                await self._do_requests()

    async def _do_requests(self) -> None:
        while (request := self.setup.request) is not None:
            try:
                async with bleak_call(ANSWER_TIMEOUT):
                    value = await self._do(request)
            except BleakError as error:
                if not is_rejection(error, self.client):
                    raise
                self.emitter.emit(self.setup.reject(describe_error(error), _now()))
            else:
                self.emitter.emit(self.setup.answer(value, _now()))

    async def _do(self, request: Request) -> bytes:
        """Do one request and return what was read. Raises BleakError."""
        characteristic = self._find(request.channel)
        match request.operation:
            case Operation.READ:
                return bytes(await self.client.read_gatt_char(characteristic))
            case Operation.SUBSCRIBE:
                await self.client.start_notify(characteristic, self._make_callback(request.channel.name))
            case Operation.WRITE:
                await self.client.write_gatt_char(characteristic, request.value)
        return b""

    def _find(self, channel: Channel) -> BleakGATTCharacteristic:
        """Return the channel's characteristic, the first of several."""
        services = [service for service in self.client.services if service.uuid == channel.service]
        found = (service.get_characteristic(channel.characteristic) for service in services)
        return next(characteristic for characteristic in found if characteristic is not None)

    def _make_callback(self, channel: str) -> Callable[[BleakGATTCharacteristic, bytearray], None]:
        def callback(_: BleakGATTCharacteristic, data: bytearray) -> None:
            if not self.closed:
                self.setup.add_notification(channel, self.emitter.emit_notification(channel, bytes(data)))

        return callback


def list_characteristics(client: BleakClient) -> frozenset[GattCharacteristic]:
    """Return the characteristics of a connected device; of several with one UUID in a service, the first."""
    found: dict[tuple[str, str], GattCharacteristic] = {}
    for service in client.services:
        for one in service.characteristics:
            can_notify = not {"notify", "indicate"}.isdisjoint(one.properties)
            found.setdefault((service.uuid, one.uuid), GattCharacteristic(service.uuid, one.uuid, can_notify))
    return frozenset(found.values())


def is_rejection(error: BleakError, client: BleakClient) -> bool:
    """Return whether the device rejected a request while the connection stands.

    Not every system reports this as an ATT error: Windows reports "Access Denied", BlueZ its own D-Bus errors. An error
    of D-Bus itself (BlueZ is absent or does not answer) is no rejection."""
    if isinstance(error, BleakDBusError) and error.dbus_error.startswith("org.freedesktop.DBus."):
        return False
    return isinstance(error, BleakGATTProtocolError) or client.is_connected


def _now() -> float:
    return asyncio.get_running_loop().time()
