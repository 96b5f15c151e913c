"""Every event once, for whoever reads what an engine delivers at least once.

An engine that was killed goes on from what it had kept, and tells again what it told after that: the same events under
the same identities (wearer, number). A wearer's numbers have no holes, so what was heard is one number a wearer, and a
few ranges where something is still to come.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from attrs import define, field

from ...saving.codec import Json, SnapshotError, load, save

ONCE_VERSION = 1
RANGES = 16
"""Of one wearer, that may be missing at a time."""


@define
class _Heard:
    """What was heard of one wearer: all below `end`, but what is in `missing`, ranges [first, end) in rising order."""

    end: int = 0
    missing: list[tuple[int, int]] = field(factory=list)

    def first(self, number: int) -> bool:
        if number == self.end:
            self.end += 1
            return True
        if number > self.end:
            self.missing = [*self.missing, (self.end, number)][-RANGES:]
            self.end = number + 1
            return True
        for at, (first, end) in enumerate(self.missing):
            if first <= number < end:
                rest = [(first, number), (number + 1, end)]
                kept = [*self.missing[:at], *[part for part in rest if part[0] < part[1]], *self.missing[at + 1 :]]
                self.missing = kept[-RANGES:]
                return True
        return False

    @property
    def sound(self) -> bool:
        """Ranges that rise, hold something, do not touch, and end before `end`."""
        bounds = [bound for part in self.missing for bound in part]
        rising = all(low < high for low, high in pairwise([-1, *bounds, self.end]))
        return rising and len(self.missing) <= RANGES


@define
class Once:
    """Tells the first time that an identity is heard from every other time: `if once.first(wearer, number): ...`.

    Numbers may come in any order; what is missing is let through once when it comes. Of one wearer up to 16 ranges may
    be missing at a time, and of more the lowest is given up: it counts as heard. `limit`: of so many wearers it is
    known what was heard, and of more the one that was silent longest is forgotten, so that what is told of it again is
    let through; there should be room for all that speak between two commits of the engine. Some 200 bytes a wearer.

    It is a plain record: save `snapshot()` together with what was done with the events and with where the reader
    stands, in one transaction or one file that is renamed. One for each partition goes with that partition to whoever
    reads it next. A sink that refuses a second (wearer, number) by itself, as a table with that key, needs none.
    """

    limit: int = 100_000
    _heard: dict[str, _Heard] = field(factory=dict, init=False)

    def __attrs_post_init__(self) -> None:
        if type(self.limit) is not int or self.limit < 1:
            raise ValueError(f"limit is a number of wearers, at least 1, not {self.limit!r}")

    def first(self, wearer: str, number: int) -> bool:
        """Is this the first time? TypeError and ValueError for what is no identity; that changes nothing."""
        if not isinstance(wearer, str) or type(number) is not int:
            raise TypeError("an identity is a wearer, a str, and a number, an int")
        if number < 0:
            raise ValueError(f"numbers count from 0, and this one is {number}")
        heard = self._heard.pop(wearer, None) or _Heard()
        self._heard[wearer] = heard  # at the end: the one heard last
        if len(self._heard) > self.limit:
            del self._heard[next(iter(self._heard))]
        return heard.first(number)

    @classmethod
    def after(cls, newest: Mapping[str, int], limit: int = 100_000) -> Once:
        """One that has heard all up to `newest`, the highest number of each wearer, as a table of events can tell."""
        once = cls(limit)
        for wearer, number in newest.items():
            once.first(wearer, number)
            once._heard[wearer].missing = []
        return once

    def snapshot(self) -> dict[str, Json]:
        """All that it knows, as plain data for JSON."""
        return {"solepath.once": ONCE_VERSION, "state": save(self)}

    @classmethod
    def restore(cls, saved: Any) -> Once:
        """One that goes on where `saved` was taken; SnapshotError when that is no snapshot of this version."""
        if not isinstance(saved, dict) or saved.get("solepath.once") != ONCE_VERSION or "state" not in saved:
            raise SnapshotError("not a snapshot of what was heard, of this version")
        once = load(cls, saved["state"])
        if once.limit < 1 or any(not heard.sound for heard in once._heard.values()):
            raise SnapshotError("a snapshot of what cannot have been heard")
        return once
