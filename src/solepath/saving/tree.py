"""What is packed as a tree, and a tree as what is packed, by a shape alone: how states of older versions are read.

The tree is the one that `machine.save` gives, without what the shape leaves out (settings). No class is asked for, so
the classes may have changed since; it takes some fifty times as long as reading.py and writing.py.
"""

from __future__ import annotations

from base64 import b64decode, b64encode
from collections.abc import Callable
from itertools import islice
from typing import Any

from .codec import Json, SnapshotError
from .reading import some
from .shape import Shape, Type, kind_of

OwnShape = Callable[[str], tuple[str, Shape]]
"""The name or what was told of a record of an app's own -> what is told of it, and its shape."""


class Streams:
    """Floats, ints, flags and bytes in the order in which they are read."""

    def __init__(self, floats: list[float], ints: list[int], flags: list[bool], data: bytes) -> None:
        self.floats, self.ints, self.flags = iter(floats), iter(ints), iter(flags)
        self.f, self.n, self.m = self.floats.__next__, self.ints.__next__, self.flags.__next__
        self.data, self.at = data, 0

    def b(self, count: int) -> bytes:
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


def to_tree(shape: Shape, streams: Streams, own: OwnShape) -> Json:
    """The tree of the shape's root."""
    return _Grower(shape, streams, own).record(shape.root)


def from_tree(
    shape: Shape, tree: Any, own: OwnShape, strict: bool = True
) -> tuple[list[float], list[int], list[bool], list[bytes]]:
    """The streams that hold the tree. `strict`: it has no fields that the shape does not have. SnapshotError,
    TypeError, KeyError, ValueError or AttributeError where it has another shape."""
    cutter = _Cutter(shape, own, strict)
    cutter.record(shape.root, tree)
    return cutter.floats, cutter.ints, cutter.flags, cutter.data


class _Grower:
    def __init__(self, shape: Shape, streams: Streams, own: OwnShape) -> None:
        self.shape, self.streams, self.own = shape, streams, own

    def record(self, name: str) -> dict[str, Json]:
        return {field: self.value(kind) for field, kind in self.shape.records[name].items()}

    def value(self, kind: Type) -> Json:
        streams = self.streams
        if isinstance(kind, str):
            if kind in ("float", "int", "bool"):
                value: Json = {"float": streams.f, "int": streams.n, "bool": streams.m}[kind]()
                return value
            data = streams.b(streams.n())
            return data.decode() if kind == "str" else b64encode(data).decode()
        (how, of) = next(iter(kind.items()))
        if how == "enum":
            return dict(enumerate(self.shape.enums[of]))[streams.n()]
        if how == "record":
            return self.record(of)
        if how == "maybe":
            return self.value(of) if streams.m() else None
        if how == "tuple":
            return [self.value(item) for item in of]
        if how == "one of":
            return self.union(of, kind["open"])
        if how == "dict":
            return {str(self.value(of[0])): self.value(of[1]) for _ in some(streams.n())}
        most = streams.n() if how == "deque" and streams.m() else None
        items: list[Json] = [self.value(of) for _ in some(streams.n())]
        return items if most is None else {"maxlen": most, "is": items}

    def union(self, of: list[str], is_open: bool) -> Json:
        k = self.streams.n()
        if is_open and k == len(of):
            told, shape = self.own(self.streams.b(self.streams.n()).decode())
            return {"kind": told.partition(" ")[0], "is": to_tree(shape, self.streams, self.own)}
        name = dict(enumerate(of))[k]
        return {"kind": kind_of(name), "is": self.record(name)}


class _Cutter:
    def __init__(self, shape: Shape, own: OwnShape, strict: bool) -> None:
        self.shape, self.own, self.strict = shape, own, strict
        self.floats: list[float] = []
        self.ints: list[int] = []
        self.flags: list[bool] = []
        self.data: list[bytes] = []

    def record(self, name: str, tree: Any) -> None:
        fields = self.shape.records[name]
        if not isinstance(tree, dict) or not fields.keys() <= tree.keys() or self.strict and len(tree) > len(fields):
            raise SnapshotError(f"not a {kind_of(name)}: {tree!r:.80}")
        for field, kind in fields.items():
            try:
                self.value(kind, tree[field])
            except (TypeError, KeyError, ValueError) as error:
                if isinstance(error, SnapshotError):
                    raise
                raise SnapshotError(f"{kind_of(name)}.{field}: {error}") from error

    def value(self, kind: Type, tree: Any) -> None:
        if isinstance(kind, str):
            return self.scalar(kind, tree)
        (how, of) = next(iter(kind.items()))
        if how == "enum":
            self.ints.append(self.shape.enums[of].index(tree))
        elif how == "record":
            self.record(of, tree)
        elif how == "maybe":
            self.flags.append(tree is not None)
            if tree is not None:
                self.value(of, tree)
        elif how == "tuple":
            for item, held in zip(of, tree, strict=True):
                self.value(item, held)
        elif how == "one of":
            self.union(of, kind["open"], tree)
        elif how == "dict":
            self.ints.append(len(tree))
            for key, held in tree.items():
                self.value(of[0], key)
                self.value(of[1], held)
        else:
            self.row(how, of, tree)
        return None

    def scalar(self, kind: str, tree: Any) -> None:
        if kind == "float":
            self.floats.append(_of(float, float(tree) if type(tree) is int else tree))
        elif kind == "int":
            self.ints.append(_of(int, tree))
        elif kind == "bool":
            self.flags.append(_of(bool, tree))
        else:
            data = tree.encode() if kind == "str" else b64decode(tree, validate=True)
            self.ints.append(len(data))
            self.data.append(data)

    def row(self, how: str, of: Type, tree: Any) -> None:
        if how == "deque":
            has_most = isinstance(tree, dict)
            self.value({"maybe": "int"}, tree["maxlen"] if has_most else None)
            tree = tree["is"] if has_most else tree
        self.ints.append(len(_of(list, tree)))
        for item in tree:
            self.value(of, item)

    def union(self, of: list[str], is_open: bool, tree: Any) -> None:
        kinds = [kind_of(name) for name in of]
        if tree["kind"] in kinds:
            k = kinds.index(tree["kind"])
            self.ints.append(k)
            self.record(of[k], tree["is"])
            return
        if not is_open:
            raise SnapshotError(f"a {tree['kind']!r:.80} where {kinds} are known")
        told, shape = self.own(tree["kind"])
        self.ints += [len(of), len(told.encode())]
        self.data.append(told.encode())
        cutter = _Cutter(shape, self.own, self.strict)
        cutter.floats, cutter.ints, cutter.flags, cutter.data = self.floats, self.ints, self.flags, self.data
        cutter.record(shape.root, tree["is"])


def _of(kind: type, value: Any) -> Any:
    if type(value) is not kind:
        raise SnapshotError(f"expected a {kind.__name__}, found {value!r:.80}")
    return value
