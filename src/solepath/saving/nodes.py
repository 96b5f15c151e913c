"""The kinds of values that a field may have, and how each is saved. A schema is a tree of these nodes (schema.py).

Each node has all forms of its values. `save` returns a value as JSON, and `load` checks and reads it. `write` appends a
value to streams of floats, ints, flags and bytes, and `read` takes it from them (protocol/snapshot.md has both forms).
A value that does not fit raises SnapshotError, or another exception that the callers turn into SnapshotError.

`read` gets `made`, the value as the holder of a part made it again, whose settings are taken from it, or None."""

from __future__ import annotations

from base64 import b64decode, b64encode
from binascii import crc32
from collections import deque
from collections.abc import Callable
from enum import Enum, EnumMeta
from functools import cache, cached_property
from itertools import islice, repeat
from math import isfinite
from typing import Any, TypeVar

from ..types.attrs import field, frozen
from ..types.checking import describe
from ..types.doubles import Doubles, doubles
from .limits import MAX_VALUES, Classes, Json, SnapshotError
from .streams import Lists, Streams


@frozen(eq=False)
class NumberNode:
    """A float, int or bool (`kind`)."""

    kind: type
    stream: int
    """Place in `Lists` and `Streams` of the stream that has such numbers."""

    def save(self, value: Any) -> Any:
        if self.kind is not float:
            return _exact(self.kind, value)
        number = float(value)
        if not isfinite(number):
            raise SnapshotError(f"{number}")
        return number

    def load(self, value: Any, classes: Classes) -> Any:
        return float(value) if self.kind is float and type(value) is int else _exact(self.kind, value)

    def write(self, value: Any, lists: Lists) -> None:
        lists[self.stream].append(value)

    def read(self, made: Any, streams: Streams) -> Any:
        return next(streams[self.stream])


@frozen(eq=False)
class DataNode:
    """A str or bytes (`kind`)."""

    kind: type
    row_size: int = 1
    """Size of the rows, in bytes, of which bytes hold a whole number."""

    def save(self, value: Any) -> Json:
        return b64encode(value).decode() if self.kind is bytes else _exact(str, value)

    def load(self, value: Any, classes: Classes) -> Any:
        text = _exact(str, value)
        return _whole_rows(b64decode(text, validate=True), self.row_size) if self.kind is bytes else text

    def write(self, value: Any, lists: Lists) -> None:
        data = value.encode() if self.kind is str else value
        lists.ints.append(len(data))
        lists.data.append(data)

    def read(self, made: Any, streams: Streams) -> Any:
        count = next(streams.ints)
        data = streams.data.read(count)
        if len(data) != count:
            raise SnapshotError("it was cut short")
        return data.decode() if self.kind is str else _whole_rows(data, self.row_size)


@frozen(eq=False)
class EnumNode:
    """A member of an enum."""

    cls: EnumMeta = field(repr=False)
    members: tuple[Enum, ...]

    def save(self, value: Any) -> Any:
        return value.value

    def load(self, value: Any, classes: Classes) -> Any:
        try:
            return self.cls(value)
        except (TypeError, ValueError):
            raise SnapshotError(f"{describe(value)} is no {self.cls.__name__}") from None

    def write(self, value: Any, lists: Lists) -> None:
        lists.ints.append(self.members.index(value))

    def read(self, made: Any, streams: Streams) -> Any:
        place = next(streams.ints)
        if place < 0:
            raise SnapshotError("no enum has a member with a negative number")
        return self.members[place]


@frozen(eq=False)
class MaybeNode:
    """None, or a value of the node `of`."""

    of: Node
    made: bool = False
    """True if the holder makes the value again, or None."""

    def save(self, value: Any) -> Json:
        return None if value is None else self.of.save(value)

    def load(self, value: Any, classes: Classes) -> Any:
        return None if value is None else self.of.load(value, classes)

    def write(self, value: Any, lists: Lists) -> None:
        lists.flags.append(value is not None)
        if value is not None:
            self.of.write(value, lists)

    def read(self, made: Any, streams: Streams) -> Any:
        exists = next(streams.flags)
        if self.made and exists is (made is None):
            raise SnapshotError("packed with a part that this recipe does not have, or without one that it has")
        return self.of.read(made, streams) if exists else None


_LIMIT = MaybeNode(NumberNode(int, 1))
"""Node of the maxlen of a deque."""


