"""The emulated CC2650 SensorTag as a GATT server: protocol/cc2650.md from the device's side.

It accepts any configuration: with another range, other axes or another period than the profile's it sends the data that
the tag would send. Each sensor keeps its own errors for every period."""

from __future__ import annotations

from bisect import bisect_right
from functools import partial
from typing import Any

import numpy as np

from ...link.devices.cc2650 import DRIVER, PROFILE
from ...types.vector import GRAVITY
from ..sensors.device import device_numbers, draw_clock
from ..sensors.parts import AK8963, BMP280
from ..sensors.sensortags import BATTERY, CC2650, CC2650_KEYS, cc2650_barometer_value
from ..sensors.tag_signals import BAROMETER_DELAY, Series
from ..wearers.walker import Walker
from .attributes import Battery
from .peripheral import Placement
from .tag import STOCK, Encoder, Presses, Sensor, Tag, checked_code, constant_sensors, shortest

WAKE_CHANGE = 0.040 * GRAVITY
"""Change of specific force from one sample to the next that wakes a tag at rest, m/s^2."""
AWAKE_TIME = 10.0
"""Time for which the tag stays awake after such a change, s."""

_CONFIG_BITS, _AXIS_BITS = 0x03FF, 0x007F
"""Bits of AA82 that the firmware uses, and those of them that switch axes on."""

# Constant values of the sensors that do not measure the wearer: 24 degrees Celsius, half of the air's moisture, a lit
# room.
_ROOM = {
    "cc2650/infrared": bytes.fromhex("000c000c"),
    "cc2650/humidity": bytes.fromhex("a6630080"),
    "cc2650/light": bytes.fromhex("0138"),
}


class CC2650Peripheral(Tag):
    """A CC2650 on a foot."""

    def __init__(self, device: CC2650, walker: Walker, seed: int, worn: Placement) -> None:
        self.device = device
        clock = draw_clock(device_numbers(seed, worn.site), 1.0 / device.rate, device.ppm)
        self._shortest = shortest(device.rate)
        sensors = (
            Sensor("cc2650/movement", 100, self._shortest, bytes(18), size=2),
            Sensor("cc2650/barometer", 100, STOCK, bytes(6)),
            *constant_sensors(_ROOM),
        )
        super().__init__(device, walker, seed, worn, clock, PROFILE, sensors, "CC2650 SensorTag")
        self._moved: dict[float, list[int]] = {}
        self._battery = Battery(BATTERY)

    def prepare(self) -> None:
        self.series("cc2650/movement", 0.01 * self._shortest)
        self.series("cc2650/barometer", 1.0)

    def start(self, t: float) -> None:
        self.flow("cc2650/keys", Presses(self.device.presses, *CC2650_KEYS), t)
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
        """Return the series of the sensor; for movement those of accelerometer, gyroscope and magnetometer."""
        worn, part = self._worn, self.device.part
        if sensor == "cc2650/barometer":
            return (worn.barometer(period, BMP280, self._numbers(3)),)
        motion = worn.motion(period)
        return (
            motion.acc(part, self._numbers(0)),
            motion.gyro(part, self._numbers(1)),
            motion.mag(AK8963, self._numbers(2)),
        )

    def _awake(self, acc: Series, period: float, number: int) -> bool:
        """Return whether the tag has been moved in the last `AWAKE_TIME` s."""
        moved = self._moved.get(period)
        if moved is None:
            change = np.abs(np.diff(acc.values, axis=0)).max(axis=1)
            moved = self._moved[period] = [int(k) + 1 for k in np.flatnonzero(change > WAKE_CHANGE)]
        before = bisect_right(moved, number)
        return before > 0 and (number - moved[before - 1]) * period <= AWAKE_TIME
