"""Random events, which hypothesis makes from the event classes."""

from __future__ import annotations

from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import attrs
from hypothesis import strategies as st

from solepath.events import Event

KINDS = get_args(Event)
TAME = st.floats(0.0, 100.0)
WIDE = st.floats(-1e11, 1e11)
WILD = st.floats()
"""Any float, also NaN and infinity."""


def _value(hint: Any, number: st.SearchStrategy[float]) -> st.SearchStrategy[Any]:
    """Return a value of an annotation, with all its floats drawn from `number`."""
    arguments = get_args(hint)
    if hint is float:
        return number
    if get_origin(hint) in (Union, UnionType):
        return st.one_of([_value(argument, number) for argument in arguments])
    if get_origin(hint) is tuple and arguments[-1:] == (Ellipsis,):
        return st.lists(_value(arguments[0], number), max_size=12).map(tuple)
    if get_origin(hint) is tuple:
        return st.tuples(*[_value(argument, number) for argument in arguments])
    if attrs.has(hint):
        return _record(hint, number)
    return st.from_type(hint)


def _record(kind: Any, number: st.SearchStrategy[float]) -> st.SearchStrategy[Any]:
    hints = get_type_hints(kind)
    return st.builds(kind, **{field.name: _value(hints[field.name], number) for field in attrs.fields(kind)})


def events() -> st.SearchStrategy[Any]:
    """Return a strategy for events of any kind, with numbers of TAME, WIDE or WILD."""
    return st.one_of([_record(kind, number) for number in (TAME, WIDE, WILD) for kind in KINDS])
