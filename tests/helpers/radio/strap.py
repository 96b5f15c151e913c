"""A minimal chest strap that sends a counter, for tests of the virtual radio; as a program it serves itself."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Sequence
from math import ceil, inf
from typing import Any

from attrs import frozen

from solepath.emulate.controllers.tcp import serve
from solepath.emulate.devices.attributes import AttCode, AttError, Characteristic, Service
from solepath.emulate.devices.peripheral import Peripheral, Placement
from solepath.types import Site


def standard(short: int) -> str:
    return f"0000{short:04x}-0000-1000-8000-00805f9b34fb"


HEART_RATE, BEAT, CONTROL = standard(0x180D), standard(0x2A37), standard(0x2A39)
BATTERY, LEVEL = standard(0x180F), standard(0x2A19)
LOG, PAGE = "7b9e0001-52f4-4f0c-9a51-3c1f6d2f8e10", "7b9e0002-52f4-4f0c-9a51-3c1f6d2f8e10"
SERVICES = (
    Service(
        HEART_RATE,
        (
            Characteristic(BEAT, "strap/beat", frozenset({"notify"})),
            Characteristic(CONTROL, "strap/control", frozenset({"read", "write", "write-without-response"})),
        ),
    ),
    Service(BATTERY, (Characteristic(LEVEL, "device/battery", frozenset({"read"})),)),
    Service(LOG, (Characteristic(PAGE, "strap/page", frozenset({"read"})),)),
)
BOOK = bytes(range(250)) * 2
"""Value of strap/page, which is longer than any packet."""


@frozen
class Count:
    """A value source of consecutive numbers at `rate` Hz, each in `size` bytes."""

    rate: float
    size: int

    def first_number_from(self, t: float) -> int:
        return max(0, ceil(t * self.rate - 1e-6))

    def due(self, number: int) -> float:
        return number / self.rate if self.rate else inf

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return [number.to_bytes(4, "little").ljust(self.size, b".")]


class Strap(Peripheral):
    """A strap that sends a counter at the rate, Hz, that one byte written to strap/control sets."""

    size = 20

    def __init__(self, name: str, address: str, *, advertised: Sequence[str] = (HEART_RATE,), **given: Any) -> None:
        super().__init__(Placement(Site.PELVIS, address, **given), name, SERVICES, advertised)
        self.rate = 0

    def value(self, channel: str, t: float) -> bytes:
        return {"strap/control": bytes([self.rate]), "device/battery": b"\x57", "strap/page": BOOK}[channel]

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        if len(value) != 1:
            raise AttError(AttCode.WRONG_LENGTH)
        self.rate = value[0]
        self.flow("strap/beat", Count(self.rate, self.size) if self.rate else None, t)

    def stop(self) -> None:
        self.rate = 0


async def main(port: int) -> None:
    async with serve([Strap("one", "F0:00:00:00:00:01"), Strap("two", "F0:00:00:00:00:02")], "127.0.0.1", port) as at:
        print(at[1], flush=True)
        await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(main(int(sys.argv[1])))
