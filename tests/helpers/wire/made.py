"""Records of any class, with other values in all of their fields, from the schema of the class."""

from __future__ import annotations

from collections import deque
from itertools import count
from random import Random
from typing import Any

from solepath.recipes import part_class

# internal: the schema of a record, which lists its fields and what they hold
from solepath.saving.nodes import (
    DataNode,
    DictNode,
    EnumNode,
    LateNode,
    MaybeNode,
    NumberNode,
    OpenNode,
    RecordNode,
    RowNode,
    TupleNode,
)
from solepath.saving.schema import record_of
from solepath.types.doubles import Doubles, doubles
from solepath.types.registry import TABLE

NAMES = (*TABLE["part"], *TABLE["aid"], *TABLE["link"])
EXTREME = (-0.0, 5e-324, -1.7976931348623157e308, 2.0**53 + 2.0, 1e-17)
LARGE = (2**63, -(2**63) - 1, 2**63 - 1, -(2**63), -1, 0)


class Maker:
    """Makes records whose numbers and texts are all different; `shape` decides what is None and how long it is."""

    def __init__(self, shape: int, first: int = 0, extreme: float = 0.2) -> None:
        """`extreme` is the share of numbers that are very large, very small or minus zero."""
        self.shape, self.words, self.numbers, self.depth = Random(shape), Random(f"{shape} {first}"), count(first), 0
        self.extreme = extreme

    def of(self, cls: type) -> Any:
        """Return a record of this class."""
        return self.record(record_of(cls))

    def record(self, node: RecordNode) -> Any:
        made = node.cls.__new__(node.cls)
        self.depth += 1
        for name, of in node.fields.items():
            object.__setattr__(made, name, self.value(of))
        for name, default in node.defaults.items():
            object.__setattr__(made, name, default)
        self.depth -= 1
        return made

    def value(self, node: Any) -> Any:
        match node:
            case NumberNode(kind) | DataNode(kind):
                k = next(self.numbers)
                if kind is bool:
                    return self.words.random() < 0.5
                is_extreme = self.words.random() < self.extreme
                number = EXTREME[k % len(EXTREME)] if is_extreme else k + 0.1
                whole = LARGE[k % len(LARGE)] if is_extreme else -k
                return {float: number, int: whole, str: f"é {k}", bytes: (b"%d" % k) * getattr(node, "row_size", 1)}[
                    kind
                ]
            case EnumNode(cls):
                return self.words.choice([*cls])
            case MaybeNode(of):
                return self.value(of) if self.shape.random() < 0.6 else None
            case TupleNode(items, make):
                return make([self.value(item) for item in items])
            case RowNode(kind, of):
                items = [self.value(of) for _ in range(node.row_size * self.shape.randrange(3))]
                if kind is Doubles:
                    return doubles(items)
                return deque(items, self.shape.choice([None, 5])) if kind is deque else kind(items)
            case DictNode(kind, key, of):
                keys = [Maker(k + self.shape.randrange(9), 7 * k).value(key) for k in range(2)]
                return kind({key: self.value(of) for key in keys})
            case OpenNode(known):
                names = [*known] or (NAMES if self.depth < 9 else ("Cycle", "Turns"))
                name = self.shape.choice(names)
                return self.record(record_of(known.get(name) or part_class(name)))
            case LateNode():
                return self.record(node.record)
            case RecordNode():
                return self.record(node)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the path of each value within a JSON value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *[place for key, item in inner for place in places(item, (*path, key))]]


def replaced(value: Any, path: tuple[Any, ...], by: Any) -> Any:
    """Return a copy of a JSON value with another one at this path."""
    if not path:
        return by
    copy = value.copy()
    copy[path[0]] = replaced(value[path[0]], path[1:], by)
    return copy
