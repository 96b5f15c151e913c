"""The attributes of a device and the errors that it answers with; what an advertisement holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import IntEnum
from math import ceil, floor, inf

from attrs import frozen

from ...link.profile import Profile, standard
from ...wire.device import build_battery, build_firmware


class AttCode(IntEnum):
    """Why a request is refused (Bluetooth Core, vol 3 part F, 3.4.1.1)."""

    READ_NOT_PERMITTED = 0x02
    WRITE_NOT_PERMITTED = 0x03
    NOT_PAIRED = 0x05
    REQUEST_NOT_SUPPORTED = 0x06
    WRONG_LENGTH = 0x0D
    APPLICATION_ERROR = 0x80
    """The first of the codes that an application may give a meaning."""


SMALLEST_MTU = 23
ADVERTISEMENT = 31
"""Bytes of a legacy advertisement (Bluetooth Core, vol 6 part B, 2.3.1)."""
SIG = "-0000-1000-8000-00805f9b34fb"
"""What the UUIDs of the Bluetooth SIG end with; of the first half only 16 bits are their own."""


class AttError(Exception):
    """A request is refused with this ATT error code."""

    def __init__(self, code: int) -> None:
        super().__init__(f"ATT error {code:#04x}")
        self.code = code


@frozen
class Characteristic:
    """`uuid`: in full, lower case. `channel`: the name by which it is read and written here.
    `properties`: of "read", "write", "write-without-response" and "notify"."""

    uuid: str
    channel: str
    properties: frozenset[str]


@frozen
class Service:
    """A primary service, its uuid in full, lower case."""

    uuid: str
    characteristics: tuple[Characteristic, ...]


@frozen
class Outgoing:
    """A notification to be sent now."""

    channel: str
    value: bytes


def is_short(uuid: str) -> bool:
    """Whether 16 bits say the UUID, since it is one of the Bluetooth SIG's."""
    return uuid.startswith("0000") and uuid.endswith(SIG)


def check_fits(name: str, services: Sequence[str]) -> None:
    """ValueError when the complete name and all services are more than an advertisement holds."""
    short = sum(map(is_short, services))
    long = len(services) - short
    size = 2 + len(name.encode()) + (2 + 2 * short if short else 0) + (2 + 16 * long if long else 0)
    if size > ADVERTISEMENT:
        raise ValueError(f"the name {name!r} and the services make {size} bytes, {ADVERTISEMENT} fit")


READ = frozenset({"read"})
NOTIFY = frozenset({"notify"})
WRITE = frozenset({"write"})

BATTERY_STEP = 600.0
"""s in which the battery loses one percent."""

_INFORMATION = {"manufacturer": 0x2A29, "model": 0x2A24, "hardware": 0x2A27, "software": 0x2A28}
_DEVICE_INFORMATION = 0x180A


def services(
    profile: Profile,
    properties: Mapping[str, frozenset[str]],
    more: Sequence[tuple[str, Characteristic]] = (),
    information: Sequence[str] = (),
) -> tuple[Service, ...]:
    """The services of a device: the profile's channels with their `properties`, `more` (service, characteristic), and
    what else Device Information tells (of manufacturer, model, hardware and software)."""
    table = [(c.service, Characteristic(c.characteristic, c.name, properties[c.name])) for c in profile.channels]
    table += more
    for name in information:
        what = Characteristic(standard(_INFORMATION[name]), f"device/{name}", READ)
        table.append((standard(_DEVICE_INFORMATION), what))
    found: dict[str, list[Characteristic]] = {}
    for service, characteristic in table:
        found.setdefault(service, []).append(characteristic)
    return tuple(Service(uuid, tuple(characteristics)) for uuid, characteristics in found.items())


def information(firmware: str, **more: str) -> dict[str, bytes]:
    """What Device Information says, by channel."""
    found = {"device/firmware": build_firmware(firmware)}
    return found | {f"device/{name}": text.encode() for name, text in more.items()}


@frozen
class Battery:
    """A Source: the level changes every `DRAIN` s of the walk, from `percent` at its beginning."""

    percent: int

    def level(self, t: float) -> bytes:
        return build_battery(max(0, self.percent - max(0, floor(t / BATTERY_STEP))))

    def after(self, t: float) -> int:
        return max(1, ceil(t / BATTERY_STEP))

    def due(self, number: int) -> float:
        return number * BATTERY_STEP if number <= self.percent else inf

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.level(number * BATTERY_STEP),)
