"""Packing: straight-line code that appends what a record and those within it remember to four lists.

The code is made from the shape, once, and looks like this:

    def write(o, F, N, M, B):
        x0, x1, x2 = o.up
        x3 = o.since
        F += (o.rate, x0, x1, x2)
        if x3 is not None:
            F.append(x3)
        x4 = o.rows
        F += x4
        N.append(len(x4))
        M += (o.known, x3 is not None)
        other(o.corrector, kinds_3, False, F, N, M, B)

F takes floats, N ints, enums (where in their class), lengths and kinds, M flags, B bytes. A loop over fields would take
eight times as long.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import chain
from operator import attrgetter
from typing import Any

from .shape import Shape, Type, is_frozen

Writer = Callable[[Any, list[float], list[int], list[bool], list[bytes]], None]
ARGUMENTS = "F, N, M, B"
KEPT = 64
"""So many rows of records that never change are kept as numbers: a layout's cells are the same in all sessions."""


def writer(shape: Shape, own: Callable[[type], tuple[str, Writer]]) -> Writer:
    """What packs a record of the shape's root. `own`: what is told of a record of an app's own, and its writer."""
    space: dict[str, Any] = {"flat": _flat, "other": _other(own)}
    for name in shape.enums:
        words: Any = shape.classes[name]
        space[_function("place", shape, name)] = {word: k for k, word in enumerate(words)}
    source: list[str] = []
    tables: dict[tuple[str, ...], str] = {}
    for name in _still(shape):
        space[_function("numbers", shape, name)] = _numbers(tuple(shape.records[name]))
    called = [shape.root]
    for name in called:  # grows meanwhile
        code = _Code(shape, tables)
        code.record(name, "o")
        code.flush()
        source.append(f"def {_function('write', shape, name)}(o, {ARGUMENTS}):")
        source += ["    " + line for line in code.lines or ["pass"]]
        called += dict.fromkeys(other for kinds in (*tables, code.called) for other in kinds if other not in called)
    space |= {table: {} for table in tables.values()}
    exec("\n".join(source), space)
    for kinds, table in tables.items():
        functions = [space[_function("write", shape, name)] for name in kinds]
        space[table].update({shape.classes[name]: (k, functions[k]) for k, name in enumerate(kinds)})
    made: Writer = space[_function("write", shape, shape.root)]
    return made


def _function(what: str, shape: Shape, name: str) -> str:
    return f"{what}_{list(shape.classes).index(name)}"


def _flat(rows: Any, width: int) -> list[Any]:
    """The numbers of rows of so many."""
    numbers = list(chain.from_iterable(rows))
    if len(numbers) != width * len(rows):
        raise ValueError(f"a row holds not {width} numbers")
    return numbers


def _still(shape: Shape) -> list[str]:
    """Records that never change, all of floats: two at least."""
    fields = {name: list(shape.records[name].values()) for name in shape.records if is_frozen(shape.classes[name])}
    return [name for name, kinds in fields.items() if len(kinds) > 1 and kinds == ["float"] * len(kinds)]


def _numbers(fields: tuple[str, ...]) -> Callable[[Any], list[float]]:
    """Of a row of such records, one after the other. The newest are kept, by which object they are."""
    kept: dict[int, tuple[Any, list[float]]] = {}
    of_one = attrgetter(*fields)

    def numbers(row: Any) -> list[float]:
        known = kept.get(id(row))
        if known is not None and known[0] is row:
            return known[1]
        made = list(chain.from_iterable(map(of_one, row)))
        if type(row) is tuple and row:
            if len(kept) >= KEPT:
                kept.clear()
            kept[id(row)] = row, made
        return made

    return numbers


def _other(own: Callable[[type], tuple[str, Writer]]) -> Callable[..., None]:
    def write(o: Any, table: dict[type, Any], is_open: bool, F: Any, N: Any, M: Any, B: Any) -> None:
        """A record of a union, by its kind; one of an app's own is the kind after ours, and its name."""
        k, write_it = table.get(type(o), (len(table), None))
        N.append(k)
        if write_it is None:
            if not is_open:
                raise TypeError(f"a {type(o).__name__} where {[cls.__name__ for cls in table]} are known")
            name, write_it = own(type(o))
            told = name.encode()
            N.append(len(told))
            B.append(told)
        write_it(o, F, N, M, B)

    return write


