"""Declaration of a device by data: its profile, and for each channel the format of its values and a reader to SI units.

A declared device sends plain numbers. A notification holds samples, and perhaps a sequence number and the device's own
time. For each channel a `Driver` has a construct (see construct.readthedocs.io), which reads and writes the bytes. For
a channel whose values the link uses, it also has a reader, which turns a value into a `Reading`. stream.py does the
work that is the same for all declared devices. A new device is therefore one file of constructs and data, and one file
of test vectors, which solepath.testing.vectors compares with it. link/devices/ has the built-in devices, and
examples/own_device.py shows a device of an app, which the app passes to `Session(profiles=[...])`.

A driver holds functions and is never saved. A saved state holds the driver's name and numbers (`Driver.signature`), and
the app passes the driver again when it restores the state. A driver with other numbers is then rejected. The functions
cannot be compared."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum
from functools import cached_property
from math import inf, isfinite
from struct import error as StructError
from types import MappingProxyType
from typing import Any

from ..events import Rejection
from ..types import Floats, Foot, Layout, Quat, Vec3
from ..types.attrs import COUNT, field, frozen, limited, limits
from ..types.checking import find_fault
from ..wire.error import WireError
from ..wire.fields import LONGEST_VALUE, Definition, build_whole, malformed, parse_whole
from .profile import Profile

FULL_SCALE_COUNTS = 32768
"""Counts that are the full scale of a sensor with 16 bits."""
RANGE_END_COUNTS = 32767
"""Magnitude of a count at the end of the range of such a sensor."""
MAX_COUNTER = 1 << 64
"""Number of values of the largest counter, which has 64 bits."""
MIN_RATE, MAX_RATE = 0.1, 10_000.0
"""Smallest and largest rate that a reading may have, samples a second."""
MOST_KNOWN, LONGEST_NAME = 64, 80
"""Largest number of known numbers of a device, and length of their names, characters, both chosen by hand."""
READING_ERRORS = (ValueError, LookupError, ArithmeticError, StructError)
"""Exceptions by which a construct or a reader rejects a value."""
FINE_SAMPLE_TICKS = 20.0
"""Smallest number of ticks per sample with which a device's time is better than its sequence numbers."""
MIN_SAMPLE_TICKS = 2.0
"""Smallest number of ticks per sample with which a device's time is better than arrivals.

It is for devices without sequence numbers. With fewer ticks, samples would have the same tick (protocol/clock.md)."""

SENSOR_VALUE = limits(-1e8, 1e8)
"""Limits of a sensor value, SI units; the largest of a known device is 24 bits of Pa, which are 1.7e7."""
COUNTER = limits(1 - MAX_COUNTER, MAX_COUNTER - 1)
"""Limits of a counter."""
ITEMS = {COUNT: (0, LONGEST_VALUE)}
"""Limits of a number of items: a value has at most as many as it may have bytes."""


@frozen
class Measured:
    """One sample as its device sent it, sensor frame, SI units; a quantity that it does not have is None."""

    acc: Vec3 | None = field(default=None, metadata=SENSOR_VALUE)
    """Specific force, m/s^2."""
    gyro: Vec3 | None = field(default=None, metadata=SENSOR_VALUE)
    """Angular rate, rad/s."""
    pressure: Floats | None = field(default=None, metadata=ITEMS)
    """Value of each cell, as in types.Sample: N when the device declares a scale, otherwise counts.

    A value that cannot be costs that cell only (foot/pressure/cell_health.py)."""
    quat: Quat | None = field(default=None, metadata=SENSOR_VALUE)
    """Attitude, sensor to world, as a quaternion of any length; all zero when the device does not know it."""
    mag: Vec3 | None = field(default=None, metadata=SENSOR_VALUE)
    """Magnetic flux density, T."""
    air_pressure: float | None = field(default=None, metadata=SENSOR_VALUE)
    """Air pressure, Pa."""
    saturated: bool = False
    """True when a sensor was at the end of its range."""


