"""Scanning for advertisements: all searches share one scan, which runs only while it has a listener."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from attrs import define, field, frozen
from bleak import BleakScanner
from bleak.backends.client import BaseBleakClient
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData, BaseBleakScanner

from .candidates import Advertisement
from .trouble import FAILURES, BluetoothError, describe_error


@frozen
class Backend:
    """Classes that bleak receives as `backend=` for clients and scanners; None leaves the choice to bleak."""

    client: type[BaseBleakClient] | None = None
    scanner: type[BaseBleakScanner] | None = None


NATIVE = Backend()
"""The Bluetooth of this machine."""

RETRY_DELAY = 2.0
"""Delay before a scan that failed is started again, s."""
MAX_SILENCE = 60.0
"""Time without any advertisement after which the scan is started again, s.

A scan may not survive Bluetooth being switched off and on."""
WEAKEST_SIGNAL, STRONGEST_SIGNAL = -127, 20
"""Range of the signal strength that a controller may report, dBm (Bluetooth Core, vol 4 part E, 7.7.65.2).

Any other value means that it is unknown, which is reported as WEAKEST_SIGNAL."""


OnAdvertisement = Callable[[Advertisement], None]


@define(eq=False)
class Scanner:
    """A scanner that scans while it has listeners; the owner starts `run` as a task.

    It calls `report_trouble` with a sentence when scanning fails."""

    backend: Backend
    report_trouble: Callable[[str], None]
    _listeners: list[OnAdvertisement] = field(factory=list, init=False)
    _changed: asyncio.Event = field(factory=asyncio.Event, init=False)
    _advertised_at: float = field(default=0.0, init=False)

    @contextmanager
    def listening(self, on_advertisement: OnAdvertisement) -> Iterator[None]:
        """Pass every advertisement to `on_advertisement` while the context lasts."""
        self._listeners.append(on_advertisement)
        self._changed.set()
        try:
            yield
        finally:
            self._listeners.remove(on_advertisement)
            self._changed.set()

    async def run(self) -> None:
        """Scan whenever there is a listener; never returns."""
        while True:
            while not self._listeners:
                self._changed.clear()
                await self._changed.wait()
            try:
                async with make_scanner(self.backend, self._on_advertisement):
                    await self._wait_until_unused_or_silent()
            except FAILURES as error:
                self.report_trouble(f"cannot look for devices: {describe_error(error)}")
                await asyncio.sleep(RETRY_DELAY)

    async def _wait_until_unused_or_silent(self) -> None:
        now = asyncio.get_running_loop().time
        self._advertised_at = now()
        while self._listeners and now() - self._advertised_at < MAX_SILENCE:
            self._changed.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout(MAX_SILENCE):
                    await self._changed.wait()

    def _on_advertisement(self, found: Advertisement) -> None:
        self._advertised_at = found.t
        for on_advertisement in tuple(self._listeners):
            on_advertisement(found)


def make_scanner(backend: Backend, on_advertisement: OnAdvertisement) -> BleakScanner:
    """Return a scanner that calls `on_advertisement` for every advertisement while its context lasts."""
    loop = asyncio.get_running_loop()

    def on_detection(device: BLEDevice, advertisement: AdvertisementData) -> None:
        name = (advertisement.local_name or device.name or "").encode("utf-8", "replace").decode("utf-8")
        signal = advertisement.rssi if WEAKEST_SIGNAL <= advertisement.rssi <= STRONGEST_SIGNAL else WEAKEST_SIGNAL
        services = tuple(advertisement.service_uuids)
        on_advertisement(Advertisement(device.address, name, services, signal, loop.time(), device))

    return BleakScanner(on_detection, backend=backend.scanner)


async def scan(seconds: float = 4.0, *, backend: Backend = NATIVE) -> list[Advertisement]:
    """Return the devices, also unknown ones, that advertise within `seconds`, the strongest signal first.

    Returns when the time is over. Raises BluetoothError when Bluetooth cannot be used."""
    devices: dict[str, Advertisement] = {}

    def on_advertisement(device: Advertisement) -> None:
        devices[device.address] = device.after(devices.get(device.address))

    try:
        async with make_scanner(backend, on_advertisement):
            await asyncio.sleep(seconds)
    except FAILURES as error:
        raise BluetoothError(describe_error(error)) from error
    return sorted(devices.values(), key=lambda one: (-one.signal, one.address))
