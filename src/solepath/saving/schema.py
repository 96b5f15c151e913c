"""Schema of a record, from the type annotations of its class.

A record is an attrs class, or a plain class with annotations in its body (a `ClassVar` is no field). A field may be a
float, int, bool, string, bytes, enum member, another record, an optional of one of these, or a tuple, NamedTuple, list,
deque, dict or Counter of these. A record may be generic. Nothing else can be saved: generators, closures, rebound
methods and arrays cannot.

An annotation that is a Protocol is *open*: the value is a record of any class. It is saved with the name of its class,
and the caller of `load` passes a function that returns the class. A union of records is open too, but has only its own
classes.

Fields that a constructor takes are *settings* and never change; other fields (`init=False`) are *state*. A class with
state is a *part*. When a session is unpacked, the *holder* of a part (the record that has it in a field) makes the part
again with the same settings. The packed form of such a part has only its state, and the state of parts in its settings.
This applies to a part in a setting, and to a part in a field of state whose default is not None. Everything else is
written with all fields: parts that may be absent, and records without state. Two marks declare exceptions:

    floorplan: Plan | None = field(default=None, metadata=NOT_SAVED)      has its default after loading
    feet: dict[Foot, Tracker] = field(factory=dict, init=False, metadata=MADE_AGAIN)      only the state is saved
"""

from __future__ import annotations

import inspect
import json
import types
import typing
from binascii import crc32
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from enum import Enum
from typing import Any

import attrs

from ..types.attrs import MADE_AGAIN, NOT_SAVED, ROW_SIZE
from .nodes import DictNode, EnumNode, MaybeNode, Node, OpenNode, RecordNode, ScalarNode, SequenceNode, TupleNode

SCALARS = (float, int, bool, str, bytes)
_RECORDS: dict[tuple[Any, bool], RecordNode] = {}


def record_of(cls: type, made: bool = False) -> RecordNode:
    """Return the schema of a class; with `made`, the schema of its state, for a record that its holder makes again.

    A type that cannot be saved raises TypeError, which names the class and the field."""
    cached = _RECORDS.get((cls, made))
    return _SchemaBuilder().record(cls, made) if cached is None else cached


def record_in(node: OpenNode, cls: type) -> RecordNode:
    """Return the schema of a record of class `cls` that is the value of an open node."""
    return record_of(cls, node.made and (cls in node.known.values() or has_state(cls)))


def is_record(cls: Any) -> bool:
    """Return whether `cls` is a record: a class whose annotations declare its fields."""
    cls = typing.get_origin(cls) or cls
    if not isinstance(cls, type) or issubclass(cls, Enum | tuple | list | dict | deque):
        return False
    return attrs.has(cls) or bool(typing.get_type_hints(cls))


def is_part(cls: Any) -> bool:
    """Return whether `cls` is a part: a record with state; a frozen class has none."""
    return (
        is_record(cls) and not is_frozen(cls) and any([not declared.is_setting for declared in _declared_fields(cls)])
    )


def has_state(hint: Any) -> bool:
    """Return whether a value with this annotation is a part, or has a part in a setting."""
    if is_open(hint) or is_part(hint):
        return True
    if is_record(hint):
        return not is_frozen(hint) and any([has_state(declared.hint) for declared in _declared_fields(hint)])
    return any([has_state(argument) for argument in typing.get_args(hint)])


def is_frozen(cls: Any) -> bool:
    """Return whether attrs forbids changes of the class's fields."""
    setter: Any = (typing.get_origin(cls) or cls).__setattr__
    return setter is _Frozen.__setattr__


def is_open(cls: Any) -> bool:
    """Return whether `cls` is a Protocol, which as an annotation stands for records of any class."""
    return bool(getattr(cls, "_is_protocol", False))


@attrs.frozen
class _Frozen:
    """A frozen class to compare with, because all frozen classes of attrs share one `__setattr__`."""


@attrs.frozen
class _DeclaredField:
    """A field as its class declares it."""

    name: str
    hint: Any
    is_setting: bool
    default: Any
    metadata: Mapping[Any, Any]

    @property
    def mark(self) -> str | None:
        """Mark of the field (types/attrs.py); None without one."""
        return self.metadata.get("saving")


def _declared_fields(record: Any) -> Iterator[_DeclaredField]:
    cls = typing.get_origin(record) or record
    hints = typing.get_type_hints(cls)
    if attrs.has(cls):
        for field in attrs.fields(cls):
            yield _DeclaredField(field.name, hints[field.name], field.init, field.default, field.metadata)
        return
    parameters = inspect.signature(cls).parameters
    for name, hint in hints.items():
        if typing.get_origin(hint) is not typing.ClassVar and hint is not typing.ClassVar:
            yield _DeclaredField(name, hint, name in parameters, getattr(cls, name, attrs.NOTHING), {})


