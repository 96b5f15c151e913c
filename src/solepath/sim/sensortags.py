"""TI SensorTags strapped to the shoe: CC2650 (protocol/cc2650.md) and CC2541 (protocol/cc2541.md)."""

from __future__ import annotations

from math import radians

import numpy as np
from attrs import frozen

from ..link import profile
from ..types import Foot, Site
from ..vector import GRAVITY
from ..wire import cc2541, cc2650
from ..wire.device import build_battery, build_firmware
from ..wire.period import build_period
from .curves import Array
from .device import FIELD, Clock, Notification, foot_of, prepared, read_imu, samplings, seen_from, started, triples
from .parts import AK8963, BMP280, KXTJ9_IMU3000, MAG3110, MPU9250, T5400, BarometerPart, Imu
from .sensors import Instants, read_barometer, read_triad
from .shoe import ON_INSTEP, Mounting
from .walker import Walker

GYRO_COUNT = radians(500.0 / 65536.0)
"""rad/s per count of both tags: +-250 degrees/s, which a swinging foot exceeds."""
_HANDLING = 2e-3
"""s from a measurement until the radio has it."""
_PRESS = 0.25
"""s for which a key is held."""
_TEMPERATURE = 24.0
"""Degrees Celsius."""
_SLOW = 1.0
"""s between readings of the barometer, and of the CC2541's magnetometer."""


@frozen
class CC2650:
    """The newer tag: one movement characteristic at `rate` Hz (stock 10), the accelerometer at +-`range` g.

    `presses`: when the wearer presses the left key, s.
    """

    rate: float = 10.0
    range: int = 8
    mounting: Mounting = ON_INSTEP
    part: Imu = MPU9250
    ppm: float | None = None
    firmware: str = "1.40 (Nov 16 2016)"
    presses: tuple[float, ...] = ()

    def emit(self, walker: Walker, site: Site, rng: np.random.Generator) -> list[Notification]:
        foot = foot_of(site)
        clock = started(rng, 1.0 / self.rate, self.ppm)
        when = samplings(walker, clock, 1.0 / self.rate)
        motion = walker.kinematics(foot, when.fine, self.mounting)
        acc, gyro = read_imu(motion, when, self.part, self.range * GRAVITY / 32768, GYRO_COUNT, rng)
        mag = read_triad(seen_from(motion.attitude, FIELD), when, AK8963, 4912e-6 / 32760, rng)
        sent = self._setup()
        rows = zip(when.taken.tolist(), triples(gyro.counts), triples(acc.counts), triples(mag.counts), strict=True)
        for t, g, a, m in rows:
            data = cc2650.build_movement(cc2650.Movement(g, a, m))
            sent.append(Notification(t + _HANDLING, "cc2650/movement", data))
        t, pressure = _air(walker, foot, self.mounting, clock, BMP280, rng)
        for moment, value in zip(t.tolist(), pressure.tolist(), strict=True):
            data = cc2650.build_barometer(cc2650.Barometer(_TEMPERATURE, value))
            sent.append(Notification(moment + _HANDLING, "cc2650/barometer", data))
        down, up = (cc2650.build_keys(cc2650.Keys(left=left)) for left in (True, False))
        sent += _keys("cc2650/keys", self.presses, down, up)
        return sorted(sent, key=_when)

    def _setup(self) -> list[Notification]:
        config = cc2650.MovementConfig(range=self.range)
        own = {
            "device/firmware": build_firmware(self.firmware),
            "device/battery": build_battery(91),
            "cc2650/movement-period": build_period(1.0 / self.rate),
            "cc2650/movement-config": cc2650.build_movement_config(config),
            "cc2650/barometer-period": build_period(_SLOW),
        }
        return prepared(profile.CC2650, own)


T5400_CALIBRATION = cc2541.BarometerCalibration(
    c1=45697, c2=25592, c3=48894, c4=36174, c5=7001, c6=1990, c7=-2364, c8=-9363
)
"""Made up, of the size of real coefficients."""


