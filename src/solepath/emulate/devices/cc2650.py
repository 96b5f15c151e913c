"""The emulated CC2650 SensorTag as a GATT server: protocol/cc2650.md from the device's side.

It does as it is told, also when it is not what one wants: another range, other axes or another period than those of the
profile give data as the tag would give them. Each sensor keeps its own errors whatever its period.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np

from ...link.devices.cc2650 import DRIVER, PROFILE
from ...types import Site
from ...types.vector import GRAVITY
from ..sensors.device import device_numbers, foot_of, started
from ..sensors.parts import AK8963, BMP280
from ..sensors.sensortags import (
    AK8963_COUNT,
    BATTERY,
    CC2650,
    CC2650_KEYS,
    GYRO_COUNT,
    cc2650_air,
    movement_bytes,
    range_count,
)
from ..sensors.tag_signals import LATE_AIR, Series, WornTag
from ..wearers.walker import Walker
from .faults import Fault
from .standard import Battery, information
from .tag import HUMIDITY, INFRARED, LIGHT, STOCK, Make, Presses, Sensor, Tag, constant, masked, room, shortest, switch

WAKES = 0.040 * GRAVITY
"""m/s^2 from one sample to the next that wake a tag which lies still."""
AWAKE = 10.0
"""s for which it stays awake after that."""

_MEANT, _AXES = 0x03FF, 0x007F
"""The bits of AA82 that the firmware looks at, and those of them that switch axes on."""

# What the sensors say that measure nothing of the wearer: 24 degrees, half the air's moisture, a lit room.
_ROOM = {
    "cc2650/infrared": bytes.fromhex("000c000c"),
    "cc2650/humidity": bytes.fromhex("a6630080"),
    "cc2650/light": bytes.fromhex("0138"),
}


class CC2650Peripheral(Tag):
    """A CC2650 on a foot of `walker`. Of `device`, `rate` is the fastest that its firmware takes if that is more than
    the stock 10 Hz; range and rate in force are what is written to it."""

    def __init__(
        self,
        device: CC2650,
        walker: Walker,
        *,
        site: Site,
        address: str,
        name: str = "CC2650 SensorTag",
        seed: int = 1,
        began: float = 0.0,
        faults: Iterable[Fault] = (),
    ) -> None:
        self.device = device
        clock = started(device_numbers(seed, site), 1.0 / device.rate, device.ppm)
        self._shortest = shortest(device.rate)
        super().__init__(
            PROFILE,
            (
                Sensor("cc2650/movement", 100, self._shortest, bytes(18), size=2),
                Sensor("cc2650/barometer", 100, STOCK, bytes(6)),
                *room(_ROOM),
            ),
            {"cc2650/infrared": INFRARED, "cc2650/humidity": HUMIDITY, "cc2650/light": LIGHT},
            information(device.firmware, manufacturer="Texas Instruments", model="CC2650 SensorTag"),
            clock,
            site=site,
            address=address,
            name=name,
            began=began,
            faults=faults,
        )
        self._numbers = partial(device_numbers, seed, site)
        self._worn = WornTag(walker, foot_of(site), device.mounting, clock)
        self._movements: dict[float, tuple[Series, Series, Series]] = {}
        self._airs: dict[float, Series] = {}
        self._moved: dict[float, list[int]] = {}
        self._battery = Battery(BATTERY)

    def prepare(self) -> None:
        self._movement(0.01 * self._shortest)
        self._air(1.0)

    def begin(self) -> None:
        self.flow("cc2650/keys", Presses(self.device.presses, *CC2650_KEYS), self.walk_time)
        self.flow("device/battery", self._battery, self.walk_time)

    def value(self, channel: str, t: float) -> bytes:
        return self._battery.level(t) if channel == "device/battery" else super().value(channel, t)

    def make(self, sensor: str, config: bytes, period: float) -> Make | None:
        if sensor == "cc2650/movement":
            bits = int.from_bytes(config, "little") & _MEANT
            parsed = DRIVER.parse("cc2650/movement-config", bits.to_bytes(2, "little"))
            return (0.0, partial(self._say_movement, parsed, period)) if bits & _AXES else None
        if not switch(config, 1):
            return None
        if sensor == "cc2650/barometer":
            return LATE_AIR, partial(self._say_air, period)
        return 0.0, partial(constant, _ROOM[sensor])

    def _say_movement(self, config: Any, period: float, number: int) -> bytes | None:
        if config.wake_on_motion and not self._awake(period, number):
            return None
        acc, gyro, mag = self._movement(period)
        return movement_bytes(
            masked(gyro.count(number, self.device.part.gyro, GYRO_COUNT), config.gyro_axes),
            masked(acc.count(number, self.device.part.acc, range_count(config.range)), config.acc_axes),
            masked(mag.count(number, AK8963, AK8963_COUNT), (config.mag,) * 3),
        )

    def _say_air(self, period: float, number: int) -> bytes:
        return cc2650_air(float(self._air(period).value(number)[0, 0]))

    def _movement(self, period: float) -> tuple[Series, Series, Series]:
        """Accelerometer, gyroscope and magnetometer over the whole walk."""
        found = self._movements.get(period)
        if found is None:
            worn, part = self._worn, self.device.part
            when = worn.when(period)
            motion = worn.motion(when)
            found = self._movements[period] = (
                worn.series(when, period, worn.acc(motion, when, part, self._numbers(0))),
                worn.series(when, period, worn.gyro(motion, when, part, self._numbers(1))),
                worn.series(when, period, worn.mag(motion, when, AK8963, self._numbers(2))),
            )
        return found

    def _air(self, period: float) -> Series:
        found = self._airs.get(period)
        if found is None:
            found = self._airs[period] = self._worn.air(period, BMP280, self._numbers(3))
        return found

    def _awake(self, period: float, number: int) -> bool:
        """Whether the tag has been moved in the last `AWAKE` s."""
        moved = self._moved.get(period)
        if moved is None:
            change = np.abs(np.diff(self._movement(period)[0].values, axis=0)).max(axis=1)
            moved = self._moved[period] = [int(k) + 1 for k in np.flatnonzero(change > WAKES)]
        before = bisect_right(moved, number)
        return before > 0 and (number - moved[before - 1]) * period <= AWAKE
