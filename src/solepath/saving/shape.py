"""The shape of a state: which fields of which records are remembered, as plain data for JSON.

A *part* is a class with fields that its constructor does not take (`init=False`): those are its state, the others its
settings. What a recipe and a calibration make is made by them again, the same way, so of a part that was made with its
holder the settings are not written, only its state and that of the parts among its settings. What cannot be made again
with its holder (a record in an optional field, in a list, an app's own) is written whole, and so are records without
state of their own, which are data.

    {"root": R, "records": {R: {field: type, ...}, ...}, "enums": {name: [value, ...]}}

A record that is written whole has the name of its class ("Stride", and of another class of that name "Stride 2"), one
of which only the state is has that with "state of " before it; which module a class is in does not matter. A type is
"float", "int", "bool", "str", "bytes", or one of

    {"enum": name}   {"record": name}   {"one of": [name, ...], "open": bool}   {"maybe": type}
    {"tuple": [type, ...]}   {"row": type}   {"list": type}   {"deque": type}   {"dict": [type, type]}

where a row is a tuple of any length, and an open union also takes records of an app's own. Fields are in the order in
which they are packed: those of a fixed size first.
"""

from __future__ import annotations

import json
import types
import typing
from binascii import crc32
from collections import deque
from collections.abc import Mapping
from enum import Enum
from typing import Any

import attrs

from .codec import PARTS

Type = Any
"""str | dict[str, Type], as above."""
Fields = dict[str, Type]

STATE_OF = "state of "
SCALARS = {float: "float", int: "int", bool: "bool", str: "str", bytes: "bytes"}


@attrs.frozen
class _Frozen:
    """What attrs makes of all of them."""


@attrs.frozen
class Shape:
    """A shape and the classes that it was read from; of an older version there are none."""

    root: str
    records: dict[str, Fields]
    enums: dict[str, list[str]]
    classes: dict[str, type] = attrs.field(factory=dict, repr=False, eq=False)
    """Of every record and enum, by its name."""

    def told(self) -> dict[str, Any]:
        """As plain data."""
        return {"root": self.root, "records": self.records, "enums": self.enums}

    @property
    def check(self) -> int:
        """CRC-32 of it."""
        return crc32(json.dumps(self.told(), separators=(",", ":")).encode())


def shape_of(root: type, odd: Mapping[tuple[str, str], str] | None = None) -> Shape:
    """The shape of `root` and all it holds. `odd`: (class, field) -> "made", "whole" or "given", where the rules above
    do not say what a field is: that what it holds is made again, is not, or is not written. TypeError for a field that
    cannot be packed."""
    reader = _ShapeReader({} if odd is None else dict(odd))
    name = reader.record(root, whole=True)
    return Shape(name, reader.records, reader.enums, reader.classes)


def kind_of(record: str) -> str:
    """The class's own name."""
    return record.removeprefix(STATE_OF).partition(" ")[0]


def is_part(cls: Any) -> bool:
    """Whether it has state of its own beside settings; what is frozen never changes, so it has none."""
    return attrs.has(cls) and not is_frozen(cls) and any([not f.init for f in attrs.fields(cls)])


def is_frozen(cls: type) -> bool:
    """Whether attrs refuses to change it."""
    setter: Any = cls.__setattr__
    return setter is _Frozen.__setattr__


