"""Schema of a record, from the type annotations of its class.

A record is an attrs class. A field may be a float, int, bool, string, bytes, enum member, another record, an optional
of one of these, or a tuple, list, deque, dict or Counter of these, or `Doubles`. A record may be generic.
Nothing else can be saved: generators, closures, rebound methods and arrays of numpy cannot.

An annotation that is a Protocol is *open*: the value is a record of any class. It is saved with the name of its class,
and the caller of `load` passes a function that returns the class. A union of records is open too, but has only its own
classes.

A class in the row "aid" of types/registry.py is imported only when there is a record of it: a module that has such a
field imports it under `if TYPE_CHECKING`, and where it makes the first one.

Fields that a constructor takes are *settings* and never change; other fields (`init=False`, which `stateful` of
types/attrs.py gives each field with a default but `settings`) are *state*. A class with state is a *part*. When a
session is unpacked, the *holder* of a part (the record that has it in a field) makes the part again with the same
settings. The packed form of such a part has only its state, and the state of parts in its settings. This applies to a
part in a setting, and to a part in a field of state whose default is not None. Everything else is written with all
fields: parts that may be absent, and records without state. Two marks declare exceptions:

    floorplan: Plan | None = field(default=None, metadata=NOT_SAVED)      has its default after loading
    feet: dict[Foot, Tracker] = field(factory=dict, metadata=MADE_AGAIN)                  only the state is saved
"""

from __future__ import annotations

import sys
import types
import typing
from collections import Counter, deque
from contextvars import ContextVar
from enum import EnumMeta
from functools import cache
from typing import Any

import attrs

from ..types.attrs import MADE_AGAIN, NOT_SAVED, ROW_SIZE, evolve
from ..types.doubles import Doubles
from ..types.registry import TABLE, load
from .nodes import (
    DataNode,
    DictNode,
    EnumNode,
    LateNode,
    MaybeNode,
    Node,
    NumberNode,
    OpenNode,
    RecordNode,
    RowNode,
    TupleNode,
    locate_error,
)

NUMBERS = (float, int, bool)
"""Kinds of numbers, in the order of their streams."""


class Late:
    """Stands in an annotation for a class that may not be imported yet; the subclass has its name."""


LATE: dict[str, Any] = {name: type(name, (Late,), {}) for name in TABLE["aid"]}
"""The subclass for each class in the row."""
_outer: ContextVar[tuple[type, ...]] = ContextVar("outer", default=())
"""Classes whose fields are being read, the outermost first."""


def record_of(cls: Any, made: bool = False) -> RecordNode:
    """Return the schema of a class; with `made`, the schema of its state, for a record that its holder makes again.

    A type that cannot be saved raises TypeError, which names the class and the field."""
    return _record_of(cls, made)


@cache
def _record_of(cls: Any, made: bool) -> RecordNode:
    if not is_record(cls):
        raise TypeError(f"{cls!r} is no attrs class")
    plain = typing.get_origin(cls) or cls
    if plain in _outer.get():
        raise TypeError(f"a {plain.__name__} in a {plain.__name__} cannot be saved")
    fields: dict[str, Node] = {}
    defaults: dict[str, Any] = {}
    token = _outer.set((*_outer.get(), plain))
    try:
        for one, hint in _fields(cls):
            try:
                node = _field(one, hint, made)
            except TypeError as error:
                raise TypeError(locate_error(error, plain, one.name)) from error
            if node is None:
                defaults[one.name] = one.default
            else:
                fields[one.name] = node
    finally:
        _outer.reset(token)
    return RecordNode(plain, made, fields, defaults)


def is_record(cls: Any) -> bool:
    """Return whether `cls` is a record: a class of attrs, or a generic one with its arguments."""
    return isinstance(typing.get_origin(cls) or cls, type) and attrs.has(cls)


def is_part(cls: Any) -> bool:
    """Return whether `cls` is a part: a record with state; a frozen class has none."""
    return is_record(cls) and not _is_frozen(cls) and not all([one.init for one, _ in _fields(cls)])


@cache
def has_state(hint: Any) -> bool:
    """Return whether a value with this annotation is a part, or has a part in a setting."""
    if is_record(hint):
        return is_part(hint) or (not _is_frozen(hint) and any([has_state(inner) for _, inner in _fields(hint)]))
    return is_open(hint) or is_late(hint) or any([has_state(argument) for argument in typing.get_args(hint)])


def _is_frozen(cls: Any) -> bool:
    """Return whether attrs forbids changes of the class's fields."""
    return (typing.get_origin(cls) or cls).__setattr__ is _Frozen.__setattr__


def is_open(cls: Any) -> bool:
    """Return whether `cls` is a Protocol, which as an annotation stands for records of any class."""
    return bool(getattr(cls, "_is_protocol", False))


def is_late(hint: Any) -> bool:
    """Return whether an annotation stands for a class that may not be imported yet."""
    return isinstance(hint, type) and issubclass(hint, Late)


