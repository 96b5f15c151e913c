"""Counters, dicts with any keys, and generic records are saved as JSON and packed, and are what they were."""

from __future__ import annotations

from collections import Counter
from typing import Any, Generic, TypeVar

import pytest
from attrs import define, field

from solepath.saving.codec import SnapshotError, load, save
from solepath.types import Foot

T = TypeVar("T")


@define
class Items(Generic[T]):
    items: list[T] = field(factory=list)
    last: T | None = None


@define
class Words(Items[str]):
    count: int = 0


@define
class Kinds:
    feet: Counter[Foot]
    lengths: dict[int, float]
    reasons: Counter[tuple[str, str]]
    up: Counter[bool]
    words: Words
    pairs: Items[tuple[float, str | None]]
    numbers: Items[float]


KINDS = Kinds(
    Counter({Foot.LEFT: 3}),
    {2: 1.5, 1: 0.5},
    Counter({("a", "b"): 2}),
    Counter({True: 1}),
    Words(["one"], "one", 1),
    Items([(1.0, None), (2.0, "two")], (2.0, "two")),
    Items([1.0], None),
)


@pytest.mark.parametrize(
    "name, value",
    [
        ("lengths", {"1": 2.0}),
        ("lengths", [[1]]),
        ("lengths", [["1", 2.0]]),
        ("reasons", [[["a"], 1]]),
        ("up", [[1, 1]]),
        ("numbers", {"items": ["1"], "last": None}),
        ("words", {"items": [1.0], "last": None, "count": 0}),
    ],
)
def test_values_of_other_types_are_rejected(name: str, value: Any) -> None:
    saved: Any = save(KINDS)
    with pytest.raises(SnapshotError):
        load(Kinds, {**saved, name: value})
