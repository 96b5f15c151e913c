"""Common base of both emulated SensorTags, whose sensors the host switches on and configures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import ceil, inf

from attrs import define, evolve, frozen

from ...link.profile import Profile, ti_uuid
from ..sensors.device import DeviceClock, device_rng, foot_of
from ..sensors.sensortags import CC2541, CC2650, PRESS_TIME
from ..sensors.tag_signals import HANDLING_TIME, PERIOD_UNIT, Series, WornTag
from ..wearers.walker import Walker
from .attributes import NOTIFY, READ, WRITE, AttCode, AttError, Characteristic, device_information, services
from .peripheral import Peripheral, Placement

MAX_MTU = 23
"""Largest ATT MTU that stock firmware accepts, bytes."""
STOCK_PERIOD = 10
"""Shortest period of stock firmware, in units of PERIOD_UNIT."""
STOCK_INFRARED_PERIOD = 30
"""Shortest period of the infrared thermometer with stock firmware, in units of PERIOD_UNIT."""
EXTRA_SERVICES = {"infrared": 0xAA00, "humidity": 0xAA20, "light": 0xAA70}
"""Service numbers of the sensors that the profiles do not contain."""

Encoder = tuple[float, Callable[[int], bytes | None]]
"""Delay of value 0 after the first sample of the tag's clock, s, and the function that encodes value k."""


@frozen
class Sensor:
    """One sensor of a SensorTag with its channels for data, configuration and period."""

    name: str
    """Name of the data channel; the names of the other two channels add -config and -period."""
    default_period: int
    """Period after connecting, in units of PERIOD_UNIT."""
    shortest_period: int
    """Shortest period of the firmware, in units of PERIOD_UNIT; it replaces shorter ones that the host writes."""
    off_value: bytes
    """Data that a read returns while the sensor is off."""
    config_size: int = 1
    """Size of the configuration, bytes."""
    constant: bytes = b""
    """Constant data of a sensor that does not measure the wearer; empty for a sensor that does."""


@define
class _SensorState:
    config: bytes
    period: int


@frozen(eq=False)
class TimedSource:
    """A ValueSource of a sensor that measures at equal intervals."""

    first: float
    """Time of the first value, s."""
    step: float
    """Time from one value to the next, s."""
    encode: Callable[[int], bytes | None]
    """Function that returns the data of value k from its number; None is not sent."""

    def first_number_from(self, t: float) -> int:
        return ceil((t - self.first) / self.step)

    def due(self, number: int) -> float:
        return self.first + self.step * number + HANDLING_TIME

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        value = self.encode(number)
        return () if value is None else (value,)


@frozen
class KeyPresses:
    """A ValueSource of a key, which sends a value at each press and at each release."""

    presses: tuple[float, ...]
    """Times at which the key is pressed, s."""
    down: bytes
    """Data of a press."""
    up: bytes
    """Data of a release."""

    def first_number_from(self, t: float) -> int:
        return sum(self.due(k) < t for k in range(2 * len(self.presses)))

    def due(self, number: int) -> float:
        if number >= 2 * len(self.presses):
            return inf
        return sorted(self.presses)[number // 2] + (PRESS_TIME if number % 2 else 0.0)

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.up if number % 2 else self.down,)


