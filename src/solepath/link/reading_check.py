"""Check of a Reading (driver.py) before it changes any state, because the readers of an app are not trusted."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

from ..events import Rejection
from ..types import Cell, Foot, Layout
from ..wire.error import WireError
from ..wire.fields import LONGEST_VALUE, malformed
from .driver import MAX_COUNTER, Measured, Reading

MAX_VALUE = 1e8
"""Largest magnitude of a sensor value, SI units; the largest of a known device is 24 bits of Pa, which are 1.7e7."""
MOST_KNOWN, LONGEST_NAME = 64, 80
"""Largest number of known numbers of a device, and length of their names, characters, both chosen by hand."""
MIN_RATE, MAX_RATE = 0.1, 10_000.0
"""Smallest and largest rate that a reading may have, samples a second."""


def check_reading(reading: object) -> Reading:
    """Return `reading` unchanged after checking it.

    WireError when it is no Reading, or has a field of a wrong type or length, a number that is not finite or larger
    than any sensor gives, or an impossible rate or range."""
    if not isinstance(reading, Reading):
        raise malformed(f"a reader gave a {type(reading).__name__}, not a Reading")
    samples = _check_tuple("samples", reading.samples)
    for sample in samples:
        _check_sample(sample)
    if reading.mag is not None:
        _check_numbers("mag", reading.mag, 3)
    if reading.air_pressure is not None:
        _check_number("air_pressure", reading.air_pressure)
    for name, counter in (("sequence", reading.sequence), ("ticks", reading.ticks), ("interval", reading.interval)):
        if counter is not None:
            _check_counter(name, counter)
    if reading.interval is not None and reading.interval < 1:
        raise malformed(f"an interval of {reading.interval} ticks")
    if reading.battery is not None:
        _check_between("battery", reading.battery, 0.0, 1.0)
    if reading.rate is not None:
        _check_between("rate", reading.rate, MIN_RATE, MAX_RATE)
    if reading.period is not None:
        _check_between("period", reading.period, 1.0 / MAX_RATE, 1.0 / MIN_RATE)
    if reading.keys is not None:
        for key in _check_tuple("keys", reading.keys):
            _check_type("keys", key, str)
    for name, value, kind in (
        ("foot", reading.foot, Foot),
        ("layout", reading.layout, Layout),
        ("silent", reading.silent, bool),
    ):
        if value is not None:
            _check_type(name, value, kind)
    if reading.layout is not None:
        _check_layout(reading.layout)
    _check_known(reading.known)
    return reading


def _check_sample(sample: object) -> None:
    if not isinstance(sample, Measured):
        raise malformed(f"a sample that is a {type(sample).__name__}, not Measured")
    if sample.acc is not None:
        _check_numbers("acc", sample.acc, 3)
    if sample.gyro is not None:
        _check_numbers("gyro", sample.gyro, 3)
    if sample.quat is not None:
        _check_numbers("quat", sample.quat, 4)
    if sample.mag is not None:
        _check_numbers("mag", sample.mag, 3)
    if sample.pressure is not None:
        _check_numbers("pressure", sample.pressure, None)
    if sample.air_pressure is not None:
        _check_number("air_pressure", sample.air_pressure)
    _check_type("saturated", sample.saturated, bool)


def _check_layout(layout: Layout) -> None:
    if type(layout.id) is not int:  # an enum or another kind of int is kept as it is, and could not be saved
        raise malformed(f"the layout's id is a {type(layout.id).__name__}, not an int")
    _check_counter("the layout's id", layout.id)
    _check_type("the layout's foot", layout.foot, Foot)
    for cell in _check_tuple("cells", layout.cells):
        _check_type("one of the layout's cells", cell, Cell)
    scale = 0.0 if layout.scale is None else layout.scale
    numbers = (layout.length, layout.full_scale, scale, *layout.xs, *layout.ys, *[cell.area for cell in layout.cells])
    _check_numbers("the layout", numbers, None)


def _check_known(known: object) -> None:
    if not isinstance(known, Mapping):
        raise malformed(f"known is a {type(known).__name__}, not a mapping")
    if len(known) > MOST_KNOWN:
        raise WireError(Rejection.ABSURD, f"{len(known)} known numbers")
    for name, value in known.items():
        if type(name) is not str:
            raise malformed(f"known has a name that is a {type(name).__name__}")
        if len(name) > LONGEST_NAME or not name.isprintable():
            raise malformed(f"known has the name {name!r:.80}")
        _check_number("known", value)
        if name == "acc_range" and not value > 0.0:
            raise WireError(Rejection.ABSURD, f"an acc_range of {value:g} g")


def _check_tuple(name: str, values: object) -> tuple[object, ...]:
    """Return `values`; WireError unless they are a tuple of at most as many items as a value may have bytes."""
    if not isinstance(values, tuple):
        raise malformed(f"{name} is a {type(values).__name__}, not a tuple")
    if len(values) > LONGEST_VALUE:
        raise WireError(Rejection.ABSURD, f"{len(values)} {name} in one value")
    return values


def _check_numbers(name: str, values: object, count: int | None) -> None:
    numbers = _check_tuple(name, values)
    if count is not None and len(numbers) != count:
        raise malformed(f"{name} has {len(numbers)} numbers, not {count}")
    for number in numbers:
        if type(number) is not float or not -MAX_VALUE <= number <= MAX_VALUE:
            _check_number(name, number)


def _check_number(name: str, number: object) -> None:
    if not isinstance(number, int) and type(number) is not float:  # numpy.float64 is a float, and spoils the state
        raise malformed(f"{name} is a {type(number).__name__}, not a float or int of Python")
    if not -MAX_VALUE <= number <= MAX_VALUE:  # a large integer is compared, because it may be too large for a float
        if isinstance(number, float) and not isfinite(number):
            raise WireError(Rejection.NOT_FINITE, f"{name} of {number}")
        raise WireError(Rejection.ABSURD, f"{name} beyond {MAX_VALUE:g}")


def _check_between(name: str, number: object, low: float, high: float) -> None:
    _check_number(name, number)
    if isinstance(number, float | int) and not low <= number <= high:
        raise WireError(Rejection.ABSURD, f"{name} of {number:g}")


def _check_counter(name: str, counter: object) -> None:
    if not isinstance(counter, int) or isinstance(counter, bool):
        raise malformed(f"{name} is a {type(counter).__name__}, not an integer")
    if not -MAX_COUNTER < counter < MAX_COUNTER:
        raise WireError(Rejection.ABSURD, f"{name} of more than 64 bits")


def _check_type(name: str, value: object, kind: type) -> None:
    if not isinstance(value, kind):
        raise malformed(f"{name} is a {type(value).__name__}, not a {kind.__name__}")