@frozen(eq=False)
class RowNode:
    """A tuple, list, deque or `Doubles` (`kind`) of any length, whose items have the node `of`.

    A deque with a maxlen, which annotations cannot declare, is an object with the keys "maxlen" and "is" as JSON."""

    kind: Any
    of: Node
    made: bool = False
    """True if the holder makes the items again."""
    row_size: int = field(default=1, repr=False)
    """Number of items in each row, of which `Doubles` hold a whole number."""

    def save(self, value: Any) -> Json:
        items = [self.of.save(item) for item in self._checked(value)]
        max_length = getattr(value, "maxlen", None)
        return items if max_length is None else {"maxlen": max_length, "is": items}

    def load(self, value: Any, classes: Classes) -> Any:
        max_length = None
        if self.kind is deque and isinstance(value, dict):
            max_length, value = _exact(int, value["maxlen"]), value["is"]
        return self._row([self.of.load(item, classes) for item in _exact(list, value)], max_length)

    def write(self, value: Any, lists: Lists) -> None:
        if self.kind is deque:
            _LIMIT.write(value.maxlen, lists)
        lists.ints.append(len(self._checked(value)))
        if isinstance(self.of, NumberNode):
            lists[self.of.stream].extend(value)
        else:
            for item in value:
                self.of.write(item, lists)

    def read(self, made: Any, streams: Streams) -> Any:
        max_length = _LIMIT.read(None, streams) if self.kind is deque else None
        count = _read_count(streams)
        if self.made and count != len(made):
            raise SnapshotError(f"packed with {count} parts, and this recipe has {len(made)}")
        if not isinstance(self.of, NumberNode):
            parts = made if self.made else repeat(None, count)
            return self._row([self.of.read(part, streams) for part in parts], max_length)
        numbers = list(islice(streams[self.of.stream], count))
        if len(numbers) != count:
            raise SnapshotError("it was cut short")
        return self._row(numbers, max_length)

    def _checked(self, value: Any) -> Any:
        """Return the value; raise TypeError for a list, or for an array whose values would change."""
        if self.kind is Doubles and getattr(value, "typecode", "") != "d":
            raise TypeError("the value is no Doubles: make it with solepath.types.doubles.doubles")
        return value

    def _row(self, items: list[Any], max_length: int | None) -> Any:
        if max_length is not None and max_length < len(items):
            raise SnapshotError("a deque does not have the length that it may have")
        if self.kind is Doubles:
            return doubles(_whole_rows(items, self.row_size))
        return self.kind(items) if max_length is None else deque(items, max_length)


_Values = TypeVar("_Values", bytes, list[Any])

Code = tuple[list[str], list[str], dict[str, Any]]
"""The lines of two generated functions, `write` and `read`, and the objects that they name."""


@frozen(eq=False)
class GeneratedNode:
    """A node of several values, with generated functions: a loop would take twice as long.

    def write(o, s):                                  def read(t, s):
        F, N, M, B = s                                    F, N, M, B, C = s
        F.append(o.rate)                                  o = new(cls)
        w1(o.sole, s)                                     o.rate = next(F)
                                                          o.sole = r1(t.sole, s)
                                                          return o
    """

    def _functions(self) -> Code:
        raise NotImplementedError

    @cached_property
    def _compiled(self) -> dict[str, Any]:
        write, read, names = self._functions()
        for lines in (["def write(o, s):", "F, N, M, B = s", *write], ["def read(t, s):", "F, N, M, B, C = s", *read]):
            exec("\n    ".join(lines), names)
        return names

    @cached_property
    def write(self) -> Any:
        return self._compiled["write"]

    @cached_property
    def read(self) -> Any:
        return self._compiled["read"]


def _code(node: Node, value: str, made: str, names: dict[str, Any]) -> tuple[str, str]:
    """Return the line that writes the expression `value`, and the expression that reads it."""
    if isinstance(node, NumberNode):
        stream = "FNM"[node.stream]
        return f"{stream}.append({value})", f"next({stream})"
    k = len(names)
    names[f"w{k}"], names[f"r{k}"] = node.write, node.read
    return f"w{k}({value}, s)", f"r{k}({made}, s)"


