"""TI SensorTags strapped to the shoe: CC2650 (protocol/cc2650.md) and CC2541 (protocol/cc2541.md)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import radians
from operator import attrgetter
from typing import Any, ClassVar

import numpy as np
from attrs import asdict, frozen

from ...link.devices import cc2541, cc2650
from ...link.profile import Profile
from ...types import Foot, Site
from ...types.vector import GRAVITY
from ...wire.device import build_battery
from ...wire.fields import build_text, build_whole
from ...wire.sensortag import PERIOD
from ..wearers.curves import Array, Rng
from ..wearers.shoe import ON_INSTEP, Mounting
from ..wearers.walker import Walker
from .device import (
    HANDLING_TIME,
    DeviceClock,
    Notification,
    draw_clock,
    foot_of,
    make_sampling,
    measure_field,
    setup_notifications,
)
from .parts import AK8963, BMP280, KXTJ9_IMU3000, MAG3110, MPU9250, T5400, BarometerErrors, Imu, TriadErrors
from .sensors import measure, read_barometer, to_counts

GYRO_COUNT = radians(500.0 / 65536.0)
"""Angular rate per count of both tags, rad/s: a range of +-250 degrees/s, which a foot in swing exceeds."""
AK8963_COUNT = 4912e-6 / 32760
"""Magnetic flux density per count of the CC2650's magnetometer, T."""
MAG3110_COUNT = 2000e-6 / 65536
"""Magnetic flux density per count of the CC2541's magnetometer, T."""
SLOW_PERIOD = 1.0
"""Period of the barometer and of the CC2541's magnetometer after the usual setup, s."""
MAG_DELAY = 0.3
"""Time from the tag's first sample to the first one of the CC2541's magnetometer, s (assumed)."""
BAROMETER_DELAY = 0.5
"""Time from the tag's first sample to the first one of the barometer, s (assumed)."""
PRESS_TIME = 0.25
"""Time for which a key is held, s."""
BAROMETER_TEMPERATURE = 24.0
"""Temperature of the barometers, degrees Celsius."""
BATTERY = 91
"""Battery level of the CC2650, percent."""

ALL_AXES = (True, True, True)
RngOf = Callable[[int], Rng]
"""Generator of the errors of a chip by its number: accelerometer, gyroscope, magnetometer, barometer."""


@frozen
class TagSensor:
    """A sensor of a SensorTag, with its channels for data, configuration and period."""

    channel: str
    """Name of the data channel; the names of the other two channels add -config and -period."""
    size: int
    """Size of the data, bytes."""
    config: bytes = b"\x01"
    """Configuration that the usual setup writes."""
    max_code: int = 1
    """Largest valid first byte of a configuration."""
    delay: float = 0.0
    """Time from the tag's first sample to the first one of this sensor, s."""
    is_fast: bool = False
    """True when it measures at the rate of the tag, False when it does so every SLOW_PERIOD s."""
    default_period: float = 1.0
    """Period after connecting, s."""


@frozen(eq=False)
class Series:
    """The values of one sensor over a walk; value k is measured at true time `first` + k `step`, s.

    Numbers below 0 and after the end of the walk are valid: the wearer then stands as at the start or the end."""

    first: float
    """True time of value 0, s."""
    step: float
    """True time between values, s."""
    values: Array
    """Measured values in SI units, (N, columns)."""

    def value(self, number: int) -> Array:
        """Return the value of this number, (1, columns)."""
        row = min(max(number, 0), len(self.values) - 1)
        return self.values[row : row + 1]


