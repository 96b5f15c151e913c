"""The emulated SensorTags as GATT servers: protocol/cc2650.md and protocol/cc2541.md from the device's side.

They accept every valid configuration, not only that of the profile, and send what a real tag with that configuration
would send, except that none waits for a motion. A sensor has the same errors at every period. Keys are not pressed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import ceil

from attrs import evolve, frozen

from ...wire.fields import build_text
from ..sensors.device import HANDLING_TIME, device_rng, foot_of
from ..sensors.sensortags import SensorTag, Series, TagSensor
from ..wearers.walker import Walker
from .attributes import AttCode, AttError, services
from .peripheral import Peripheral, Placement

MAX_MTU = 23
"""Largest ATT MTU that stock firmware accepts, bytes."""
STOCK_PERIOD = 10
"""Shortest period of stock firmware, in units of PERIOD_UNIT."""
PERIOD_UNIT = 0.01
"""Unit of a SensorTag's period characteristics, s."""
CALIBRATION, FETCH_CALIBRATION = "cc2541/barometer-calibration", ("cc2541/barometer-config", b"\x02")
"""Channel that can be read after this command, which configures nothing."""


@frozen(eq=False)
class TimedSource:
    """A ValueSource of a sensor that measures at equal intervals."""

    first: float
    """Time of the first value, s."""
    step: float
    """Time from one value to the next, s."""
    encode: Callable[[int], bytes]
    """Function that returns the data of value k from its number."""

    def first_number_from(self, t: float) -> int:
        return ceil((t - self.first) / self.step)

    def due(self, number: int) -> float:
        return self.first + self.step * number + HANDLING_TIME

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.encode(number),)


class Tag(Peripheral):
    """A worn SensorTag as a GATT server.

    The host's writes set range and rates; the largest rate is 10 Hz or `device.rate`, whichever is higher."""

    def __init__(self, device: SensorTag, walker: Walker, seed: int, placement: Placement) -> None:
        self.device, self._walker = device, walker
        self.clock, self._delays = device.draw(device_rng(seed, placement.site))
        self._rng_of = partial(device_rng, seed, placement.site)
        self._sensors = {sensor.channel: sensor for sensor in device.sensors}
        self._series: dict[tuple[str, int], Series] = {}
        profile = device.profile
        table = services(profile, [channel.name for channel in profile.channels if not channel.name.endswith("/keys")])
        super().__init__(evolve(placement, mtu=MAX_MTU), device.name, table, profile.services)
        self._constants = {"device/firmware": build_text(device.firmware), **device.constants}
        self.stop()

    def prepare(self) -> None:
        for sensor in self._sensors.values():
            self.series(sensor.channel, _shortest_period(sensor, self.device.rate) if sensor.is_fast else 100)

    def stop(self) -> None:
        """Switch all sensors off and restore the default periods."""
        self._can_calibrate = False
        self._configs = {channel: bytes(len(sensor.config)) for channel, sensor in self._sensors.items()}
        self._periods = {
            channel: round(sensor.default_period / PERIOD_UNIT) for channel, sensor in self._sensors.items()
        }

    def series(self, channel: str, period: int) -> Series:
        """Return the series of a sensor over the walk, which is measured at the first call."""
        found = self._series.get((channel, period))
        if found is None:
            foot, delay = foot_of(self.site), self._delays[channel]
            found = self._series[channel, period] = self.device.measure(
                channel, self._walker, foot, self.clock, PERIOD_UNIT * period, delay, self._rng_of
            )
        return found

    def value(self, channel: str, t: float) -> bytes:
        name, _, kind = channel.partition("-")
        if name in self._sensors and kind == "config":
            return self._configs[name]
        if name in self._sensors and kind == "period":
            return bytes([self._periods[name]])
        if channel in self._sensors:
            source = self._source(channel)
            off = bytes(self._sensors[channel].size)
            return off if source is None else source.encode(source.first_number_from(t) - 1)
        if channel == CALIBRATION and not self._can_calibrate:
            raise AttError(AttCode.READ_NOT_PERMITTED)
        return self._constants[channel]

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        name, _, kind = channel.partition("-")
        sensor = self._sensors[name]
        if len(value) != (len(sensor.config) if kind == "config" else 1):
            raise AttError(AttCode.WRONG_LENGTH)
        if (channel, value) == FETCH_CALIBRATION:
            self._can_calibrate = True
            return
        if kind == "period":
            self._periods[name] = max(_shortest_period(sensor, self.device.rate), value[0])
        elif value[0] > sensor.max_code:
            raise AttError(AttCode.APPLICATION_ERROR)
        else:
            self._configs[name] = value
        self.flow(name, self._source(name), t)

    def _source(self, channel: str) -> TimedSource | None:
        """Return the source of a sensor's values; None while no axis is on."""
        config, period = self._configs[channel], self._periods[channel]
        if not config[0] & 0x7F:
            return None

        def encode(number: int) -> bytes:
            (data,) = self.device.encode(channel, config, self.series(channel, period).value(number))
            return data

        first, step = self.clock.first + self._delays[channel], self.clock.interval(PERIOD_UNIT * period)
        return TimedSource(first, step, encode)


def _shortest_period(sensor: TagSensor, rate: float) -> int:
    """Return the shortest period, in units of PERIOD_UNIT, of stock firmware or of firmware rebuilt for `rate` Hz."""
    return min(STOCK_PERIOD, max(1, round(100.0 / rate))) if sensor.is_fast else STOCK_PERIOD
