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
from .nodes import OpenNode, RecordNode
from .schema import describe, record_in, schema_checksum

Lists = tuple[list[float], list[int], list[bool], list[bytes]]
FEW = 1 << 20
"""Largest length of a list of records; no state comes near it."""


class Streams:
    """Floats, ints, flags and bytes in the order in which they are read."""

    def __init__(self, floats: list[float], ints: list[int], flags: list[bool], data: bytes) -> None:
        self.floats, self.ints, self.flags = iter(floats), iter(ints), iter(flags)
        self.data, self.at = data, 0

    def take(self, count: int) -> bytes:
        """Return the next `count` bytes."""
        taken = self.data[self.at : self.at + count] if count >= 0 else b""
        if len(taken) != count:
            raise SnapshotError("it was cut short")
        self.at += count
        return taken

    def end(self) -> None:
        """Raise SnapshotError unless everything was read."""
        if [*islice(self.floats, 1), *islice(self.ints, 1), *islice(self.flags, 1)] or self.at != len(self.data):
            raise SnapshotError("more is packed than a session holds")


def write(record: RecordNode, value: Any, lists: Lists) -> None:
    """Append the values of a record; raise TypeError, ValueError and the like for values that it cannot hold."""
    _form(record).write(value, *lists)


def read(record: RecordNode, streams: Streams, classes: Classes, made: Any = None) -> Any:
    """Return the record that was written; `made` is the same record as its holder makes it, if it is made again."""
    s = streams
    next_of = [stream.__next__ for stream in (s.floats, s.ints, s.flags)]
    return _form(record).read(made, *next_of, s.take, s.floats, classes)


@frozen
class _Form:
    write: Callable[..., None]
    read: Callable[..., Any]


@lru_cache(maxsize=512)
def _form(record: RecordNode) -> _Form:
    """Return the functions of a record."""
    called: dict[str, Callable[..., Any]]
    called = {
        "all_of": _check_widths,
        "take": _take,
        "rows": _rows,
        "some": _check_count,
        "word": _get_word,
        "there": _check_presence,
        "each": _check_parts,
    }
    return _Form(*CodeGenerator(called, _Kinds).made(record))


class _Kinds:
    """Writes and reads open records: the kind, then the record.

    A class without a known name has the kind after the known ones, followed by its name and the checksum of its schema.
    """

    def __init__(self, node: OpenNode) -> None:
        self.node, self.names = node, list(node.known)
        self.kinds: dict[type, tuple[int, bytes, _Form]] = {}
        """Classes met so far, each with its number, its identity if it has no number, its writer and reader."""

    def _kind(self, cls: type) -> tuple[int, bytes, _Form]:
        known = self.kinds.get(cls)
        if known is None:
            record = record_in(self.node, cls)
            if cls.__name__ in self.names:
                known = self.names.index(cls.__name__), b"", _form(record)
            else:
                known = len(self.names), identify_record(record).encode(), _form(record)
            self.kinds[cls] = known
        return known

    def write(self, o: Any, F: Any, N: Any, M: Any, B: Any) -> None:
        cls = type(o)
        if cls not in self.kinds:
            check_open(self.node, cls)
        k, identity, form = self._kind(cls)
        N.append(k)
        if identity:
            N.append(len(identity))
            B.append(identity)
        form.write(o, F, N, M, B)

    def read(self, t: Any, f: Any, n: Any, m: Any, b: Any, F: Any, C: Classes) -> Any:
        """Return the record; one that is made again must be of the class that stands there."""
        k = n()
        identity = b(n()) if k == len(self.names) and self.node.others else b""
        name = identity.decode().partition(" ")[0] if identity else _get_word(self.names, k)
        if self.node.made and name != type(t).__name__:
            raise SnapshotError(f"packed with {name}, and this recipe has {type(t).__name__}")
        _, expected, form = self._kind(type(t) if self.node.made else class_in(self.node, name, C))
        if identity and identity != expected:
            raise SnapshotError(f"packed with a part {name!r} that had other fields")
        return form.read(t, f, n, m, b, F, C)


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
    taken = list(islice(floats, count))
    if len(taken) != count:
        raise SnapshotError("it was cut short")
    return taken


def _rows(floats: Iterator[float], count: int, width: int) -> list[tuple[float, ...]]:
    """Return `count` tuples of `width` floats."""
    return list(zip(*[iter(_take(floats, width * count))] * width, strict=True))


def _check_count(count: int) -> range:
    """Return a range of this length; raise SnapshotError if no list can be that long."""
    if not 0 <= count <= FEW:
        raise SnapshotError(f"a list of {count}")
    return range(count)


def _check_parts(count: int, made: Any) -> Iterable[Any]:
    """Return the parts in whose places the packed ones are read; raise SnapshotError if their number differs."""
    if count != len(made):
        raise SnapshotError(f"packed with {count} parts, and this recipe has {len(made)}")
    return made  # type: ignore[no-any-return]


def _get_word(words: list[Any], k: int) -> Any:
    if k < 0:
        raise SnapshotError("a word that is none")
    return words[k]
