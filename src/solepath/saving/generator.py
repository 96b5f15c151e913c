"""Generator of the code that packs and unpacks records of one schema.

A loop over fields would take eight times as long. The generated code is straight-line:

    def write(o, F, N, M, B):                          def read_0(t, f, n, m, b, F, C):
        x0, x1, x2 = o.up                                  o = new_0(cls_1)
        x3 = o.since                                       o.spread = t.spread
        F += (o.rate, x0, x1, x2)                          o.rate = f()
        if x3 is not None:                                 o.up = (f(), f(), f(), )
            F.append(x3)                                   o.since = f() if m() else None
        x4 = o.rows                                        o.rows = take(F, n())
        F += x4                                            o.corrector = kinds_1.read(t.corrector, f, n, m, b, F, C)
        N.append(len(x4))                                  return o
        M.append(x3 is not None)
        kinds_0.write(o.corrector, F, N, M, B)

F, N, M and B are the streams to which `write` appends: F floats; N ints, enums (index of the member), lengths and
kinds; M flags; B bytes. The functions f, n, m and b return the next value of each stream. `o` is the record. `t` is
this record as its holder made it again: fields outside the schema are copied from it by reference. C returns a class
by its name."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable
from typing import Any

from .nodes import DictNode, EnumNode, MaybeNode, Node, OpenNode, RecordNode, ScalarNode, SequenceNode, TupleNode
from .schema import is_frozen


class CodeGenerator:
    """Collects the lines of code that write a record and its inner records, and a function that reads each.

    `functions` has the functions that the generated code calls, by name. `open_codec` returns the object that writes
    and reads open records."""

    def __init__(self, functions: dict[str, Callable[..., Any]], open_codec: Callable[[OpenNode], Any]) -> None:
        self.namespace: dict[str, Any] = {
            "put": object.__setattr__, "deque": deque, "Counter": Counter, **functions
        }  # fmt: skip
        self.open_codec = open_codec
        self.source: list[str] = []
        self.lines: list[str] = []
        self.pending_numbers: dict[str, list[str]] = {"F": [], "N": [], "M": []}
        """Expressions of the numbers that the next line of each stream writes."""
        self.name_count = 0
        self.read_functions: dict[RecordNode, str] = {}

    def generate(self, record: RecordNode) -> tuple[Callable[..., None], Callable[..., Any]]:
        """Generate and return the functions that write and read the record."""
        self.write(record, "o")
        self.flush()
        self.source += ["def write(o, F, N, M, B):", *["    " + line for line in self.lines or ["pass"]]]
        read_function = self.add_read_function(record)
        exec("\n".join(self.source), self.namespace)
        return self.namespace["write"], self.namespace[read_function]

    def name_object(self, prefix: str, value: Any) -> str:
        """Return a new name by which the generated code refers to the object `value`."""
        name = f"{prefix}_{len(self.namespace)}"
        self.namespace[name] = value
        return name

    def new_name(self) -> str:
        """Return a variable name that the code does not use yet."""
        self.name_count += 1
        return f"x{self.name_count - 1}"

    def assign_name(self, value: str) -> str:
        """Return a variable that has the value of the expression `value`, with an assignment if needed."""
        if value.isidentifier():
            return value
        variable = self.new_name()
        self.lines.append(f"{variable} = {value}")
        return variable

    def flush(self, streams: str = "FNM") -> None:
        """Add lines that write the pending numbers of these streams."""
        for stream, parts in self.pending_numbers.items():
            if parts and stream in streams:
                joined = ", ".join(parts)
                self.lines.append(f"{stream}.append({joined})" if len(parts) == 1 else f"{stream} += ({joined})")
                parts.clear()

    def add_line(self, stream: str, line: str) -> None:
        """Add a line that writes to one stream, after its pending numbers."""
        self.flush(stream)
        self.lines.append(line)

    def add_block(self, opening: str, *written: tuple[Node, str]) -> None:
        """Add a block with the line `opening` that writes these values."""
        self.flush()
        outer, self.lines = self.lines, []
        for node, value in written:
            self.write(node, value)
        self.flush()
        outer += [opening, *["    " + line for line in self.lines or ["pass"]]]
        self.lines = outer

    def write(self, node: Node, value: str) -> None:
        """Add the lines that write the expression `value`."""
        match node:
            case ScalarNode(kind) if _stream(node):
                self.pending_numbers[_stream(node)].append(value)
            case ScalarNode(kind):
                variable = self.assign_name(value + ".encode()" if kind is str else value)
                self.pending_numbers["N"].append(f"len({variable})")
                self.add_line("B", f"B.append({variable})")
            case EnumNode(cls):
                indices = {member: k for k, member in enumerate(cls)}
                self.pending_numbers["N"].append(f"{self.name_object('indices', indices)}[{value}]")
            case MaybeNode(of):
                variable = self.assign_name(value)
                self.pending_numbers["M"].append(f"{variable} is not None")
                self.add_block(f"if {variable} is not None:", (of, variable))
            case TupleNode(items, _):
                names = [self.new_name() for _ in items]
                self.lines.append(f"[{', '.join(names)}] = {value}")
                for item, variable in zip(items, names, strict=True):
                    self.write(item, variable)
            case SequenceNode(kind, of):
                self.write_sequence(kind, of, self.assign_name(value))
            case DictNode(key, of):
                variable, k, v = self.assign_name(value), self.new_name(), self.new_name()
                self.pending_numbers["N"].append(f"len({variable})")
                self.add_block(f"for {k}, {v} in {variable}.items():", (key, k), (of, v))
            case OpenNode():
                self.flush()
                self.lines.append(f"{self.name_object('kinds', self.open_codec(node))}.write({value}, F, N, M, B)")
            case RecordNode(_, _, fields):
                variable = self.assign_name(value)
                for name, of in fields.items():
                    self.write(of, f"{variable}.{name}")

    def write_sequence(self, kind: type, of: Node, variable: str) -> None:
        """Write the code that saves a sequence of this kind in `variable`."""
        if kind is deque:
            self.write(MaybeNode(ScalarNode(int)), f"{variable}.maxlen")
        self.pending_numbers["N"].append(f"len({variable})")
        if _stream(of):
            self.add_line(_stream(of), f"{_stream(of)} += {variable}")
        elif isinstance(of, TupleNode) and {*map(_stream, of.items)} in ({"F"}, {"N"}):
            stream, item = _stream(of.items[0]), self.new_name()
            self.add_line(stream, f"for {item} in check_widths({variable}, {len(of.items)}): {stream} += {item}")
        else:
            item = self.new_name()
            self.add_block(f"for {item} in {variable}:", (of, item))

    def add_read_function(self, record: RecordNode) -> str:
        """Return the name of the function that reads the record, and add its code if needed."""
        if record in self.read_functions:
            return self.read_functions[record]
        function = self.read_functions[record] = f"read_{len(self.read_functions)}"
        new, cls = self.name_object("new", record.cls.__new__), self.name_object("cls", record.cls)
        form = "put(o, {!r}, {})" if is_frozen(record.cls) else "o.{} = {}"
        lines = [f"def {function}(t, f, n, m, b, F, C):", f"o = {new}({cls})"]
        for name, default in record.defaults.items():
            lines.append(form.format(name, f"t.{name}" if record.made else self.name_object("default", default)))
        lines += [form.format(name, self.read_expression(of, f"t.{name}")) for name, of in record.fields.items()]
        self.source += "\n    ".join([*lines, "return o"]).splitlines()
        return function

    def read_expression(self, node: Node, t: str) -> str:
        """Return the expression that reads a value; `t` is the expression of this value as its holder made it again."""
        match node:
            case ScalarNode(kind, row_size):
                if row_size > 1:
                    return f"check_rows(b(n()), {row_size})"
                return {float: "f()", int: "n()", bool: "m()", bytes: "b(n())", str: "b(n()).decode()"}[kind]
            case EnumNode(cls):
                return f"get_word({self.name_object('words', list(cls))}, n())"
            case MaybeNode(of):
                presence = f"check_presence(m(), {t})" if _is_made(of) else "m()"
                return f"({self.read_expression(of, t)} if {presence} else None)"
            case TupleNode(items, make):
                values = "".join([self.read_expression(item, f"{t}[{k}]") + ", " for k, item in enumerate(items)])
                return f"({values})" if make is tuple else f"{self.name_object('make', make)}(({values}))"
            case DictNode(key, of, kind):
                inner = self.read_expression(of, f"{t}[k]")
                pairs = f"{{(k := {self.read_expression(key, t)}): {inner} for _ in check_count(n())}}"
                return f"Counter({pairs})" if kind is Counter else pairs
            case SequenceNode(kind, of):
                most = "(n() if m() else None)" if kind is deque else ""
                each = f"check_parts(n(), {t})" if _is_made(of) else "check_count(n())"
                if _stream(of) == "F":
                    row = "take(F, n())"
                elif isinstance(of, TupleNode) and of.make is tuple and {*map(_stream, of.items)} == {"F"}:
                    row = f"rows(F, n(), {len(of.items)})"
                else:
                    row = f"[{self.read_expression(of, 'i')} for i in {each}]"
                if kind is deque:
                    return f"deque(maxlen={most}, iterable={row})"
                return f"tuple({row})" if kind is tuple else row
            case OpenNode():
                made = t if node.made else "None"
                return f"{self.name_object('kinds', self.open_codec(node))}.read({made}, f, n, m, b, F, C)"
            case RecordNode():
                return f"{self.add_read_function(node)}({t if node.made else 'None'}, f, n, m, b, F, C)"


def _stream(node: Node) -> str:
    """Return the stream of a number or flag; "" for any other value."""
    return {float: "F", int: "N", bool: "M"}.get(node.kind, "") if isinstance(node, ScalarNode) else ""


def _is_made(node: Node) -> bool:
    return _is_made(node.of) if isinstance(node, MaybeNode) else isinstance(node, RecordNode | OpenNode) and node.made
