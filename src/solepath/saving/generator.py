"""Generator of the code that packs and unpacks records of one schema.

A loop over fields would take eight times as long. The generated code is straight-line:

    def write(o, F, N, M, B):                          def read_0(t, f, n, m, b, F, C):
        x0, x1, x2 = o.up                                  o = new(cls_0)
        x3 = o.since                                       o.spread = t.spread
        F += (o.rate, x0, x1, x2)                          o.rate = f()
        if x3 is not None:                                 o.up = (f(), f(), f(), )
            F.append(x3)                                   o.since = f() if m() else None
        x4 = o.rows                                        o.rows = take(F, n())
        F += x4                                            o.corrector = kinds_1.read(t.corrector, f, n, m, b, F, C)
        N.append(len(x4))                                  return o
        M.append(x3 is not None)
        kinds_0.write(o.corrector, F, N, M, B)

F takes floats, N ints, enums (the index in their class), lengths and kinds, M flags, B bytes; f, n, m, b return the
next of each. `t` is the same record made again: fields outside the schema are taken from it, and shared. C looks
classes up."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from .nodes import DictNode, EnumNode, MaybeNode, Node, OpenNode, RecordNode, RowNode, ScalarNode, TupleNode
from .schema import is_frozen


class CodeGenerator:
    """Collects the lines that write a record and those within it, and a function for each that reads it.

    `called` holds the functions that they call, by name. `kinds` makes the object that writes and reads open records.
    """

    def __init__(self, called: dict[str, Callable[..., Any]], kinds: Callable[[OpenNode], Any]) -> None:
        self.space: dict[str, Any] = {
            "new": object.__new__, "put": object.__setattr__, "deque": deque, **called
        }  # fmt: skip
        self.kinds = kinds
        self.source: list[str] = []
        self.lines: list[str] = []
        self.pending: dict[str, list[str]] = {"F": [], "N": [], "M": []}
        """Numbers that the next line of their stream writes."""
        self.named = 0
        self.readers: dict[RecordNode, str] = {}

    def made(self, record: RecordNode) -> tuple[Callable[..., None], Callable[..., Any]]:
        """Return the functions that write and read the record."""
        self.write(record, "o")
        self.flush()
        self.source += ["def write(o, F, N, M, B):", *["    " + line for line in self.lines or ["pass"]]]
        reader = self.reader(record)
        exec("\n".join(self.source), self.space)
        return self.space["write"], self.space[reader]

    def named_value(self, what: str, value: Any) -> str:
        """Return a name of the generated code for an object."""
        name = f"{what}_{len(self.space)}"
        self.space[name] = value
        return name

    def name(self) -> str:
        self.named += 1
        return f"x{self.named - 1}"

    def held(self, what: str) -> str:
        """Return a name for the value of an expression, assigning it if needed."""
        if what.isidentifier():
            return what
        held = self.name()
        self.lines.append(f"{held} = {what}")
        return held

    def flush(self, streams: str = "FNM") -> None:
        """Write the pending numbers now, before later ones of their stream."""
        for stream, parts in self.pending.items():
            if parts and stream in streams:
                joined = ", ".join(parts)
                self.lines.append(f"{stream}.append({joined})" if len(parts) == 1 else f"{stream} += ({joined})")
                parts.clear()

    def put(self, stream: str, line: str) -> None:
        """Add a line that writes to one stream."""
        self.flush(stream)
        self.lines.append(line)

    def block(self, opening: str, *written: tuple[Node, str]) -> None:
        """Add a block that writes these values."""
        self.flush()
        outer, self.lines = self.lines, []
        for node, what in written:
            self.write(node, what)
        self.flush()
        outer += [opening, *["    " + line for line in self.lines or ["pass"]]]
        self.lines = outer

    def write(self, node: Node, what: str) -> None:
        """Add the lines that write a value."""
        match node:
            case ScalarNode(kind) if _stream(node):
                self.pending[_stream(node)].append(what)
            case ScalarNode(kind):
                held = self.held(what + ".encode()" if kind is str else what)
                self.pending["N"].append(f"len({held})")
                self.put("B", f"B.append({held})")
            case EnumNode(cls):
                places = {member: k for k, member in enumerate(cls)}
                self.pending["N"].append(f"{self.named_value('places', places)}[{what}]")
            case MaybeNode(of):
                held = self.held(what)
                self.pending["M"].append(f"{held} is not None")
                self.block(f"if {held} is not None:", (of, held))
            case TupleNode(items):
                names = [self.name() for _ in items]
                self.lines.append(f"[{', '.join(names)}] = {what}")
                for item, held in zip(items, names, strict=True):
                    self.write(item, held)
            case RowNode(kind, of):
                self.row(kind, of, self.held(what))
            case DictNode(key, of):
                held, k, v = self.held(what), self.name(), self.name()
                self.pending["N"].append(f"len({held})")
                self.block(f"for {k}, {v} in {held}.items():", (key, k), (of, v))
            case OpenNode():
                self.flush()
                self.lines.append(f"{self.named_value('kinds', self.kinds(node))}.write({what}, F, N, M, B)")
            case RecordNode(_, _, fields):
                held = self.held(what)
                for name, of in fields.items():
                    self.write(of, f"{held}.{name}")

    def row(self, kind: type, of: Node, held: str) -> None:
        if kind is deque:
            self.write(MaybeNode(ScalarNode(int)), f"{held}.maxlen")
        self.pending["N"].append(f"len({held})")
        if _stream(of):
            self.put(_stream(of), f"{_stream(of)} += {held}")
        elif isinstance(of, TupleNode) and {*map(_stream, of.items)} in ({"F"}, {"N"}):
            stream, item = _stream(of.items[0]), self.name()
            self.put(stream, f"for {item} in all_of({held}, {len(of.items)}): {stream} += {item}")
        else:
            item = self.name()
            self.block(f"for {item} in {held}:", (of, item))

    def reader(self, record: RecordNode) -> str:
        """Return the name of the function that reads the record."""
        if record in self.readers:
            return self.readers[record]
        function = self.readers[record] = f"read_{len(self.readers)}"
        form = "put(o, {!r}, {})" if is_frozen(record.cls) else "o.{} = {}"
        lines = [f"def {function}(t, f, n, m, b, F, C):", f"o = new({self.named_value('cls', record.cls)})"]
        for name, default in record.defaults.items():
            lines.append(form.format(name, f"t.{name}" if record.made else self.named_value("default", default)))
        lines += [form.format(name, self.expression(of, f"t.{name}")) for name, of in record.fields.items()]
        self.source += "\n    ".join([*lines, "return o"]).splitlines()
        return function

    def expression(self, node: Node, t: str) -> str:
        """Return the expression that reads a value; `t` stands in its place if it is made again."""
        match node:
            case ScalarNode(kind):
                return {float: "f()", int: "n()", bool: "m()", bytes: "b(n())", str: "b(n()).decode()"}[kind]
            case EnumNode(cls):
                return f"word({self.named_value('words', list(cls))}, n())"
            case MaybeNode(of):
                is_there = f"there(m(), {t})" if _is_made(of) else "m()"
                return f"({self.expression(of, t)} if {is_there} else None)"
            case TupleNode(items):
                return "(" + "".join([self.expression(item, f"{t}[{k}]") + ", " for k, item in enumerate(items)]) + ")"
            case DictNode(key, of):
                inner = self.expression(of, f"{t}[k]")
                return f"{{(k := {self.expression(key, t)}): {inner} for _ in some(n())}}"
            case RowNode(kind, of):
                most = "(n() if m() else None)" if kind is deque else ""
                each = f"each(n(), {t})" if _is_made(of) else "some(n())"
                if _stream(of) == "F":
                    row = "take(F, n())"
                elif isinstance(of, TupleNode) and {*map(_stream, of.items)} == {"F"}:
                    row = f"rows(F, n(), {len(of.items)})"
                else:
                    row = f"[{self.expression(of, 'i')} for i in {each}]"
                if kind is deque:
                    return f"deque(maxlen={most}, iterable={row})"
                return f"tuple({row})" if kind is tuple else row
            case OpenNode():
                made = t if node.made else "None"
                return f"{self.named_value('kinds', self.kinds(node))}.read({made}, f, n, m, b, F, C)"
            case RecordNode():
                return f"{self.reader(node)}({t if node.made else 'None'}, f, n, m, b, F, C)"


def _stream(node: Node) -> str:
    """Return the stream of a number; "" for anything else."""
    return {float: "F", int: "N", bool: "M"}.get(node.kind, "") if isinstance(node, ScalarNode) else ""


def _is_made(node: Node) -> bool:
    return _is_made(node.of) if isinstance(node, MaybeNode) else isinstance(node, RecordNode | OpenNode) and node.made
