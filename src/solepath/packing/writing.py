"""Packing: straight-line code that appends what a record and those within it remember to four lists.

The code is made from the shape, once, and looks like this:

    def write(o, F, N, M, B):
        x0, x1, x2 = o.up
        x3 = o.since
        F += (o.rate, x0, x1, x2)
        M += (o.known, x3 is not None)
        if x3 is not None:
            F += (x3,)
        N += (len(o.rows),)
        F += o.rows
        other(o.corrector, kinds_3, False, F, N, M, B)

F takes floats, N ints, enums (where in their class), lengths and kinds, M flags, B bytes. A loop over fields would take
six times as long.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain
from typing import Any

from .shape import Shape, Type

Writer = Callable[[Any, list[float], list[int], list[bool], list[bytes]], None]
ARGUMENTS = "F, N, M, B"


def writer(shape: Shape, own: Callable[[type], tuple[str, Writer]]) -> Writer:
    """What packs a record of the shape's root. `own`: what is told of a record of an app's own, and its writer."""
    space: dict[str, Any] = {"flat": _flat, "other": _other(own)}
    for name in shape.enums:
        words: Any = shape.classes[name]
        space[_function("place", shape, name)] = {word: k for k, word in enumerate(words)}
    source: list[str] = []
    tables: dict[tuple[str, ...], str] = {}
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
        self.called: list[str] = []
        self.lines: list[str] = []
        self.indent = ""
        self.pending: dict[str, list[str]] = {"F": [], "N": [], "M": []}
        self.named = 0
        self.within: list[str] = []

    def line(self, line: str) -> None:
        self.lines.append(self.indent + line)

    def name(self) -> str:
        self.named += 1
        return f"x{self.named - 1}"

    def flush(self) -> None:
        for stream, parts in self.pending.items():
            if parts:
                self.line(f"{stream} += ({', '.join(parts)},)")
                parts.clear()

    def inner(self, opening: str, kind: Type, what: str) -> None:
        """A block that writes `what`."""
        self.flush()
        self.line(opening)
        self.indent += "    "
        self.write(kind, what)
        self.flush()
        self.indent = self.indent[:-4]

    def write(self, kind: Type, what: str) -> None:
        if isinstance(kind, str):
            return self.scalar(kind, what)
        (how, of) = next(iter(kind.items()))
        if how == "enum":
            self.pending["N"].append(f"{_function('place', self.shape, of)}[{what}]")
        elif how == "record":
            self.held(of, what)
        elif how == "one of":
            table = self.tables.setdefault(tuple(of), f"kinds_{len(self.tables)}")
            self.flush()
            self.line(f"other({what}, {table}, {kind['open']}, {ARGUMENTS})")
        elif how == "maybe":
            held = self.name()
            self.line(f"{held} = {what}")
            self.pending["M"].append(f"{held} is not None")
            self.inner(f"if {held} is not None:", of, held)
        elif how == "tuple":
            names = [self.name() for _ in of]
            self.line(f"{', '.join(names)}{',' * (len(of) == 1)} = {what}" if of else f"() = {what}")
            for item, held in zip(of, names, strict=True):
                self.write(item, held)
        elif how == "dict":
            held, key = self.name(), self.name()
            self.line(f"{held} = {what}")
            self.pending["N"].append(f"len({held})")
            self.inner(f"for {key}, {held} in {held}.items():", {"tuple": of}, f"{key}, {held}")
        else:
            self.row(how, of, what)
        return None

    def held(self, name: str, what: str) -> None:
        """A record within another, in the same lines: calls would take a sixth of the time. Unless it holds itself."""
        if name in self.within:
            self.flush()
            self.called.append(name)
            self.line(f"{_function('write', self.shape, name)}({what}, {ARGUMENTS})")
            return
        held = self.name()
        self.line(f"{held} = {what}")
        self.record(name, held)

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
        held = self.name()
        self.line(f"{held} = {what}" + (".encode()" if kind == "str" else ""))
        self.pending["N"].append(f"len({held})")
        self.line(f"B.append({held})")

    def row(self, how: str, of: Type, what: str) -> None:
        held = self.name()
        self.line(f"{held} = {what}")
        if how == "deque":
            self.write({"maybe": "int"}, f"{held}.maxlen")
        self.pending["N"].append(f"len({held})")
        self.flush()
        if of in ("float", "int", "bool"):
            self.line(f"{ {'float': 'F', 'int': 'N', 'bool': 'M'}[of] } += {held}")
        elif isinstance(of, dict) and "tuple" in of and all([item == "float" for item in of["tuple"]]):
            self.line(f"F += flat({held}, {len(of['tuple'])})")
        else:
            item = self.name()
            self.inner(f"for {item} in {held}:", of, item)