@frozen
class Reading:
    """The content of one value of a channel; a field that the value does not hold is None."""

    samples: tuple[Measured, ...] = field(default=(), metadata=ITEMS)
    """Samples at equal time intervals, the oldest first."""
    sequence: int | None = field(default=None, metadata=COUNTER)
    """Sequence number of the notification."""
    ticks: int | None = field(default=None, metadata=COUNTER)
    """The device's time of the first sample, in ticks."""
    interval: int | None = field(default=None, metadata=COUNTER)
    """Number of ticks from one sample to the next, if the packet has it."""
    mag: Vec3 | None = field(default=None, metadata=SENSOR_VALUE)
    """Magnetic flux density, T, measured separately; it is attached to the next sample."""
    air_pressure: float | None = field(default=None, metadata=SENSOR_VALUE)
    """Air pressure, Pa, measured separately; it is attached to the next sample."""
    battery: float | None = limited(None, 0.0, 1.0)
    """Battery level, 0 to 1."""
    keys: tuple[str, ...] | None = field(default=None, metadata=ITEMS)
    """Names of the keys that are down."""
    foot: Foot | None = None
    """Foot that wears the device."""
    layout: Layout | None = field(default=None, metadata=SENSOR_VALUE)
    """Layout of the pressure cells."""
    rate: float | None = limited(None, MIN_RATE, MAX_RATE, "Hz")
    """Samples a second from this value on, Hz."""
    period: float | None = limited(None, 1.0 / MAX_RATE, 1.0 / MIN_RATE, "s")
    """Time from one notification to the next, s, for a device without counters."""
    silent: bool | None = None
    """True when the device may be silent from now on, because it is off or waits for motion."""
    known: Mapping[str, float] = field(factory=dict, metadata={COUNT: (0, MOST_KNOWN), **SENSOR_VALUE})
    """Numbers that are passed to the readers of later values, by name; "acc_range" is the accelerometer's full scale in
    g."""

    def contradiction(self) -> str | None:
        """Return what is wrong with the layout and with what is known (types/checking.py)."""
        if self.layout is not None and len(self.layout.cells) > LONGEST_VALUE:
            return f".layout has {len(self.layout.cells)} cells; it can have up to {LONGEST_VALUE}"
        if self.layout is not None and abs(self.layout.id) >= MAX_COUNTER:
            return ".layout.id has more than 64 bits"
        scale = self.known.get("acc_range", 1.0)
        return None if scale > 0.0 else f".known.acc_range is {scale:g} g; it is above 0"


Known = Mapping[str, float]
"""Numbers from earlier values of a device (`Reading.known`), by name."""
Reader = Callable[[Any, Known], Reading]
"""A function that turns a parsed value and the numbers of earlier values (`Reading.known`) into a Reading.

A reader holds no state. It raises ValueError, LookupError, ArithmeticError or struct.error for a value that cannot be
used. Any other exception is a bug of the reader and is passed on. `Driver.read` checks the Reading."""


def _reject_errors(read: Callable[..., Any], *values: Any) -> Any:
    """Return what `read` makes of the values; WireError for an error of an adapter, a validator or a reader."""
    try:
        return read(*values)
    except WireError:
        raise
    except READING_ERRORS as error:
        raise malformed(str(error) or type(error).__name__) from error


class TimeAxis(Enum):
    """The source of sample times; the first that the device has in sufficient resolution is used."""

    TICKS = "the device's time"
    COUNT = "its sequence numbers"
    ARRIVAL = "arrivals alone"


