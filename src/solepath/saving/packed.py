"""Packing and unpacking: records as four streams of floats, ints, flags and bytes (streams.py; protocol/snapshot.md).

Functions that do it are made from the schema of a record, once (generator.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from itertools import islice
from typing import Any

from ..types.attrs import frozen
from .codec import Classes, SnapshotError, check_open, class_in
from .generator import CodeGenerator
from .nodes import OpenNode, RecordNode
from .schema import check_of, described, record_in

Lists = tuple[list[float], list[int], list[bool], list[bytes]]
FEW = 1 << 20
"""No list of records is longer: no state of ours comes near."""


class Streams:
    """Floats, ints, flags and bytes in the order in which they are read."""

    def __init__(self, floats: list[float], ints: list[int], flags: list[bool], data: bytes) -> None:
        self.floats, self.ints, self.flags = iter(floats), iter(ints), iter(flags)
        self.data, self.at = data, 0

    def take(self, count: int) -> bytes:
        """So many bytes."""
        taken = self.data[self.at : self.at + count] if count >= 0 else b""
        if len(taken) != count:
            raise SnapshotError("it was cut short")
        self.at += count
        return taken

    def end(self) -> None:
        """All was read, or SnapshotError."""
        if [*islice(self.floats, 1), *islice(self.ints, 1), *islice(self.flags, 1)] or self.at != len(self.data):
            raise SnapshotError("more is packed than a session holds")


def write(record: RecordNode, value: Any, lists: Lists) -> None:
    """Appends what a record holds. TypeError, ValueError and the like for what it cannot hold."""
    _form(record).write(value, *lists)


def read(record: RecordNode, streams: Streams, classes: Classes, made: Any = None) -> Any:
    """The record that was written. `made`: the same record as its holder makes it, where it is made again."""
    s = streams
    next_of = [stream.__next__ for stream in (s.floats, s.ints, s.flags)]
    return _form(record).read(made, *next_of, s.take, s.floats, classes)


@frozen
class _Form:
    write: Callable[..., None]
    read: Callable[..., Any]


@lru_cache(maxsize=512)
def _form(record: RecordNode) -> _Form:
    """The functions of a record."""
    called: dict[str, Callable[..., Any]]
    called = {
        "all_of": _all_of,
        "take": _take,
        "rows": _rows,
        "some": _some,
        "word": _word,
        "there": _there,
        "each": _each,
    }
    return _Form(*CodeGenerator(called, _Kinds).made(record))


class _Kinds:
    """Writes and reads open records: the kind, then the record. What is not known by name is the kind after those that
    are, and its name and how it looks."""

    def __init__(self, node: OpenNode) -> None:
        self.node, self.names = node, list(node.known)
        self.kinds: dict[type, tuple[int, bytes, _Form]] = {}
        """Of each class met so far: its number, what stands for it where it has none, and its writer and reader."""

    def _kind(self, cls: type) -> tuple[int, bytes, _Form]:
        known = self.kinds.get(cls)
        if known is None:
            record = record_in(self.node, cls)
            if cls.__name__ in self.names:
                known = self.names.index(cls.__name__), b"", _form(record)
            else:
                known = len(self.names), told_of(record).encode(), _form(record)
            self.kinds[cls] = known
        return known

    def write(self, o: Any, F: Any, N: Any, M: Any, B: Any) -> None:
        cls = type(o)
        if cls not in self.kinds:
            check_open(self.node, cls)
        k, told, form = self._kind(cls)
        N.append(k)
        if told:
            N.append(len(told))
            B.append(told)
        form.write(o, F, N, M, B)

    def read(self, t: Any, f: Any, n: Any, m: Any, b: Any, F: Any, C: Classes) -> Any:
        """It must be of the class that stands there, where it is made again."""
        k = n()
        told = b(n()) if k == len(self.names) and self.node.others else b""
        name = told.decode().partition(" ")[0] if told else _word(self.names, k)
        if self.node.made and name != type(t).__name__:
            raise SnapshotError(f"packed with {name}, and this recipe has {type(t).__name__}")
        _, expected, form = self._kind(type(t) if self.node.made else class_in(self.node, name, C))
        if told and told != expected:
            raise SnapshotError(f"packed with a part {name!r} that had other fields")
        return form.read(t, f, n, m, b, F, C)


@lru_cache(maxsize=512)
def told_of(record: RecordNode) -> str:
    """What an open record is known by again: the name of its class, and how it looks."""
    return f"{record.cls.__name__} {check_of(described(record)):08x}"


def _all_of(rows: Any, width: int) -> Any:
    """The rows, of so many numbers each."""
    if {*map(len, rows)} - {width}:
        raise ValueError(f"a row holds not {width} numbers")
    return rows


def _there(is_there: bool, t: Any) -> bool:
    if is_there is (t is None):
        raise SnapshotError("packed with a part that this recipe does not have, or without one that it has")
    return is_there


def _take(floats: Iterator[float], count: int) -> list[float]:
    taken = list(islice(floats, count))
    if len(taken) != count:
        raise SnapshotError("it was cut short")
    return taken


def _rows(floats: Iterator[float], count: int, width: int) -> list[tuple[float, ...]]:
    """So many tuples of so many."""
    return list(zip(*[iter(_take(floats, width * count))] * width, strict=True))


def _some(count: int) -> range:
    """As many times, if a list can be that long."""
    if not 0 <= count <= FEW:
        raise SnapshotError(f"a list of {count}")
    return range(count)


def _each(count: int, made: Any) -> Iterable[Any]:
    """What stands in the place of each."""
    if count != len(made):
        raise SnapshotError(f"packed with {count} parts, and this recipe has {len(made)}")
    return made  # type: ignore[no-any-return]


def _word(words: list[Any], k: int) -> Any:
    if k < 0:
        raise SnapshotError("a word that is none")
    return words[k]
