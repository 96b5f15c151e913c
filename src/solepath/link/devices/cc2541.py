"""One CC2541 SensorTag: five separate sensors in raw axes, scales by table, put together by the assembler."""

from __future__ import annotations

from math import radians

from attrs import define, field

from ...events import KeysChanged, Limitation, LinkEvent, PacketsLost, ScaleSuspect
from ...types import Sample, Site, Vec3
from ...types.vector import GRAVITY
from ...wire.cc2541 import (
    BarometerCalibration,
    parse_accelerometer,
    parse_accelerometer_config,
    parse_barometer,
    parse_barometer_calibration,
    parse_barometer_config,
    parse_gyroscope,
    parse_gyroscope_config,
    parse_keys,
    parse_magnetometer,
    parse_magnetometer_config,
)
from ...wire.period import parse_period
from ..periodic import Periodic, periodic
from ..rest import RestCheck, suggestion
from .assembler import Assembler

PERIOD = 0.1
"""s, what the stock profile writes; 20 Hz firmware is known by its period packet, or by its arrivals."""
GYRO = radians(500.0 / 65536.0)
"""rad/s per count (TI, SensorTag user's guide: v * 500 / 65536 degrees/s)."""
MAG = 2000.0 / 65536.0 * 1e-6
"""T per count (the same: v * 2000 / 65536 uT)."""
APART = 1.0
"""Seconds without inertial samples after which air pressure no longer waits for one to ride on."""

COUNTS_PER_G = {
    # (firmware revision contains, value of AA12) -> counts of the KXTJ9's 8 bits per g: protocol/cc2541.md's table.
    # Published drivers contradict each other (16 always, 64 always, opposite tests of the revision), so this is what
    # the firmware itself does: since 1.5, AA12 = 1, 2, 3 sets 2, 4, 8 g; before, it only switches on, at 2 g.
    ("1.4", 1): 64,
    ("1.4", 2): 64,
    ("1.4", 3): 64,
    ("", 1): 64,
    ("", 2): 32,
    ("", 3): 16,
}
WRITTEN = 3
"""AA12 as the profile writes it, until a packet says otherwise."""


def counts_per_g(firmware: str, code: int) -> int:
    """The accelerometer's scale by firmware revision and AA12 (1 to 3); "" in the table is any other revision."""
    return COUNTS_PER_G["1.4" if "1.4" in firmware else "", code]


Output = list[Sample | LinkEvent]