class _SchemaBuilder:
    """Builds the nodes of a schema from annotations."""

    def __init__(self) -> None:
        self.enclosing_classes: list[type] = []

    def record(self, hint: Any, made: bool) -> RecordNode:
        cached = _RECORDS.get((hint, made))
        if cached is not None:
            return cached
        if not is_record(hint):
            raise TypeError(f"a record is an attrs class, and {hint!r} is none")
        cls, arguments = typing.get_origin(hint) or hint, _type_arguments(hint)
        if cls in self.enclosing_classes:
            raise TypeError(f"a {cls.__name__} in a {cls.__name__} cannot be saved")
        self.enclosing_classes.append(cls)
        fields: dict[str, Node] = {}
        defaults: dict[str, Any] = {}
        for declared in _declared_fields(cls):
            try:
                declared = attrs.evolve(declared, hint=_substituted(declared.hint, arguments))
                node = None if declared.mark == NOT_SAVED["saving"] else self.field(declared, made)
            except TypeError as error:
                raise TypeError(locate_error(error, cls, declared.name)) from error
            if node is None:
                defaults[declared.name] = declared.default
            elif ROW_SIZE in declared.metadata:
                fields[declared.name] = ScalarNode(bytes, declared.metadata[ROW_SIZE])
            else:
                fields[declared.name] = node
        self.enclosing_classes.pop()
        return _RECORDS.setdefault((hint, made), RecordNode(cls, made, fields, defaults))

    def field(self, declared: _DeclaredField, made: bool) -> Node | None:
        """Return the node of a field; None for a setting without parts of a record that is made again."""
        if not made:
            return self.node(declared.hint, False)
        if declared.is_setting:
            return self.node(declared.hint, True) if has_state(declared.hint) else None
        kinds = [kind for kind in alternatives(declared.hint) if kind is not type(None)]
        exists_from_start = declared.default is not None and all([is_record(kind) or is_open(kind) for kind in kinds])
        made = exists_from_start and any([is_part(kind) or is_open(kind) for kind in kinds])
        return self.node(declared.hint, made or declared.mark == MADE_AGAIN["saving"])

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
            return SequenceNode(tuple, self.node(arguments[0], made))
        if origin is tuple:
            return TupleNode(tuple([self.node(argument, made) for argument in arguments]))
        if make := getattr(hint, "_make", None):
            items = typing.get_type_hints(hint).values()
            return TupleNode(tuple([self.node(item, made) for item in items]), make)
        if origin in (list, deque):
            return SequenceNode(origin, self.node(arguments[0], made))
        if origin is dict:
            return DictNode(self.node(arguments[0], made), self.node(arguments[1], made))
        if origin is Counter:
            return DictNode(self.node(arguments[0], made), ScalarNode(int), Counter)
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
        elif len(records) + len([*filter(is_open, kinds)]) == len(kinds):
            node = OpenNode(records, others, made)
        else:
            raise TypeError(f"it could not tell apart {hint!r}")
        return MaybeNode(node) if len(kinds) < len(alternatives(hint)) else node


def _type_arguments(hint: Any) -> dict[Any, Any]:
    """Return what stands for each type variable in a generic record, and in the records that it derives from."""
    cls = typing.get_origin(hint) or hint
    arguments = dict(zip(getattr(cls, "__parameters__", ()), typing.get_args(hint), strict=False))
    for base in getattr(cls, "__orig_bases__", ()):
        if typing.get_origin(base) is not typing.Generic and is_record(base):
            arguments |= _type_arguments(_substituted(base, arguments))
    return arguments


def _substituted(hint: Any, arguments: dict[Any, Any]) -> Any:
    """Return an annotation with its type variables replaced."""
    if isinstance(hint, typing.TypeVar):
        return arguments.get(hint, hint)
    parameters = getattr(hint, "__parameters__", ()) if typing.get_origin(hint) is not None else ()
    return hint[tuple([arguments.get(one, one) for one in parameters])] if parameters else hint


def alternatives(hint: Any) -> tuple[Any, ...]:
    """Return the members of a union; for another type, the type itself."""
    return typing.get_args(hint) if typing.get_origin(hint) in (typing.Union, types.UnionType) else (hint,)


_CANNOT = "a snapshot cannot hold "


def locate_error(error: Exception, cls: type, name: str) -> str:
    """Return the error's text with class and field of the innermost record."""
    return str(error) if str(error).startswith(_CANNOT) else f"{_CANNOT}{cls.__name__}.{name}: {error}"


def describe(*roots: RecordNode) -> dict[str, Any]:
    """Return the schema as plain data (protocol/snapshot.md)."""
    data: dict[str, Any] = {"roots": [], "records": {}, "enums": {}}
    numbers: dict[type, int] = {}

    def name(cls: type) -> str:
        if cls not in numbers:
            numbers[cls] = 1 + sum([known.__name__ == cls.__name__ for known in numbers])
        return f"{cls.__name__} {numbers[cls]}" if numbers[cls] > 1 else cls.__name__

    def record(node: RecordNode) -> str:
        title = f"state of {name(node.cls)}" if node.made else name(node.cls)
        if title not in data["records"]:
            data["records"][title] = {}
            data["records"][title] = {field: kind(inner) for field, inner in node.fields.items()}
        return title

    def kind(node: Node) -> Any:
        match node:
            case ScalarNode(cls):
                return cls.__name__
            case EnumNode(cls):
                data["enums"][name(cls)] = [str(word.value) for word in cls]
                return {"enum": name(cls)}
            case MaybeNode(of):
                return {"maybe": kind(of)}
            case TupleNode(items, _):
                return {"tuple": [kind(item) for item in items]}
            case SequenceNode(cls, of):
                return {"row" if cls is tuple else cls.__name__: kind(of)}
            case DictNode(key, of):
                return {"dict": [kind(key), kind(of)]}
            case OpenNode(known, others, _):
                return {"one of": [record(record_in(node, cls)) for cls in known.values()], "open": others}
            case RecordNode():
                return {"record": record(node)}

    data["roots"] = [record(root) for root in roots]
    return data


def schema_checksum(data: dict[str, Any]) -> int:
    """Return the CRC-32 of a schema in the form of `describe`."""
    return crc32(json.dumps(data, separators=(",", ":")).encode())
