"""Deduplication for readers of what an engine delivers at least once.

An engine that was killed goes on from its last kept state and emits again what it emitted after that: the same events
under the same identities (wearer, number). A wearer's numbers have no holes, so the received ones are described by one
number for each wearer, and a few ranges that are still missing."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from attrs import define, field

from ...saving.codec import Json, SnapshotError, load, save

ONCE_VERSION = 1
RANGES = 16
"""Largest number of ranges of one wearer that may be missing at a time."""


@define
class _ReceivedNumbers:
    """Numbers received of one wearer: all below `end` except those in `missing`.

    `missing` holds ranges [first, end) in rising order."""

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
    def is_consistent(self) -> bool:
        """True if the ranges rise, are not empty, do not touch, and end before `end`."""
        bounds = [bound for part in self.missing for bound in part]
        rising = all(low < high for low, high in pairwise([-1, *bounds, self.end]))
        return rising and len(self.missing) <= RANGES


@define
class Once:
    """Distinguishes the first delivery of an identity from every later one: `if once.first(wearer, number): ...`.

    Numbers may come in any order; a missing one is accepted once when it comes. Up to 16 ranges of one wearer may be
    missing at a time; of more the lowest is given up and counts as received. `limit` is the number of wearers whose
    numbers are remembered; of more, the one that was silent longest is forgotten, so that its repeated events are
    accepted again. There should be room for all that send between two commits of the engine. Takes about 200 bytes for
    each wearer.

    It is a plain record: save `snapshot()` together with the result of the events and with the reader's position, in
    one transaction or one file that is renamed. Use one for each partition, which goes with that partition to its next
    reader. A sink that itself rejects a second (wearer, number), as a table with that key does, needs none."""

    limit: int = 100_000
    _received: dict[str, _ReceivedNumbers] = field(factory=dict, init=False)

    def __attrs_post_init__(self) -> None:
        if type(self.limit) is not int or self.limit < 1:
            raise ValueError(f"limit is a number of wearers, at least 1, not {self.limit!r}")

    def first(self, wearer: str, number: int) -> bool:
        """Return whether this is the first delivery of the identity.

        Raises TypeError or ValueError, and changes nothing, for an invalid identity."""
        if not isinstance(wearer, str) or type(number) is not int:
            raise TypeError("an identity is a wearer, a str, and a number, an int")
        if number < 0:
            raise ValueError(f"numbers count from 0, and this one is {number}")
        received = self._received.pop(wearer, None) or _ReceivedNumbers()
        self._received[wearer] = received  # at the end: the most recent one
        if len(self._received) > self.limit:
            del self._received[next(iter(self._received))]
        return received.first(number)

    @classmethod
    def after(cls, newest: Mapping[str, int], limit: int = 100_000) -> Once:
        """Return one that has received all up to `newest`, each wearer's highest number, as from a table of events."""
        once = cls(limit)
        for wearer, number in newest.items():
            once.first(wearer, number)
            once._received[wearer].missing = []
        return once

    def snapshot(self) -> dict[str, Json]:
        """Return its whole state as plain data for JSON."""
        return {"solepath.once": ONCE_VERSION, "state": save(self)}

    @classmethod
    def restore(cls, saved: Any) -> Once:
        """Return one that continues from `saved`; raise SnapshotError for no snapshot of this version."""
        if not isinstance(saved, dict) or saved.get("solepath.once") != ONCE_VERSION or "state" not in saved:
            raise SnapshotError("not a snapshot of received events, of this version")
        once = load(cls, saved["state"])
        if once.limit < 1 or any(not received.is_consistent for received in once._received.values()):
            raise SnapshotError("a snapshot of events that cannot have been received")
        return once
