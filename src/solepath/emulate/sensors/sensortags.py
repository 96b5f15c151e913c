"""TI SensorTags strapped to the shoe: CC2650 (protocol/cc2650.md) and CC2541 (protocol/cc2541.md)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import radians
from operator import attrgetter
from typing import Any

import numpy as np
from attrs import asdict, frozen

from ...link.devices import cc2541, cc2650
from ...types import Site
from ...types.vector import GRAVITY
from ...wire.device import build_battery, build_firmware
from ...wire.fields import build_whole
from ...wire.sensortag import PERIOD
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

Counts = tuple[int, int, int]
_ON = (True, True, True)
_EVERYTHING = {"gyro_axes": _ON, "acc_axes": _ON, "mag": True, "wake_on_motion": False}
CC2650_KEYS = tuple(
    [cc2650.DRIVER.write("cc2650/keys", {"left": left, "right": False, "reed": False}) for left in (True, False)]
)
"""The left key down, and up."""


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
            data = movement_bytes(*row)
            sent.append(Notification(acc.taken(k) + HANDLING, "cc2650/movement", data))
        air = worn.air(SLOW, BMP280, rng)
        for k, (pascal,) in enumerate(air.values.tolist()):
            sent.append(Notification(air.taken(k) + HANDLING, "cc2650/barometer", cc2650_air(pascal)))
        sent += _keys("cc2650/keys", self.presses, *CC2650_KEYS)
        return sorted(sent, key=attrgetter("t"))

    def _setup(self) -> list[Notification]:
        config = {**_EVERYTHING, "range": self.range}
        own = {
            "device/firmware": build_firmware(self.firmware),
            "device/battery": build_battery(BATTERY),
            "cc2650/movement-period": build_whole(PERIOD, {"period": 1.0 / self.rate}),
            "cc2650/movement-config": cc2650.DRIVER.write("cc2650/movement-config", config),
            "cc2650/barometer-period": build_whole(PERIOD, {"period": SLOW}),
        }
        return prepared(cc2650.PROFILE, own)


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
        accs, gyros = acc.counts(self.part.acc, code_count(self.code)), gyro.counts(self.part.gyro, GYRO_COUNT)
        sent += _each(acc, "accelerometer", [{"acc": row} for row in accs])
        sent += _each(gyro, "gyroscope", [{"gyro": row} for row in gyros])
        sent += _each(mag, "magnetometer", [{"mag": row} for row in mag.counts(MAG3110, MAG3110_COUNT)])
        sent += _each(air, "barometer", [raw_air(pascal) for (pascal,) in air.values.tolist()])
        sent += _keys("cc2541/keys", self.presses, *CC2541_KEYS)
        return sorted(sent, key=attrgetter("t"))

    def _setup(self) -> list[Notification]:
        period = build_whole(PERIOD, {"period": 1.0 / self.rate})
        config = cc2541_bytes("accelerometer-config", code=self.code)
        own = {
            "device/firmware": build_firmware(self.firmware),
            "cc2541/accelerometer-period": period,
            "cc2541/accelerometer-config": config,
            "cc2541/gyroscope-period": period,
            "cc2541/magnetometer-period": build_whole(PERIOD, {"period": SLOW}),
            "cc2541/barometer-period": build_whole(PERIOD, {"period": SLOW}),
            "cc2541/barometer-calibration": calibration_bytes(),
        }
        return prepared(cc2541.PROFILE, own)


def cc2541_bytes(sensor: str, **fields: Any) -> bytes:
    """What a sensor of a CC2541 says."""
    return build_whole(cc2541.FORMATS[f"cc2541/{sensor}"], fields)


CC2541_KEYS = tuple([cc2541_bytes("keys", left=left, right=False, side=False) for left in (True, False)])
"""The left key down, and up."""


def raw_air(pascal: float) -> dict[str, int]:
    """What the T5400 reports raw at this pressure: the inverse of its compensation."""
    c = T5400_CALIBRATION
    t = round((TEMPERATURE - c.c2 / 2**10) * 2**24 / c.c1)
    low, high = c.pascal(t, 0), c.pascal(t, 1)
    return {"temperature": t, "pressure": round((pascal - low) / (high - low))}


def calibration_bytes() -> bytes:
    return cc2541_bytes("barometer-calibration", **asdict(T5400_CALIBRATION))


def _keys(channel: str, presses: tuple[float, ...], down: bytes, up: bytes) -> list[Notification]:
    return [n for t in presses for n in (Notification(t, channel, down), Notification(t + PRESS, channel, up))]


def _each(series: Series, sensor: str, said: Sequence[Mapping[str, Any]]) -> list[Notification]:
    when = [series.taken(k) + HANDLING for k in range(len(said))]
    return [
        Notification(t, f"cc2541/{sensor}", cc2541_bytes(sensor, **fields))
        for t, fields in zip(when, said, strict=True)
    ]


def cc2650_air(pascal: float) -> bytes:
    """What the barometer of a CC2650 says of this pressure."""
    return cc2650.DRIVER.write("cc2650/barometer", {"temperature": TEMPERATURE, "pressure": pascal})


def movement_bytes(gyro: Counts, acc: Counts, mag: Counts) -> bytes:
    """What the movement sensor of a CC2650 says."""
    return cc2650.DRIVER.write("cc2650/movement", {"gyro": gyro, "acc": acc, "mag": mag})


def range_count(gravities: int) -> float:
    """m/s^2 per count of the CC2650's accelerometer at a range of +-`gravities` g."""
    return gravities * GRAVITY / 32768


def code_count(code: int) -> float:
    """m/s^2 per count of the CC2541's accelerometer when 1, 2 or 3 was written to AA12."""
    return float(GRAVITY * 2**code / 128)
