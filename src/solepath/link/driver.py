"""A device that is declared, not programmed: its profile, the construct of each channel, and what a value means in SI.

A declared device speaks plain numbers: a notification holds samples, and perhaps a sequence number and the device's own
time. A `Driver` has, for each channel, the construct that reads and writes its values, and, where a value means
something, a reader that turns it into a `Reading`. stream.py does the rest, the same for all. So a new device is one
file of constructs and data, and a file of vectors (vectors.py checks one with the other): link/devices/ has some,
examples/own_device.py one of an app's own, which it hands to `Session(profiles=[...])`.

A driver holds functions, so it is never saved: what is saved holds its name and its numbers (`DriverSignature`), and whoever
restores brings it again. Other numbers are refused then; whether the functions are the same, nobody can see.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum
from math import inf
from struct import error as StructError
from types import MappingProxyType
from typing import Any

from ..types import Foot, Layout, Quat, Vec3
from ..types.attrs import field, frozen
from ..wire.error import WireError
from ..wire.fields import Definition, build_whole, malformed, parse_whole
from .profile import Profile, Write

MAX_COUNTER = 1 << 64
"""No counter of a device has more than 64 bits."""
UNREADABLE = (ValueError, LookupError, ArithmeticError, StructError)
"""What a construct or a reader raises that can make nothing of a value."""
FINE_TICKS = 20.0
"""Ticks that there must be in a sample's time, for ticks to be better than counting samples."""

MIN_TICKS = 2.0
"""The same, for ticks to be better than arrivals where nothing is counted: with fewer, samples would share a tick."""


@frozen
class Measured:
    """One sample as its device sent it, in SI units (m/s^2, rad/s, T, Pa; pressure as types.Sample has it).

    `quat`: sensor to world, of any length; all zero where the device does not know. `saturated`: some sensor was at the
    end of its range.
    """

    acc: Vec3 | None = None
    gyro: Vec3 | None = None
    pressure: tuple[float, ...] | None = None
    quat: Quat | None = None
    mag: Vec3 | None = None
    air_pressure: float | None = None
    saturated: bool = False


@frozen
class Reading:
    """What one value of a channel says; what it does not say is None.

    `samples`: at equal distances, the oldest first. `sequence`: its number among the notifications of the stream.
    `ticks`: the device's time of the first sample; `interval`: ticks from one sample to the next, where the packet says
    so. `mag` (T), `air_pressure` (Pa): measured beside the stream; they ride on its next sample.

    `battery`: 0 to 1. `keys`: which are down. `foot`: whose it is. `layout`: of the pressure cells. `rate`: samples a
    second from this value on; or `period`: s from one notification to the next, where arrivals alone time them.
    `silent`: whether the device may fall silent from now on (off, or waits for motion).
    `known`: numbers that later values are read with; "acc_range" is the accelerometer's full scale in g.
    """

    samples: tuple[Measured, ...] = ()
    sequence: int | None = None
    ticks: int | None = None
    interval: int | None = None
    mag: Vec3 | None = None
    air_pressure: float | None = None
    battery: float | None = None
    keys: tuple[str, ...] | None = None
    foot: Foot | None = None
    layout: Layout | None = None
    rate: float | None = None
    period: float | None = None
    silent: bool | None = None
    known: Mapping[str, float] = field(factory=dict)


Known = Mapping[str, float]
Reader = Callable[[Any, Known], Reading]
"""Makes of what the channel's construct has parsed, and of what earlier values said (`Reading.known`), a Reading. It
holds nothing. ValueError, LookupError, ArithmeticError and struct.error say that the value is none; other exceptions,
that the reader is wrong, and they are not hidden. What it returns is looked at by sound.py."""


class TimeAxis(Enum):
    """What sample times are made of, the best that the device has."""

    TICKS = "the device's time"
    COUNT = "its sequence numbers"
    ARRIVAL = "arrivals alone"


@frozen
class DriverSignature:
    """What the state of a link stands on in its driver: it is saved with it, and means nothing on another one."""

    built_in: bool
    """A device of devices/, not one of an app's own."""
    stream: str
    nominal_rate: float
    axis: TimeAxis
    sequence: int
    tick_rate: float
    tick_modulus: int
    acc_range: float


