"""TI SensorTags strapped to the shoe: CC2650 (protocol/cc2650.md) and CC2541 (protocol/cc2541.md)."""

from __future__ import annotations

from math import radians
from operator import attrgetter

import numpy as np
from attrs import frozen

from ...link import profile
from ...types import Site
from ...types.vector import GRAVITY
from ...wire import cc2541, cc2650
from ...wire.device import build_battery, build_firmware
from ...wire.period import build_period
from ..wearers.shoe import ON_INSTEP, Mounting
from ..wearers.walker import Walker
from .device import Notification, foot_of, prepared, started
from .parts import AK8963, BMP280, KXTJ9_IMU3000, MAG3110, MPU9250, T5400, Imu
from .tag_signals import HANDLING, LATE_MAG, SLOW, Series, WornTag

GYRO_COUNT = radians(500.0 / 65536.0)
"""rad/s per count of both tags: +-250 degrees/s, which a swinging foot exceeds."""
AK8963_COUNT = 4912e-6 / 32760
"""T per count of the CC2650's magnetometer."""
MAG3110_COUNT = 2000e-6 / 65536
"""T per count of the CC2541's magnetometer."""
PRESS = 0.25
"""s for which a key is held."""
TEMPERATURE = 24.0
"""Degrees Celsius."""
BATTERY = 91
"""Percent, of the CC2650."""


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
        period = 1.0 / self.rate
        worn = WornTag(walker, foot_of(site), self.mounting, started(rng, period, self.ppm))
        when = worn.when(period)
        motion = worn.motion(when)
        acc = worn.series(when, period, worn.acc(motion, when, self.part, rng))
        gyro = worn.series(when, period, worn.gyro(motion, when, self.part, rng))
        mag = worn.series(when, period, worn.mag(motion, when, AK8963, rng))
        sent = self._setup()
        counts = (
            gyro.counts(self.part.gyro, GYRO_COUNT),
            acc.counts(self.part.acc, range_count(self.range)),
            mag.counts(AK8963, AK8963_COUNT),
        )
        for k, row in enumerate(zip(*counts, strict=True)):
            data = cc2650.build_movement(cc2650.Movement(*row))
            sent.append(Notification(acc.taken(k) + HANDLING, "cc2650/movement", data))
        air = worn.air(SLOW, BMP280, rng)
        for k, (pascal,) in enumerate(air.values.tolist()):
            sent.append(Notification(air.taken(k) + HANDLING, "cc2650/barometer", cc2650_air(pascal)))
        down, up = (cc2650.build_keys(cc2650.Cc2650Keys(left=left)) for left in (True, False))
        sent += _keys("cc2650/keys", self.presses, down, up)
        return sorted(sent, key=attrgetter("t"))

    def _setup(self) -> list[Notification]:
        config = cc2650.MovementConfig(range=self.range)
        own = {
            "device/firmware": build_firmware(self.firmware),
            "device/battery": build_battery(BATTERY),
            "cc2650/movement-period": build_period(1.0 / self.rate),
            "cc2650/movement-config": cc2650.build_movement_config(config),
            "cc2650/barometer-period": build_period(SLOW),
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
        period = 1.0 / self.rate
        worn = WornTag(walker, foot_of(site), self.mounting, started(rng, period, self.ppm))
        acc_when = worn.when(period)
        gyro_when = worn.when(period, period * float(rng.uniform()))
        mag_when = worn.when(SLOW, LATE_MAG)
        acc = worn.series(acc_when, period, worn.acc(worn.motion(acc_when), acc_when, self.part, rng))
        gyro = worn.series(gyro_when, period, worn.gyro(worn.motion(gyro_when), gyro_when, self.part, rng))
        mag = worn.series(mag_when, SLOW, worn.mag(worn.motion(mag_when), mag_when, MAG3110, rng))
        air = worn.air(SLOW, T5400, rng)

        sent = self._setup()
        sent += _each(
            acc, "accelerometer", [acc_bytes(row) for row in acc.counts(self.part.acc, code_count(self.code))]
        )
        sent += _each(gyro, "gyroscope", [gyro_bytes(row) for row in gyro.counts(self.part.gyro, GYRO_COUNT)])
        sent += _each(mag, "magnetometer", [mag_bytes(row) for row in mag.counts(MAG3110, MAG3110_COUNT)])
        sent += _each(air, "barometer", [cc2541.build_barometer(raw_air(pascal)) for (pascal,) in air.values.tolist()])
        down, up = (cc2541.build_keys(cc2541.Cc2541Keys(left=left)) for left in (True, False))
        sent += _keys("cc2541/keys", self.presses, down, up)
        return sorted(sent, key=attrgetter("t"))

    def _setup(self) -> list[Notification]:
        period = build_period(1.0 / self.rate)
        config = cc2541.build_accelerometer_config(cc2541.AccelerometerConfig(self.code))
        own = {
            "device/firmware": build_firmware(self.firmware),
            "cc2541/accelerometer-period": period,
            "cc2541/accelerometer-config": config,
            "cc2541/gyroscope-period": period,
            "cc2541/magnetometer-period": build_period(SLOW),
            "cc2541/barometer-period": build_period(SLOW),
            "cc2541/barometer-calibration": cc2541.build_barometer_calibration(T5400_CALIBRATION),
        }
        return prepared(profile.CC2541, own)


def raw_air(pascal: float) -> cc2541.Cc2541Barometer:
    """What the T5400 reports raw at this pressure: the inverse of its compensation."""
    c = T5400_CALIBRATION
    t = round((TEMPERATURE - c.c2 / 2**10) * 2**24 / c.c1)
    low, high = (c.pascal(cc2541.Cc2541Barometer(t, p)) for p in (0, 1))
    return cc2541.Cc2541Barometer(t, round((pascal - low) / (high - low)))


def _keys(channel: str, presses: tuple[float, ...], down: bytes, up: bytes) -> list[Notification]:
    return [n for t in presses for n in (Notification(t, channel, down), Notification(t + PRESS, channel, up))]


def _each(series: Series, sensor: str, values: list[bytes]) -> list[Notification]:
    return [Notification(series.taken(k) + HANDLING, f"cc2541/{sensor}", data) for k, data in enumerate(values)]


def cc2650_air(pascal: float) -> bytes:
    """What the barometer of a CC2650 says of this pressure."""
    return cc2650.build_barometer(cc2650.Cc2650Barometer(TEMPERATURE, pascal))


def range_count(gravities: int) -> float:
    """m/s^2 per count of the CC2650's accelerometer at a range of +-`gravities` g."""
    return gravities * GRAVITY / 32768


def code_count(code: int) -> float:
    """m/s^2 per count of the CC2541's accelerometer when 1, 2 or 3 was written to AA12."""
    return float(GRAVITY * 2**code / 128)


def acc_bytes(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_accelerometer(cc2541.Accelerometer(row))


def gyro_bytes(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_gyroscope(cc2541.Gyroscope(row))


def mag_bytes(row: tuple[int, int, int]) -> bytes:
    return cc2541.build_magnetometer(cc2541.Magnetometer(row))