@define
class Cc2541Link:
    """Feeds on the channels cc2541/... of one site.

    `feed` raises WireError for what cannot be used, and then nothing has changed. Latency: see assembler.py.
    Losses of accelerometer and gyroscope are estimated by their periods (periodic.py); those of slower channels not.
    """

    site: Site
    assembler: Assembler
    firmware: str = ""
    code: int = WRITTEN
    acc: Periodic = field(factory=lambda: periodic(PERIOD))
    gyro: Periodic = field(factory=lambda: periodic(PERIOD))
    acc_on: bool = True
    gyro_on: bool = True
    calibration: BarometerCalibration | None = None
    told: bool = False
    """The Limitation about the barometer was said."""
    rest: RestCheck = field(factory=lambda: RestCheck(GRAVITY / COUNTS_PER_G["", WRITTEN]))

    @property
    def name(self) -> str:
        return "cc2541"

    @property
    def silence_is_legal(self) -> bool:
        return not (self.acc_on or self.gyro_on)

    @property
    def doubt(self) -> float | None:
        """The newest time that is not to be compared with those of other devices (clock.py), s."""
        return self.acc.clock.doubt if self.acc.clock.last_x is not None else self.gyro.clock.doubt

    def feed(self, channel: str, data: bytes, arrival: float) -> Output:
        match channel:
            case "cc2541/accelerometer":
                return self._acc(data, arrival)
            case "cc2541/gyroscope":
                return self._gyro(data, arrival)
            case "cc2541/magnetometer":
                self.assembler.mag = _scaled(parse_magnetometer(data).mag, MAG)
            case "cc2541/barometer":
                return self._barometer(data, arrival)
            case "cc2541/barometer-calibration":
                self.calibration = parse_barometer_calibration(data)
            case "cc2541/accelerometer-config":
                self._configure(parse_accelerometer_config(data).code)
            case "cc2541/gyroscope-config":
                self.gyro_on = any(parse_gyroscope_config(data).axes)
            case "cc2541/accelerometer-period":
                self._change(self.acc, parse_period(data))
            case "cc2541/gyroscope-period":
                self._change(self.gyro, parse_period(data))
            case "cc2541/magnetometer-config":
                parse_magnetometer_config(data)
            case "cc2541/barometer-config":
                parse_barometer_config(data)
            case "cc2541/magnetometer-period" | "cc2541/barometer-period":
                parse_period(data)
            case "cc2541/keys":
                down = parse_keys(data).down
                return [KeysChanged(t=arrival, known_at=arrival, site=self.site, down=down)]
        return []

    def learn_firmware(self, firmware: str) -> None:
        """The firmware revision decides on the accelerometer's scale."""
        before = counts_per_g(self.firmware, self.code)
        self.firmware = firmware
        if counts_per_g(firmware, self.code) != before:
            self._check_again()

    def forget_clock(self) -> None:
        """The receiver's clock was set back: fit anew, and let times begin anew too."""
        self.acc, self.gyro = periodic(self.acc.period), periodic(self.gyro.period)
        self.assembler = Assembler(self.site)

    def reconnected(self) -> None:
        """A new connection: nothing was under way that could end with the old one."""

    def flush(self, known_at: float) -> Output:
        return [*self.assembler.flush(known_at)]

    def _configure(self, code: int) -> None:
        self.acc_on = code != 0
        if code and code != self.code:
            before = counts_per_g(self.firmware, self.code)
            self.code = code
            if counts_per_g(self.firmware, code) != before:
                self._check_again()

    def _check_again(self) -> None:
        self.rest = RestCheck(GRAVITY / counts_per_g(self.firmware, self.code))

    def _change(self, stream: Periodic, period: float) -> None:
        if period != stream.period:
            stream.change(period)

    def _acc(self, data: bytes, arrival: float) -> Output:
        counts = parse_accelerometer(data).acc
        per_g = counts_per_g(self.firmware, self.code)
        acc = _scaled(counts, GRAVITY / per_g)
        slot = self.acc.arrive(arrival)
        out = self._lost("cc2541/accelerometer", slot.lost, slot.t_missing, arrival)
        out += self.assembler.acc(slot.t, acc, self.acc.period, arrival)
        if not self.rest.done:
            magnitude = self.rest.feed(slot.t, acc)
            if magnitude is not None:
                words = suggestion(magnitude, 128.0 / per_g)
                known_at = max(arrival, slot.t)
                out.append(
                    ScaleSuspect(t=slot.t, known_at=known_at, site=self.site, magnitude=magnitude, suggestion=words)
                )
        return out

    def _gyro(self, data: bytes, arrival: float) -> Output:
        gyro = _scaled(parse_gyroscope(data).gyro, GYRO)
        slot = self.gyro.arrive(arrival)
        out = self._lost("cc2541/gyroscope", slot.lost, slot.t_missing, arrival)
        out += self.assembler.gyro(slot.t, gyro, self.gyro.period, arrival)
        return out

    def _lost(self, channel: str, count: int, t: float, arrival: float) -> Output:
        if count == 0:
            return []
        return [PacketsLost(t=t, known_at=max(arrival, t), site=self.site, channel=channel, count=count)]

    def _barometer(self, data: bytes, arrival: float) -> Output:
        raw = parse_barometer(data)
        if self.calibration is None:
            if self.told:
                return []
            self.told = True
            what = "no barometer calibration (AA43) from the CC2541: no air pressure"
            return [Limitation(t=arrival, known_at=arrival, site=self.site, what=what)]
        pressure = self.calibration.pascal(raw)
        if any(s.arrived is not None and arrival - s.arrived <= APART for s in (self.acc, self.gyro)):
            self.assembler.air_pressure = pressure
            return []
        return [*self.assembler.pressure_alone(arrival, pressure)]


def _scaled(counts: tuple[int, int, int], scale: float) -> Vec3:
    x, y, z = counts
    return (x * scale, y * scale, z * scale)


def cc2541_link(site: Site, firmware: str) -> Cc2541Link:
    """A fresh tag at `site`."""
    link = Cc2541Link(site, Assembler(site))
    link.learn_firmware(firmware)
    return link