@frozen(kw_only=True)
class SensorTag(ABC):
    """A SensorTag on a foot; its fields have defaults of either model."""

    rate: float = 10.0
    """Rate of the inertial sensors, Hz; stock firmware has 10."""
    mounting: Mounting = ON_INSTEP
    """Position and attitude on the foot."""
    ppm: float | None = None
    """Rate error of the clock, ppm; None: random."""
    presses: tuple[float, ...] = ()
    """Times at which the wearer presses the left key, s."""
    chip: Imu
    """Chip of the inertial sensors, with its errors."""
    firmware: str
    """Firmware version that the tag reports."""

    name: ClassVar[str]
    """Name of the product."""
    profile: ClassVar[Profile]
    keys: ClassVar[tuple[bytes, ...]]
    """Values of the channel of the keys for the left one: pressed, released."""
    mag_chip: ClassVar[TriadErrors]
    barometer_chip: ClassVar[BarometerErrors]
    constants: ClassVar[Mapping[str, bytes]]
    """Constant values by channel."""

    @property
    @abstractmethod
    def sensors(self) -> tuple[TagSensor, ...]:
        """Sensors of the tag, with the configurations of this one."""

    @abstractmethod
    def encode(self, channel: str, config: bytes, measured: Array) -> Iterable[bytes]:
        """Encode each row of measured values as data of the channel, with this configuration."""

    def draw(self, rng: Rng) -> tuple[DeviceClock, dict[str, float]]:
        """Return the clock of a tag, and the times from its first sample to the first one of each sensor, s."""
        return draw_clock(rng, 1.0 / self.rate, self.ppm), {sensor.channel: sensor.delay for sensor in self.sensors}

    def measure(
        self, channel: str, walker: Walker, foot: Foot, clock: DeviceClock, period: float, delay: float, rng_of: RngOf
    ) -> Series:
        """Return the series of a channel, with a value every `period` s of the clock."""
        first, kind = clock.first + delay, channel.partition("/")[2]
        sampling = make_sampling(walker, clock, period, first)
        if kind == "barometer":
            t = sampling.times
            height = walker.kinematics(foot, t, self.mounting).position[:, 2]
            columns = [read_barometer(height, t, self.barometer_chip, rng_of(3), walker.air)[:, None]]
        else:
            true, columns = walker.kinematics(foot, sampling.fine_times, self.mounting), []
            if kind in ("accelerometer", "movement"):
                columns.append(measure(true.force, sampling, self.chip.acc, rng_of(0)))
            if kind in ("gyroscope", "movement"):
                columns.append(measure(true.rate, sampling, self.chip.gyro, rng_of(1), true.force))
            if kind in ("magnetometer", "movement"):
                columns.append(measure_field(true, walker.field, sampling, self.mag_chip, rng_of(2)))
        return Series(first, clock.interval(period), np.concatenate(columns, axis=1))

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the tag sends over the walk, in the order of sending."""
        clock, delays = self.draw(rng)
        device_values = {"device/firmware": build_text(self.firmware), **self.constants}
        sent: list[Notification] = []
        for sensor in self.sensors:
            channel, period = sensor.channel, 1.0 / self.rate if sensor.is_fast else SLOW_PERIOD
            device_values[f"{channel}-period"] = build_whole(PERIOD, {"period": period})
            series = self.measure(channel, walker, foot_of(site), clock, period, delays[channel], lambda _: rng)
            for k, data in enumerate(self.encode(channel, sensor.config, series.values)):
                sent.append(Notification(series.first + series.step * k + HANDLING_TIME, channel, data))
        inertial = self.sensors[0]
        device_values[f"{inertial.channel}-config"] = inertial.config
        for t in self.presses:
            for when, data in zip((t, t + PRESS_TIME), self.keys, strict=True):
                sent.append(Notification(when, f"{self.profile.name}/keys", data))
        return sorted(setup_notifications(self.profile, device_values) + sent, key=attrgetter("t"))


def _counts(measured: Array, chip: TriadErrors, count: float, axes: Sequence[bool] = ALL_AXES) -> list[list[int]]:
    """Return the counts of a three-axis sensor for measured values (N, 3); axes that are off read 0."""
    counts: list[list[int]] = (to_counts(measured, chip, count).counts * axes).tolist()
    return counts


@frozen(kw_only=True)
class CC2650(SensorTag):
    """The newer SensorTag, which has one movement characteristic for all inertial sensors."""

    range: int = 8
    """Range of the accelerometer, +- g."""
    chip: Imu = MPU9250
    firmware: str = "1.40 (Nov 16 2016)"

    name = "CC2650 SensorTag"
    profile = cc2650.PROFILE
    keys = tuple(
        [cc2650.DRIVER.write("cc2650/keys", {"left": left, "right": False, "reed": False}) for left in (True, False)]
    )
    mag_chip, barometer_chip = AK8963, BMP280
    constants = {"device/battery": build_battery(BATTERY)}

    @property
    def sensors(self) -> tuple[TagSensor, ...]:
        """Sensors of the tag."""
        on = {"gyro_axes": ALL_AXES, "acc_axes": ALL_AXES, "mag": True, "wake_on_motion": False, "range": self.range}
        return (
            TagSensor(
                "cc2650/movement", 18, cc2650.DRIVER.write("cc2650/movement-config", on), max_code=255, is_fast=True
            ),
            TagSensor("cc2650/barometer", 6, delay=BAROMETER_DELAY),
        )

    def encode(self, channel: str, config: bytes, measured: Array) -> Iterable[bytes]:
        """Encode each row of measured values as data of the channel, with this configuration."""
        if channel == "cc2650/barometer":
            rows = [{"temperature": BAROMETER_TEMPERATURE, "pressure": pascal} for pascal in measured[:, 0].tolist()]
        else:
            on = cc2650.DRIVER.parse("cc2650/movement-config", bytes((config[0], config[1] & 0x03)))
            # the magnetometer's own axes: (y, x, -z) in those of accelerometer and gyroscope (protocol/cc2650.md)
            mag = measured[:, [7, 6, 8]] * [1.0, 1.0, -1.0]
            found = zip(
                _counts(measured[:, 3:6], self.chip.gyro, GYRO_COUNT, on.gyro_axes),
                _counts(measured[:, :3], self.chip.acc, on.range * GRAVITY / 32768, on.acc_axes),
                _counts(mag, AK8963, AK8963_COUNT, (on.mag,) * 3),
                strict=True,
            )
            rows = [{"gyro": g, "acc": a, "mag": m} for g, a, m in found]
        return [cc2650.DRIVER.write(channel, row) for row in rows]


T5400_CALIBRATION = cc2541.BarometerCalibration(
    c1=45697, c2=25592, c3=48894, c4=36174, c5=7001, c6=1990, c7=-2364, c8=-9363
)
"""Calibration of the CC2541's barometer; the coefficients are made up, of the size of real ones."""