class _Code:
    """Lines that write one record. Numbers are gathered into one line as far as that keeps their order."""

    def __init__(self, shape: Shape, tables: dict[tuple[str, ...], str]) -> None:
        self.shape, self.tables = shape, tables
        self.still = _still(shape)
        self.called: list[str] = []
        self.lines: list[str] = []
        self.pending: dict[str, list[str]] = {"F": [], "N": [], "M": []}
        self.used: set[str] = set()
        """The streams that the lines write to."""
        self.named = 0
        self.within: list[str] = []

    def name(self) -> str:
        self.named += 1
        return f"x{self.named - 1}"

    def flush(self, streams: Iterable[str] = "FNM") -> None:
        """Now, or they would come after what is written next."""
        for stream in streams:
            parts = self.pending.get(stream, [])
            if parts:
                joined = ", ".join(parts)
                self.lines.append(f"{stream}.append({joined})" if len(parts) == 1 else f"{stream} += ({joined})")
                parts.clear()
            self.used.add(stream)

    def put(self, stream: str, line: str) -> None:
        """A line that writes to a stream."""
        self.flush(stream)
        self.lines.append(line)

    def inner(self, opening: str, kind: Type, what: str) -> None:
        """A block that writes `what`: only what goes to the same streams must be written before."""
        outer = self.lines, self.pending, self.used
        self.lines, self.pending, self.used = [], {stream: [] for stream in outer[1]}, set()
        self.write(kind, what)
        self.flush([stream for stream, parts in self.pending.items() if parts])
        block, used = self.lines, self.used
        self.lines, self.pending, self.used = outer
        self.flush(sorted(used))
        self.lines += [opening, *["    " + line for line in block or ["pass"]]]

    def write(self, kind: Type, what: str) -> None:
        if isinstance(kind, str):
            return self.scalar(kind, what)
        (how, of) = next(iter(kind.items()))
        if how == "enum":
            self.pending["N"].append(f"{_function('place', self.shape, of)}[{what}]")
        elif how == "record":
            self.inlined(of, what)
        elif how == "one of":
            table = self.tables.setdefault(tuple(of), f"kinds_{len(self.tables)}")
            self.flush()
            self.lines.append(f"other({what}, {table}, {kind['open']}, {ARGUMENTS})")
        elif how == "maybe":
            held = self.held(what)
            self.pending["M"].append(f"{held} is not None")
            self.inner(f"if {held} is not None:", of, held)
        elif how == "tuple":
            names = [self.name() for _ in of]
            self.lines.append(f"{', '.join(names)}{',' * (len(of) == 1)} = {what}" if of else f"() = {what}")
            for item, held in zip(of, names, strict=True):
                self.write(item, held)
        elif how == "dict":
            held, key, value = self.held(what), self.name(), self.name()
            self.pending["N"].append(f"len({held})")
            self.inner(f"for {key}, {value} in {held}.items():", {"both": of}, f"{key}, {value}")
        elif how == "both":
            for item, held in zip(of, what.split(", "), strict=True):
                self.write(item, held)
        else:
            self.row(how, of, what)
        return None

    def held(self, what: str) -> str:
        """A name for it."""
        if what.isidentifier():
            return what
        held = self.name()
        self.lines.append(f"{held} = {what}")
        return held

    def inlined(self, name: str, what: str) -> None:
        """A record within another, in the same lines: calls would take a sixth of the time. Unless it holds itself."""
        if name in self.within:
            self.flush()
            self.called.append(name)
            self.lines.append(f"{_function('write', self.shape, name)}({what}, {ARGUMENTS})")
        else:
            self.record(name, self.held(what))

    def record(self, name: str, what: str) -> None:
        self.within.append(name)
        for field, kind in self.shape.records[name].items():
            self.write(kind, f"{what}.{field}")
        self.within.pop()

    def scalar(self, kind: str, what: str) -> None:
        stream = {"float": "F", "int": "N", "bool": "M"}.get(kind)
        if stream is not None:
            self.pending[stream].append(what)
            return
        held = self.held(what + (".encode()" if kind == "str" else ""))
        self.pending["N"].append(f"len({held})")
        self.put("B", f"B.append({held})")

    def row(self, how: str, of: Type, what: str) -> None:
        held = self.held(what)
        if how == "deque":
            self.write({"maybe": "int"}, f"{held}.maxlen")
        self.pending["N"].append(f"len({held})")
        stream = {"float": "F", "int": "N", "bool": "M"}.get(of) if isinstance(of, str) else None
        if stream is not None:
            self.put(stream, f"{stream} += {held}")
        elif isinstance(of, dict) and "tuple" in of and all([item == "float" for item in of["tuple"]]):
            self.put("F", f"F += flat({held}, {len(of['tuple'])})")
        elif isinstance(of, dict) and of.get("record") in self.still:
            self.put("F", f"F += {_function('numbers', self.shape, of['record'])}({held})")
        else:
            item = self.name()
            self.inner(f"for {item} in {held}:", of, item)
