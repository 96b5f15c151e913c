"""Deduplication for programs that consume events which an engine delivers at least once.

An engine that was killed continues from its last saved state and emits later events again, with the same identities
(wearer, number). An engine numbers a wearer's events without gaps, so for each wearer the next number and a few ranges
of missing numbers describe all received numbers."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from attrs import define, field

from ...saving.codec import Json, SnapshotError, load, save

ONCE_VERSION = 1
MAX_RANGES = 16
"""Largest number of missing ranges that are remembered for one wearer."""


@define
class _ReceivedNumbers:
    """The numbers received of one wearer: all below `end` except those in `missing`.

    `missing` holds ranges (low, high) of the numbers from `low` to `high` - 1, in rising order."""

    end: int = 0
    missing: list[tuple[int, int]] = field(factory=list)

    def accept(self, number: int) -> bool:
        if number == self.end:
            self.end += 1
            return True
        if number > self.end:
            self.missing = [*self.missing, (self.end, number)][-MAX_RANGES:]
            self.end = number + 1
            return True
        for index, (low, high) in enumerate(self.missing):
            if low <= number < high:
                remaining = [(low, number), (number + 1, high)]
                ranges = [*self.missing[:index], *[r for r in remaining if r[0] < r[1]], *self.missing[index + 1 :]]
                self.missing = ranges[-MAX_RANGES:]
                return True
        return False

    @property
    def is_consistent(self) -> bool:
        """True if the ranges rise, are not empty, do not touch, and end before `end`."""
        bounds = [bound for span in self.missing for bound in span]
        rising = all(low < high for low, high in pairwise([-1, *bounds, self.end]))
        return rising and len(self.missing) <= MAX_RANGES


@define
class Once:
    """The record of received identities; it detects repeated deliveries: `if once.accept(wearer, number): ...`.

    Numbers may come in any order; a missing number is accepted once when it comes. At most 16 missing ranges of one
    wearer are remembered; beyond that the lowest range counts as received. `limit` is the largest number of wearers
    that are remembered; beyond it the wearer that was silent longest is forgotten, and its repeated events are accepted
    again. Choose `limit` above the number of wearers who send between two snapshots of the engine: after a crash only
    their events come again. A wearer takes about 200 bytes.

    Save `snapshot()` together with the result of the events and with the offset in the stream, in one transaction or
    one file that is renamed. Use one Once for each partition; a process that takes over a partition restores its Once.
    A table with the primary key (wearer, number) rejects a repeated event itself and needs no Once."""

    limit: int = 100_000
    _received: dict[str, _ReceivedNumbers] = field(factory=dict, init=False)

    def __attrs_post_init__(self) -> None:
        if type(self.limit) is not int or self.limit < 1:
            raise ValueError(f"limit is a number of wearers, at least 1, not {self.limit!r}")

    def accept(self, wearer: str, number: int) -> bool:
        """Record an identity as received; return True at its first delivery and False at a repeated one.

        Raises TypeError or ValueError, and changes nothing, for an invalid identity."""
        if not isinstance(wearer, str) or type(number) is not int:
            raise TypeError("an identity is a wearer, a str, and a number, an int")
        if number < 0:
            raise ValueError(f"numbers count from 0, and this one is {number}")
        received = self._received.pop(wearer, None) or _ReceivedNumbers()
        self._received[wearer] = received  # at the end, as the most recent wearer
        if len(self._received) > self.limit:
            del self._received[next(iter(self._received))]
        return received.accept(number)

    @classmethod
    def after(cls, newest: Mapping[str, int], limit: int = 100_000) -> Once:
        """Return a Once that counts the number in `newest`, and all lower ones, of each wearer as received."""
        once = cls(limit)
        for wearer, number in newest.items():
            once.accept(wearer, number)
            once._received[wearer].missing = []
        return once

    def snapshot(self) -> dict[str, Json]:
        """Return the whole state as plain data for JSON."""
        return {"solepath.once": ONCE_VERSION, "state": save(self)}

    @classmethod
    def restore(cls, saved: Any) -> Once:
        """Return a Once that continues from the snapshot `saved`; raise SnapshotError for other data."""
        if not isinstance(saved, dict) or saved.get("solepath.once") != ONCE_VERSION or "state" not in saved:
            raise SnapshotError("not a snapshot of received events, of this version")
        once = load(cls, saved["state"])
        if once.limit < 1 or any(not received.is_consistent for received in once._received.values()):
            raise SnapshotError("a snapshot of events that cannot have been received")
        return once
