"""A declared device (link/driver.py) for tests, with or without sequence numbers and ticks, and with other values."""

from __future__ import annotations

from typing import Any

from attrs import evolve, frozen
from construct import Int8ub, Int16ub, Int32ub, Struct, Terminated
from walks import of

from solepath import Packet, Sample, Site
from solepath.link.decoder import Decoder
from solepath.link.driver import Driver, Measured, Reading
from solepath.link.kinds import make_kinds
from solepath.link.profile import BATTERY, Access, Channel, Profile, Write
from solepath.types import Cell, Foot, Layout
from solepath.wire.fields import Fields

LEFT = Site.LEFT_FOOT
ACC_AT_REST = (0.0, 0.0, 9.80665)


def channel(name: str, access: Access, number: int) -> Channel:
    return Channel(f"toy/{name}", "5d1e0001-9c60-4cf1-a1b3-1a2b3c4d5e6f", f"5d1e{number:04x}-9c60-4cf1-a1b3-0", access)


PROFILE = Profile(
    name="toy",
    names=("Toy",),
    services=(),
    channels=(
        channel("data", Access.NOTIFY, 2),
        channel("more", Access.NOTIFY, 3),
        channel("start", Access.WRITE, 4),
        BATTERY,
    ),
    setup=(Write("toy/start", b"\x01"),),
    nominal_rate=100.0,
    streams=("toy/data",),
    stale_after=1.0,
)
FORMATS = {
    "toy/data": Struct("number" / Int16ub, "ticks" / Int32ub, "count" / Int8ub, "up" / Fields(">f"), Terminated),
    "toy/more": Struct("what" / Int8ub, "value" / Fields(">d"), Terminated),
    "toy/start": Struct("go" / Int8ub, Terminated),
}
LAYOUT = Layout(3, Foot.LEFT, (Cell(0.1, 0.0),), 0.26)
MORE: dict[int, Any] = {
    0: lambda value: Reading(battery=value),
    1: lambda value: Reading(rate=value),
    2: lambda value: Reading(silent=value > 0.0),
    3: lambda value: Reading(air_pressure=value),
    4: lambda value: Reading(mag=(value, 0.0, 0.0)),
    5: lambda value: Reading(foot=Foot.LEFT if value > 0.0 else Foot.RIGHT),
    6: lambda value: Reading(keys=("left",) if value > 0.0 else ()),
    7: lambda value: Reading(layout=evolve(LAYOUT, id=3 + round(value))),
    8: lambda value: Reading(known={"acc_range": value, "times": 2.0}),
    9: lambda value: Reading((Measured(ACC_AT_REST),)),
    10: lambda value: Reading(battery=1.0 / value),
    11: lambda value: {}[value],
}


def data(sent: Any, known: Any) -> Reading:
    (up,) = sent.up
    sample = Measured((0.0, 0.0, up * known.get("times", 1.0)), (0.0, 0.0, 0.0), quat=(2.0, 0.0, 0.0, 0.0))
    return Reading((sample,) * sent.count, sequence=sent.number, ticks=sent.ticks)


def more(sent: Any, known: Any) -> Reading:
    if sent.what not in MORE:
        raise ValueError("nobody knows what this is")
    (value,) = sent.value
    reading: Reading = MORE[sent.what](value)
    return reading


BASE = Driver(PROFILE, FORMATS, {"toy/data": data, "toy/more": more})
NUMBERED = evolve(BASE, sequence=1 << 16)
TICKING = evolve(BASE, tick_rate=1e6, tick_modulus=1 << 32)
BOTH = evolve(TICKING, sequence=1 << 16)
COARSE = evolve(NUMBERED, tick_rate=1000.0, tick_modulus=86_400_000)
KIND = {"arrival": BASE, "number": NUMBERED, "ticks": TICKING, "both": BOTH, "coarse": COARSE}


@frozen
class Toy:
    """A decoder and the driver of its device."""

    driver: Driver
    decoder: Decoder

    def receive(self, t: float, name: str, value: bytes, site: Site = LEFT) -> list[Any]:
        return self.decoder.feed(Packet(t, site, f"toy/{name}", value), make_kinds([self.driver]))

    def send_data(self, t: float, number: int = 0, ticks: int = 0, count: int = 1) -> list[Any]:
        fields = {"number": number % 65536, "ticks": ticks % 2**32, "count": count, "up": [9.80665]}
        return self.receive(t, "data", self.driver.write("toy/data", fields))

    def send_more(self, t: float, what: int, value: float) -> list[Any]:
        return self.receive(t, "more", self.driver.write("toy/more", {"what": what, "value": [value]}))

    def packet(self, k: int, delay: float = 0.0, true_rate: float = 100.0, count: int = 1) -> list[Any]:
        """Feed packet k, which is `delay` s late, of a device that starts at 10 s with counters near their wraps."""
        t = 10.0 + k * count / true_rate
        unit = 1000 if self.driver is COARSE else 1_000_000
        t_first = t - (count - 1) / true_rate
        return self.send_data(
            t + delay, 65_530 + k, round(unit * t_first) - 12 * unit + (86_400_000 if unit == 1000 else 0), count
        )


def toy(driver: Driver) -> Toy:
    return Toy(driver, Decoder(LEFT))


def times(output: list[Any]) -> list[float]:
    return [sample.t for sample in of(Sample, output)]
