"""Common base of both emulated SensorTags: sensors that the host switches on and whose period it sets."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import ceil, inf

from attrs import define, evolve, frozen

from ...link.profile import Profile, ti_uuid
from ..sensors.device import DeviceClock, device_numbers, foot_of
from ..sensors.sensortags import CC2541, CC2650, PRESS_TIME
from ..sensors.tag_signals import HANDLING_TIME, Series, WornTag
from ..wearers.walker import Walker
from .attributes import NOTIFY, READ, WRITE, AttCode, AttError, Characteristic, information, services
from .peripheral import Peripheral, Placement

MTU = 23
"""Largest ATT MTU that stock firmware accepts, bytes."""
STOCK = 10
"""Shortest period of stock firmware, in units of 10 ms."""
STOCK_INFRARED = 30
"""Shortest period of the infrared thermometer with stock firmware, in units of 10 ms."""
SERVICES = {"infrared": 0xAA00, "humidity": 0xAA20, "light": 0xAA70}
"""Services of the sensors that the profiles leave out."""

Encoder = tuple[float, Callable[[int], bytes | None]]
"""Delay of a sensor after the clock's first sample, s, and the function that encodes its value of a given number."""


@frozen
class Sensor:
    """One sensor of a SensorTag with its channels for data, configuration and period."""

    name: str
    """Name of the data channel; the two others end in -config and -period."""
    default: int
    """Period after connecting, in units of 10 ms."""
    shortest: int
    """Shortest period that the firmware accepts, in units of 10 ms; it replaces shorter ones."""
    blank: bytes
    """Data that a read returns while the sensor is off."""
    size: int = 1
    """Size of the configuration, bytes."""
    always: bytes = b""
    """Constant data of a sensor that does not measure the wearer; empty for all others."""


@define
class _State:
    config: bytes
    period: int


@frozen(eq=False)
class TimedSource:
    """A ValueSource of samples at `first` + k `step` s, encoded by `encode(k)`; None is not sent."""

    first: float
    step: float
    encode: Callable[[int], bytes | None]

    def after(self, t: float) -> int:
        return ceil((t - self.first) / self.step)

    def due(self, number: int) -> float:
        return self.first + self.step * number + HANDLING_TIME

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        value = self.encode(number)
        return () if value is None else (value,)


@frozen
class Presses:
    """A ValueSource of key presses at the times `presses`, s: byte `down` at each press, `up` at each release."""

    presses: tuple[float, ...]
    down: bytes
    up: bytes

    def after(self, t: float) -> int:
        return sum(self.due(k) < t for k in range(2 * len(self.presses)))

    def due(self, number: int) -> float:
        if number >= 2 * len(self.presses):
            return inf
        return sorted(self.presses)[number // 2] + (PRESS_TIME if number % 2 else 0.0)

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.up if number % 2 else self.down,)


class Tag(Peripheral, ABC):
    """A worn SensorTag as a GATT server; `name` is the product name of the model, `clock` its own clock.

    `device.rate` is the highest rate that the firmware accepts, if it is above the stock 10 Hz. The host's writes set
    range and rates."""

    def __init__(
        self,
        device: CC2541 | CC2650,
        walker: Walker,
        seed: int,
        worn: Placement,
        clock: DeviceClock,
        profile: Profile,
        sensors: Iterable[Sensor],
        name: str,
    ) -> None:
        self._sensors = {sensor.name: sensor for sensor in sensors}
        more = [one for sensor in self._sensors.values() if sensor.always for one in _table(sensor.name)]
        allowed = {channel.name: self._allowed(channel.name) for channel in profile.channels}
        table = services(profile, allowed, more, ("manufacturer", "model"))
        super().__init__(evolve(worn, mtu=MTU), name, table, profile.services)
        self._device_information = information(device.firmware, manufacturer="Texas Instruments", model=name)
        self.clock = clock
        self._numbers = partial(device_numbers, seed, worn.site)
        self._worn = WornTag(walker, foot_of(worn.site), device.mounting, clock)
        self._series: dict[tuple[str, float], tuple[Series, ...]] = {}
        self._states: dict[str, _State] = {}
        self.stop()

    @abstractmethod
    def measure(self, sensor: str, period: float) -> tuple[Series, ...]:
        """Return the values of a sensor that measures every `period` s, over the whole walk."""

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
        self._states = {s.name: _State(bytes(s.size), s.default) for s in self._sensors.values()}

    def value(self, channel: str, t: float) -> bytes:
        name, kind = _split(channel)
        state = self._states.get(name)
        if state is None:
            return self._device_information[channel]
        if kind == "config":
            return state.config
        if kind == "period":
            return bytes([state.period])
        source = self._source(name, state)
        value = None if source is None else source.encode(source.after(t) - 1)
        return self._sensors[name].blank if value is None else value

    def take(self, channel: str, value: bytes, t: float) -> None:
        name, kind = _split(channel)
        sensor, state = self._sensors[name], self._states[name]
        if len(value) != (sensor.size if kind == "config" else 1):
            raise AttError(AttCode.WRONG_LENGTH)
        new = _State(value, state.period)
        if kind == "period":
            new = _State(state.config, max(sensor.shortest, value[0]))
        source = self._source(name, new)
        self._states[name] = new
        self.flow(name, source, t)

    def _source(self, name: str, state: _State) -> TimedSource | None:
        period = 0.01 * state.period
        always = self._sensors[name].always
        if always:
            made: Encoder | None = (0.0, lambda number: always) if checked_code(state.config, 1) else None
        else:
            made = self.encoder(name, state.config, period)
        return None if made is None else TimedSource(self.clock.first + made[0], self.clock.interval(period), made[1])

    def _allowed(self, channel: str) -> frozenset[str]:
        name, kind = _split(channel)
        if kind:
            return READ | WRITE
        if name in self._sensors or channel == "device/battery":
            return READ | NOTIFY
        return NOTIFY if channel.endswith("/keys") else READ


def _split(channel: str) -> tuple[str, str]:
    """Return the sensor's name, and "config", "period" or "" for its data."""
    for kind in ("config", "period"):
        if channel.endswith(f"-{kind}"):
            return channel.removesuffix(f"-{kind}"), kind
    return channel, ""


def _table(sensor: str) -> list[tuple[str, Characteristic]]:
    """Return the characteristics for data, configuration and period, numbered as TI does."""
    service = SERVICES[sensor.partition("/")[2]]
    rows = ((1, "", READ | NOTIFY), (2, "-config", READ | WRITE), (3, "-period", READ | WRITE))
    return [(ti_uuid(service), Characteristic(ti_uuid(service + k), sensor + end, may)) for k, end, may in rows]


def shortest(rate: float) -> int:
    """Return the shortest period, in units of 10 ms, of stock firmware or of firmware rebuilt for `rate` Hz."""
    return min(STOCK, max(1, round(100.0 / rate)))


def checked_code(config: bytes, most: int) -> int:
    """Return a configuration of one byte; raise AttError when it is above `most`."""
    if config[0] > most:
        raise AttError(AttCode.APPLICATION_ERROR)
    return config[0]


def constant_sensors(values: Mapping[str, bytes]) -> list[Sensor]:
    """Return sensors that do not measure the wearer and always send the same values."""
    slow = {name: STOCK_INFRARED if name.endswith("infrared") else STOCK for name in values}
    return [Sensor(name, 100, slow[name], bytes(len(constant)), always=constant) for name, constant in values.items()]