@frozen
class Driver:
    """The declaration of one kind of device, which is data except for the readers.

    ValueError when its fields contradict each other."""

    profile: Profile
    """Advertisement, channels and setup. Its name is the prefix of the device's channels, and exactly one of them is a
    stream with samples."""
    formats: Mapping[str, Definition]
    """Construct of each channel's values, also of written ones, except for the standard channels (device/...). A
    construct reads a whole value: a value with bytes left over is rejected, even if the construct does not end in
    Terminated."""
    readers: Mapping[str, Reader]
    """Reader of each channel whose values are used."""
    sequence: int = 0
    """Number of values of the sequence counter (65536 for u16); 0 without one."""
    tick_rate: float = 0.0
    """Ticks a second of the device's time, Hz; 0 without one."""
    tick_modulus: int = 0
    """Number of values of the device's time; 0 without one."""
    limitation: str = ""
    """Sentence on what the device cannot do, which is reported once; "" for none."""

    def __attrs_post_init__(self) -> None:
        channel_names = {c.name for c in self.profile.channels if not c.name.startswith("device/")}
        mismatched = sorted(channel_names ^ self.formats.keys() | self.readers.keys() - channel_names)
        foreign_names = sorted(name for name in channel_names if not name.startswith(f"{self.name}/"))
        streams, counters = self.profile.streams, (self.sequence, self.tick_modulus)
        has_rate = 0.0 < self.tick_rate < inf
        ticks_fit = (has_rate or self.tick_rate == 0.0) and has_rate is (self.tick_modulus > 0)
        counters_fit = self.sequence != 1 and 0 <= min(counters) <= max(counters) <= MAX_COUNTER
        for is_wrong, what in (
            (mismatched, f"without a channel, or a channel without a format: {mismatched}"),
            (foreign_names, f"its channels begin with its name, not as {foreign_names}"),
            (len(streams) != 1, f"one channel carries the samples, not {streams}"),
            (not ticks_fit, "ticks have a rate and a modulus, both above 0"),
            (not counters_fit, "counters wrap at 2 to 2**64"),
        ):
            if is_wrong:
                raise ValueError(f"{self.name}: {what}")
        for write in self.profile.setup:
            try:
                if write.channel in self.formats:
                    self.parse(write.channel, write.value)
            except WireError as error:
                what = f"setup writes {write.value.hex()} to {write.channel}: {error}"
                raise ValueError(f"{self.name}: {what}") from error

    @property
    def name(self) -> str:
        """Name of the device, the prefix of its channels."""
        return self.profile.name

    @cached_property
    def axis(self) -> TimeAxis:
        """Source of sample times: ticks if they are fine enough, else sequence numbers, else arrivals."""
        if self.tick_rate >= (FINE_SAMPLE_TICKS if self.sequence else MIN_SAMPLE_TICKS) * self.profile.nominal_rate:
            return TimeAxis.TICKS
        return TimeAxis.COUNT if self.sequence else TimeAxis.ARRIVAL

    def signature(self, built_in: bool) -> str:
        """Return the numbers on which a saved link depends; `built_in` is True for a device of devices/."""
        profile = self.profile
        counters = self.axis.name, self.sequence, self.tick_rate, self.tick_modulus
        return repr((built_in, profile.streams, profile.nominal_rate, *counters))

    def parse(self, channel: str, data: bytes) -> Any:
        """Return the value that the channel's construct reads from `data`; WireError when `data` does not fit it."""
        return _reject_errors(parse_whole, self.formats[channel], data)

    def read(self, channel: str, data: bytes, known: Known) -> Reading:
        """Return the content of `data`; WireError when it cannot be read, or cannot be."""
        parsed, reader = self.parse(channel, data), self.readers.get(channel)
        if reader is None:
            return Reading()
        return check_reading(_reject_errors(reader, parsed, MappingProxyType(known)))

    def write(self, channel: str, value: Any) -> bytes:
        """Return the bytes of a value that the channel's construct accepts; ValueError when it does not fit."""
        try:
            return build_whole(self.formats[channel], value)
        except (TypeError, AttributeError, *READING_ERRORS) as error:  # a field is missing or of a wrong type
            raise ValueError(str(error) or type(error).__name__) from error


def check_reading(reading: Any) -> Reading:
    """Return the reading; WireError for one that cannot be, because the readers of an app are not trusted."""
    if not isinstance(reading, Reading):
        raise malformed(f"a reader gave a {type(reading).__name__}, not a Reading")
    fault = find_fault(reading, Reading, exact=True)
    if fault is not None and fault.is_outside:
        no_number = isinstance(fault.value, float) and not isfinite(fault.value)
        raise WireError(Rejection.NOT_FINITE if no_number else Rejection.ABSURD, str(fault))
    if fault is not None:
        raise malformed(str(fault))
    if reading.interval is not None and reading.interval < 1:
        raise malformed(f"an interval of {reading.interval} ticks")
    if reading.layout is not None and type(reading.layout.id) is not int:  # an enum is an int, and cannot be saved
        raise malformed(f"layout.id is a {type(reading.layout.id).__name__}, not an int")
    for name in reading.known:
        if type(name) is not str or len(name) > LONGEST_NAME or not name.isprintable():
            raise malformed(f"known has the name {name!r:.80}")
    return reading
