"""TI CC2541 SensorTag (protocol/cc2541.md): five sensors, each with a characteristic and the axes of its chip.

It has its own link class and no Driver, because accelerometer and gyroscope are two streams on two clocks, which
assembler.py combines, and because the accelerometer's scale depends on the firmware."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import ClassVar

from construct import Array, BitsInteger, BitsSwapped, BitStruct, Const, Flag, Int8ul, Int16sl, Int16ul, OneOf, Struct

from ...events import KeysChanged
from ...types import Sample, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, scaled
from ...wire.fields import Definition, Fields, parse_whole
from ...wire.sensortag import ON_OFF, PERIOD
from ..counters import MIN_GAP, SampleTimes
from ..kinds import MAX_PRESSURE_WAIT, DeviceKind, DeviceLink, Output
from ..periodic import PeriodicClock
from ..profile import FIRMWARE, Access, Channel, Profile, Write, standard_uuid, ti_sensor, ti_uuid
from .assembler import Assembler

STOCK_PERIOD = 0.1
"""Period that the stock profile writes, s; a recorded period write or faster arrivals show 20 Hz firmware."""
GYRO_SCALE = radians(500.0 / 65536.0)
"""Gyroscope scale, rad/s per count (TI, SensorTag user's guide: v * 500 / 65536 degrees/s)."""
MAG_SCALE = 2000.0 / 65536.0 * 1e-6
"""Magnetometer scale, T per count (TI, SensorTag user's guide: v * 2000 / 65536 uT)."""


def _profile(name: str, period: bytes, nominal_rate: float) -> Profile:
    return Profile(
        name=name,
        names=("SensorTag", "TI BLE Sensor Tag"),
        services=(),
        channels=(
            *ti_sensor("cc2541", "accelerometer", 0xAA10),
            *ti_sensor("cc2541", "magnetometer", 0xAA30),
            *ti_sensor("cc2541", "barometer", 0xAA40, period=4),
            Channel("cc2541/barometer-calibration", ti_uuid(0xAA40), ti_uuid(0xAA43), Access.READ),
            *ti_sensor("cc2541", "gyroscope", 0xAA50),
            Channel("cc2541/keys", standard_uuid(0xFFE0), standard_uuid(0xFFE1), Access.NOTIFY),
            FIRMWARE,
        ),
        setup=(
            Write("cc2541/accelerometer-period", period),
            Write("cc2541/accelerometer-config", b"\x03"),  # 8 g: the value on which published drivers agree most
            Write("cc2541/gyroscope-period", period),
            Write("cc2541/gyroscope-config", b"\x07"),
            Write("cc2541/magnetometer-period", b"\x64"),
            Write("cc2541/magnetometer-config", b"\x01"),
            Write("cc2541/barometer-period", b"\x64"),
            Write("cc2541/barometer-config", b"\x02", then_read=("cc2541/barometer-calibration",)),
            Write("cc2541/barometer-config", b"\x01"),
        ),
        reads=("device/firmware",),
        nominal_rate=nominal_rate,
        streams=("cc2541/accelerometer", "cc2541/gyroscope"),
        stale_after=2.0,
    )


PROFILE = _profile("cc2541", b"\x0a", 10.0)
PROFILE_20HZ = _profile("cc2541-20hz", b"\x05", 20.0)
"""Profile of firmware rebuilt with a lower minimum period; its advertisement is the same as the stock one's."""

FORMATS: dict[str, Definition] = {
    "cc2541/accelerometer": Struct("acc" / Fields("<3b")),
    "cc2541/accelerometer-config": Struct("code" / OneOf(Int8ul, range(4))),
    "cc2541/accelerometer-period": PERIOD,
    "cc2541/gyroscope": Struct("gyro" / Fields("<3h")),
    # From the low bit up: x, y, z.
    "cc2541/gyroscope-config": BitsSwapped(BitStruct("axes" / Array(3, Flag), Const(0, BitsInteger(5)))),
    "cc2541/gyroscope-period": PERIOD,
    "cc2541/magnetometer": Struct("mag" / Fields("<3h")),
    "cc2541/magnetometer-config": Struct("on" / ON_OFF),
    "cc2541/magnetometer-period": PERIOD,
    # Raw values of the barometer chip T5400, which its calibration converts.
    "cc2541/barometer": Struct("temperature" / Int16sl, "pressure" / Int16ul),
    # 0 is off, 1 is on, and 2 makes the calibration coefficients readable.
    "cc2541/barometer-config": Struct("code" / OneOf(Int8ul, range(3))),
    "cc2541/barometer-calibration": Struct(
        *[f"c{n}" / Int16ul for n in range(1, 5)], *[f"c{n}" / Int16sl for n in range(5, 9)]
    ),
    "cc2541/barometer-period": PERIOD,
    # The order differs from the CC2650: here the right key is bit 0.
    "cc2541/keys": BitStruct(Const(0, BitsInteger(5)), "side" / Flag, "left" / Flag, "right" / Flag),
}

COUNTS_PER_G = {
    # value of AA12 -> counts per g of the 8-bit accelerometer chip KXTJ9, from the table of protocol/cc2541.md.
    # Published drivers contradict each other (16 always, 64 always, opposite tests of the revision), so the table
    # follows the firmware. From 1.5 on, AA12 = 1, 2, 3 sets 2, 4, 8 g. Before 1.5, each of them sets 2 g.
    1: 64,
    2: 32,
    3: 16,
}
WRITTEN_ACC_CODE = 3
"""Value of AA12 (accelerometer configuration) that the profile writes."""


def counts_per_g(firmware: str, code: int) -> int:
    """Return the accelerometer's scale by firmware revision and value of AA12 (1 to 3), counts per g."""
    return COUNTS_PER_G[1 if "1.4" in firmware else code]


@frozen
class BarometerCalibration:
    """The coefficients of the barometer chip T5400, read from AA43: c1 to c4 are unsigned, c5 to c8 signed."""

    c1: int
    c2: int
    c3: int
    c4: int
    c5: int
    c6: int
    c7: int
    c8: int

    def pascal(self, temperature: int, pressure: int) -> float:
        """Return the air pressure in Pa for the raw values t and p: (S p + O) / 2^14.

        S = c3 + c4 t / 2^17 + c5 t^2 / 2^34 and O = c6 2^14 + c7 t / 2^3 + c8 t^2 / 2^19."""
        t = temperature
        sensitivity = self.c3 + self.c4 * t / 2**17 + self.c5 * t * t / 2**34
        offset = self.c6 * 2**14 + self.c7 * t / 2**3 + self.c8 * t * t / 2**19
        return (sensitivity * pressure + offset) / 2**14


Add = Callable[[Assembler, float, Vec3, float, float], list[Sample]]
"""`Assembler.add_acc` or `Assembler.add_gyro`."""


@define
class Cc2541Link(DeviceLink):
    """The link of a CC2541 at one site.

    `feed` raises WireError for a value that cannot be used, and then changes nothing. assembler.py states the latency.
    Only losses of accelerometer and gyroscope packets are estimated, from the period (periodic.py)."""

    name: ClassVar[str] = "cc2541"

    site: Site
    assembler: Assembler
    firmware: str = ""
    code: int = WRITTEN_ACC_CODE
    """Newest value of AA12 other than 0 (off); it selects the accelerometer's scale."""
    acc_clock: PeriodicClock = field(factory=lambda: PeriodicClock(STOCK_PERIOD))
    gyro_clock: PeriodicClock = field(factory=lambda: PeriodicClock(STOCK_PERIOD))
    acc_on: bool = True
    gyro_on: bool = True
    calibration: BarometerCalibration | None = None
    ahead: float = 0.0
    """Time by which the newest accelerometer time is ahead of its fit, s: the gyroscope's times are as much ahead."""
    newest_arrival: float | None = None
    """Arrival of the newest packet of either stream, s; None before the first, and after a new connection."""
    absent_since: float | None = None
    """Time of the newest sample before an absence, s, until the first sample after it; None otherwise."""
    limitation_reported: bool = False
    """True if the Limitation about the barometer was reported."""

    @property
    def may_be_silent(self) -> bool:
        return not (self.acc_on or self.gyro_on)

    @property
    def interval(self) -> float:
        return max(self.acc_clock.period, self.gyro_clock.period)

    @property
    def unsettled_until(self) -> float | None:
        """Newest time that is not comparable with times of other devices (clock.py), s."""
        acc_time = self.acc_clock.clock.unsettled_until
        return self.gyro_clock.clock.unsettled_until if acc_time is None else acc_time

    def feed(self, channel: str, data: bytes, arrival: float) -> Output:
        value = parse_whole(FORMATS[channel], data)
        match channel:
            case "cc2541/accelerometer":
                acc = scaled(value.acc, GRAVITY / counts_per_g(self.firmware, self.code))
                return self._add(self.acc_clock, Assembler.add_acc, acc, arrival, data)
            case "cc2541/gyroscope":
                gyro = scaled(value.gyro, GYRO_SCALE)
                return self._add(self.gyro_clock, Assembler.add_gyro, gyro, arrival, data)
            case "cc2541/magnetometer":
                self.assembler.mag = scaled(value.mag, MAG_SCALE)
            case "cc2541/barometer":
                return self._read_barometer(value.temperature, value.pressure, arrival)
            case "cc2541/barometer-calibration":
                self.calibration = BarometerCalibration(*[value[f"c{n}"] for n in range(1, 9)])
            case "cc2541/accelerometer-config":
                self.acc_on = value.code != 0
                self.code = value.code or self.code
            case "cc2541/gyroscope-config":
                self.gyro_on = any(value.axes)
            case "cc2541/accelerometer-period":
                self.acc_clock.set_period(value.period)
            case "cc2541/gyroscope-period":
                self.gyro_clock.set_period(value.period)
            case "cc2541/keys":
                down = tuple([name for name in ("left", "right", "side") if value[name]])
                return [KeysChanged(t=arrival, site=self.site, down=down)]
        return []

    def set_firmware(self, firmware: str) -> None:
        """Set the firmware revision, on which the accelerometer's scale depends."""
        self.firmware = firmware

    def restart_clock(self) -> None:
        """Restart the clock fits and the times, because the receiver's clock restarted."""
        self.acc_clock = PeriodicClock(self.acc_clock.period)
        self.gyro_clock = PeriodicClock(self.gyro_clock.period)
        self.assembler, self.absent_since = Assembler(self.site), None
        self.newest_arrival, self.ahead = None, 0.0

    def handle_reconnection(self) -> None:
        """Restart both streams with the next packet."""
        self.newest_arrival = self.acc_clock.newest_arrival = self.gyro_clock.newest_arrival = None

    def flush(self, known_at: float) -> Output:
        return self._end_absence(self.assembler.flush(known_at), known_at)

    def _add(self, clock: PeriodicClock, add: Add, value: Vec3, arrival: float, data: bytes) -> Output:
        """Return the samples and events of a value; an absence is one of both streams; both then restart."""
        limit, newest = max(PROFILE.stale_after, MIN_GAP * self.interval), self.newest_arrival
        sample_times = clock.add_packet(arrival, PROFILE.stale_after, data)
        out: Output = []
        if newest is None or arrival - newest > limit:
            out += self.flush(arrival)
            self.absent_since = self.assembler.newest_t or self.absent_since
            self.assembler = self.assembler.after_absence()
        self.newest_arrival = arrival
        (t,) = sample_times.times
        if not sample_times.lost_count or self.absent_since is not None:
            sample_times.gap_start = None
        out += sample_times.make_events(self.site, arrival)
        fitted = clock.clock.fit_time(clock.slot)
        if clock is self.acc_clock:
            self.ahead = t - fitted
            out += clock.report_rate(1, self.site, arrival)
        elif self.assembler.newest_acc_t is not None:  # two late starts are caught up with from different times
            t = fitted + self.ahead
        return out + self._end_absence(add(self.assembler, t, value, clock.period, arrival), arrival)

    def _end_absence(self, samples: list[Sample], arrival: float) -> Output:
        """Return the samples after the absence that the first measurement among them ends."""
        times = [sample.t for sample in samples if sample.acc is not None or sample.gyro is not None]
        if not times or self.absent_since is None:
            return [*samples]
        absence, self.absent_since = SampleTimes(times, 0, self.absent_since), None
        return [*absence.make_events(self.site, arrival), *samples]

    def _read_barometer(self, temperature: int, raw: int, arrival: float) -> Output:
        if self.calibration is None:
            return self.report_limitation("no barometer calibration (AA43) from the CC2541: no air pressure", arrival)
        pressure = self.calibration.pascal(temperature, raw)
        if self.newest_arrival is not None and arrival - self.newest_arrival <= MAX_PRESSURE_WAIT:
            self.assembler.air_pressure = pressure
            return []
        return self._end_absence(self.assembler.add_pressure_alone(arrival, pressure), arrival)


def _make_link(site: Site) -> Cc2541Link:
    return Cc2541Link(site, Assembler(site))


KIND = DeviceKind(PROFILE, _make_link, Cc2541Link.feed)
