"""The emulated SensorTags as GATT servers: protocol/cc2650.md and protocol/cc2541.md from the device's side.

They do as they are told, also when it is not what one wants: another range, other axes or another period than those of
the profile give data as the tag would give them. Each sensor keeps its own errors whatever its period.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from ..link import profile
from ..sim.device import device_numbers, foot_of, started
from ..sim.parts import AK8963, BMP280, MAG3110, T5400
from ..sim.sensortags import (
    AK8963_COUNT,
    BATTERY,
    CC2541,
    CC2650,
    GYRO_COUNT,
    MAG3110_COUNT,
    T5400_CALIBRATION,
    acc_bytes,
    cc2650_air,
    code_count,
    gyro_bytes,
    mag_bytes,
    range_count,
    raw_air,
)
from ..sim.tag_signals import LATE_AIR, LATE_MAG, Series, Worn
from ..sim.walker import Walker
from ..types import Site
from ..vector import GRAVITY
from ..wire import cc2541, cc2650
from .faults import Fault
from .peripheral import READ_NOT_PERMITTED, REFUSED, AttError
from .standard import Battery, information
from .tag import Presses, Sensor, Tag

STOCK = 10
"""The shortest period of stock firmware, in units of 10 ms."""
SLUGGISH = 30
"""The same of the infrared thermometer."""
WAKES = 0.040 * GRAVITY
"""m/s^2 from one sample to the next that wake a tag which lies still."""
AWAKE = 10.0
"""s for which it stays awake after that."""

_MEANT, _AXES = 0x03FF, 0x007F
"""The bits of AA82 that the firmware looks at, and those of them that switch axes on."""
_INFRARED, _HUMIDITY, _LIGHT = 0xAA00, 0xAA20, 0xAA70

# What the sensors say that measure nothing of the wearer: 24 degrees, half the air's moisture, a lit room.
_ROOM_2650 = {
    "cc2650/infrared": bytes.fromhex("000c000c"),
    "cc2650/humidity": bytes.fromhex("a6630080"),
    "cc2650/light": bytes.fromhex("0138"),
}
_ROOM_2541 = {"cc2541/infrared": bytes.fromhex("0000000c"), "cc2541/humidity": bytes.fromhex("3867b072")}

Make = tuple[float, Callable[[int], bytes | None]]


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
        self._shortest = _shortest(device.rate)
        super().__init__(
            profile.CC2650,
            (
                Sensor("cc2650/movement", 100, self._shortest, bytes(18), size=2),
                Sensor("cc2650/barometer", 100, STOCK, bytes(6)),
                *_room(_ROOM_2650),
            ),
            {"cc2650/infrared": _INFRARED, "cc2650/humidity": _HUMIDITY, "cc2650/light": _LIGHT},
            information(device.firmware, manufacturer="Texas Instruments", model="CC2650 SensorTag"),
            clock,
            site=site,
            address=address,
            name=name,
            began=began,
            faults=faults,
        )
        self._numbers = partial(device_numbers, seed, site)
        self._worn = Worn(walker, foot_of(site), device.mounting, clock)
        self._movements: dict[float, tuple[Series, Series, Series]] = {}
        self._airs: dict[float, Series] = {}
        self._moved: dict[float, list[int]] = {}
        self._battery = Battery(BATTERY)

    def prepare(self) -> None:
        self._movement(0.01 * self._shortest)
        self._air(1.0)

    def begin(self) -> None:
        down, up = (cc2650.build_keys(cc2650.Keys(left=left)) for left in (True, False))
        self.flow("cc2650/keys", Presses(self.device.presses, down, up), self.walk_time)
        self.flow("device/battery", self._battery, self.walk_time)

    def value(self, channel: str, t: float) -> bytes:
        return self._battery.level(t) if channel == "device/battery" else super().value(channel, t)

    def make(self, sensor: str, config: bytes, period: float) -> Make | None:
        if sensor == "cc2650/movement":
            bits = int.from_bytes(config, "little") & _MEANT
            parsed = cc2650.parse_movement_config(bits.to_bytes(2, "little"))
            return (0.0, partial(self._say_movement, parsed, period)) if bits & _AXES else None
        if not _on(config, 1):
            return None
        if sensor == "cc2650/barometer":
            return LATE_AIR, partial(self._say_air, period)
        return 0.0, partial(_say_room, _ROOM_2650[sensor])

    def _say_movement(self, config: cc2650.MovementConfig, period: float, number: int) -> bytes | None:
        if config.wake_on_motion and not self._awake(period, number):
            return None
        acc, gyro, mag = self._movement(period)
        movement = cc2650.Movement(
            _masked(gyro.count(number, self.device.part.gyro, GYRO_COUNT), config.gyro_axes),
            _masked(acc.count(number, self.device.part.acc, range_count(config.range)), config.acc_axes),
            _masked(mag.count(number, AK8963, AK8963_COUNT), (config.mag,) * 3),
        )
        return cc2650.build_movement(movement)

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


class CC2541Peripheral(Tag):
    """A CC2541 on a foot of `walker`. Of `device`, `rate` is the fastest that its firmware takes if that is more than
    the stock 10 Hz; range and rates in force are what is written to it."""

    def __init__(
        self,
        device: CC2541,
        walker: Walker,
        *,
        site: Site,
        address: str,
        name: str = "SensorTag",
        seed: int = 1,
        began: float = 0.0,
        faults: Iterable[Fault] = (),
    ) -> None:
        self.device = device
        numbers = device_numbers(seed, site)
        clock = started(numbers, 1.0 / device.rate, device.ppm)
        self._late = {
            "cc2541/accelerometer": 0.0,
            "cc2541/gyroscope": float(numbers.uniform()) / device.rate,
            "cc2541/magnetometer": LATE_MAG,
            "cc2541/barometer": LATE_AIR,
        }
        self._shortest = _shortest(device.rate)
        super().__init__(
            profile.CC2541,
            (
                Sensor("cc2541/accelerometer", 100, self._shortest, bytes(3)),
                Sensor("cc2541/gyroscope", 100, self._shortest, bytes(6)),
                Sensor("cc2541/magnetometer", 200, STOCK, bytes(6)),
                Sensor("cc2541/barometer", 100, STOCK, bytes(4)),
                *_room(_ROOM_2541),
            ),
            {"cc2541/infrared": _INFRARED, "cc2541/humidity": _HUMIDITY},
            information(device.firmware, manufacturer="Texas Instruments", model="SensorTag"),
            clock,
            site=site,
            address=address,
            name=name,
            began=began,
            faults=faults,
        )
        self._numbers = partial(device_numbers, seed, site)
        self._worn = Worn(walker, foot_of(site), device.mounting, clock)
        self._series: dict[tuple[str, float], Series] = {}

    def prepare(self) -> None:
        for sensor in ("cc2541/accelerometer", "cc2541/gyroscope"):
            self._measured(sensor, 0.01 * self._shortest)
        for sensor in ("cc2541/magnetometer", "cc2541/barometer"):
            self._measured(sensor, 1.0)

    def begin(self) -> None:
        down, up = (cc2541.build_keys(cc2541.Keys(left=left)) for left in (True, False))
        self.flow("cc2541/keys", Presses(self.device.presses, down, up), self.walk_time)

    def stop(self) -> None:
        super().stop()
        self._fetched = False

    def value(self, channel: str, t: float) -> bytes:
        if channel != "cc2541/barometer-calibration":
            return super().value(channel, t)
        if not self._fetched:
            raise AttError(READ_NOT_PERMITTED)
        return cc2541.build_barometer_calibration(T5400_CALIBRATION)

    def take(self, channel: str, value: bytes, t: float) -> None:
        super().take(channel, value, t)
        if channel == "cc2541/barometer-config" and value == b"\x02":
            self._fetched = True

    def make(self, sensor: str, config: bytes, period: float) -> Make | None:
        most = {"cc2541/accelerometer": 3, "cc2541/gyroscope": 7, "cc2541/barometer": 2}.get(sensor, 1)
        code = _on(config, most)
        if not code or (sensor == "cc2541/barometer" and code == 2):
            return None
        if sensor in _ROOM_2541:
            return 0.0, partial(_say_room, _ROOM_2541[sensor])
        return self._late[sensor], partial(self._say, sensor, code, period)

    def _say(self, sensor: str, code: int, period: float, number: int) -> bytes:
        series = self._measured(sensor, period)
        match sensor:
            case "cc2541/accelerometer":
                return acc_bytes(series.count(number, self.device.part.acc, code_count(code)))
            case "cc2541/gyroscope":
                axes = (bool(code & 1), bool(code & 2), bool(code & 4))
                return gyro_bytes(_masked(series.count(number, self.device.part.gyro, GYRO_COUNT), axes))
            case "cc2541/magnetometer":
                return mag_bytes(series.count(number, MAG3110, MAG3110_COUNT))
        return cc2541.build_barometer(raw_air(float(series.value(number)[0, 0])))

    def _measured(self, sensor: str, period: float) -> Series:
        found = self._series.get((sensor, period))
        if found is None:
            found = self._series[sensor, period] = self._measure(sensor, period)
        return found

    def _measure(self, sensor: str, period: float) -> Series:
        worn, numbers = self._worn, self._numbers(list(self._late).index(sensor))
        if sensor == "cc2541/barometer":
            return worn.air(period, T5400, numbers)
        when = worn.when(period, self._late[sensor])
        motion = worn.motion(when)
        if sensor == "cc2541/magnetometer":
            return worn.series(when, period, worn.mag(motion, when, MAG3110, numbers))
        feel = worn.acc if sensor == "cc2541/accelerometer" else worn.gyro
        return worn.series(when, period, feel(motion, when, self.device.part, numbers))


def _shortest(rate: float) -> int:
    """The shortest period of a firmware that takes `rate` Hz: stock, or rebuilt with a lower one."""
    return min(STOCK, max(1, round(100.0 / rate)))


def _on(config: bytes, most: int) -> int:
    """A configuration of one byte. AttError when it is more than `most`."""
    if config[0] > most:
        raise AttError(REFUSED)
    return config[0]


def _room(values: dict[str, bytes]) -> list[Sensor]:
    return [Sensor(n, 100, SLUGGISH if n.endswith("infrared") else STOCK, bytes(len(v))) for n, v in values.items()]


def _say_room(value: bytes, number: int) -> bytes:
    return value


def _masked(row: tuple[int, int, int], axes: tuple[bool, ...]) -> tuple[int, int, int]:
    """The axes that are on; the others read 0."""
    x, y, z = (value if on else 0 for value, on in zip(row, axes, strict=True))
    return (x, y, z)
