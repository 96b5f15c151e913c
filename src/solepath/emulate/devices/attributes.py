"""Attributes of a device, the ATT errors that it answers with, and the size limit of its advertisement."""

from __future__ import annotations

from collections.abc import Container, Sequence
from enum import IntEnum

from attrs import frozen

from ...link.profile import BASE_UUID, Profile


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
    return uuid.startswith("0000") and uuid.endswith(BASE_UUID)


def check_fits(name: str, services: Sequence[str]) -> None:
    """Raise ValueError when the complete name and all services do not fit in an advertisement."""
    short = sum(map(is_short, services))
    long = len(services) - short
    # Each list and the name have 2 bytes for length and type.
    size = 2 + len(name.encode()) + (2 + 2 * short if short else 0) + (2 + 16 * long if long else 0)
    if size > MAX_ADVERTISEMENT_SIZE:
        raise ValueError(f"the name {name!r} and the services make {size} bytes, {MAX_ADVERTISEMENT_SIZE} fit")


READ = frozenset({"read"})


def services(profile: Profile, readable: Container[str]) -> tuple[Service, ...]:
    """Return the services of a device with the channels of `profile`, of which the `readable` ones can be read too."""
    found: dict[str, list[Characteristic]] = {}
    for channel in profile.channels:
        properties = frozenset({channel.access.value}) | (READ if channel.name in readable else frozenset())
        characteristic = Characteristic(channel.characteristic, channel.name, properties)
        found.setdefault(channel.service, []).append(characteristic)
    return tuple(Service(uuid, tuple(characteristics)) for uuid, characteristics in found.items())
