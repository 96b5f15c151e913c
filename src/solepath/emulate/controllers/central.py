"""Client and scanner of bleak over a virtual central, to be passed as `BleakClient(..., backend=)`."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from functools import partial
from typing import Any, ClassVar, TypeVar

from bleak import BleakScanner
from bleak.args import SizedBuffer
from bleak.assigned_numbers import gatt_char_props_to_strs
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.backends.client import BaseBleakClient, NotifyCallback
from bleak.backends.descriptor import BleakGATTDescriptor
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData, AdvertisementDataCallback, BaseBleakScanner
from bleak.backends.service import BleakGATTService, BleakGATTServiceCollection
from bleak.exc import BleakDeviceNotFoundError, BleakError, BleakGATTProtocolError
from bleak.uuids import normalize_uuid_str
from bumble import att, core, hci, smp
from bumble.core import AdvertisingData
from bumble.device import Advertisement, Connection, Peer

from ...ble.scanning import Backend
from ..devices.attributes import ATT_HEADER_SIZE, SMALLEST_MTU
from .radio import VirtualRadio, end_link

_T = TypeVar("_T")

_PAIRING_TIMEOUT = 30.0
"""Time after which a pairing has failed, s (Bluetooth Core, vol 3 part H, 3.4)."""
_PAIRING_ERRORS: dict[tuple[str, int | None], str] = {
    ("smp", int(smp.ErrorCode.PAIRING_NOT_SUPPORTED)): "the device rejected the pairing",
    ("hci", int(hci.HCI_ErrorCode.PIN_OR_KEY_MISSING_ERROR)): "the device has forgotten the pairing: unpair it here "
    "too, and pair again",
}
_SERVICE_LISTS = (
    AdvertisingData.INCOMPLETE_LIST_OF_16_BIT_SERVICE_CLASS_UUIDS,
    AdvertisingData.INCOMPLETE_LIST_OF_128_BIT_SERVICE_CLASS_UUIDS,
)
"""Lists of services in the advertisements of emulated devices (server.py)."""


def backend_of(radio: VirtualRadio) -> Backend:
    """Return the classes that make bleak use this radio."""

    class VirtualScanner(RadioScanner):
        pass

    class VirtualClient(RadioClient):
        pass

    VirtualScanner.radio = VirtualClient.radio = radio
    VirtualClient.scanner = VirtualScanner
    return Backend(client=VirtualClient, scanner=VirtualScanner)


def _uuid(uuid: core.UUID) -> str:
    return normalize_uuid_str(uuid.to_hex_str("-"))


class RadioScanner(BaseBleakScanner):
    """A scanner of the advertisements on the virtual medium."""

    radio: ClassVar[VirtualRadio]

    def __init__(
        self,
        detection_callback: AdvertisementDataCallback | None,
        service_uuids: list[str] | None,
        scanning_mode: str = "active",
        **kwargs: Any,
    ) -> None:
        super().__init__(detection_callback, service_uuids)

    async def start(self) -> None:
        self.seen_devices = {}
        await self.radio.add_listener(self.on_advertisement)

    async def stop(self) -> None:
        await self.radio.remove_listener(self.on_advertisement)

    def on_advertisement(self, advertisement: Advertisement) -> None:
        """Report one advertisement to the callbacks of bleak."""
        fields = advertisement.data
        lists = [listed for kind in _SERVICE_LISTS for listed in fields.get_all(kind) if isinstance(listed, list)]
        services = [_uuid(uuid) for listed in lists for uuid in listed]
        name = fields.get(AdvertisingData.COMPLETE_LOCAL_NAME)
        data = AdvertisementData(
            local_name=name,
            manufacturer_data={},
            service_data={},
            service_uuids=list(dict.fromkeys(services)),
            tx_power=None,
            rssi=advertisement.rssi,
            platform_data=(advertisement,),
        )
        if self.is_allowed_uuid(data.service_uuids):
            address = advertisement.address.to_string(False)
            device = self.create_or_update_device(address, address, name, {"peer": advertisement.address}, data)
            self.call_detection_callbacks(device, data)


class RadioClient(BaseBleakClient):
    """A GATT client on the virtual medium.

    When an established link ends, whichever side ended it, the disconnected callback is called once, and a pending
    request raises BleakError."""

    radio: ClassVar[VirtualRadio]
    scanner: ClassVar[type[RadioScanner]]

    def __init__(self, address_or_ble_device: BLEDevice | str, services: set[str] | None = None, **kwargs: Any) -> None:
        super().__init__(address_or_ble_device, **kwargs)
        self._device = address_or_ble_device if isinstance(address_or_ble_device, BLEDevice) else None
        self._requested_services = services
        self._link: Connection | None = None
        self._established = False
        self._subscriptions: dict[int, Callable[[bytes], None]] = {}

    @property
    def name(self) -> str:
        return (self._device.name if self._device is not None else None) or self.address.replace(":", "-")

    @property
    def mtu_size(self) -> int:
        return self._link.att_mtu if self._link is not None else SMALLEST_MTU

    @property
    def is_connected(self) -> bool:
        return self._link is not None

    async def connect(self, pair: bool, **kwargs: Any) -> None:
        """Connect, exchange the MTU and discover the services.

        With the keys of an earlier pairing the link is encrypted; without keys `pair` decides whether to pair. A device
        that does not answer within `timeout` s raises TimeoutError. An address that no device advertises raises
        BleakDeviceNotFoundError. A link that is lost at once, or a failed pairing, raises BleakError."""
        if self._link is not None:
            raise BleakError("already connected")
        timeout: float = kwargs.get("timeout", self._timeout)
        if self._device is None:
            self._device = await BleakScanner.find_device_by_address(self.address, timeout, backend=self.scanner)
        if self._device is None:
            raise BleakDeviceNotFoundError(self.address, f"device {self.address} was not found")
        async with asyncio.timeout(timeout):
            link = await self.radio.connect(self._device.details["peer"])
            self._link = link
            link.on(Connection.EVENT_DISCONNECTION, partial(self._lost, link))
            try:
                if await self.radio.keys.get(str(link.peer_address)) is not None:
                    await self._request(link.encrypt)
                elif pair:
                    await self.pair()
                peer = Peer(link)
                await self._request(partial(peer.request_mtu, self.radio.mtu))
                self.services = await self._request(partial(self._discover, peer))
                if self._link is not link:
                    raise BleakError("the link was lost")
            except BaseException:
                await self.disconnect()
                raise
            self._established = True

    async def _discover(self, peer: Peer) -> BleakGATTServiceCollection:
        collection = BleakGATTServiceCollection()
        for service in await peer.discover_services():
            if self._requested_services and _uuid(service.uuid) not in self._requested_services:
                continue
            bleak_service = BleakGATTService(service, service.handle, _uuid(service.uuid))
            collection.add_service(bleak_service)
            for characteristic in await service.discover_characteristics():
                properties = list(gatt_char_props_to_strs(int(characteristic.properties)))
                bleak_characteristic = BleakGATTCharacteristic(
                    characteristic,
                    characteristic.handle,
                    _uuid(characteristic.uuid),
                    properties,
                    self._payload_size,
                    bleak_service,
                )
                collection.add_characteristic(bleak_characteristic)
                for descriptor in await characteristic.discover_descriptors():
                    collection.add_descriptor(
                        BleakGATTDescriptor(descriptor, descriptor.handle, _uuid(descriptor.type), bleak_characteristic)
                    )
        return collection

    def _payload_size(self) -> int:
        return self.mtu_size - ATT_HEADER_SIZE

    def _lost(self, link: Connection, reason: int) -> None:
        if self._link is not link:
            return
        established, self._established = self._established, False
        self._link = self.services = None
        self._subscriptions.clear()
        if established and self._disconnected_callback is not None:
            asyncio.get_running_loop().call_soon(self._disconnected_callback)

    async def disconnect(self) -> None:
        link = self._link
        if link is not None:
            await end_link(link)
            self._lost(link, 0)

    async def pair(self, *args: Any, **kwargs: Any) -> None:
        """Pair by LE Secure Connections, Just Works, without user input; the radio keeps the keys in memory."""
        link = self._link
        if link is None:
            raise BleakError("not connected")
        if link.is_encrypted:
            return
        try:
            async with asyncio.timeout(_PAIRING_TIMEOUT):
                await self._request(link.pair)
        except TimeoutError as error:
            await self.disconnect()
            raise BleakError("the device did not answer when it was to be paired") from error

    async def unpair(self) -> None:
        """Delete the keys of the pairing and end the link."""
        await self.radio.keys.delete(self.address)
        await self.disconnect()

    async def _request(self, exchange: Callable[[], Coroutine[Any, Any, _T]]) -> _T:
        link = self._link
        if link is None:
            raise BleakError("not connected")
        try:
            return await self.radio.finish(exchange())
        except att.ATT_Error as error:
            raise BleakGATTProtocolError(int(error.error_code)) from error
        except core.TimeoutError as error:
            # Core specification Vol 3, Part F, 3.3.3: after 30 s without an answer nothing more may be sent on the link
            await self.disconnect()
            raise BleakError("the device did not answer") from error
        except core.ProtocolError as error:
            message = _PAIRING_ERRORS.get((error.error_namespace, error.error_code))
            raise BleakError(message or str(error)) from error
        except (core.BaseBumbleError, TimeoutError) as error:
            raise BleakError(str(error)) from error

    async def read_gatt_char(self, characteristic: BleakGATTCharacteristic, **kwargs: Any) -> bytearray:
        return bytearray(await self._request(characteristic.obj.read_value))

    async def read_gatt_descriptor(self, descriptor: BleakGATTDescriptor, **kwargs: Any) -> bytearray:
        return bytearray(await self._request(descriptor.obj.read_value))

    async def write_gatt_char(self, characteristic: BleakGATTCharacteristic, data: SizedBuffer, response: bool) -> None:
        value = bytes(data)
        if not response and len(value) > self._payload_size():
            raise BleakError(f"{len(value)} bytes do not fit in a write without response ({self._payload_size()} do)")
        await self._request(partial(characteristic.obj.write_value, value, with_response=response))

    async def write_gatt_descriptor(self, descriptor: BleakGATTDescriptor, data: SizedBuffer) -> None:
        await self._request(partial(descriptor.obj.write_value, bytes(data), with_response=True))

    async def start_notify(
        self, characteristic: BleakGATTCharacteristic, callback: NotifyCallback, **kwargs: Any
    ) -> None:
        subscriber = self._subscriptions[characteristic.handle] = partial(_deliver, callback)
        try:
            await self._request(partial(characteristic.obj.subscribe, subscriber))
        except BaseException:
            self._subscriptions.pop(characteristic.handle, None)
            raise

    async def stop_notify(self, characteristic: BleakGATTCharacteristic) -> None:
        subscriber = self._subscriptions.pop(characteristic.handle, None)
        if subscriber is not None:
            # bleak's side is unsubscribed even when the device answers with an error.
            with suppress(BleakGATTProtocolError):
                await self._request(partial(characteristic.obj.unsubscribe, subscriber))


def _deliver(callback: NotifyCallback, value: bytes) -> None:
    """Call the app's callback; report its exception to the event loop, so that it is not taken for a bad packet."""
    try:
        callback(bytearray(value))
    except Exception as error:
        asyncio.get_running_loop().call_exception_handler(
            {"message": "a notification callback raised", "exception": error}
        )
