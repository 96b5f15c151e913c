"""Check of a record by what its class declares: types, limits, and rules between fields.

A program may put anything into a record. `find_fault` finds a value whose type is not that of its annotation, or that
is outside the limits of its field (`limits` in attrs.py). If the class of a record has a method `contradiction`, it is
called after the fields of the record: it returns what is wrong with values that are each within their limits, as words
that follow the record's name in a sentence, or None.

    newtons: Newtons | None = None                                              checked if it is not None
    noise: tuple[float, ...] = field(default=(), metadata=limits(0.0, 1e6))     each number from 0 to 1e6

Limits of a field hold for every float in its value, in place of those of the records in it. Annotations may be numbers,
bool, str, enums, records, tuples with items of one type, dict, Mapping, and optionals of these."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from functools import cache
from math import inf
from types import NoneType
from typing import Any, NoReturn, get_args, get_origin, get_type_hints

import attrs

from .attrs import COUNT, LIMITS


class Fault(ValueError):
    """What is wrong with one value in a record; as text, a sentence for a person."""

    def __init__(self, way: Any, text: str, value: Any, is_outside: bool = False) -> None:
        path = ""
        while way is not None:
            way, step = way
            step = step.value if isinstance(step, Enum) else step
            path = (f".{step}" if isinstance(step, str) and step.isidentifier() else f"[{describe(step)}]") + path
        super().__init__((path.removeprefix(".") or "it") + text)
        self.value = value
        self.is_outside = is_outside
        """True for a value of the right type that is outside its limits."""


def find_fault(value: Any, cls: type, *, exact: bool = False) -> Fault | None:
    """Return the first fault of a record of class `cls`, or None.

    With `exact`, a float is one of Python itself: a numpy.float64 is a float too, but comparisons with it give no bool.
    A flag then counts as a number, as it does in Python."""
    try:
        _check_of(cls, exact)(value, None)
    except Fault as fault:
        return fault
    return None


Check = Callable[[Any, Any], None]
"""Raises Fault for a value. The second argument is the way to it: a pair of the way to what has it and the last step,
which is the name of a field, an index or a key; None for the record itself."""


@cache
def _check_of(hint: Any, exact: bool, limits: Any = None, count: Any = (0, inf)) -> Check:
    """Return the check of values with this annotation."""
    kind, arguments = get_origin(hint) or hint, get_args(hint)
    if kind in (float, int):
        allowed, excluded = (int, ()) if exact and kind is float else ((kind, int), bool)
        least, most, unit = limits or (None, None, "")

        def check(value: Any, way: Any) -> None:
            if type(value) is not kind and (not isinstance(value, allowed) or isinstance(value, excluded)):
                _reject(value, kind, way)
            if limits is not None and not least <= value <= most:
                raise Fault(way, f" is {describe(value)}; it can be {least:g} to {most:g} {unit}".rstrip(), value, True)

    elif arguments:
        key_kind = None if kind is tuple else arguments[0]
        check_item = _check_of(arguments[key_kind is not None], exact, limits)
        fewest, largest = count if key_kind is not None or ... in arguments else (len(arguments),) * 2

        def check(value: Any, way: Any) -> None:
            if not isinstance(value, kind):
                _reject(value, kind, way)
            if not fewest <= len(value) <= largest:
                allowed = f"; it can have {fewest} to {largest}" if fewest < largest else f", not {largest}"
                raise Fault(way, f" has {len(value)} values{allowed}", value, fewest < largest)
            for step, item in enumerate(value) if key_kind is None else value.items():
                if key_kind is not None and not isinstance(step, key_kind):
                    raise Fault(way, f" has the key {describe(step)}, not of type {key_kind.__name__}", step)
                check_item(item, (way, step))

    else:
        hints, contradiction = get_type_hints(kind), getattr(kind, "contradiction", None)
        fields = []
        for one in attrs.fields(kind) if attrs.has(kind) else ():
            field_hint = hints[one.name]
            is_optional = NoneType in get_args(field_hint)
            if is_optional:
                (field_hint,) = set(get_args(field_hint)) - {NoneType}
            own = one.metadata.get(LIMITS) if limits is None or field_hint is int else limits
            check_field = _check_of(field_hint, exact, own, one.metadata.get(COUNT, (0, inf)))
            fields.append((one.name, is_optional, check_field))

        def check(value: Any, way: Any) -> None:
            if not isinstance(value, kind):
                _reject(value, kind, way)
            for name, is_optional, check_field in fields:
                item = getattr(value, name)
                if item is not None or not is_optional:
                    check_field(item, (way, name))
            wrong = None if contradiction is None else contradiction(value)
            if wrong is not None:
                raise Fault(way, wrong, value, True)

    return check


def _reject(value: Any, kind: type, way: Any) -> NoReturn:
    raise Fault(way, f" is {describe(value)}, not of type {kind.__name__}", value)


def describe(value: object) -> str:
    """Return a value for use in a sentence: short, on one line, of any type."""
    if isinstance(value, float):
        return f"{value:g}" if type(value) is float else f"{type(value).__name__}({value:g})"
    if isinstance(value, int) and not abs(value) < 10**30:
        return "a huge number"  # Python does not convert very long integers to text
    if isinstance(value, tuple) and len(value) <= 3:
        return f"({', '.join([describe(item) for item in value])})"
    if isinstance(value, str | int | None):
        return repr(value)[:60]
    return f"a {type(value).__name__}"