class Tag(Peripheral, ABC):
    """A worn SensorTag as a GATT server; `name` is the product name of the model.

    The host's writes set range and rates; the largest rate is 10 Hz or `device.rate`, whichever is higher."""

    def __init__(
        self,
        device: CC2541 | CC2650,
        walker: Walker,
        seed: int,
        placement: Placement,
        clock: DeviceClock,
        profile: Profile,
        sensors: Iterable[Sensor],
        name: str,
    ) -> None:
        self._sensors = {sensor.name: sensor for sensor in sensors}
        more = [row for sensor in self._sensors.values() if sensor.constant for row in _characteristics(sensor.name)]
        properties = {channel.name: self._properties_of(channel.name) for channel in profile.channels}
        table = services(profile, properties, more, ("manufacturer", "model"))
        super().__init__(evolve(placement, mtu=MAX_MTU), name, table, profile.services)
        self._device_information = device_information(device.firmware, manufacturer="Texas Instruments", model=name)
        self.clock = clock
        self._sensor_rng = partial(device_rng, seed, placement.site)
        self._worn = WornTag(walker, foot_of(placement.site), device.mounting, clock)
        self._series: dict[tuple[str, float], tuple[Series, ...]] = {}
        self._states: dict[str, _SensorState] = {}
        self.stop()

    @abstractmethod
    def measure(self, sensor: str, period: float) -> tuple[Series, ...]:
        """Return the series of a sensor that measures every `period` s over the whole walk."""

    def series(self, sensor: str, period: float) -> tuple[Series, ...]:
        """Return the cached result of `measure`, computed at the first call."""
        found = self._series.get((sensor, period))
        if found is None:
            found = self._series[sensor, period] = self.measure(sensor, period)
        return found

    def encoder(self, sensor: str, config: bytes, period: float) -> Encoder | None:
        """Return the encoder of a sensor with this configuration; None when the sensor is off.

        A configuration that the firmware does not accept raises AttError."""
        raise AttError(AttCode.APPLICATION_ERROR)

    def stop(self) -> None:
        """Switch all sensors off and restore the default periods."""
        self._states = {s.name: _SensorState(bytes(s.config_size), s.default_period) for s in self._sensors.values()}

    def value(self, channel: str, t: float) -> bytes:
        name, kind = _split_channel(channel)
        state = self._states.get(name)
        if state is None:
            return self._device_information[channel]
        if kind == "config":
            return state.config
        if kind == "period":
            return bytes([state.period])
        source = self._source(name, state)
        value = None if source is None else source.encode(source.first_number_from(t) - 1)
        return self._sensors[name].off_value if value is None else value

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        name, kind = _split_channel(channel)
        sensor, state = self._sensors[name], self._states[name]
        if len(value) != (sensor.config_size if kind == "config" else 1):
            raise AttError(AttCode.WRONG_LENGTH)
        new = _SensorState(value, state.period)
        if kind == "period":
            new = _SensorState(state.config, max(sensor.shortest_period, value[0]))
        source = self._source(name, new)
        self._states[name] = new
        self.flow(name, source, t)

    def _source(self, name: str, state: _SensorState) -> TimedSource | None:
        period = PERIOD_UNIT * state.period
        constant = self._sensors[name].constant
        if constant:
            encoder: Encoder | None = (0.0, lambda number: constant) if checked_code(state.config, 1) else None
        else:
            encoder = self.encoder(name, state.config, period)
        return (
            None
            if encoder is None
            else TimedSource(self.clock.first + encoder[0], self.clock.interval(period), encoder[1])
        )

    def _properties_of(self, channel: str) -> frozenset[str]:
        name, kind = _split_channel(channel)
        if kind:
            return READ | WRITE
        if name in self._sensors or channel == "device/battery":
            return READ | NOTIFY
        return NOTIFY if channel.endswith("/keys") else READ


def _split_channel(channel: str) -> tuple[str, str]:
    """Return the sensor's name, and "config", "period" or "" for its data."""
    for kind in ("config", "period"):
        if channel.endswith(f"-{kind}"):
            return channel.removesuffix(f"-{kind}"), kind
    return channel, ""


def _characteristics(sensor: str) -> list[tuple[str, Characteristic]]:
    """Return the characteristics for data, configuration and period, numbered as TI does."""
    service = EXTRA_SERVICES[sensor.partition("/")[2]]
    rows = ((1, "", READ | NOTIFY), (2, "-config", READ | WRITE), (3, "-period", READ | WRITE))
    return [
        (ti_uuid(service), Characteristic(ti_uuid(service + k), sensor + end, properties))
        for k, end, properties in rows
    ]


def shortest_period(rate: float) -> int:
    """Return the shortest period, in units of PERIOD_UNIT, of stock firmware or of firmware rebuilt for `rate` Hz."""
    return min(STOCK_PERIOD, max(1, round(100.0 / rate)))


def checked_code(config: bytes, max_code: int) -> int:
    """Return the value of a configuration of one byte; raise AttError when it is above `max_code`."""
    if config[0] > max_code:
        raise AttError(AttCode.APPLICATION_ERROR)
    return config[0]


def constant_sensors(values: Mapping[str, bytes]) -> list[Sensor]:
    """Return sensors that do not measure the wearer and always send the same values."""
    shortest_periods = {name: STOCK_INFRARED_PERIOD if name.endswith("infrared") else STOCK_PERIOD for name in values}
    return [
        Sensor(name, 100, shortest_periods[name], bytes(len(constant)), constant=constant)
        for name, constant in values.items()
    ]
