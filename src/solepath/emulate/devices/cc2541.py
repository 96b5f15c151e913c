"""The emulated CC2541 SensorTag as a GATT server: protocol/cc2541.md from the device's side.

Like the CC2650 it accepts every valid configuration, not only that of the profile. A sensor has the same errors at
every period."""

from __future__ import annotations

from functools import partial

from ...link.devices.cc2541 import PROFILE
from ..sensors.device import device_rng, draw_clock
from ..sensors.sensortags import CALIBRATION_VALUE, CC2541, CC2541_KEYS, DELAYS
from ..sensors.tag_signals import PERIOD_UNIT, Series
from ..wearers.walker import Walker
from .attributes import AttCode, AttError
from .peripheral import Placement
from .tag import STOCK_PERIOD, Encoder, KeyPresses, Sensor, Tag, checked_code, constant_sensors, shortest_period

# Constant values of the sensors that do not measure the wearer: 24 degrees Celsius, 50 % humidity.
_CONSTANT_VALUES = {"cc2541/infrared": bytes.fromhex("0000000c"), "cc2541/humidity": bytes.fromhex("3867b072")}


class CC2541Peripheral(Tag):
    """A CC2541 on a foot."""

    def __init__(self, device: CC2541, walker: Walker, seed: int, placement: Placement) -> None:
        self.device = device
        rng = device_rng(seed, placement.site)
        clock = draw_clock(rng, 1.0 / device.rate, device.ppm)
        self._delays = {**DELAYS, "cc2541/gyroscope": float(rng.uniform()) / device.rate}
        self._shortest_period = shortest_period(device.rate)
        sensors = (
            Sensor("cc2541/accelerometer", 100, self._shortest_period, bytes(3)),
            Sensor("cc2541/gyroscope", 100, self._shortest_period, bytes(6)),
            Sensor("cc2541/magnetometer", 200, STOCK_PERIOD, bytes(6)),
            Sensor("cc2541/barometer", 100, STOCK_PERIOD, bytes(4)),
            *constant_sensors(_CONSTANT_VALUES),
        )
        super().__init__(device, walker, seed, placement, clock, PROFILE, sensors, "SensorTag")

    def prepare(self) -> None:
        for sensor in ("cc2541/accelerometer", "cc2541/gyroscope"):
            self.series(sensor, PERIOD_UNIT * self._shortest_period)
        for sensor in ("cc2541/magnetometer", "cc2541/barometer"):
            self.series(sensor, 1.0)

    def start(self, t: float) -> None:
        self.flow("cc2541/keys", KeyPresses(self.device.presses, *CC2541_KEYS), t)

    def stop(self) -> None:
        super().stop()
        self._calibration_requested = False

    def value(self, channel: str, t: float) -> bytes:
        if channel != "cc2541/barometer-calibration":
            return super().value(channel, t)
        if not self._calibration_requested:
            raise AttError(AttCode.READ_NOT_PERMITTED)
        return CALIBRATION_VALUE

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        super().accept_write(channel, value, t)
        if channel == "cc2541/barometer-config" and value == b"\x02":
            self._calibration_requested = True

    def encoder(self, sensor: str, config: bytes, period: float) -> Encoder | None:
        max_code = {"cc2541/accelerometer": 3, "cc2541/gyroscope": 7, "cc2541/barometer": 2}.get(sensor, 1)
        code = checked_code(config, max_code)
        if not code or (sensor == "cc2541/barometer" and code == 2):
            return None
        return self._delays[sensor], partial(self._encode, sensor, code, period)

    def _encode(self, sensor: str, code: int, period: float, number: int) -> bytes:
        (series,) = self.series(sensor, period)
        return self.device.encode(sensor, series.value(number), code)[0]

    def measure(self, sensor: str, period: float) -> tuple[Series, ...]:
        rng = self._sensor_rng(list(self._delays).index(sensor))
        return (self.device.measure(sensor, self._worn, period, self._delays[sensor], rng),)
