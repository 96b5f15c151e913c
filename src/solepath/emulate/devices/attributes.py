"""The attributes of a device and the errors that it answers with; what an advertisement holds."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import frozen

READ_NOT_PERMITTED = 0x02
WRITE_NOT_PERMITTED = 0x03
NOT_PAIRED = 0x05
"""Insufficient authentication (Bluetooth Core, vol 3 part C, 10.3.1)."""
REQUEST_NOT_SUPPORTED = 0x06
WRONG_LENGTH = 0x0D
REFUSED = 0x80
"""The first of the codes that an application may give a meaning (Bluetooth Core, vol 3 part F, 3.4.1.1)."""

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


def standard(short: int) -> str:
    """The full UUID of a 16-bit one."""
    return f"0000{short:04x}{SIG}"


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
