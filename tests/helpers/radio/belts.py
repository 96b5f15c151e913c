"""Straps for the adapter's tests: their profile, and a radio that logs every request."""

from __future__ import annotations

from typing import Any

from attrs import define, evolve, field
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.backends.scanner import BaseBleakScanner
from memory_radio import MemoryRadio
from strap import BATTERY, BEAT, CONTROL, HEART_RATE, LEVEL, LOG, PAGE, Strap

from solepath.ble import Backend, DeviceConfig
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.link.profile import Access, Channel, Profile, Write
from solepath.types import Packet, Site

RATE = 10
"""Rate that the profile sets, Hz."""
STRAP = Profile(
    name="strap",
    names=(),
    services=(HEART_RATE,),
    channels=(
        Channel("strap/beat", HEART_RATE, BEAT, Access.NOTIFY),
        Channel("strap/control", HEART_RATE, CONTROL, Access.WRITE),
        Channel("strap/page", LOG, PAGE, Access.READ),
        Channel("device/battery", BATTERY, LEVEL, Access.NOTIFY),
    ),
    setup=(Write("strap/control", bytes([RATE])),),
    reads=("device/battery",),
    nominal_rate=float(RATE),
    streams=("strap/beat",),
    stale_after=1.0,
)
READ_AFTER = evolve(STRAP, setup=(Write("strap/control", bytes([RATE]), then_read=("strap/page",)),))
"""Profile of a strap whose page is read after the setup write."""


def address(number: int) -> str:
    return f"F0:00:00:00:00:{number:02X}"


def strap(number: int = 1, faults: str = "", **given: Any) -> Strap:
    return Strap(f"strap {number}", address(number), faults=parse_faults(faults), **given)


@define
class LoggedRadio:
    """An in-memory radio with a log of every request: (address, kind, channel)."""

    air: MemoryRadio
    log: list[tuple[str, str, str]] = field(factory=list)
    paired: list[bool] = field(factory=list)
    scanning: int = 0
    most: int = 0
    """Largest number of scanners at the same time."""

    @property
    def backend(self) -> Backend:
        logged_radio, beneath = self, self.air.backend
        client, scanner = beneath.client, beneath.scanner
        assert client is not None and scanner is not None

        class Client(client):  # type: ignore[valid-type,misc]
            async def connect(self, pair: bool, **more: Any) -> None:
                logged_radio.log.append((self.address, "connect", ""))
                logged_radio.paired.append(pair)
                await super().connect(pair, **more)

            async def disconnect(self) -> None:
                logged_radio.log.append((self.address, "disconnect", ""))
                await super().disconnect()

            async def read_gatt_char(self, one: BleakGATTCharacteristic, **more: Any) -> bytearray:
                logged_radio.log.append((self.address, "read", one.obj.channel))
                return await super().read_gatt_char(one, **more)

            async def write_gatt_char(self, one: BleakGATTCharacteristic, data: Any, response: bool) -> None:
                logged_radio.log.append((self.address, "write" if response else "command", one.obj.channel))
                await super().write_gatt_char(one, data, response)

            async def start_notify(self, one: BleakGATTCharacteristic, callback: Any, **more: Any) -> None:
                logged_radio.log.append((self.address, "subscribe", one.obj.channel))
                await super().start_notify(one, callback, **more)

        class Scanner(scanner):  # type: ignore[valid-type,misc]
            async def start(self) -> None:
                await super().start()
                logged_radio.scanning += 1
                logged_radio.most = max(logged_radio.most, logged_radio.scanning)

            async def stop(self) -> None:
                await super().stop()
                logged_radio.scanning -= 1

        return Backend(Client, Scanner)

    def of(self, device: Peripheral, *kinds: str) -> list[tuple[str, str]]:
        """Return the requests of these kinds to a device, in order: (kind, channel)."""
        return [(what, channel) for at, what, channel in self.log if at == device.address and what in kinds]


def logged_radio(*devices: Peripheral) -> LoggedRadio:
    return LoggedRadio(MemoryRadio(devices))


PELVIS = Site.PELVIS
ONE = DeviceConfig(PELVIS, address(1), STRAP)


def times(packets: list[Packet], channel: str) -> list[float]:
    return [packet.t for packet in packets if packet.channel == channel]


def failing(beneath: Backend, errors: list[Exception | None]) -> Backend:
    """Return a backend whose next scans fail to start with these errors, in order; None starts."""
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        async def start(self) -> None:
            error = errors.pop(0) if errors else None
            if error is not None:
                raise error
            await super().start()

    kind: type[BaseBleakScanner] = Scanner
    return Backend(beneath.client, kind)
