"""A fast radio for tests: emulated devices behind bleak's own classes, in one process, without GATT.

    reach = MemoryRadio(bench.peripherals)
    device = await BleakScanner.find_device_by_name("solepath L", backend=reach.backend.scanner)
    async with BleakClient(device, backend=reach.backend.client) as client: ...

A host sees what it would see on a real link. Devices advertise, and one host at a time connects. Each request takes
`round_trip` s and is answered, rejected (BleakGATTProtocolError) or ended by the loss of the link (BleakError). A
notification that is longer than the MTU allows is cut without an error. Time is that of the running loop."""

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

ADVERTISING_INTERVAL = 0.1
"""Time between advertisements of a device, s."""
SIGNAL_STRENGTH = -50
"""Received signal strength of every device, dBm."""
_CONFIGURATION_UUID = standard_uuid(0x2902)


class MemoryRadio:
    """The devices within reach; `mtu` is the ATT MTU that the host requests, `round_trip` the time of a request, s."""

    def __init__(self, peripherals: Iterable[Peripheral], *, mtu: int = 247, round_trip: float = 0.015) -> None:
        self.peripherals = tuple(peripherals)
        self.mtu = mtu
        self.round_trip = round_trip
        self.paired: set[str] = set()
        """Addresses of the devices that the host is paired with."""

        class MemoryClient(_MemoryClient):
            radio = self

        class MemoryScanner(_Scanner):
            radio = self

        self.backend = Backend(MemoryClient, MemoryScanner)

    def advertising(self, now: float) -> list[Peripheral]:
        """Return the devices that advertise now."""
        return [device for device in self.peripherals if not device.is_connected and device.visible(now)]


class _MemoryClient(BaseBleakClient):
    radio: ClassVar[MemoryRadio]

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
        device = await self._find_device(float(kwargs.get("timeout", self._timeout)))
        self._device, self._name = device, device.name
        link = self._link = LoopbackLink(device, min(self.radio.mtu, device.mtu), self.radio.round_trip, self._on_lost)
        try:
            await self._encrypt(pair)
        except BaseException:
            link.lose()
            raise
        self.services = _collection(device, self._requested_services, link.mtu)
        self._established = True

    async def _find_device(self, timeout: float) -> Peripheral:
        loop = asyncio.get_running_loop()
        deadline = loop.time() + timeout
        while True:
            await asyncio.sleep(self.radio.round_trip)
            for device in self.radio.advertising(loop.time()):
                if device.address.lower() == self.address.lower():
                    return device
            if loop.time() >= deadline:
                raise BleakDeviceNotFoundError(self.address, f"no device with the address {self.address} is in reach")
            await asyncio.sleep(ADVERTISING_INTERVAL)

    async def disconnect(self) -> None:
        if self._link is not None:
            await asyncio.sleep(self.radio.round_trip)
        if self._link is not None:
            self._link.lose()

    def _on_lost(self) -> None:
        established, self._established = self._established, False
        self._link, self.services = None, None
        if established and self._disconnected_callback is not None:
            self._disconnected_callback()

    async def _encrypt(self, pair: bool) -> None:
        """Encrypt the link with the keys of an earlier pairing, or pair first if `pair`."""
        link, device = self._open_link()
        if device.address in self.radio.paired:
            await link.request(lambda now: _encrypt_link(device))
        elif pair:
            await self.pair()

    async def pair(self, *args: Any, **kwargs: Any) -> None:
        link, device = self._open_link()
        if device.address in self.radio.paired:
            return
        if not await link.request(device.accepts_pairing):
            raise BleakError("the device rejected the pairing")
        await link.request(lambda now: _encrypt_link(device))
        self.radio.paired.add(device.address)

    async def unpair(self) -> None:
        """Delete the pairing and end the link."""
        self.radio.paired.discard(self.address)
        await self.disconnect()

    async def read_gatt_char(self, characteristic: BleakGATTCharacteristic, **kwargs: Any) -> bytearray:
        link, device = self._open_link()
        channel = _channel(characteristic)
        return bytearray(await link.request(lambda now: device.read(channel, now)))

    async def write_gatt_char(self, characteristic: BleakGATTCharacteristic, data: SizedBuffer, response: bool) -> None:
        link, device = self._open_link()
        channel, value = _channel(characteristic), bytes(data)
        if response:
            await link.request(lambda now: device.write(channel, value, now) or None)
        else:
            link.command(lambda now: device.write(channel, value, now))

    async def read_gatt_descriptor(self, descriptor: BleakGATTDescriptor, **kwargs: Any) -> bytearray:
        link, _ = self._open_link()
        on = _channel_of(descriptor) in link.callbacks
        return bytearray(await link.request(lambda now: bytes([on, 0])))

    async def write_gatt_descriptor(self, descriptor: BleakGATTDescriptor, data: SizedBuffer) -> None:
        self._open_link()
        raise BleakGATTProtocolError(AttCode.WRITE_NOT_PERMITTED)

    async def start_notify(
        self, characteristic: BleakGATTCharacteristic, callback: NotifyCallback, **kwargs: Any
    ) -> None:
        link, device = self._open_link()
        channel = _channel(characteristic)
        if channel in link.callbacks:
            raise BleakError("notifications have been started already")
        link.callbacks[channel] = callback
        try:
            await link.request(lambda now: _subscribe(device, channel, True, now))
        except BaseException:
            link.callbacks.pop(channel, None)
            raise

    async def stop_notify(self, characteristic: BleakGATTCharacteristic) -> None:
        link, device = self._open_link()
        channel = _channel(characteristic)
        await link.request(lambda now: _subscribe(device, channel, False, now))
        link.callbacks.pop(channel, None)

    def _open_link(self) -> tuple[LoopbackLink, Peripheral]:
        if self._link is None or self._device is None:
            raise BleakError("not connected")
        return self._link, self._device


