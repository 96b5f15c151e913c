"""Unpacking: of each record a function of straight-line code that builds it from four streams.

The code is made from the shape, once, as in writing.py:

    def read(t, f, n, m, b, F, P):
        o = new(cls)
        o.spread = t.spread
        o.rate = f()
        o.up = (f(), f(), f())
        o.since = f() if m() else None
        o.rows = list(take(F, n()))
        o.rhythm = read_7(t.rhythm, f, n, m, b, F, P)
        return o

f, n, m give the next float, int, flag, b so many bytes, F is the iterator behind f, P are an app's own classes. `t` is
the same record in a session that was just begun by the same recipe: settings are its own, and shared. Records that are
written whole need none.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from itertools import islice
from typing import Any

import attrs

from .codec import SnapshotError
from .shape import STATE_OF, Shape, Type

Reader = Callable[..., Any]
Own = dict[str, type]
"""Classes of an app's own, by their names."""
ARGUMENTS = "f, n, m, b, F, P"
FEW = 1 << 20
"""No list of records is longer: no state of ours comes near."""


def readers(shape: Shape, own: Callable[[str, Own], Reader]) -> dict[str, Reader]:
    """What builds each record of the shape. `own`: the reader of a record of an app's own, by what `writers` told of
    it."""
    space: dict[str, Any] = {
        "new": object.__new__, "put": object.__setattr__, "take": _take, "deque": deque, "some": some,
        "word": _word, "there": _there, "other": _other(own),
    }  # fmt: skip
    names = list(shape.classes)
    for name, cls in shape.classes.items():
        space[f"cls_{names.index(name)}"] = list(cls) if name in shape.enums else cls  # type: ignore[call-overload]
    source: list[str] = []
    tables: dict[tuple[str, ...], str] = {}
    for name, fields in shape.records.items():
        source += _record(shape, name, fields, names, tables)
    exec("\n".join(source), space)
    for kinds, table in tables.items():
        space[table] = {
            k: (shape.classes[name], space[f"read_{names.index(name)}"], name.startswith(STATE_OF))
            for k, name in enumerate(kinds)
        }
    return {name: space[f"read_{names.index(name)}"] for name in shape.records}


def _record(
    shape: Shape, name: str, fields: dict[str, Type], names: list[str], tables: dict[tuple[str, ...], str]
) -> list[str]:
    cls, number = shape.classes[name], names.index(name)
    setter: Any = cls.__setattr__
    plain = setter is object.__setattr__
    lines = [f"def read_{number}(t, {ARGUMENTS}):", f"    o = new(cls_{number})"]

    def put(field: str, value: str) -> None:
        lines.append(f"    o.{field} = {value}" if plain else f"    put(o, {field!r}, {value})")

    for field in attrs.fields(cls):
        if field.name not in fields:
            put(field.name, f"t.{field.name}")
    for field_name, kind in fields.items():
        put(field_name, _value(kind, f"t.{field_name}", names, tables))
    return [*lines, "    return o"]


def _value(kind: Type, t: str, names: list[str], tables: dict[tuple[str, ...], str]) -> str:
    """The expression that reads it. `t`: what the begun session has in its place, if it was made with its holder."""
    if isinstance(kind, str):
        return {"float": "f()", "int": "n()", "bool": "m()", "bytes": "b(n())", "str": "b(n()).decode()"}[kind]
    (how, of) = next(iter(kind.items()))
    if how == "enum":
        return f"word(cls_{names.index(of)}, n())"
    if how == "record":
        is_made = of.startswith(STATE_OF)
        return f"read_{names.index(of)}({t if is_made else 'None'}, {ARGUMENTS})"
    if how == "one of":
        table = tables.setdefault(tuple(of), f"kinds_{len(tables)}")
        is_made = of[0].startswith(STATE_OF)
        return f"other({t if is_made else 'None'}, {table}, {kind['open']}, {ARGUMENTS})"
    if how == "maybe":
        is_there = f"there(m(), {t})" if _record_of(of).startswith(STATE_OF) else "m()"
        return f"({_value(of, t, names, tables)} if {is_there} else None)"
    if how == "tuple":
        return "(" + "".join([_value(item, t, names, tables) + ", " for item in of]) + ")"
    if how == "dict":
        key, item = of
        inner = _value(item, f"{t}[k]", names, tables)
        return f"{{(k := {_value(key, t, names, tables)}): {inner} for _ in some(n())}}"
    most = "(n() if m() else None)" if how == "deque" else ""
    item = "take(F, n())" if of == "float" else f"[{_value(of, t, names, tables)} for _ in some(n())]"
    if how == "deque":
        return f"deque(maxlen={most}, iterable={item})"
    return f"tuple({item})" if how == "row" else item


def _record_of(kind: Type) -> str:
    return kind.get("record", "") if isinstance(kind, dict) else ""


def _there(is_there: bool, t: Any) -> bool:
    if is_there is (t is None):
        raise SnapshotError("packed with a part that this recipe does not have, or without one that it has")
    return is_there


def _take(floats: Iterator[float], count: int) -> list[float]:
    taken = list(islice(floats, count))
    if len(taken) != count:
        raise SnapshotError("it was cut short")
    return taken


def some(count: int) -> range:
    """As many times, if a list can be that long."""
    if not 0 <= count <= FEW:
        raise SnapshotError(f"a list of {count}")
    return range(count)


def _word(words: list[Any], k: int) -> Any:
    if k < 0:
        raise SnapshotError("a word that is none")
    return words[k]


def _other(own: Callable[[str, Own], Reader]) -> Callable[..., Any]:
    def read(t: Any, table: dict[int, Any], is_open: bool, f: Any, n: Any, m: Any, b: Any, F: Any, P: Own) -> Any:
        """A record of a union, by its kind; it must be of the class that the recipe has there."""
        k = n()
        if is_open and k == len(table):
            found = own(b(n()).decode(), P)(None, f, n, m, b, F, P)
            if t is not None and type(t) is not type(found):
                raise SnapshotError(f"packed with {type(found).__name__}, and this recipe has {type(t).__name__}")
            return found
        cls, read_it, is_made = table[k]
        if is_made and type(t) is not cls:
            raise SnapshotError(f"packed with {cls.__name__}, and this recipe has {type(t).__name__}")
        return read_it(t, f, n, m, b, F, P)

    return read
