"""An org.bluez service with emulated devices, for bleak's unchanged backend for Linux without a radio.

It behaves as BlueZ 5 documents (doc/org.bluez.Adapter.rst, .Device.rst and .GattCharacteristic.rst; for errors
create_gatt_dbus_error of src/gatt-client.c), as far as a central can see.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable, Iterator
from contextlib import asynccontextmanager
from typing import Any, TypeVar

import bus
from bleak.exc import BleakError, BleakGATTProtocolError
from bus import DBusError
from dbus_fast import Variant
from memory_link import LoopbackLink

from solepath.emulate.devices.attributes import Characteristic, Service
from solepath.emulate.devices.peripheral import Peripheral

ADAPTER = "/org/bluez/hci0"
ADVERTISING_INTERVAL = 0.1
"""Time between the advertisements of a device, s."""
SIGNAL_STRENGTH = -60
"""Received signal strength, dBm."""
NOT_PAIRED = DBusError("org.bluez.Error.NotPermitted", "Not paired")

_ADAPTER = "org.bluez.Adapter1"
_DEVICE = "org.bluez.Device1"
_SERVICE = "org.bluez.GattService1"
_CHARACTERISTIC = "org.bluez.GattCharacteristic1"
_ATT_ERRORS = {
    0x02: DBusError("org.bluez.Error.NotPermitted", "Read not permitted"),
    0x03: DBusError("org.bluez.Error.NotPermitted", "Write not permitted"),
    0x05: NOT_PAIRED,
    0x06: DBusError("org.bluez.Error.NotSupported", "Operation is not supported"),
    0x08: DBusError("org.bluez.Error.NotAuthorized", "Operation Not Authorized"),
    0x0D: DBusError("org.bluez.Error.InvalidArguments", "Invalid Length"),
}

T = TypeVar("T")


class Bluez(bus.Service):
    """The service org.bluez; `adapter` says whether there is an adapter, `powered` whether it is on."""

    def __init__(self, peripherals: Iterable[Peripheral], *, adapter: bool = True, powered: bool = True) -> None:
        super().__init__()
        self._devices = {f"{ADAPTER}/dev_{one.address.replace(':', '_')}": one for one in peripherals}
        self._links: dict[str, LoopbackLink] = {}
        self._channels: dict[str, tuple[str, str]] = {}
        """Path of the device, and channel, for each path of a characteristic."""
        self._scanning: set[str] = set()
        """Bus names of the programs that discover."""
        if adapter:
            self.objects[ADAPTER] = {
                _ADAPTER: {
                    "Address": Variant("s", "00:00:00:00:00:01"),
                    "AddressType": Variant("s", "public"),
                    "Name": Variant("s", "host"),
                    "Alias": Variant("s", "host"),
                    "Powered": Variant("b", powered),
                    "Discovering": Variant("b", False),
                    "Roles": Variant("as", ["central", "peripheral"]),
                }
            }

    @asynccontextmanager
    async def serving(self, address: str) -> AsyncIterator[Bluez]:
        """Serve org.bluez on the bus until the block is left."""
        async with self.owning("org.bluez", address):
            radio = asyncio.create_task(self._scan())
            try:
                yield self
            finally:
                radio.cancel()
        self.lose()

    @property
    def is_idle(self) -> bool:
        """True when no program discovers and no device is connected."""
        return not self._scanning and not self._links

    def lose(self) -> None:
        """Lose all links, as if the devices left the range and came back."""
        for link in tuple(self._links.values()):
            link.lose()

    def power(self, on: bool) -> None:
        """Switch the adapter on or off."""
        if not on:
            self._scanning.clear()
            self.lose()
        self.change(ADAPTER, _ADAPTER, Powered=Variant("b", on))

    # advertisements and links

    async def _scan(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            for path, device in self._devices.items():
                if self._scanning and path not in self._links and device.visible(loop.time()):
                    self._report_device(path, device)
            await asyncio.sleep(ADVERTISING_INTERVAL)

    def _report_device(self, path: str, device: Peripheral) -> None:
        signal = Variant("n", SIGNAL_STRENGTH)
        if path in self.objects:
            self.change(path, _DEVICE, RSSI=signal)
            return
        properties = {
            "Address": Variant("s", device.address),
            "AddressType": Variant("s", "random"),
            "Name": Variant("s", device.name),
            "Alias": Variant("s", device.name),
            "Adapter": Variant("o", ADAPTER),
            "UUIDs": Variant("as", list(device.advertised)),
            "RSSI": signal,
        }
        no = Variant("b", False)
        flags = dict.fromkeys(("Paired", "Bonded", "Trusted", "Blocked", "Connected", "ServicesResolved"), no)
        self.add(path, _DEVICE, properties | flags)

    def _lost(self, path: str) -> None:
        del self._links[path]
        self.change(path, _DEVICE, Connected=Variant("b", False), ServicesResolved=Variant("b", False))

    # D-Bus methods

    async def call(self, method: str, path: str, sender: str, body: list[Any]) -> tuple[str, list[Any]]:
        match method:
            case "Adapter1.SetDiscoveryFilter":
                pass
            case "Adapter1.StartDiscovery":
                self._start_discovery(sender)
            case "Adapter1.StopDiscovery":
                self._stop_discovery(sender)
            case "Device1.Connect":
                await self._connect(path)
            case "Device1.Disconnect":
                if path in self._links:
                    self._links[path].lose()
            case "Properties.Set":
                interface, name, value = body
                self.change(path, interface, **{name: value})
            case "GattCharacteristic1.ReadValue":
                value = await self._request(path, Peripheral.read)
                self._notified(path, value)  # BlueZ notifies subscribers too
                return "ay", [value]
            case "GattCharacteristic1.WriteValue":
                value = bytes(body[0])
                await self._request(path, lambda device, channel, now: device.write(channel, value, now) or None)
            case "GattCharacteristic1.StartNotify":
                device, channel = self._channels[path]
                self._links[device].callbacks[channel] = lambda data: self._notified(path, bytes(data))
                await self._request(path, _subscribe)
            case _:
                raise DBusError("org.freedesktop.DBus.Error.UnknownMethod", f"there is no {method}")
        return "", []

    def client_left(self, sender: str) -> None:
        if sender in self._scanning:
            self._stop_discovery(sender)

    def _start_discovery(self, sender: str) -> None:
        if not self.objects[ADAPTER][_ADAPTER]["Powered"].value:
            raise DBusError("org.bluez.Error.NotReady", "Resource Not Ready")
        if sender in self._scanning:
            raise DBusError("org.bluez.Error.InProgress", "Operation already in progress")
        self._scanning.add(sender)

    def _stop_discovery(self, sender: str) -> None:
        if sender not in self._scanning:
            raise DBusError("org.bluez.Error.Failed", "No discovery started")
        self._scanning.discard(sender)
        for path in self._devices:
            if not self._scanning and path in self.objects:
                self.change(path, _DEVICE, "RSSI")

    async def _connect(self, path: str) -> None:
        device = self._devices[path]
        if path in self._links:
            raise DBusError("org.bluez.Error.AlreadyConnected", "Already Connected")
        loop = asyncio.get_running_loop()
        while not device.visible(loop.time()):
            await asyncio.sleep(ADVERTISING_INTERVAL)  # until it is cancelled
        self._links[path] = LoopbackLink(device, device.mtu, 0.01, lambda: self._lost(path))
        device.is_encrypted = self.objects[path][_DEVICE]["Paired"].value
        self.change(path, _DEVICE, Connected=Variant("b", True))
        await asyncio.sleep(0.05)
        for attribute, interface, properties in _attributes(path, device.services):
            if attribute not in self.objects:
                self.add(attribute, interface, properties)
            if interface == _CHARACTERISTIC:
                self._channels[attribute] = path, _channel(device.services, properties["UUID"].value)
        self.change(path, _DEVICE, ServicesResolved=Variant("b", True))

    async def _request(self, path: str, do: Callable[[Peripheral, str, float], T | None]) -> T:
        """Return the device's answer to a request to the characteristic; raise DBusError when it rejects it."""
        at, channel = self._channels[path]
        device, link = self._devices[at], self._links.get(at)
        if link is None:
            raise DBusError("org.bluez.Error.Failed", "Not connected")
        try:
            return await link.request(lambda now: do(device, channel, now))
        except BleakGATTProtocolError as error:
            code = int(error.code)
            unnamed = DBusError("org.bluez.Error.Failed", f"Operation failed with ATT error: 0x{code:02x}")
            raise _ATT_ERRORS.get(code, unnamed) from None
        except BleakError:
            raise DBusError("org.bluez.Error.Failed", "Not connected") from None

    def _notified(self, path: str, value: bytes) -> None:
        self.change(path, _CHARACTERISTIC, Value=Variant("ay", value))


