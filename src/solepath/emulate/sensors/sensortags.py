"""TI SensorTags strapped to the shoe: CC2650 (protocol/cc2650.md) and CC2541 (protocol/cc2541.md)."""

from __future__ import annotations

from math import radians
from operator import attrgetter
from typing import Any

from attrs import asdict, frozen

from ...link.devices import cc2541, cc2650
from ...types import Site
from ...types.vector import GRAVITY
from ...wire.device import build_battery
from ...wire.fields import build_text, build_whole
from ...wire.sensortag import PERIOD
from ..wearers.curves import Array, Rng
from ..wearers.shoe import ON_INSTEP, Mounting
from ..wearers.walker import Walker
from .device import Notification, draw_clock, foot_of, setup_notifications
from .parts import AK8963, BMP280, KXTJ9_IMU3000, MAG3110, MPU9250, T5400, Imu
from .tag_signals import BAROMETER_DELAY, MAG_DELAY, SLOW_PERIOD, Series, WornTag, counts

GYRO_COUNT = radians(500.0 / 65536.0)
"""Angular rate per count of both tags, rad/s: a range of +-250 degrees/s, which a foot in swing exceeds."""
AK8963_COUNT = 4912e-6 / 32760
"""Magnetic flux density per count of the CC2650's magnetometer, T."""
MAG3110_COUNT = 2000e-6 / 65536
"""Magnetic flux density per count of the CC2541's magnetometer, T."""
PRESS_TIME = 0.25
"""Time for which a key is held, s."""
BAROMETER_TEMPERATURE = 24.0
"""Temperature of the barometers, degrees Celsius."""
BATTERY = 91
"""Battery level of the CC2650, percent."""

_ALL_SENSORS_ON = {"gyro_axes": (True,) * 3, "acc_axes": (True,) * 3, "mag": True, "wake_on_motion": False}
CC2650_KEYS = tuple(
    [cc2650.DRIVER.write("cc2650/keys", {"left": left, "right": False, "reed": False}) for left in (True, False)]
)
"""Values of the CC2650's key channel for the left key: pressed, released."""


@frozen
class CC2650:
    """The newer SensorTag, which has one movement characteristic for all inertial sensors."""

    rate: float = 10.0
    """Rate of the movement sensor, Hz; stock firmware has 10."""
    range: int = 8
    """Range of the accelerometer, +- g."""
    mounting: Mounting = ON_INSTEP
    """Position and attitude on the foot."""
    chip: Imu = MPU9250
    """Chip of the inertial sensors, with its errors."""
    ppm: float | None = None
    """Rate error of the clock, ppm; None: random."""
    firmware: str = "1.40 (Nov 16 2016)"
    """Firmware version that the tag reports."""
    presses: tuple[float, ...] = ()
    """Times at which the wearer presses the left key, s."""

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the tag sends over the walk, in the order of sending."""
        period = 1.0 / self.rate
        worn = WornTag(walker, foot_of(site), self.mounting, draw_clock(rng, period, self.ppm))
        motion = worn.motion(period)
        acc, gyro, mag = motion.acc(self.chip, rng), motion.gyro(self.chip, rng), motion.mag(AK8963, rng)
        barometer = worn.barometer(SLOW_PERIOD, BMP280, rng)
        config = cc2650.DRIVER.write("cc2650/movement-config", {**_ALL_SENSORS_ON, "range": self.range})
        device_values = {
            "device/firmware": build_text(self.firmware),
            "device/battery": build_battery(BATTERY),
            "cc2650/movement-period": build_whole(PERIOD, {"period": period}),
            "cc2650/movement-config": config,
            "cc2650/barometer-period": build_whole(PERIOD, {"period": SLOW_PERIOD}),
        }
        movements = self.movement(
            cc2650.DRIVER.parse("cc2650/movement-config", config), acc.values, gyro.values, mag.values
        )
        sent = setup_notifications(cc2650.PROFILE, device_values) + acc.notified("cc2650/movement", movements)
        sent += barometer.notified("cc2650/barometer", map(cc2650_barometer_value, barometer.values[:, 0].tolist()))
        sent += _keys("cc2650/keys", self.presses, *CC2650_KEYS)
        return sorted(sent, key=attrgetter("t"))

    def movement(self, config: Any, acc: Array, gyro: Array, mag: Array) -> list[bytes]:
        """Encode each row of measured values as bytes of the movement channel, with the configuration `config`."""
        rows = zip(
            counts(gyro, self.chip.gyro, GYRO_COUNT, config.gyro_axes),
            counts(acc, self.chip.acc, config.range * GRAVITY / 32768, config.acc_axes),
            # the chip's own axes: (y, x, -z) in those of accelerometer and gyroscope (protocol/cc2650.md)
            counts(mag[:, [1, 0, 2]] * [1.0, 1.0, -1.0], AK8963, AK8963_COUNT, (config.mag,) * 3),
            strict=True,
        )
        return [cc2650.DRIVER.write("cc2650/movement", {"gyro": g, "acc": a, "mag": m}) for g, a, m in rows]


T5400_CALIBRATION = cc2541.BarometerCalibration(
    c1=45697, c2=25592, c3=48894, c4=36174, c5=7001, c6=1990, c7=-2364, c8=-9363
)
"""Calibration of the CC2541's barometer; the coefficients are made up, of the size of real ones."""
DELAYS = {
    "cc2541/accelerometer": 0.0,
    "cc2541/gyroscope": 0.0,
    "cc2541/magnetometer": MAG_DELAY,
    "cc2541/barometer": BAROMETER_DELAY,
}
"""Time from the tag's first sample to the first one of each sensor, s; the gyroscope has a random delay instead."""
ALL_AXES = 7
"""Configuration of the gyroscope that switches all axes on."""


