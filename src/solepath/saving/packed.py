"""Packing and unpacking: records as four streams of floats, ints, flags and bytes (streams.py; protocol/snapshot.md).

The functions are generated from the schema of a record, once (generator.py)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from itertools import islice
from typing import Any

from ..types.attrs import frozen
from .codec import Classes, SnapshotError, check_open, class_in
from .generator import CodeGenerator
from .limits import MAX_VALUES, check_rows, shorten
from .nodes import OpenNode, RecordNode
from .schema import describe, record_in, schema_checksum

Lists = tuple[list[float], list[int], list[bool], list[bytes]]


class Streams:
    """Floats, ints, flags and bytes in the order in which they are read."""

    def __init__(self, floats: list[float], ints: list[int], flags: list[bool], data: bytes) -> None:
        self.floats, self.ints, self.flags = iter(floats), iter(ints), iter(flags)
        self.data, self.at = data, 0

    def take(self, count: int) -> bytes:
        """Return the next `count` bytes."""
        values = self.data[self.at : self.at + count] if count >= 0 else b""
        if len(values) != count:
            raise SnapshotError("it was cut short")
        self.at += count
        return values

    def end(self) -> None:
        """Raise SnapshotError unless all values were read."""
        if [*islice(self.floats, 1), *islice(self.ints, 1), *islice(self.flags, 1)] or self.at != len(self.data):
            raise SnapshotError("more is packed than a session holds")


def write(record: RecordNode, value: Any, lists: Lists) -> None:
    """Append the values of a record to `lists`; a value that does not fit raises, for example, TypeError."""
    _functions_of(record).write(value, *lists)


def read(record: RecordNode, streams: Streams, classes: Classes, made: Any = None) -> Any:
    """Return the record that was written; `made` is this record as its holder made it again, None if it did not."""
    s = streams
    next_of = [stream.__next__ for stream in (s.floats, s.ints, s.flags)]
    return _functions_of(record).read(made, *next_of, s.take, s.floats, classes)


@frozen
class _RecordFunctions:
    write: Callable[..., None]
    read: Callable[..., Any]


@lru_cache(maxsize=512)
def _functions_of(record: RecordNode) -> _RecordFunctions:
    functions: dict[str, Callable[..., Any]]
    functions = {
        "check_widths": _check_widths,
        "take": _take,
        "rows": _rows,
        "check_count": _check_count,
        "get_word": _get_word,
        "check_presence": _check_presence,
        "check_parts": _check_parts,
        "check_rows": check_rows,
    }
    return _RecordFunctions(*CodeGenerator(functions, _OpenRecordCodec).generate(record))


class _OpenRecordCodec:
    """Writes and reads open records: first the kind (an index in the known names), then the record.

    The kind of any other class is the number of known names; the name and the schema's checksum follow it."""

    def __init__(self, node: OpenNode) -> None:
        self.node, self.names = node, list(node.known)
        self.functions_of_class: dict[type, tuple[int, bytes, _RecordFunctions]] = {}
        """Kind, identity (empty for a known class) and functions of each class so far."""

    def _find_functions(self, cls: type) -> tuple[int, bytes, _RecordFunctions]:
        entry = self.functions_of_class.get(cls)
        if entry is None:
            record = record_in(self.node, cls)
            if cls.__name__ in self.names:
                entry = self.names.index(cls.__name__), b"", _functions_of(record)
            else:
                entry = len(self.names), identify_record(record).encode(), _functions_of(record)
            self.functions_of_class[cls] = entry
        return entry

    def write(self, o: Any, F: Any, N: Any, M: Any, B: Any) -> None:
        cls = type(o)
        if cls not in self.functions_of_class:
            check_open(self.node, cls)
        k, identity, functions = self._find_functions(cls)
        N.append(k)
        if identity:
            N.append(len(identity))
            B.append(identity)
        functions.write(o, F, N, M, B)

    def read(self, t: Any, f: Any, n: Any, m: Any, b: Any, F: Any, C: Classes) -> Any:
        """Return the record; a record that is made again must have the class of `t`."""
        k = n()
        identity = b(n()) if k == len(self.names) and self.node.others else b""
        name = identity.decode().partition(" ")[0] if identity else _get_word(self.names, k)
        if self.node.made and name != type(t).__name__:
            raise SnapshotError(f"packed with {name:.80}, and this recipe has {type(t).__name__}")
        _, expected, functions = self._find_functions(type(t) if self.node.made else class_in(self.node, name, C))
        if identity and identity != expected:
            raise SnapshotError(f"packed with a part {shorten(name)} that had other fields")
        return functions.read(t, f, n, m, b, F, C)


@lru_cache(maxsize=512)
def identify_record(record: RecordNode) -> str:
    """Return the identity of an open record: the name of its class and the checksum of its schema."""
    return f"{record.cls.__name__} {schema_checksum(describe(record)):08x}"


def _check_widths(rows: Any, width: int) -> Any:
    """Return the rows; raise ValueError unless each has `width` numbers."""
    if {*map(len, rows)} - {width}:
        raise ValueError(f"a row holds not {width} numbers")
    return rows


def _check_presence(is_there: bool, t: Any) -> bool:
    if is_there is (t is None):
        raise SnapshotError("packed with a part that this recipe does not have, or without one that it has")
    return is_there


def _take(floats: Iterator[float], count: int) -> list[float]:
    values = list(islice(floats, count))
    if len(values) != count:
        raise SnapshotError("it was cut short")
    return values


def _rows(floats: Iterator[float], count: int, width: int) -> list[tuple[float, ...]]:
    return list(zip(*[iter(_take(floats, width * count))] * width, strict=True))


def _check_count(count: int) -> range:
    """Return a range of this length; raise SnapshotError if no list can be that long."""
    if not 0 <= count <= MAX_VALUES:
        raise SnapshotError(f"a list of {count}")
    return range(count)


def _check_parts(count: int, made: Any) -> Iterable[Any]:
    """Return the parts that were made again; raise SnapshotError unless there are `count`, as in the packed state."""
    if count != len(made):
        raise SnapshotError(f"packed with {count} parts, and this recipe has {len(made)}")
    return made  # type: ignore[no-any-return]


def _get_word(words: list[Any], k: int) -> Any:
    if k < 0:
        raise SnapshotError("a word that is none")
    return words[k]