@frozen(eq=False)
class TupleNode(GeneratedNode):
    """A tuple with one node for each item; `make` makes it of a list: `tuple`, or `_make` of a NamedTuple."""

    items: tuple[Node, ...]
    make: Any = tuple

    def save(self, value: Any) -> Json:
        return [node.save(item) for node, item in zip(self.items, value, strict=True)]

    def load(self, value: Any, classes: Classes) -> Any:
        if len(_exact(list, value)) != len(self.items):
            raise SnapshotError(f"expected {len(self.items)} items, found {len(value)}")
        return self.make([node.load(item, classes) for node, item in zip(self.items, value, strict=True)])

    def _functions(self) -> Code:
        names: dict[str, Any] = {"make": self.make}
        code = [_code(node, f"x{k}", f"t and t[{k}]", names) for k, node in enumerate(self.items)]
        start = f"[{', '.join([f'x{k}' for k, _ in enumerate(code)])}] = o"
        made = f"({''.join([f'{one}, ' for _, one in code])})"
        returned = made if self.make is tuple else f"make({made})"
        return [start, *[line for line, _ in code]], [f"return {returned}"], names


@frozen(eq=False)
class DictNode:
    """A dict or Counter (`kind`); keys have the node `key`, values the node `of`.

    As JSON it is an object if the keys become strings, and a list of pairs otherwise."""

    kind: type
    key: Node
    of: Node
    has_text_keys: bool

    def save(self, value: Any) -> Json:
        pairs: Any = [[self.key.save(key), self.of.save(item)] for key, item in value.items()]
        return dict(pairs) if self.has_text_keys else pairs

    def load(self, value: Any, classes: Classes) -> Any:
        pairs = _exact(dict, value).items() if self.has_text_keys else _exact(list, value)
        return self.kind({self.key.load(key, classes): self.of.load(item, classes) for key, item in pairs})

    def write(self, value: Any, lists: Lists) -> None:
        lists.ints.append(len(value))
        for key, item in value.items():
            self.key.write(key, lists)
            self.of.write(item, lists)

    def read(self, made: Any, streams: Streams) -> Any:
        items = {}
        for _ in range(_read_count(streams)):
            key = self.key.read(None, streams)
            items[key] = self.of.read(made and made[key], streams)
        return self.kind(items)


@frozen(eq=False)
class OpenNode:
    """A record of one of the classes `known`; if there are none, of any class.

    The record is saved with the name of its class, and packed with the checksum of its schema too. Unless the class is
    known, the caller of `load` or `read` passes a function that returns it."""

    known: dict[str, type] = field(repr=" ".join)
    """Classes by name."""
    made: bool
    """True as in `RecordNode`; even then, a record without state is saved with all fields."""
    record_of: Callable[[type, bool], RecordNode] = field(repr=False)
    """Function that returns the schema of a record, or if True is passed and it has state, that of its state."""

    def record(self, cls: type) -> RecordNode:
        """Return the schema of a record of this class; raise TypeError when it may not be saved here."""
        if self.known and self.known.get(cls.__name__) is not cls:
            raise TypeError(f"a {cls.__name__} where {' or '.join(self.known)} is known")
        return self.record_of(cls, self.made)

    def _find(self, name: Any, classes: Classes) -> type:
        cls = self.known.get(name) if self.known else classes(_exact(str, name))
        if cls is None:
            raise SnapshotError(f"a snapshot of a part {describe(name)} that is not known here")
        return cls

    def save(self, value: Any) -> Json:
        return {"kind": type(value).__name__, "is": self.record(type(value)).save(value)}

    def load(self, value: Any, classes: Classes) -> Any:
        return self.record(self._find(value["kind"], classes)).load(value["is"], classes)

    def write(self, value: Any, lists: Lists) -> None:
        record = self.record(type(value))
        _TEXT.write(identify_record(record), lists)
        record.write(value, lists)

    def read(self, made: Any, streams: Streams) -> Any:
        identity = _TEXT.read(None, streams)
        name = identity.partition(" ")[0]
        if self.made and name != type(made).__name__:
            raise SnapshotError(f"packed with {name:.80}, and this recipe has {type(made).__name__}")
        record = self.record(type(made) if self.made else self._find(name, streams.classes))
        if identity != identify_record(record):
            raise SnapshotError(f"packed with a part {describe(name)} that had other fields")
        return record.read(made, streams)


