"""Attributes of a device, the ATT errors that it answers with, and the size limit of its advertisement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import IntEnum
from math import ceil, floor, inf

from attrs import frozen

from ...link.profile import FIRMWARE, Profile, standard_uuid
from ...wire.device import build_battery
from ...wire.fields import build_text


class AttCode(IntEnum):
    """ATT error codes (Bluetooth Core, vol 3 part F, 3.4.1.1)."""

    READ_NOT_PERMITTED = 0x02
    WRITE_NOT_PERMITTED = 0x03
    NOT_PAIRED = 0x05
    REQUEST_NOT_SUPPORTED = 0x06
    WRONG_LENGTH = 0x0D
    APPLICATION_ERROR = 0x80
    """First of the codes that an application may define."""


SMALLEST_MTU = 23
"""Smallest ATT MTU, bytes; a link has it until both sides agree on a larger one."""
ATT_HEADER_SIZE = 3
"""Bytes of an ATT packet before the value that it delivers."""
MAX_ADVERTISEMENT_SIZE = 31
"""Largest size of a legacy advertisement, bytes (Bluetooth Core, vol 6 part B, 2.3.1)."""
SIG_UUID_END = "-0000-1000-8000-00805f9b34fb"
"""End of every UUID that the Bluetooth SIG assigns; these UUIDs differ only in 16 bits of the start."""


class AttError(Exception):
    """The error code with which the device rejects a request."""

    def __init__(self, code: int) -> None:
        super().__init__(f"ATT error {code:#04x}")
        self.code = code


@frozen
class Characteristic:
    """A GATT characteristic of an emulated device."""

    uuid: str
    """Full UUID in lower case."""
    channel: str
    """Name of the channel whose values are read, written or notified here."""
    properties: frozenset[str]
    """Subset of "read", "write", "write-without-response" and "notify"."""


@frozen
class Service:
    """A primary GATT service."""

    uuid: str
    """Full UUID in lower case."""
    characteristics: tuple[Characteristic, ...]


@frozen
class Outgoing:
    """A notification that must be sent now."""

    channel: str
    value: bytes


def is_short(uuid: str) -> bool:
    """Return whether the Bluetooth SIG assigned the UUID, so that 16 bits identify it."""
    return uuid.startswith("0000") and uuid.endswith(SIG_UUID_END)


def check_fits(name: str, services: Sequence[str]) -> None:
    """Raise ValueError when the complete name and all services do not fit in an advertisement."""
    short = sum(map(is_short, services))
    long = len(services) - short
    # Each list and the name have 2 bytes for length and type.
    size = 2 + len(name.encode()) + (2 + 2 * short if short else 0) + (2 + 16 * long if long else 0)
    if size > MAX_ADVERTISEMENT_SIZE:
        raise ValueError(f"the name {name!r} and the services make {size} bytes, {MAX_ADVERTISEMENT_SIZE} fit")


READ = frozenset({"read"})
NOTIFY = frozenset({"notify"})
WRITE = frozenset({"write"})

BATTERY_STEP = 600.0
"""Time in which the battery loses one percent, s (assumed)."""

_INFORMATION_NUMBERS = {"manufacturer": 0x2A29, "model": 0x2A24, "hardware": 0x2A27, "software": 0x2A28}


def services(
    profile: Profile,
    properties: Mapping[str, frozenset[str]],
    more: Sequence[tuple[str, Characteristic]] = (),
    information_names: Sequence[str] = (),
) -> tuple[Service, ...]:
    """Return the services of a device.

    They contain the channels of `profile`, with their `properties` by name, the pairs (UUID of the service,
    characteristic) of `more`, and the characteristics of Device Information with the names `information_names`, which
    are those of `_INFORMATION_NUMBERS`."""
    table = [(c.service, Characteristic(c.characteristic, c.name, properties[c.name])) for c in profile.channels]
    table += more
    table += [
        (FIRMWARE.service, Characteristic(standard_uuid(_INFORMATION_NUMBERS[name]), f"device/{name}", READ))
        for name in information_names
    ]
    found: dict[str, list[Characteristic]] = {}
    for service, characteristic in table:
        found.setdefault(service, []).append(characteristic)
    return tuple(Service(uuid, tuple(characteristics)) for uuid, characteristics in found.items())


def device_information(firmware: str, **more: str) -> dict[str, bytes]:
    """Return the values of Device Information by channel; `more` has texts by the names of `_INFORMATION_NUMBERS`."""
    found = {"device/firmware": build_text(firmware)}
    return found | {f"device/{name}": text.encode() for name, text in more.items()}


@frozen
class Battery:
    """The battery level as a ValueSource: value k is due at k BATTERY_STEP s, when the level falls by one percent."""

    percent: int
    """Level at the start of the walk, percent."""

    def level(self, t: float) -> bytes:
        """Return the value of the battery characteristic at `t` s of the walk."""
        return build_battery(max(0, self.percent - max(0, floor(t / BATTERY_STEP))))

    def first_number_from(self, t: float) -> int:
        return max(1, ceil(t / BATTERY_STEP))

    def due(self, number: int) -> float:
        return number * BATTERY_STEP if number <= self.percent else inf

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.level(number * BATTERY_STEP),)
