"""What both emulated SensorTags do alike: sensors that are switched on by their configuration and told their period."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import ceil, inf

from attrs import define, evolve, frozen

from ...link.profile import Profile, ti
from ..sensors.device import DeviceClock, device_numbers, foot_of
from ..sensors.sensortags import CC2541, CC2650, PRESS
from ..sensors.tag_signals import HANDLING, Series, WornTag
from ..wearers.walker import Walker
from .attributes import NOTIFY, READ, WRITE, AttCode, AttError, Characteristic, information, services
from .peripheral import Peripheral, Placement

MTU = 23
"""Stock firmware agrees to no larger one."""
STOCK = 10
"""The shortest period of stock firmware, in units of 10 ms."""
STOCK_INFRARED = 30
"""The same of the infrared thermometer."""
SERVICES = {"infrared": 0xAA00, "humidity": 0xAA20, "light": 0xAA70}
"""Of the sensors that the profiles leave out."""

Encoder = tuple[float, Callable[[int], bytes | None]]
"""How many s after the clock's first sample a sensor begins, and what it says."""


@frozen
class Sensor:
    """`name` is that of its data channel; the others end in -config and -period. Periods are in units of 10 ms:
    `default` after connecting, `shortest` what the firmware makes of anything below. `blank`: the data read while it is
    off. `size`: bytes of the configuration. `always`: what a sensor says that measures nothing of the wearer."""

    name: str
    default: int
    shortest: int
    blank: bytes
    size: int = 1
    always: bytes = b""


@define
class _State:
    config: bytes
    period: int


@frozen(eq=False)
class TimedSource:
    """A Source: what `make` gives for the numbers of samples taken at `first` + k `step` s; None is not sent."""

    first: float
    step: float
    encode: Callable[[int], bytes | None]

    def after(self, t: float) -> int:
        return ceil((t - self.first) / self.step)

    def due(self, number: int) -> float:
        return self.first + self.step * number + HANDLING

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        value = self.encode(number)
        return () if value is None else (value,)


@frozen
class Presses:
    """A Source: a byte when a key goes down and another when it comes up, `presses` s."""

    presses: tuple[float, ...]
    down: bytes
    up: bytes

    def after(self, t: float) -> int:
        return sum(self.due(k) < t for k in range(2 * len(self.presses)))

    def due(self, number: int) -> float:
        if number >= 2 * len(self.presses):
            return inf
        return sorted(self.presses)[number // 2] + (PRESS if number % 2 else 0.0)

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.up if number % 2 else self.down,)


class Tag(Peripheral, ABC):
    """A SensorTag as it is worn; `name` is what its model is sold by, `clock` its own. Of the device, `rate` is the
    fastest that its firmware takes if that is more than the stock 10 Hz; what is written sets range and rates."""

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
        """What a sensor that measures every `period` s measures over the whole walk."""

    def series(self, sensor: str, period: float) -> tuple[Series, ...]:
        """The same, worked out when it is first asked for."""
        found = self._series.get((sensor, period))
        if found is None:
            found = self._series[sensor, period] = self.measure(sensor, period)
        return found

    def encoder(self, sensor: str, config: bytes, period: float) -> Encoder | None:
        """What a sensor says that is configured like this; None when that is off. AttError for a configuration that the
        firmware does not take."""
        raise AttError(AttCode.APPLICATION_ERROR)

    def stop(self) -> None:
        """Everything is off and as it was when the tag was switched on."""
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
    """The sensor, and which of its values: "config", "period" or "" for its data."""
    for kind in ("config", "period"):
        if channel.endswith(f"-{kind}"):
            return channel.removesuffix(f"-{kind}"), kind
    return channel, ""


def _table(sensor: str) -> list[tuple[str, Characteristic]]:
    """Data, configuration and period, in a row as TI numbers them."""
    service = SERVICES[sensor.partition("/")[2]]
    rows = ((1, "", READ | NOTIFY), (2, "-config", READ | WRITE), (3, "-period", READ | WRITE))
    return [(ti(service), Characteristic(ti(service + k), sensor + end, may)) for k, end, may in rows]


def shortest(rate: float) -> int:
    """The shortest period, in units of 10 ms, of stock firmware or of one rebuilt to take `rate` Hz."""
    return min(STOCK, max(1, round(100.0 / rate)))


def checked_code(config: bytes, most: int) -> int:
    """A configuration of one byte. AttError when it is more than `most`."""
    if config[0] > most:
        raise AttError(AttCode.APPLICATION_ERROR)
    return config[0]


def constant_sensors(values: Mapping[str, bytes]) -> list[Sensor]:
    """Sensors that measure nothing of the wearer and always say the same."""
    slow = {name: STOCK_INFRARED if name.endswith("infrared") else STOCK for name in values}
    return [Sensor(name, 100, slow[name], bytes(len(constant)), always=constant) for name, constant in values.items()]
