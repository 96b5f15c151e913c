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
from .records import Packet, Sample, Site

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
    if pressure is not None and (type(pressure) is not tuple or not PLAIN_NUMBERS.issuperset(map(type, pressure))):
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


PACKET_TYPES: dict[str, type | tuple[type, ...]] = {
    "site": Site,
    "channel": str,
    "device": str,
    "data": (bytes, bytearray, memoryview),
}
"""Types of the values of a packet that can be used; its time is any number."""


def has_plain_values(packet: Packet) -> bool:
    """Return whether no value of the packet must be converted; it is called for every packet."""
    if not (type(packet.channel) is type(packet.device) is str and type(packet.site) is Site):
        return False
    return type(packet.t) is float and type(packet.data) is bytes


def with_plain_values(packet: Packet) -> Packet:
    """Return the packet with Python's own number, texts and bytes; raise TypeError, naming the field, for others."""
    for name, kinds in PACKET_TYPES.items():
        value = getattr(packet, name)
        if not isinstance(value, kinds):
            fault = f"this {name} is {value!r:.40}"
            raise TypeError(f"a packet holds a time, a Site, a channel's name, bytes and a device's address; {fault}")
    t, channel, device = number("t of a packet", packet.t), text(packet.channel), text(packet.device)
    return evolve(packet, t=t, channel=channel, data=bytes(packet.data), device=device)


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