class _Scanner(BaseBleakScanner):
    radio: ClassVar[MemoryRadio]

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
        self._timer = loop.call_later(ADVERTISING_INTERVAL, self._listen)
        for device in self.radio.advertising(loop.time()):
            advertisement = AdvertisementData(
                local_name=device.name,
                manufacturer_data={},
                service_data={},
                service_uuids=list(device.advertised),
                tx_power=None,
                rssi=SIGNAL_STRENGTH,
                platform_data=(device,),
            )
            if self.is_allowed_uuid(advertisement.service_uuids):
                ble_device = self.create_or_update_device(
                    device.address, device.address, device.name, device, advertisement
                )
                self.call_detection_callbacks(ble_device, advertisement)


def _collection(device: Peripheral, requested: set[str] | None, mtu: int) -> BleakGATTServiceCollection:
    """Return the device's attributes as discovery finds them, with consecutive handles."""
    collection = BleakGATTServiceCollection()
    handle = 0
    for service in device.services:
        handle += 1
        if requested and service.uuid not in requested:
            continue
        group = BleakGATTService(service, handle, service.uuid)
        collection.add_service(group)
        for characteristic in service.characteristics:
            handle += 1
            names = cast(list[CharacteristicPropertyName], sorted(characteristic.properties))
            bleak_characteristic = BleakGATTCharacteristic(
                characteristic, handle, characteristic.uuid, names, lambda: mtu - 3, group
            )
            collection.add_characteristic(bleak_characteristic)
            handle += 1
            if "notify" in characteristic.properties:
                handle += 1
                collection.add_descriptor(
                    BleakGATTDescriptor(characteristic, handle, _CONFIGURATION_UUID, bleak_characteristic)
                )
    return collection


def _channel(characteristic: BleakGATTCharacteristic) -> str:
    attribute: Characteristic = characteristic.obj
    return attribute.channel


def _channel_of(descriptor: BleakGATTDescriptor) -> str:
    attribute: Characteristic = descriptor.obj
    return attribute.channel


def _subscribe(device: Peripheral, channel: str, on: bool, now: float) -> bool:
    device.subscribe(channel, on, now)
    return True


def _encrypt_link(device: Peripheral) -> bool:
    device.is_encrypted = True
    return True