@frozen
class Driver:
    """One kind of device, all data but the readers.

    `profile`: its name is the prefix of its own channels, and exactly one of them is a stream that carries samples.
    `formats`: by channel, the construct of its values, for every channel but the standard ones (device/...), written
    ones too. It takes a whole value: bytes that it leaves over are refused, whether it ends in Terminated or not.
    `readers`: for the channels that say something. `sequence`: where the sequence number wraps (65536 for u16); 0 when
    there is none. `tick_rate`, `tick_modulus`: the device's time, in ticks a second, and where it wraps; 0 when there
    is none. Without a sequence, ticks of which there are fewer than two in a sample's time are not used. `acc_range`:
    full scale of the accelerometer in g until a value says otherwise. `limitation`: what an app must do without, said
    once; "" for nothing. ValueError when these do not fit together.
    """

    profile: Profile
    formats: Mapping[str, Definition]
    readers: Mapping[str, Reader]
    sequence: int = 0
    tick_rate: float = 0.0
    tick_modulus: int = 0
    acc_range: float = 16.0
    limitation: str = ""

    def __attrs_post_init__(self) -> None:
        own = {c.name for c in self.profile.channels if not c.name.startswith("device/")}
        wrong = sorted(own ^ self.formats.keys() | self.readers.keys() - own)
        if wrong:
            raise ValueError(f"{self.name}: without a channel, or a channel without a format: {wrong}")
        elsewhere = sorted(name for name in own if not name.startswith(f"{self.name}/"))
        if elsewhere:
            raise ValueError(f"{self.name}: its channels begin with its name, not as {elsewhere}")
        if len(self.profile.streams) != 1:
            raise ValueError(f"{self.name}: one channel carries the samples, not {self.profile.streams}")
        if (self.tick_rate > 0.0) is not (self.tick_modulus > 0) or not 0.0 <= self.tick_rate < inf:
            raise ValueError(f"{self.name}: ticks have a rate and a modulus, both above 0")
        if self.sequence == 1 or not (0 <= self.sequence <= MAX_COUNTER and 0 <= self.tick_modulus <= MAX_COUNTER):
            raise ValueError(f"{self.name}: counters wrap at 2 to 2**64")
        if not 0.0 < self.acc_range < inf:
            raise ValueError(f"{self.name}: the range of the accelerometer is above 0")
        for write in self.profile.setup:
            if write.channel in self.formats:
                self._check_setup(write)

    def _check_setup(self, write: Write) -> None:
        try:
            self.parse(write.channel, write.value)
        except WireError as error:
            raise ValueError(f"{self.name}: setup writes {write.value.hex()} to {write.channel}: {error}") from error

    @property
    def name(self) -> str:
        return self.profile.name

    @property
    def axis(self) -> TimeAxis:
        """Ticks, unless they are so coarse beside the samples that counting these is better, or arrivals are."""
        if self.tick_rate >= (FINE_TICKS if self.sequence else MIN_TICKS) * self.profile.nominal_rate:
            return TimeAxis.TICKS
        return TimeAxis.COUNT if self.sequence else TimeAxis.ARRIVAL

    def signature(self, built_in: bool) -> DriverSignature:
        (stream,) = self.profile.streams
        rate, ticks = self.profile.nominal_rate, (self.tick_rate, self.tick_modulus)
        return DriverSignature(built_in, stream, rate, self.axis, self.sequence, *ticks, self.acc_range)

    def parse(self, channel: str, data: bytes) -> Any:
        """What the channel's construct makes of `data`, all of it. WireError when it is not that."""
        try:
            return parse_whole(self.formats[channel], data)
        except WireError:
            raise
        except UNREADABLE as error:  # of an adapter, a validator, or an expression over what was parsed before
            raise malformed(str(error) or type(error).__name__) from error

    def read(self, channel: str, data: bytes, known: Known) -> Reading:
        """What `data` says. WireError when it cannot be read."""
        parsed, reader = self.parse(channel, data), self.readers.get(channel)
        try:
            return Reading() if reader is None else reader(parsed, MappingProxyType(known))
        except WireError:
            raise
        except UNREADABLE as error:
            raise malformed(str(error) or type(error).__name__) from error

    def write(self, channel: str, value: Any) -> bytes:
        """The bytes of a value, as its construct takes it. ValueError when it does not fit."""
        try:
            return build_whole(self.formats[channel], value)
        except (TypeError, AttributeError, *UNREADABLE) as error:  # a field is missing, or of another kind
            raise ValueError(str(error) or type(error).__name__) from error
