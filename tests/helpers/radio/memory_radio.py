"""A fast radio for tests: emulated devices behind bleak's own classes, in one process, without GATT.

    reach = MemoryRadio(bench.peripherals)
    device = await BleakScanner.find_device_by_name("solepath L", backend=reach.backend.scanner)
    async with BleakClient(device, backend=reach.backend.client) as client: ...

A host sees the same as on a real link: devices advertise, one host at a time connects. Each request takes its time and
is answered, rejected (BleakGATTProtocolError) or ended by the loss of the link (BleakError). A notification that is
longer than the MTU allows is cut without an error. Time is that of the running loop.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Any, ClassVar, cast

from bleak.args import SizedBuffer
from bleak.assigned_numbers import CharacteristicPropertyName
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.backends.client import BaseBleakClient, NotifyCallback
from bleak.backends.descriptor import BleakGATTDescriptor
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData, AdvertisementDataCallback, BaseBleakScanner
from bleak.backends.service import BleakGATTService, BleakGATTServiceCollection
from bleak.exc import BleakDeviceNotFoundError, BleakError, BleakGATTProtocolError
from memory_link import LoopbackLink

from solepath.ble.scanning import Backend
from solepath.emulate.devices.attributes import SMALLEST_MTU, AttCode, Characteristic
from solepath.emulate.devices.peripheral import Peripheral
from solepath.link.profile import standard_uuid

ADVERTISING = 0.1
"""Time between advertisements of a device, s."""
SIGNAL = -50
"""Received signal strength of every device, dBm."""
_SUBSCRIPTION = standard_uuid(0x2902)


class MemoryRadio:
    """The devices within reach; `mtu` is the MTU that the host requests, `round_trip` the time of a request, s."""

    def __init__(self, peripherals: Iterable[Peripheral], *, mtu: int = 247, round_trip: float = 0.015) -> None:
        self.peripherals = tuple(peripherals)
        self.mtu = mtu
        self.round_trip = round_trip
        self.paired: set[str] = set()
        """Addresses of the devices that the host is paired with."""

        class MemoryClient(_MemoryClient):
            air = self

        class MemoryScanner(_Scanner):
            air = self

        self.backend = Backend(MemoryClient, MemoryScanner)

    def advertising(self, now: float) -> list[Peripheral]:
        """Return the devices that advertise now."""
        return [device for device in self.peripherals if not device.is_connected and device.visible(now)]


class _MemoryClient(BaseBleakClient):
    air: ClassVar[MemoryRadio]

    def __init__(self, address_or_ble_device: BLEDevice | str, **kwargs: Any) -> None:
        requested: set[str] | None = kwargs.pop("services", None)
        super().__init__(address_or_ble_device, **kwargs)
        self._requested_services = requested
        self._name = address_or_ble_device.name if isinstance(address_or_ble_device, BLEDevice) else None
        self._link: LoopbackLink | None = None
        self._established = False
        self._device: Peripheral | None = None

    @property
    def name(self) -> str:
        return self._name or self.address.replace(":", "-")

    @property
    def mtu_size(self) -> int:
        return SMALLEST_MTU if self._link is None else self._link.mtu

    @property
    def is_connected(self) -> bool:
        return self._link is not None and self._link.is_up

    async def connect(self, pair: bool, **kwargs: Any) -> None:
        if self.is_connected:
            raise BleakError("already connected")
        device = await self._found(float(kwargs.get("timeout", self._timeout)))
        self._device, self._name = device, device.name
        link = self._link = LoopbackLink(device, min(self.air.mtu, device.mtu), self.air.round_trip, self._on_lost)
        try:
            await self._encrypt(pair)
        except BaseException:
            link.lose()
            raise
        self.services = _collection(device, self._requested_services, link.mtu)
        self._established = True

    async def _found(self, timeout: float) -> Peripheral:
        loop = asyncio.get_running_loop()
        give_up = loop.time() + timeout
        while True:
            await asyncio.sleep(self.air.round_trip)
            for device in self.air.advertising(loop.time()):
                if device.address.lower() == self.address.lower():
                    return device
            if loop.time() >= give_up:
                raise BleakDeviceNotFoundError(self.address, f"no device with the address {self.address} is in reach")
            await asyncio.sleep(ADVERTISING)

    async def disconnect(self) -> None:
        if self._link is not None:
            await asyncio.sleep(self.air.round_trip)
        if self._link is not None:
            self._link.lose()

    def _on_lost(self) -> None:
        established, self._established = self._established, False
        self._link, self.services = None, None
        if established and self._disconnected_callback is not None:
            self._disconnected_callback()

    async def _encrypt(self, pair: bool) -> None:
        """Encrypt the link with the keys of an earlier pairing, or pair first if `pair`."""
        link, device = self._up()
        if device.address in self.air.paired:
            await link.request(lambda now: _encrypted(device))
        elif pair:
            await self.pair()

    async def pair(self, *args: Any, **kwargs: Any) -> None:
        link, device = self._up()
        if device.address in self.air.paired:
            return
        if not await link.request(device.accepts_pairing):
            raise BleakError("the device refused to be paired")
        await link.request(lambda now: _encrypted(device))
        self.air.paired.add(device.address)

    async def unpair(self) -> None:
        """Delete the pairing and end the link."""
        self.air.paired.discard(self.address)
        await self.disconnect()

    async def read_gatt_char(self, characteristic: BleakGATTCharacteristic, **kwargs: Any) -> bytearray:
        link, device = self._up()
        channel = _channel(characteristic)
        return bytearray(await link.request(lambda now: device.read(channel, now)))

    async def write_gatt_char(self, characteristic: BleakGATTCharacteristic, data: SizedBuffer, response: bool) -> None:
        link, device = self._up()
        channel, value = _channel(characteristic), bytes(data)
        if response:
            await link.request(lambda now: device.write(channel, value, now) or None)
        else:
            link.command(lambda now: device.write(channel, value, now))

    async def read_gatt_descriptor(self, descriptor: BleakGATTDescriptor, **kwargs: Any) -> bytearray:
        link, _ = self._up()
        on = _channel_of(descriptor) in link.callbacks
        return bytearray(await link.request(lambda now: bytes([on, 0])))

    async def write_gatt_descriptor(self, descriptor: BleakGATTDescriptor, data: SizedBuffer) -> None:
        self._up()
        raise BleakGATTProtocolError(AttCode.WRITE_NOT_PERMITTED)

    async def start_notify(
        self, characteristic: BleakGATTCharacteristic, callback: NotifyCallback, **kwargs: Any
    ) -> None:
        link, device = self._up()
        channel = _channel(characteristic)
        if channel in link.callbacks:
            raise BleakError("notifications have been started already")
        link.callbacks[channel] = callback
        try:
            await link.request(lambda now: _subscribed(device, channel, True, now))
        except BaseException:
            link.callbacks.pop(channel, None)
            raise

    async def stop_notify(self, characteristic: BleakGATTCharacteristic) -> None:
        link, device = self._up()
        channel = _channel(characteristic)
        await link.request(lambda now: _subscribed(device, channel, False, now))
        link.callbacks.pop(channel, None)

    def _up(self) -> tuple[LoopbackLink, Peripheral]:
        if self._link is None or self._device is None:
            raise BleakError("not connected")
        return self._link, self._device


class _Scanner(BaseBleakScanner):
    air: ClassVar[MemoryRadio]

    def __init__(
        self,
        detection_callback: AdvertisementDataCallback | None,
        service_uuids: list[str] | None,
        scanning_mode: str,
        **kwargs: Any,
    ) -> None:
        super().__init__(detection_callback, service_uuids)
        self._timer: asyncio.Handle | None = None

    async def start(self) -> None:
        if self._timer is not None:
            raise BleakError("scanning already")
        self.seen_devices = {}
        self._timer = asyncio.get_running_loop().call_soon(self._listen)

    async def stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _listen(self) -> None:
        loop = asyncio.get_running_loop()
        self._timer = loop.call_later(ADVERTISING, self._listen)
        for device in self.air.advertising(loop.time()):
            advertisement = AdvertisementData(
                local_name=device.name,
                manufacturer_data={},
                service_data={},
                service_uuids=list(device.advertised),
                tx_power=None,
                rssi=SIGNAL,
                platform_data=(device,),
            )
            if self.is_allowed_uuid(advertisement.service_uuids):
                seen = self.create_or_update_device(device.address, device.address, device.name, device, advertisement)
                self.call_detection_callbacks(seen, advertisement)


def _collection(device: Peripheral, requested: set[str] | None, mtu: int) -> BleakGATTServiceCollection:
    """Return the device's attributes as discovery finds them, with consecutive handles."""
    found = BleakGATTServiceCollection()
    handle = 0
    for service in device.services:
        handle += 1
        if requested and service.uuid not in requested:
            continue
        group = BleakGATTService(service, handle, service.uuid)
        found.add_service(group)
        for characteristic in service.characteristics:
            handle += 1
            names = cast(list[CharacteristicPropertyName], sorted(characteristic.properties))
            one = BleakGATTCharacteristic(characteristic, handle, characteristic.uuid, names, lambda: mtu - 3, group)
            found.add_characteristic(one)
            handle += 1
            if "notify" in characteristic.properties:
                handle += 1
                found.add_descriptor(BleakGATTDescriptor(characteristic, handle, _SUBSCRIPTION, one))
    return found


def _channel(characteristic: BleakGATTCharacteristic) -> str:
    attribute: Characteristic = characteristic.obj
    return attribute.channel


def _channel_of(descriptor: BleakGATTDescriptor) -> str:
    attribute: Characteristic = descriptor.obj
    return attribute.channel


def _subscribed(device: Peripheral, channel: str, on: bool, now: float) -> bool:
    device.subscribe(channel, on, now)
    return True


def _encrypted(device: Peripheral) -> bool:
    device.is_encrypted = True
    return True