@attrs.frozen
class _Frozen:
    """A frozen class to compare with, because all frozen classes of attrs share one `__setattr__`."""


def _fields(record: Any) -> list[tuple[Any, Any]]:
    """Return the fields of a record with their annotations, in which type variables are replaced."""
    cls = typing.get_origin(record) or record
    arguments: dict[Any, Any] = {}
    for base in (*getattr(cls, "__orig_bases__", ()), record):
        arguments |= zip(getattr(typing.get_origin(base), "__parameters__", ()), typing.get_args(base), strict=False)
    hints: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        # a name of the row stands for the late class where a module of this package imports it for type checkers alone
        own: dict[str, Any] = getattr(sys.modules.get(base.__module__), "__dict__", {})
        late = LATE if base.__module__.partition(".")[0] == __name__.partition(".")[0] else {}
        annotated = type(base.__name__, (), {"__annotations__": base.__dict__.get("__annotations__", {})})
        hints |= typing.get_type_hints(annotated, own, {name: one for name, one in late.items() if name not in own})
    return [(one, _substituted(hints[one.name], arguments)) for one in attrs.fields(cls)]


def _substituted(hint: Any, arguments: dict[Any, Any]) -> Any:
    alias: Any = list[hint]
    variables = alias.__parameters__
    return typing.get_args(alias[tuple([arguments.get(one, one) for one in variables])])[0] if variables else hint


def _field(one: Any, hint: Any, made: bool) -> Node | None:
    """Return the node of a field; None if it is not saved, as a setting without parts of a record made again."""
    mark = one.metadata.get("saving")
    if mark == NOT_SAVED["saving"] or (made and one.init and not has_state(hint)):
        return None
    if row_size := one.metadata.get(ROW_SIZE):
        if hint not in (bytes, Doubles):
            raise TypeError("only bytes and Doubles have a row size")
        return evolve(_node(hint, made), row_size=row_size)
    if not made or one.init or mark == MADE_AGAIN["saving"]:
        return _node(hint, made)
    kinds = _kinds(hint)
    exists_from_start = one.default is not None and all([is_record(kind) or is_open(kind) for kind in kinds])
    return _node(hint, exists_from_start and any([is_part(kind) or is_open(kind) for kind in kinds]))


def _node(hint: Any, made: bool) -> Node:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if hint in NUMBERS:
        return NumberNode(hint, NUMBERS.index(hint))
    if hint in (str, bytes):
        return DataNode(hint)
    if isinstance(hint, EnumMeta):
        return EnumNode(hint, tuple(hint))
    if is_late(hint):
        return LateNode(hint.__name__, made, lambda name, made: _record_of_value(load("aid", name), made))
    if is_open(hint) or origin in (typing.Union, types.UnionType):
        return _union(hint, made)
    if is_record(hint):
        return record_of(hint, made)
    if origin is tuple and arguments[1:] != (...,):
        return TupleNode(tuple([_node(argument, made) for argument in arguments]))
    if make := getattr(hint, "_make", None):
        return TupleNode(tuple([_node(item, made) for item in typing.get_type_hints(hint).values()]), make)
    if hint is Doubles:
        return RowNode(Doubles, NumberNode(float, 0))
    if origin in (tuple, list, deque):
        return RowNode(origin, _node(arguments[0], made), made)
    if origin in (dict, Counter):
        has_text_keys = arguments[0] is str or isinstance(arguments[0], EnumMeta)
        return DictNode(origin, _node(arguments[0], made), _node([*arguments, int][1], made), has_text_keys)
    if hint in (tuple, list, deque, dict):
        what = "dict[str, float]" if hint is dict else f"{hint.__name__}[float]"
        raise TypeError(f"its type does not say what is in it; write {what}, or whatever it is")
    raise TypeError(f"{hint!r} is no number, string, enum, bytes, tuple, list, deque, dict, Doubles or record")


def _union(hint: Any, made: bool) -> Node:
    kinds = _kinds(hint)
    node: Node
    if len(kinds) == 1:
        node = OpenNode({}, made, _record_of_value) if is_open(kinds[0]) else _node(kinds[0], made)
    elif all([is_record(kind) and not is_open(kind) for kind in kinds]):
        node = OpenNode({kind.__name__: kind for kind in kinds}, made, _record_of_value)
    else:
        raise TypeError(f"it could not tell apart {hint!r}")
    return MaybeNode(node, made and not isinstance(node, LateNode)) if types.NoneType in typing.get_args(hint) else node


def _record_of_value(cls: type, made: bool) -> RecordNode:
    return record_of(cls, made and has_state(cls))


def _kinds(hint: Any) -> list[Any]:
    """Return the members of a union but None; for another type, the type itself."""
    is_union = typing.get_origin(hint) in (typing.Union, types.UnionType)
    return [kind for kind in (typing.get_args(hint) if is_union else (hint,)) if kind is not types.NoneType]