@frozen
class CC2541:
    """The older tag: a characteristic for every sensor, each with a timer of its own.

    `rate`: 10 Hz stock, 20 Hz with modified firmware. `code` is what was written to AA12: 1, 2, 3 for 2, 4, 8 g.
    `presses`: when the wearer presses the left key, s.
    """

    rate: float = 10.0
    code: int = 3
    mounting: Mounting = ON_INSTEP
    part: Imu = KXTJ9_IMU3000
    ppm: float | None = None
    firmware: str = "1.5 (Oct 23 2013)"
    presses: tuple[float, ...] = ()

    def emit(self, walker: Walker, site: Site, rng: np.random.Generator) -> list[Notification]:
        foot, period = foot_of(site), 1.0 / self.rate
        clock = started(rng, period, self.ppm)
        acc_when = samplings(walker, clock, period)
        gyro_when = samplings(walker, clock, period, clock.first + period * float(rng.uniform()))
        mag_when = samplings(walker, clock, _SLOW, clock.first + 0.3)
        count = GRAVITY * 2**self.code / 128

        motion = walker.kinematics(foot, acc_when.fine, self.mounting)
        acc = read_triad(motion.force, acc_when, self.part.acc, count, rng)
        motion = walker.kinematics(foot, gyro_when.fine, self.mounting)
        gyro = read_triad(motion.rate, gyro_when, self.part.gyro, GYRO_COUNT, rng, force=motion.force)
        motion = walker.kinematics(foot, mag_when.fine, self.mounting)
        mag = read_triad(seen_from(motion.attitude, FIELD), mag_when, MAG3110, 2000e-6 / 65536, rng)
        t, pressure = _air(walker, foot, self.mounting, clock, T5400, rng)

        sent = self._setup()
        sent += _each(acc_when, "accelerometer", [_acc(row) for row in triples(acc.counts)])
        sent += _each(gyro_when, "gyroscope", [_gyro(row) for row in triples(gyro.counts)])
        sent += _each(mag_when, "magnetometer", [_mag(row) for row in triples(mag.counts)])
        for moment, value in zip(t.tolist(), pressure.tolist(), strict=True):
            sent.append(Notification(moment + _HANDLING, "cc2541/barometer", cc2541.build_barometer(raw_air(value))))
        down, up = (cc2541.build_keys(cc2541.Keys(left=left)) for left in (True, False))
        sent += _keys("cc2541/keys", self.presses, down, up)
        return sorted(sent, key=_when)

    def _setup(self) -> list[Notification]:
        period = build_period(1.0 / self.rate)
        config = cc2541.build_accelerometer_config(cc2541.AccelerometerConfig(self.code))
        own = {
            "device/firmware": build_firmware(self.firmware),
            "cc2541/accelerometer-period": period,
            "cc2541/accelerometer-config": config,
            "cc2541/gyroscope-period": period,
            "cc2541/magnetometer-period": build_period(_SLOW),
            "cc2541/barometer-period": build_period(_SLOW),
            "cc2541/barometer-calibration": cc2541.build_barometer_calibration(T5400_CALIBRATION),
        }
        return prepared(profile.CC2541, own)


def raw_air(pascal: float) -> cc2541.Barometer:
    """What the T5400 reports raw at this pressure: the inverse of its compensation."""
    c = T5400_CALIBRATION
    t = round((_TEMPERATURE - c.c2 / 2**10) * 2**24 / c.c1)
    low, high = (c.pascal(cc2541.Barometer(t, p)) for p in (0, 1))
    return cc2541.Barometer(t, round((pascal - low) / (high - low)))


def _air(
    walker: Walker, foot: Foot, mounting: Mounting, clock: Clock, part: BarometerPart, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Instants and readings of a barometer, s and Pa."""
    t = samplings(walker, clock, _SLOW, clock.first + 0.5).taken
    height = walker.kinematics(foot, t, mounting).position[:, 2]
    return t, read_barometer(height, t, part, rng)


def _keys(channel: str, presses: tuple[float, ...], down: bytes, up: bytes) -> list[Notification]:
    return [n for t in presses for n in (Notification(t, channel, down), Notification(t + _PRESS, channel, up))]


def _each(when: Instants, sensor: str, values: list[bytes]) -> list[Notification]:
    times = when.taken.tolist()
    return [Notification(t + _HANDLING, f"cc2541/{sensor}", data) for t, data in zip(times, values, strict=True)]


def _acc(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_accelerometer(cc2541.Accelerometer(row))


def _gyro(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_gyroscope(cc2541.Gyroscope(row))


def _mag(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_magnetometer(cc2541.Magnetometer(row))


def _when(notification: Notification) -> float:
    return notification.t