@frozen
class CC2541:
    """The older SensorTag, which has one characteristic and one timer for each sensor."""

    rate: float = 10.0
    """Rate of the inertial sensors, Hz: 10 with stock firmware, 20 with modified firmware."""
    code: int = 3
    """Value written to the characteristic AA12: 1, 2 or 3 for an accelerometer range of +-2, +-4 or +-8 g."""
    mounting: Mounting = ON_INSTEP
    """Position and attitude on the foot."""
    chip: Imu = KXTJ9_IMU3000
    """Chips of the inertial sensors, with their errors."""
    ppm: float | None = None
    """Rate error of the clock, ppm; None: random."""
    firmware: str = "1.5 (Oct 23 2013)"
    """Firmware version that the tag reports."""
    presses: tuple[float, ...] = ()
    """Times at which the wearer presses the left key, s."""

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the tag sends over the walk, in the order of sending."""
        period = 1.0 / self.rate
        worn = WornTag(walker, foot_of(site), self.mounting, draw_clock(rng, period, self.ppm))
        delays = {**DELAYS, "cc2541/gyroscope": period * float(rng.uniform())}
        period_value = build_whole(PERIOD, {"period": period})
        slow_period_value = build_whole(PERIOD, {"period": SLOW_PERIOD})
        device_values = {
            "device/firmware": build_text(self.firmware),
            "cc2541/accelerometer-period": period_value,
            "cc2541/accelerometer-config": cc2541_bytes("cc2541/accelerometer-config", code=self.code),
            "cc2541/gyroscope-period": period_value,
            "cc2541/magnetometer-period": slow_period_value,
            "cc2541/barometer-period": slow_period_value,
            "cc2541/barometer-calibration": CALIBRATION_VALUE,
        }
        sent = setup_notifications(cc2541.PROFILE, device_values)
        for channel, sensor_period, code in (
            ("cc2541/accelerometer", period, self.code),
            ("cc2541/gyroscope", period, ALL_AXES),
            ("cc2541/magnetometer", SLOW_PERIOD, 1),  # 1: on; `encode` does not use it
            ("cc2541/barometer", SLOW_PERIOD, 1),
        ):
            series = self.measure(channel, worn, sensor_period, delays[channel], rng)
            sent += series.notified(channel, self.encode(channel, series.values, code))
        sent += _keys("cc2541/keys", self.presses, *CC2541_KEYS)
        return sorted(sent, key=attrgetter("t"))

    def measure(self, channel: str, worn: WornTag, period: float, delay: float, rng: Rng) -> Series:
        """Return the series of a channel, with a value every `period` s.

        The first value is `delay` s after the tag's first sample; for the barometer `delay` is ignored."""
        match channel:
            case "cc2541/accelerometer":
                return worn.motion(period, delay).acc(self.chip, rng)
            case "cc2541/gyroscope":
                return worn.motion(period, delay).gyro(self.chip, rng)
            case "cc2541/magnetometer":
                return worn.motion(period, delay).mag(MAG3110, rng)
        return worn.barometer(period, T5400, rng)

    def encode(self, channel: str, measured: Array, code: int) -> list[bytes]:
        """Encode each row of measured values as bytes of the channel, with the configuration `code`."""
        rows: list[dict[str, Any]]
        match channel:
            case "cc2541/accelerometer":
                rows = [{"acc": row} for row in counts(measured, self.chip.acc, GRAVITY * 2**code / 128)]
            case "cc2541/gyroscope":
                axes = [bool(code & bit) for bit in (1, 2, 4)]
                rows = [{"gyro": row} for row in counts(measured, self.chip.gyro, GYRO_COUNT, axes)]
            case "cc2541/magnetometer":
                rows = [{"mag": row} for row in counts(measured, MAG3110, MAG3110_COUNT)]
            case _:
                rows = [raw_barometer_values(pascal) for pascal in measured[:, 0].tolist()]
        return [cc2541_bytes(channel, **row) for row in rows]


def cc2541_bytes(channel: str, **fields: Any) -> bytes:
    """Return the encoded value of a channel of a CC2541."""
    return build_whole(cc2541.FORMATS[channel], fields)


CC2541_KEYS = tuple([cc2541_bytes("cc2541/keys", left=left, right=False, side=False) for left in (True, False)])
"""Values of the CC2541's key channel for the left key: pressed, released."""
CALIBRATION_VALUE = cc2541_bytes("cc2541/barometer-calibration", **asdict(T5400_CALIBRATION))
"""Value of the channel of the barometer's calibration."""


def raw_barometer_values(pascal: float) -> dict[str, int]:
    """Return the raw values of the T5400 at this pressure, Pa: the inverse of `BarometerCalibration.pascal`."""
    c = T5400_CALIBRATION
    temperature = round((BAROMETER_TEMPERATURE - c.c2 / 2**10) * 2**24 / c.c1)
    at_0, at_1 = c.pascal(temperature, 0), c.pascal(temperature, 1)  # linear in the raw pressure
    return {"temperature": temperature, "pressure": round((pascal - at_0) / (at_1 - at_0))}


def _keys(channel: str, presses: tuple[float, ...], down: bytes, up: bytes) -> list[Notification]:
    return [n for t in presses for n in (Notification(t, channel, down), Notification(t + PRESS_TIME, channel, up))]


def cc2650_barometer_value(pascal: float) -> bytes:
    """Return the value of the CC2650's barometer channel at this pressure, Pa."""
    return cc2650.DRIVER.write("cc2650/barometer", {"temperature": BAROMETER_TEMPERATURE, "pressure": pascal})