def _subscribe(device: Peripheral, channel: str, now: float) -> bool:
    device.subscribe(channel, True, now)
    return True


def _channel(services: Iterable[Service], uuid: str) -> str:
    return next(one.channel for service in services for one in service.characteristics if one.uuid == uuid)


def _attributes(device: str, services: Iterable[Service]) -> Iterator[tuple[str, str, dict[str, Variant]]]:
    """Yield path, interface and properties of the attributes that discovery finds, with consecutive handles."""
    handle = 0
    for service in services:
        handle += 1
        path = f"{device}/service{handle:04x}"
        properties = {"UUID": Variant("s", service.uuid), "Device": Variant("o", device), "Primary": Variant("b", True)}
        yield path, _SERVICE, properties
        for one in service.characteristics:
            handle += 1
            yield f"{path}/char{handle:04x}", _CHARACTERISTIC, _properties(one, path)
            handle += 2 if "notify" in one.properties else 1


def _properties(one: Characteristic, service: str) -> dict[str, Variant]:
    properties = {
        "UUID": Variant("s", one.uuid),
        "Service": Variant("o", service),
        "Value": Variant("ay", b""),
        "Flags": Variant("as", sorted(one.properties)),
        "MTU": Variant("q", 247),
    }
    if "notify" in one.properties:
        properties |= dict.fromkeys(("Notifying", "NotifyAcquired"), Variant("b", False))
    return properties
