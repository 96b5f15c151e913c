"""The emulated CC2650 SensorTag as a GATT server: protocol/cc2650.md from the device's side.

It accepts every valid configuration, not only that of the profile, and sends what a real tag with that configuration
would send. A sensor has the same errors at every period."""

from __future__ import annotations

from bisect import bisect_right
from functools import partial
from typing import Any

import numpy as np

from ...link.devices.cc2650 import DRIVER, PROFILE
from ...types.vector import GRAVITY
from ..sensors.device import device_rng, draw_clock
from ..sensors.parts import AK8963, BMP280
from ..sensors.sensortags import BATTERY, CC2650, CC2650_KEYS, cc2650_barometer_value
from ..sensors.tag_signals import BAROMETER_DELAY, PERIOD_UNIT, Series
from ..wearers.walker import Walker
from .attributes import Battery
from .peripheral import Placement
from .tag import STOCK_PERIOD, Encoder, KeyPresses, Sensor, Tag, checked_code, constant_sensors, shortest_period

WAKE_CHANGE = 0.040 * GRAVITY
"""Change of specific force from one sample to the next that wakes a sleeping tag, m/s^2."""
AWAKE_TIME = 10.0
"""Time for which the tag stays awake after a change above WAKE_CHANGE, s."""

_CONFIG_BITS, _AXIS_BITS = 0x03FF, 0x007F
"""Bits of the configuration AA82 that the firmware uses, and the bits among these that switch axes on."""

# Constant values of the sensors that do not measure the wearer: 24 degrees Celsius, 50 % humidity, a lit room.
_CONSTANT_VALUES = {
    "cc2650/infrared": bytes.fromhex("000c000c"),
    "cc2650/humidity": bytes.fromhex("a6630080"),
    "cc2650/light": bytes.fromhex("0138"),
}


class CC2650Peripheral(Tag):
    """A CC2650 on a foot."""

    def __init__(self, device: CC2650, walker: Walker, seed: int, placement: Placement) -> None:
        self.device = device
        clock = draw_clock(device_rng(seed, placement.site), 1.0 / device.rate, device.ppm)
        self._shortest_period = shortest_period(device.rate)
        sensors = (
            Sensor("cc2650/movement", 100, self._shortest_period, bytes(18), config_size=2),
            Sensor("cc2650/barometer", 100, STOCK_PERIOD, bytes(6)),
            *constant_sensors(_CONSTANT_VALUES),
        )
        super().__init__(device, walker, seed, placement, clock, PROFILE, sensors, "CC2650 SensorTag")
        self._wake_samples: dict[float, list[int]] = {}
        self._battery = Battery(BATTERY)

    def prepare(self) -> None:
        self.series("cc2650/movement", PERIOD_UNIT * self._shortest_period)
        self.series("cc2650/barometer", 1.0)

    def start(self, t: float) -> None:
        self.flow("cc2650/keys", KeyPresses(self.device.presses, *CC2650_KEYS), t)
        self.flow("device/battery", self._battery, t)

    def value(self, channel: str, t: float) -> bytes:
        return self._battery.level(t) if channel == "device/battery" else super().value(channel, t)

    def encoder(self, sensor: str, config: bytes, period: float) -> Encoder | None:
        if sensor == "cc2650/movement":
            bits = int.from_bytes(config, "little") & _CONFIG_BITS
            parsed = DRIVER.parse("cc2650/movement-config", bits.to_bytes(2, "little"))
            return (0.0, partial(self._encode_movement, parsed, period)) if bits & _AXIS_BITS else None
        if not checked_code(config, 1):
            return None
        return BAROMETER_DELAY, lambda number: cc2650_barometer_value(
            float(self.series(sensor, period)[0].value(number)[0, 0])
        )

    def _encode_movement(self, config: Any, period: float, number: int) -> bytes | None:
        acc, gyro, mag = self.series("cc2650/movement", period)
        if config.wake_on_motion and not self._awake(acc, period, number):
            return None
        return self.device.movement(config, acc.value(number), gyro.value(number), mag.value(number))[0]

    def measure(self, sensor: str, period: float) -> tuple[Series, ...]:
        """Return the series of the barometer, or for movement those of accelerometer, gyroscope and magnetometer."""
        worn, chip = self._worn, self.device.chip
        if sensor == "cc2650/barometer":
            return (worn.barometer(period, BMP280, self._sensor_rng(3)),)
        motion = worn.motion(period)
        return (
            motion.acc(chip, self._sensor_rng(0)),
            motion.gyro(chip, self._sensor_rng(1)),
            motion.mag(AK8963, self._sensor_rng(2)),
        )

    def _awake(self, acc: Series, period: float, number: int) -> bool:
        """Return whether the tag was moved in the `AWAKE_TIME` s before this sample."""
        wake_samples = self._wake_samples.get(period)
        if wake_samples is None:
            change = np.abs(np.diff(acc.values, axis=0)).max(axis=1)
            wake_samples = self._wake_samples[period] = [int(k) + 1 for k in np.flatnonzero(change > WAKE_CHANGE)]
        before = bisect_right(wake_samples, number)
        return before > 0 and (number - wake_samples[before - 1]) * period <= AWAKE_TIME
