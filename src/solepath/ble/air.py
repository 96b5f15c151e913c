"""Who advertises: one scan for all that are sought, however many seek, and only while somebody does."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from attrs import define, field, frozen
from bleak import BleakScanner
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData

from ..link.profile import Profile
from .backend import NATIVE, Backend
from .trouble import FAILURES, BluetoothError, sentence
from .wanted import identify

RETRY = 2.0
"""s before a scan that failed is begun again."""


@frozen
class Found:
    """A device as it was last heard, `signal` in dBm, `t` s on the loop's clock. `services`: UUIDs that it names."""

    device: BLEDevice
    name: str
    services: tuple[str, ...]
    signal: int
    t: float

    @property
    def address(self) -> str:
        """As the system gives it; on macOS it is an identifier that holds on this machine only."""
        return self.device.address

    @property
    def profile(self) -> Profile | None:
        """What kind of device it is; None for a stranger."""
        return identify(self.name, self.services)


Heard = Callable[[Found], None]


@define(eq=False)
class Air:
    """Scans while there are listeners, in a task of its owner that runs `run`. `complain` gets a sentence when it
    cannot."""

    backend: Backend
    complain: Callable[[str], None]
    _listeners: list[Heard] = field(factory=list, init=False)
    _changed: asyncio.Event = field(factory=asyncio.Event, init=False)

    @contextmanager
    def listening(self, heard: Heard) -> Iterator[None]:
        """While this lasts `heard` gets every advertisement."""
        self._listeners.append(heard)
        self._changed.set()
        try:
            yield
        finally:
            self._listeners.remove(heard)
            self._changed.set()

    async def run(self) -> None:
        """Scan whenever somebody listens, for ever."""
        while True:
            await self._until(listened_to=True)
            try:
                async with scanner(self.backend, self._hear):
                    await self._until(listened_to=False)
            except FAILURES as error:
                self.complain(f"cannot look for devices: {sentence(error)}")
                await asyncio.sleep(RETRY)

    async def _until(self, listened_to: bool) -> None:
        while bool(self._listeners) is not listened_to:
            self._changed.clear()
            await self._changed.wait()

    def _hear(self, found: Found) -> None:
        for heard in tuple(self._listeners):
            heard(found)


def scanner(backend: Backend, heard: Heard) -> BleakScanner:
    """A scanner that tells `heard` of every advertisement while its context lasts."""
    loop = asyncio.get_running_loop()

    def hear(device: BLEDevice, advertisement: AdvertisementData) -> None:
        name = advertisement.local_name or device.name or ""
        heard(Found(device, name, tuple(advertisement.service_uuids), advertisement.rssi, loop.time()))

    return BleakScanner(hear, backend=backend.scanner)


async def scan(seconds: float = 4.0, *, backend: Backend = NATIVE) -> list[Found]:
    """The devices that advertise within so many seconds, strangers too, the strongest first. BluetoothError when there
    is no Bluetooth to scan with."""
    found: dict[str, Found] = {}

    def heard(one: Found) -> None:
        found[one.address] = one

    try:
        async with scanner(backend, heard):
            await asyncio.sleep(seconds)
    except FAILURES as error:
        raise BluetoothError(sentence(error)) from error
    return sorted(found.values(), key=lambda one: (-one.signal, one.address))
