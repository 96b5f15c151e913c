"""What a record holds: one walk over the type annotations of its class.

A record is an attrs class, or a plain class with annotations in its body (`ClassVar` is none of its fields). Its fields
are floats, ints, bools, strings, bytes, enums, other records, None or one of these, tuples, lists, deques, and dicts
whose keys are strings or enums. Nothing else can be saved: no generators, closures, rebound methods or arrays.

An annotation that is a Protocol is *open*: what stands there is a record of any class, saved with the name of its class
and loaded by a lookup that is handed in. A union of records is open too, with a lookup of its own.

Fields that a constructor takes are *settings* and never change; those that it does not take (`init=False`) are *state*.
A class with state is a *part*. What makes a part makes it with the same settings again, so of such a part the packed
form has the state alone, and that of the parts among its settings: a part in a setting, and one in a field of state
that is there from the beginning (its default is not None). Everything else is written whole: parts that come and go,
and records without state, which are data. Two marks say what these rules do not:

    floorplan: Plan | None = field(default=None, metadata=NOT_SAVED)      its default after loading
    feet: dict[Foot, Tracker] = field(factory=dict, init=False, metadata=MADE_AGAIN)      of its parts the state alone
"""

from __future__ import annotations

import inspect
import json
import types
import typing
from binascii import crc32
from collections import deque
from collections.abc import Iterator
from enum import Enum
from typing import Any

import attrs

from ..types.attrs import MADE_AGAIN, NOT_SAVED
from .nodes import DictNode, EnumNode, MaybeNode, Node, OpenNode, RecordNode, RowNode, ScalarNode, TupleNode

SCALARS = (float, int, bool, str, bytes)
_RECORDS: dict[tuple[type, bool], RecordNode] = {}


def record_of(cls: type, made: bool = False) -> RecordNode:
    """The schema of a class. `made`: of its state alone. TypeError, which names the class and the field, for what
    cannot be saved."""
    known = _RECORDS.get((cls, made))
    return _Walk().record(cls, made) if known is None else known


def record_in(node: OpenNode, cls: type) -> RecordNode:
    """The schema of a record of that class in an open node."""
    return record_of(cls, node.made and (cls in node.known.values() or remembers(cls)))


def is_record(cls: Any) -> bool:
    """Whether it is a class whose fields can be read from its annotations."""
    if not isinstance(cls, type) or issubclass(cls, Enum | tuple):
        return False
    return attrs.has(cls) or bool(typing.get_type_hints(cls))


def is_part(cls: Any) -> bool:
    """Whether it has state beside settings; what is frozen never changes, so it has none."""
    return is_record(cls) and not is_frozen(cls) and any([not one.is_setting for one in _declared(cls)])


def remembers(hint: Any) -> bool:
    """Whether what stands there is a part, or holds one among its settings."""
    if is_open(hint) or is_part(hint):
        return True
    if is_record(hint):
        return not is_frozen(hint) and any([remembers(one.hint) for one in _declared(hint)])
    return any([remembers(one) for one in typing.get_args(hint)])


def is_frozen(cls: type) -> bool:
    """Whether attrs refuses to change it."""
    setter: Any = cls.__setattr__
    return setter is _Frozen.__setattr__


def is_open(cls: Any) -> bool:
    """Whether it stands for records of any class: it is a Protocol."""
    return bool(getattr(cls, "_is_protocol", False))


@attrs.frozen
class _Frozen:
    """What attrs makes of all of them."""


@attrs.frozen
class _DeclaredField:
    """A field as its class declares it."""

    name: str
    hint: Any
    is_setting: bool
    default: Any
    mark: str | None


def _declared(cls: type) -> Iterator[_DeclaredField]:
    hints = typing.get_type_hints(cls)
    if attrs.has(cls):
        for field in attrs.fields(cls):
            yield _DeclaredField(field.name, hints[field.name], field.init, field.default, field.metadata.get("saving"))
        return
    taken = inspect.signature(cls).parameters
    for name, hint in hints.items():
        if typing.get_origin(hint) is not typing.ClassVar and hint is not typing.ClassVar:
            yield _DeclaredField(name, hint, name in taken, getattr(cls, name, attrs.NOTHING), None)


