"""Plain numbers: those of numpy, pandas and others become Python's own where they come in.

State made of other numbers could not be saved: a comparison of two numpy.float64 is no bool."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Set
from copy import deepcopy
from math import inf
from typing import Any, TypeVar

import attrs

from .attrs import evolve
from .records import Sample

_Value = TypeVar("_Value")

ONLY_FLOATS = frozenset((float,))
"""Type of the numbers of an attitude that are not converted."""
PLAIN_NUMBERS = frozenset((float, int))
"""Types of the numbers of pressure cells that are not converted; counts are whole numbers."""


def has_floats(sample: Sample) -> bool:
    """Return whether no number of the sample must be converted; it is called for every sample, and so is fast."""
    vector: Any
    for vector in (sample.acc, sample.gyro, sample.mag):
        if vector is not None:
            if type(vector) is not tuple or len(vector) != 3:
                return False
            x, y, z = vector
            if not (type(x) is type(y) is type(z) is float):
                return False
    pressure = sample.pressure
    if pressure is not None:
        if type(pressure) is not tuple:
            return False
        # to count takes two thirds of the time of comparing sets, which is left for cells with whole numbers
        only_floats = list(map(type, pressure)).count(float) == len(pressure)
        if not only_floats and not PLAIN_NUMBERS.issuperset(map(type, pressure)):
            return False
    quat = sample.quat
    if quat is not None and (type(quat) is not tuple or len(quat) != 4 or not ONLY_FLOATS.issuperset(map(type, quat))):
        return False
    if sample.air_pressure is not None and type(sample.air_pressure) is not float:
        return False
    return type(sample.t) is type(sample.known_at) is float and type(sample.saturated) is bool


def with_floats(sample: Sample) -> Sample:
    """Return the sample with plain floats; raise TypeError, naming the field, for what is no number.

    Numbers of numpy, of pandas and of any class that float() takes are converted, vectors may be lists or arrays."""
    return evolve(
        sample,
        t=number("t of a sample", sample.t),
        known_at=number("known_at of a sample", sample.t if sample.known_at is None else sample.known_at),
        acc=_floats("acc of a sample", sample.acc, 3),
        gyro=_floats("gyro of a sample", sample.gyro, 3),
        quat=_floats("quat of a sample", sample.quat, 4),
        mag=_floats("mag of a sample", sample.mag, 3),
        pressure=_floats("pressure of a sample", sample.pressure, None),
        air_pressure=None if sample.air_pressure is None else number("air_pressure of a sample", sample.air_pressure),
        saturated=flag("saturated of a sample", sample.saturated),
    )


def number(what: str, value: Any) -> float:
    """Return a number as a float; raise TypeError, naming `what` it is, for anything else, also for text.

    An int that is too large for a float counts as infinite."""
    kind = getattr(getattr(value, "dtype", None), "kind", "f")  # of numpy: no complex numbers, and no dates
    try:
        if kind in "biufO" and not isinstance(value, str | bytes | bytearray):
            return float(value)
    except OverflowError:
        return inf
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{what} is a number, not {value!r:.80}")


def _floats(what: str, values: Any, count: int | None) -> Any:
    """Return a vector of `count` floats, or the loads of cells, of which one that was not measured stays None."""
    if values is None:
        return None
    is_sequence = isinstance(values, Iterable) and not isinstance(values, str | bytes | bytearray | Set | Mapping)
    numbers: Any = tuple(values) if is_sequence else None  # arrays have no common class
    if numbers is None or count not in (None, len(numbers)):
        raise TypeError(f"{what} is {count or 'a row of'} numbers, not {values!r:.80}")
    return tuple([None if value is None and count is None else number(what, value) for value in numbers])


def text(value: str) -> str:
    """Return a text of numpy, of an enum or of another class of texts as a plain one, with the same characters."""
    return str.__str__(value)


def flag(what: str, value: Any) -> bool:
    """Return a flag as a bool; flags of numpy are not bools themselves, but equal one."""
    try:
        if not isinstance(value, str | bytes) and value in (False, True):
            return bool(value)
    except (TypeError, ValueError):  # a missing value of pandas, an array
        pass
    raise TypeError(f"{what} is True or False, not {value!r:.80}")


def plain_copy(value: _Value) -> _Value:
    """Return a copy of the value with plain numbers in all its records, tuples, lists and dicts."""
    copy: _Value = _make_plain(deepcopy(value))
    return copy


def _make_plain(value: Any) -> Any:
    if isinstance(value, float):
        return float(value)
    if hasattr(value, "dtype") and getattr(value, "ndim", None) == 0:  # a number of numpy
        return value.item()
    if isinstance(value, deque):
        return deque(map(_make_plain, value), value.maxlen)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value)(*map(_make_plain, value))
    if type(value) in (tuple, list):
        return type(value)(map(_make_plain, value))
    if type(value) is dict:
        return {_make_plain(key): _make_plain(item) for key, item in value.items()}
    if attrs.has(type(value)):
        for attribute in attrs.fields(type(value)):
            if hasattr(value, attribute.name):
                object.__setattr__(value, attribute.name, _make_plain(getattr(value, attribute.name)))
    return value
