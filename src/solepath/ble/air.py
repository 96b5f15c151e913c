"""Who advertises: one scan for all that seek, however many, only while somebody does; and whose Bluetooth it is."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from attrs import define, field, frozen
from bleak import BleakScanner
from bleak.backends.client import BaseBleakClient
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData, BaseBleakScanner

from ..link.profile import Profile
from .trouble import FAILURES, BluetoothError, sentence
from .wanted import identify


@frozen
class Backend:
    """Classes that bleak is given as `backend=` for clients and scanners; None leaves the choice to bleak."""

    client: type[BaseBleakClient] | None = None
    scanner: type[BaseBleakScanner] | None = None


NATIVE = Backend()
"""The Bluetooth of this machine."""

RETRY = 2.0
"""s before a scan that failed is begun again."""
DEAF = 60.0
"""s without any advertisement after which it is begun anew: it may not have outlived that Bluetooth was off and on."""
WEAKEST, STRONGEST = -127, 20
"""dBm that a controller may report (Bluetooth Core, vol 4 part E, 7.7.65.2); what systems say instead is no signal."""


@frozen
class Found:
    """A device as it was last heard, `signal` in dBm (-127 when the system does not know it), `t` s on the loop's
    clock. `services`: UUIDs that it names."""

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
class Scanner:
    """Scans while there are listeners, in a task of its owner that runs `run`. `complain` gets a sentence when it
    cannot."""

    backend: Backend
    complain: Callable[[str], None]
    _listeners: list[Heard] = field(factory=list, init=False)
    _changed: asyncio.Event = field(factory=asyncio.Event, init=False)
    _heard_at: float = field(default=0.0, init=False)

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
            while not self._listeners:
                self._changed.clear()
                await self._changed.wait()
            try:
                async with scanner(self.backend, self._hear):
                    await self._until_unheeded_or_deaf()
            except FAILURES as error:
                self.complain(f"cannot look for devices: {sentence(error)}")
                await asyncio.sleep(RETRY)

    async def _until_unheeded_or_deaf(self) -> None:
        now = asyncio.get_running_loop().time
        self._heard_at = now()
        while self._listeners and now() - self._heard_at < DEAF:
            self._changed.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout(DEAF):
                    await self._changed.wait()

    def _hear(self, found: Found) -> None:
        self._heard_at = found.t
        for heard in tuple(self._listeners):
            heard(found)


def scanner(backend: Backend, heard: Heard) -> BleakScanner:
    """A scanner that tells `heard` of every advertisement while its context lasts."""
    loop = asyncio.get_running_loop()

    def hear(device: BLEDevice, advertisement: AdvertisementData) -> None:
        name = (advertisement.local_name or device.name or "").encode("utf-8", "replace").decode("utf-8")
        signal = advertisement.rssi if WEAKEST <= advertisement.rssi <= STRONGEST else WEAKEST
        heard(Found(device, name, tuple(advertisement.service_uuids), signal, loop.time()))

    return BleakScanner(hear, backend=backend.scanner)


async def scan(seconds: float = 4.0, *, backend: Backend = NATIVE) -> list[Found]:
    """The devices that advertise within so many seconds, strangers too, the strongest first; known when these are over.
    BluetoothError when there is no Bluetooth to scan with."""
    found: dict[str, Found] = {}

    def heard(one: Found) -> None:
        found[one.address] = one

    try:
        async with scanner(backend, heard):
            await asyncio.sleep(seconds)
    except FAILURES as error:
        raise BluetoothError(sentence(error)) from error
    return sorted(found.values(), key=lambda one: (-one.signal, one.address))