class _ShapeReader:
    """Reads classes into records."""

    def __init__(self, odd: dict[tuple[str, str], str]) -> None:
        self.odd = odd
        self.records: dict[str, Fields] = {}
        self.enums: dict[str, list[str]] = {}
        self.classes: dict[str, type] = {}
        self.names: dict[type, str] = {}

    def name(self, cls: type) -> str:
        """Its own, and its number among those of one name."""
        if cls not in self.names:
            alike = sum([known.__name__ == cls.__name__ for known in self.names])
            self.names[cls] = f"{cls.__name__} {alike + 1}" if alike else cls.__name__
        return self.names[cls]

    def record(self, cls: type, whole: bool) -> str:
        name = self.name(cls) if whole else STATE_OF + self.name(cls)
        if name in self.records:
            return name
        self.classes[name] = cls
        self.records[name] = {}
        hints = typing.get_type_hints(cls)
        found: Fields = {}
        for field in attrs.fields(cls):
            odd = self.odd.get((cls.__name__, field.name))
            if odd == "given":
                continue
            try:
                if odd is not None:
                    kind = self.type(hints[field.name], made=odd == "made")
                elif whole:
                    kind = self.type(hints[field.name], made=False)
                elif field.init:
                    kind = self.part(hints[field.name])
                else:
                    kind = self.state(hints[field.name], field.default is None)
            except TypeError as error:
                raise TypeError(f"{name}.{field.name}: {error}") from error
            if kind is not None:
                found[field.name] = kind
        self.records[name] = dict(sorted(found.items(), key=lambda item: _order(item[1])))
        return name

    def part(self, hint: Any) -> Type | None:
        """Of a setting: the state of the part that it is, or None."""
        kinds = [a for a in alternatives(hint) if a is not type(None)]
        if not any([self.remembers(a) for a in kinds]):
            return None
        return self.type(hint, made=True)

    def remembers(self, cls: Any) -> bool:
        """Whether it is a part, or has parts among its settings."""
        if not attrs.has(cls) or is_frozen(cls):
            return False
        hints = typing.get_type_hints(cls)
        return is_part(cls) or any([self.remembers(a) for f in attrs.fields(cls) for a in alternatives(hints[f.name])])

    def state(self, hint: Any, begins_without: bool) -> Type:
        """Of a field that no constructor takes: parts that are there from the beginning were made with their holder."""
        kinds = alternatives(hint)
        made = (
            not begins_without
            and any([is_part(a) for a in kinds])
            and all([attrs.has(a) or a is type(None) for a in kinds])
        )
        return self.type(hint, made=made)

    def type(self, hint: Any, made: bool) -> Type:
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if hint in SCALARS:
            return SCALARS[hint]
        if isinstance(hint, type) and issubclass(hint, Enum):
            name = self.name(hint)
            self.classes[name] = hint
            self.enums[name] = [str(member.value) for member in hint]
            return {"enum": name}
        if isinstance(hint, type) and attrs.has(hint):
            return {"record": self.record(hint, not made)}
        if origin in (typing.Union, types.UnionType) or hint in PARTS:
            return self.union(alternatives(hint), made)
        if origin is tuple and len(arguments) == 2 and arguments[1] is Ellipsis:
            return {"row": self.type(arguments[0], made)}
        if origin is tuple:
            return {"tuple": [self.type(a, made) for a in arguments]}
        if origin is list or origin is deque:
            return {origin.__name__: self.type(arguments[0], made)}
        if origin is dict:
            return {"dict": [self.type(a, made) for a in arguments]}
        raise TypeError(f"{hint!r} cannot be packed")

    def union(self, arguments: tuple[Any, ...], made: bool) -> Type:
        kinds = [a for a in arguments if a is not type(None)]
        records = [a for a in kinds if attrs.has(a)]
        is_open = any([getattr(a, "_is_protocol", False) for a in kinds])
        kind: Type
        if len(kinds) == 1:
            kind = self.type(kinds[0], made)
        elif len(records) == len(kinds) - is_open:
            kind = {"one of": [self.record(a, not made) for a in records], "open": is_open}
        else:
            raise TypeError(f"it could not tell apart {arguments!r}")
        return {"maybe": kind} if len(kinds) < len(arguments) else kind


def alternatives(hint: Any) -> tuple[Any, ...]:
    """What a union is made of, or a Protocol stands for; of another type itself."""
    if hint in PARTS:
        return (*PARTS[hint], hint)
    return typing.get_args(hint) if typing.get_origin(hint) in (typing.Union, types.UnionType) else (hint,)


def _order(kind: Type) -> int:
    """What has a fixed size first, then what may be absent, then the rest."""
    if is_fixed(kind):
        return 0
    return 1 if isinstance(kind, dict) and "maybe" in kind and is_fixed(kind["maybe"]) else 2


def is_fixed(kind: Type) -> bool:
    """Whether it is always as many numbers."""
    if isinstance(kind, str):
        return kind in ("float", "int", "bool")
    return "enum" in kind or "tuple" in kind and all([is_fixed(item) for item in kind["tuple"]])