def _cc2541_bytes(channel: str, **fields: Any) -> bytes:
    return build_whole(cc2541.FORMATS[channel], fields)


@frozen(kw_only=True)
class CC2541(SensorTag):
    """The older SensorTag, which has one characteristic and one timer for each sensor."""

    code: int = 3
    """Value written to the characteristic AA12: 1, 2 or 3 for an accelerometer range of +-2, +-4 or +-8 g."""
    chip: Imu = KXTJ9_IMU3000
    firmware: str = "1.5 (Oct 23 2013)"

    name = "SensorTag"
    profile = cc2541.PROFILE
    keys = tuple([_cc2541_bytes("cc2541/keys", left=left, right=False, side=False) for left in (True, False)])
    mag_chip, barometer_chip = MAG3110, T5400
    constants = {
        "cc2541/barometer-calibration": _cc2541_bytes("cc2541/barometer-calibration", **asdict(T5400_CALIBRATION))
    }

    @property
    def sensors(self) -> tuple[TagSensor, ...]:
        """Sensors of the tag."""
        return (
            TagSensor("cc2541/accelerometer", 3, bytes([self.code]), max_code=3, is_fast=True),
            TagSensor("cc2541/gyroscope", 6, b"\x07", max_code=7, is_fast=True),
            TagSensor("cc2541/magnetometer", 6, delay=MAG_DELAY, default_period=2.0),
            TagSensor("cc2541/barometer", 4, delay=BAROMETER_DELAY),
        )

    def draw(self, rng: Rng) -> tuple[DeviceClock, dict[str, float]]:
        """Return the clock of a tag, and the delays of its sensors; that of the gyroscope is random."""
        clock, delays = super().draw(rng)
        return clock, {**delays, "cc2541/gyroscope": 1.0 / self.rate * float(rng.uniform())}

    def encode(self, channel: str, config: bytes, measured: Array) -> Iterable[bytes]:
        """Encode each row of measured values as data of the channel, with this configuration."""
        code, rows = config[0], list[dict[str, Any]]()
        match channel:
            case "cc2541/accelerometer":
                rows = [{"acc": row} for row in _counts(measured, self.chip.acc, GRAVITY * 2**code / 128)]
            case "cc2541/gyroscope":
                axes = [bool(code & bit) for bit in (1, 2, 4)]
                rows = [{"gyro": row} for row in _counts(measured, self.chip.gyro, GYRO_COUNT, axes)]
            case "cc2541/magnetometer":
                rows = [{"mag": row} for row in _counts(measured, MAG3110, MAG3110_COUNT)]
            case "cc2541/barometer":
                rows = [raw_barometer_values(pascal) for pascal in measured[:, 0].tolist()]
        return [_cc2541_bytes(channel, **row) for row in rows]


def raw_barometer_values(pascal: float) -> dict[str, int]:
    """Return the raw values of the T5400 at this pressure, Pa: the inverse of `BarometerCalibration.pascal`."""
    c = T5400_CALIBRATION
    temperature = round((BAROMETER_TEMPERATURE - c.c2 / 2**10) * 2**24 / c.c1)
    at_0, at_1 = c.pascal(temperature, 0), c.pascal(temperature, 1)  # linear in the raw pressure
    return {"temperature": temperature, "pressure": round((pascal - at_0) / (at_1 - at_0))}
