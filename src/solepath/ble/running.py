"""Reads a sensor of the Bluetooth Running Speed and Cadence Service, of any maker (protocol/running.md).

    async with RunningSensor() as sensor:            # the nearest one; or its address or name
        async for t, measurement in sensor:
            print(measurement.speed, measurement.cadence)

It is apart from `Devices`, because such a sensor has no samples and a session therefore takes nothing from it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, suppress

from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.exc import BleakError
from bleak_retry_connector import establish_connection

from ..link.profile import standard_uuid
from ..wire.error import WireError
from ..wire.running import (
    DISTANCE_UNIT,
    RscFeature,
    RscMeasurement,
    RscOperation,
    RscRequest,
    RscResponse,
    RscResult,
    build_request,
    parse_feature,
    parse_location,
    parse_measurement,
    parse_response,
)
from .scanning import NATIVE, Backend, scan
from .trouble import FAILURES, BluetoothError, bleak_call, describe_error

SERVICE = standard_uuid(0x1814)
MEASUREMENT, FEATURE, LOCATION, CONTROL = (standard_uuid(number) for number in (0x2A53, 0x2A54, 0x2A5D, 0x2A55))
SEARCH_TIME, ANSWER_TIME = 4.0, 10.0
"""Time of the search for a sensor, and for an answer of it, s."""
MAX_UNREAD = 3600
"""Largest number of measurements that wait to be read: an hour; the oldest ones are dropped."""


class RunningSensor:
    """A connected sensor; iterate over it for (arrival time on the event loop's clock, s, measurement).

    `device`: its address or name; None for the nearest sensor with the service. `feature` and `location` are what it
    says of itself, None if it does not. `rejected` counts notifications that could not be read. Entering raises
    BluetoothError when there is no such sensor, or when it does not answer; iterating ends with the connection."""

    def __init__(
        self, device: str | None = None, *, backend: Backend = NATIVE, search_time: float = SEARCH_TIME
    ) -> None:
        self.name = self.address = ""
        self.feature: RscFeature | None = None
        self.location: int | None = None
        self.rejected = 0
        self._device, self._backend, self._search_time = device, backend, search_time
        self._queue: asyncio.Queue[tuple[float, RscMeasurement] | None] = asyncio.Queue()
        self._stack = AsyncExitStack()
        self._client: BleakClient | None = None

    async def __aenter__(self) -> RunningSensor:
        found = await scan(self._search_time, backend=self._backend)
        device = self._device
        chosen = [
            one for one in found
            if (SERVICE in one.services if device is None else device in (one.name, one.address))
        ]  # fmt: skip
        if not chosen:
            which = "no sensor of running speed and cadence" if device is None else f"no device {device!r}"
            raise BluetoothError(f"{which} is in range: wake it by moving it, and see that no other program holds it")
        self.name, self.address = chosen[0].name, chosen[0].address
        try:
            async with bleak_call(2 * ANSWER_TIME):
                client = await establish_connection(
                    BleakClient,
                    chosen[0].device,
                    self.name or self.address,
                    lambda _: self._queue.put_nowait(None),
                    backend=self._backend.client,
                )
            self._client = client
            self._stack.push_async_callback(self._disconnect, client)
            if client.services.get_characteristic(MEASUREMENT) is None:
                raise BleakError("it has no service of running speed and cadence")
            async with bleak_call(ANSWER_TIME):
                await self._set_up(client)
        except FAILURES as error:
            await self._stack.aclose()
            raise BluetoothError(f"{self.name or self.address}: {describe_error(error)}") from error
        return self

    async def __aexit__(self, *error: object) -> None:
        await self._stack.aclose()

    async def _set_up(self, client: BleakClient) -> None:
        if client.services.get_characteristic(FEATURE) is not None:
            with suppress(WireError):
                self.feature = parse_feature(bytes(await client.read_gatt_char(FEATURE)))
        if client.services.get_characteristic(LOCATION) is not None:
            with suppress(WireError):
                self.location = parse_location(bytes(await client.read_gatt_char(LOCATION)))
        await client.start_notify(MEASUREMENT, self._take)

    def _take(self, _: BleakGATTCharacteristic, data: bytearray) -> None:
        try:
            measurement = parse_measurement(bytes(data))
        except WireError:
            self.rejected += 1
            return
        if self._queue.qsize() >= MAX_UNREAD:
            self._queue.get_nowait()
        self._queue.put_nowait((asyncio.get_running_loop().time(), measurement))

    async def _disconnect(self, client: BleakClient) -> None:
        with suppress(*FAILURES):
            async with bleak_call(ANSWER_TIME):
                await client.disconnect()

    async def __aiter__(self) -> AsyncIterator[tuple[float, RscMeasurement]]:
        while (received := await self._queue.get()) is not None:
            yield received

    async def set_distance(self, distance: float) -> None:
        """Set the total distance of the sensor, m; BluetoothError when it cannot, or does not answer."""
        client = self._client
        if client is None or client.services.get_characteristic(CONTROL) is None:
            raise BluetoothError(f"{self.name or self.address} has no control point, so that its distance stays")

        responses: asyncio.Queue[RscResponse] = asyncio.Queue()

        def take(_: BleakGATTCharacteristic, data: bytearray) -> None:
            with suppress(WireError):
                responses.put_nowait(parse_response(bytes(data)))

        request = RscRequest(RscOperation.SET_DISTANCE, round(distance * DISTANCE_UNIT))
        try:
            async with bleak_call(ANSWER_TIME):
                await client.start_notify(CONTROL, take)
                await client.write_gatt_char(CONTROL, build_request(request), response=True)
                response = await responses.get()
                await client.stop_notify(CONTROL)
        except FAILURES as error:
            raise BluetoothError(f"{self.name or self.address}: {describe_error(error)}") from error
        if response.result != RscResult.SUCCESS:
            raise BluetoothError(f"{self.name or self.address}: the distance stays (result {response.result})")