@frozen(eq=False)
class LateNode:
    """A record of the class `name`, which is imported only when there is one."""

    name: str
    made: bool
    """True as in `RecordNode`."""
    record_of: Callable[[str, bool], RecordNode] = field(repr=False)
    """Function that imports the class and returns the schema of its records."""

    @cached_property
    def record(self) -> RecordNode:
        """The schema of the record."""
        return self.record_of(self.name, self.made)

    def __repr__(self) -> str:
        return repr(self.record)

    def save(self, value: Any) -> Json:
        return self.record.save(value)

    def load(self, value: Any, classes: Classes) -> Any:
        return self.record.load(value, classes)

    def write(self, value: Any, lists: Lists) -> None:
        self.record.write(value, lists)

    def read(self, made: Any, streams: Streams) -> Any:
        return self.record.read(made, streams)


_TEXT = DataNode(str)


@frozen(eq=False)
class RecordNode(GeneratedNode):
    """A record of one class."""

    cls: type = field(repr=lambda cls: cls.__name__)
    made: bool
    """True if the holder makes the record again with the same settings, so that `fields` has only the state."""
    fields: dict[str, Node]
    """Nodes of the saved fields, in the order of the class."""
    defaults: dict[str, Any] = field(repr=False)
    """Defaults of the fields that are not saved; unused for a record that is made again, which has its own values."""

    def save(self, record: Any) -> Json:
        saved: dict[str, Json] = {}
        for name, node in self.fields.items():
            try:
                saved[name] = node.save(getattr(record, name))
            except (TypeError, ValueError) as error:
                kind = TypeError if isinstance(error, TypeError) else SnapshotError
                raise kind(locate_error(error, self.cls, name)) from error
        return saved

    def load(self, value: Any, classes: Classes) -> Any:
        saved = _exact(dict, value)
        for name in saved | self.fields:
            if name not in saved or name not in self.fields:
                lacks = "no" if name in saved else "not the"
                raise SnapshotError(f"{self.cls.__name__} has {lacks} field {describe(name)}")
        loaded = {name: node.load(saved[name], classes) for name, node in self.fields.items()}
        new: Any = self.cls.__new__  # object's own makes no compiled classes
        record = new(self.cls)
        for name, item in (loaded | self.defaults).items():
            object.__setattr__(record, name, item)
        return record

    def _functions(self) -> Code:
        names: dict[str, Any] = {"new": self.cls.__new__, "cls": self.cls, "put": object.__setattr__}
        form = "put(o, {!r}, {})" if self.cls.__setattr__ is not names["put"] else "o.{} = {}"
        write, read = [], ["o = new(cls)"]
        for name, node in self.fields.items():
            line, value = _code(node, f"o.{name}", f"t.{name}" if self.made else "None", names)
            write.append(line)
            read.append(form.format(name, value))
        for name, default in self.defaults.items():
            names["d_" + name] = default
            read.append(form.format(name, f"t.{name}" if self.made else f"d_{name}"))
        return write, [*read, "return o"], names


Node = NumberNode | DataNode | EnumNode | MaybeNode | RowNode | TupleNode | DictNode | OpenNode | LateNode | RecordNode


def schema_check(*records: RecordNode) -> int:
    """Return a checksum of schemas, which is another one when a record has another name, or other fields."""
    return crc32(repr(records).encode())


@cache
def identify_record(record: RecordNode) -> str:
    """Return the identity of an open record: the name of its class and the checksum of its schema."""
    return f"{record.cls.__name__} {schema_check(record):08x}"


_CANNOT = "a snapshot cannot hold "


def locate_error(error: Exception, cls: type, name: str) -> str:
    """Return the error's text with class and field of the innermost record."""
    return str(error) if str(error).startswith(_CANNOT) else f"{_CANNOT}{cls.__name__}.{name}: {error}"


def _whole_rows(values: _Values, size: int) -> _Values:
    if len(values) % size:
        raise SnapshotError(f"{len(values)} values are no whole rows of {size}")
    return values


def _exact(kind: type, value: Any) -> Any:
    if type(value) is not kind:
        raise SnapshotError(f"expected {kind.__name__}, found {describe(value)}")
    return value


def _read_count(streams: Streams) -> int:
    """Return the number of items that follow; raise SnapshotError if no state has as many."""
    count = next(streams.ints)
    if not 0 <= count <= MAX_VALUES:
        raise SnapshotError(f"a list of {count}")
    return count