class _Walk:
    """Reads annotations into nodes."""

    def __init__(self) -> None:
        self.within: list[type] = []

    def record(self, cls: type, made: bool) -> RecordNode:
        known = _RECORDS.get((cls, made))
        if known is not None:
            return known
        if not is_record(cls):
            raise TypeError(f"a record is an attrs class, and {cls!r} is none")
        if cls in self.within:
            raise TypeError(f"a {cls.__name__} in a {cls.__name__} cannot be saved")
        self.within.append(cls)
        fields: dict[str, Node] = {}
        defaults: dict[str, Any] = {}
        for one in _declared(cls):
            try:
                node = None if one.mark == NOT_SAVED["saving"] else self.field(one, made)
            except TypeError as error:
                raise TypeError(placed(error, cls, one.name)) from error
            if node is None:
                defaults[one.name] = one.default
            else:
                fields[one.name] = node
        self.within.pop()
        return _RECORDS.setdefault((cls, made), RecordNode(cls, made, fields, defaults))

    def field(self, one: _DeclaredField, made: bool) -> Node | None:
        """None for a setting of a record that is made again, and for one that is no part."""
        if not made:
            return self.node(one.hint, False)
        if one.is_setting:
            return self.node(one.hint, True) if remembers(one.hint) else None
        kinds = [kind for kind in alternatives(one.hint) if kind is not type(None)]
        there = one.default is not None and all([is_record(kind) or is_open(kind) for kind in kinds])
        made = there and any([is_part(kind) or is_open(kind) for kind in kinds])
        return self.node(one.hint, made or one.mark == MADE_AGAIN["saving"])

    def node(self, hint: Any, made: bool) -> Node:
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if hint in SCALARS:
            return ScalarNode(hint)
        if isinstance(hint, type) and issubclass(hint, Enum):
            return EnumNode(hint)
        if is_open(hint) or origin in (typing.Union, types.UnionType):
            return self.union(hint, made)
        if is_record(hint):
            return self.record(hint, made)
        if origin is tuple and arguments[1:] == (...,):
            return RowNode(tuple, self.node(arguments[0], made))
        if origin is tuple:
            return TupleNode(tuple([self.node(one, made) for one in arguments]))
        if origin in (list, deque):
            return RowNode(origin, self.node(arguments[0], made))
        if origin is dict:
            return DictNode(self.node(arguments[0], made), self.node(arguments[1], made))
        if hint in (tuple, list, deque, dict):
            what = "dict[str, float]" if hint is dict else f"{hint.__name__}[float]"
            raise TypeError(f"its type does not say what is in it; write {what}, or whatever it is")
        raise TypeError(f"{hint!r} is no number, string, enum, bytes, tuple, list, deque, dict or record")

    def union(self, hint: Any, made: bool) -> Node:
        kinds = [kind for kind in alternatives(hint) if kind is not type(None)]
        records = {kind.__name__: kind for kind in kinds if is_record(kind) and not is_open(kind)}
        others = any([is_open(kind) for kind in kinds])
        if len(kinds) == 1 and not others:
            node = self.node(kinds[0], made)
        elif len(records) + sum(map(is_open, kinds)) == len(kinds):
            node = OpenNode(records, others, made)
        else:
            raise TypeError(f"it could not tell apart {hint!r}")
        return MaybeNode(node) if len(kinds) < len(alternatives(hint)) else node


def alternatives(hint: Any) -> tuple[Any, ...]:
    """What a union is made of; of another type itself."""
    return typing.get_args(hint) if typing.get_origin(hint) in (typing.Union, types.UnionType) else (hint,)


_CANNOT = "a snapshot cannot hold "


def placed(error: Exception, cls: type, name: str) -> str:
    """What it says, with the class and the field, once: those of the innermost record are what is to be mended."""
    return str(error) if str(error).startswith(_CANNOT) else f"{_CANNOT}{cls.__name__}.{name}: {error}"


def described(*roots: RecordNode) -> dict[str, Any]:
    """The schema as plain data (protocol/snapshot.md)."""
    told: dict[str, Any] = {"roots": [], "records": {}, "enums": {}}
    numbers: dict[type, int] = {}

    def name(cls: type) -> str:
        """Its own, and its number among those of one name."""
        if cls not in numbers:
            numbers[cls] = 1 + sum([known.__name__ == cls.__name__ for known in numbers])
        return f"{cls.__name__} {numbers[cls]}" if numbers[cls] > 1 else cls.__name__

    def record(node: RecordNode) -> str:
        named = f"state of {name(node.cls)}" if node.made else name(node.cls)
        if named not in told["records"]:
            told["records"][named] = {}
            told["records"][named] = {field: kind(inner) for field, inner in node.fields.items()}
        return named

    def kind(node: Node) -> Any:
        match node:
            case ScalarNode(cls):
                return cls.__name__
            case EnumNode(cls):
                told["enums"][name(cls)] = [str(word.value) for word in cls]
                return {"enum": name(cls)}
            case MaybeNode(of):
                return {"maybe": kind(of)}
            case TupleNode(items):
                return {"tuple": [kind(item) for item in items]}
            case RowNode(cls, of):
                return {"row" if cls is tuple else cls.__name__: kind(of)}
            case DictNode(key, of):
                return {"dict": [kind(key), kind(of)]}
            case OpenNode(known, others, _):
                return {"one of": [record(record_in(node, cls)) for cls in known.values()], "open": others}
            case RecordNode():
                return {"record": record(node)}

    told["roots"] = [record(root) for root in roots]
    return told


def check_of(told: dict[str, Any]) -> int:
    """CRC-32 of a schema as plain data."""
    return crc32(json.dumps(told, separators=(",", ":")).encode())
