"""Declaration of a device by data: its profile, and the construct and the meaning in SI units of each channel's values.

A declared device sends plain numbers: a notification holds samples, and perhaps a sequence number and the device's own
time. A `Driver` has, for each channel, the construct that reads and writes its values, and, where a value has a meaning
for the link, a reader that turns it into a `Reading`. stream.py does the rest, the same for all. So a new device is one
file of constructs and data, and a file of vectors (vectors.py checks one with the other): link/devices/ has some,
examples/own_device.py one of an app's own, which it hands to `Session(profiles=[...])`.

A driver holds functions and is never saved. A saved state holds its name and its numbers (`DriverSignature`), and the
app supplies the driver again when it restores the state. A driver with other numbers is rejected then; whether its
functions are the same cannot be checked."""

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
"""Number of values of a 64-bit counter; no counter of a device has more bits."""
UNREADABLE = (ValueError, LookupError, ArithmeticError, StructError)
"""Exceptions that a construct or a reader raises when it cannot interpret a value."""
FINE_TICKS = 20.0
"""Ticks per sample from which on a device's time is better than its sequence numbers."""

MIN_TICKS = 2.0
"""Ticks per sample from which on a device's time is better than arrivals, where it has no sequence numbers.

With fewer ticks, samples would share a tick."""


@frozen
class Measured:
    """One sample as its device sent it, in SI units (m/s^2, rad/s, T, Pa; pressure as in types.Sample).

    `quat`: sensor to world, of any length; all zero where the device does not know it. `saturated`: some sensor was at
    the end of its range."""

    acc: Vec3 | None = None
    gyro: Vec3 | None = None
    pressure: tuple[float, ...] | None = None
    quat: Quat | None = None
    mag: Vec3 | None = None
    air_pressure: float | None = None
    saturated: bool = False


@frozen
class Reading:
    """The content of one value of a channel; what the value does not hold is None.

    `samples`: at equal distances, the oldest first. `sequence`: number of the value among the notifications of the
    stream. `ticks`: the device's time of the first sample; `interval`: ticks from one sample to the next, where the
    packet has it. `mag` (T), `air_pressure` (Pa): measured beside the stream; they are attached to its next sample.

    `battery`: 0 to 1. `keys`: those that are down. `foot`: foot that wears the device. `layout`: of the pressure cells.
    `rate`: samples a second from this value on; or `period`: s from one notification to the next, where only arrivals
    time them. `silent`: whether the device may fall silent from now on (off, or waits for motion). `known`: numbers
    that later values are read with; "acc_range" is the accelerometer's full scale in g."""

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
"""Numbers from earlier values of a device (`Reading.known`), by name."""
Reader = Callable[[Any, Known], Reading]
"""A function that turns a parsed value and the numbers of earlier values (`Reading.known`) into a Reading.

It holds no state. ValueError, LookupError, ArithmeticError and struct.error mean that the value cannot be used; other
exceptions mean that the reader is wrong, and they are not hidden. reading_check.py checks its result."""


class TimeAxis(Enum):
    """The source of sample times, the best that the device has."""

    TICKS = "the device's time"
    COUNT = "its sequence numbers"
    ARRIVAL = "arrivals alone"


@frozen
class DriverSignature:
    """The numbers of a driver on which the state of a link depends.

    It is saved with the state, which has no meaning with other numbers."""

    built_in: bool
    """True if the device is one of devices/, not one of an app's own."""
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
    ones too. It takes a whole value: bytes that it leaves over are rejected, whether it ends in Terminated or not.
    `readers`: by channel, for the channels whose values are used. `sequence`: number at which the sequence wraps (65536
    for u16); 0 when there is none. `tick_rate`, `tick_modulus`: ticks a second of the device's time, and number at
    which it wraps; 0 when there is none. Without a sequence, ticks of which there are fewer than two in a sample's time
    are not used. `acc_range`: full scale of the accelerometer in g until a value says otherwise. `limitation`: what an
    app must do without, reported once; "" for nothing. ValueError when these do not fit together."""

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
        """Name of the device, the prefix of its channels."""
        return self.profile.name

    @property
    def axis(self) -> TimeAxis:
        """Source of sample times: ticks, unless they are too coarse; else sequence numbers, else arrivals."""
        if self.tick_rate >= (FINE_TICKS if self.sequence else MIN_TICKS) * self.profile.nominal_rate:
            return TimeAxis.TICKS
        return TimeAxis.COUNT if self.sequence else TimeAxis.ARRIVAL

    def signature(self, built_in: bool) -> DriverSignature:
        """Return the numbers on which a saved link depends; `built_in`: the device is one of devices/."""
        (stream,) = self.profile.streams
        rate, ticks = self.profile.nominal_rate, (self.tick_rate, self.tick_modulus)
        return DriverSignature(built_in, stream, rate, self.axis, self.sequence, *ticks, self.acc_range)

    def parse(self, channel: str, data: bytes) -> Any:
        """Return the value that the channel's construct reads from all of `data`. WireError when it does not fit."""
        try:
            return parse_whole(self.formats[channel], data)
        except WireError:
            raise
        except UNREADABLE as error:  # from an adapter, a validator, or an expression over values parsed before
            raise malformed(str(error) or type(error).__name__) from error

    def read(self, channel: str, data: bytes, known: Known) -> Reading:
        """Return the content of `data`. WireError when it cannot be read."""
        parsed, reader = self.parse(channel, data), self.readers.get(channel)
        try:
            return Reading() if reader is None else reader(parsed, MappingProxyType(known))
        except WireError:
            raise
        except UNREADABLE as error:
            raise malformed(str(error) or type(error).__name__) from error

    def write(self, channel: str, value: Any) -> bytes:
        """Return the bytes of a value, as its construct takes it. ValueError when it does not fit."""
        try:
            return build_whole(self.formats[channel], value)
        except (TypeError, AttributeError, *UNREADABLE) as error:  # a field is missing, or of another kind
            raise ValueError(str(error) or type(error).__name__) from error
