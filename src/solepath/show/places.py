"""Counts what became known of the wearer's place on a floor plan."""

from __future__ import annotations

from attrs import define, field

from ..events import Event, Placed, PlaceLost, StrideTaken

MOST_LISTED = 20
"""Level changes, and losses, that are kept one by one at the most."""


@define
class PlaceCounts:
    """Counts of places over a whole recording; level changes and losses have their time, s."""

    strides: int = 0
    """Number of final strides of both feet."""
    places: int = 0
    decided: int = 0
    """Number of places with one candidate only."""
    found: tuple[int, float] | None = None
    """Number of strides before the first place with one candidate only, and its time, s."""
    levels: list[tuple[float, str]] = field(factory=list)
    """Time and level of the first place with one candidate only, and of the first MOST_LISTED changes of level."""
    level: str | None = None
    """Level of the last place with one candidate only."""
    changes: int = 0
    """Number of changes of that level."""
    lost: list[tuple[float, str]] = field(factory=list)
    """Time and reason of the first MOST_LISTED losses."""
    losses: int = 0
    last: Placed | None = None
    """The newest place; None while there is none."""

    def add(self, event: Event) -> None:
        """Add any event of the session."""
        match event:
            case StrideTaken(final=True):
                self.strides += 1
            case Placed():
                self.last = event
                self.places += 1
                if len(event.candidates) == 1:
                    self._decided(event)
            case PlaceLost():
                self.losses += 1
                if len(self.lost) < MOST_LISTED:
                    self.lost.append((event.t, event.what))
                self.last = None
            case _:
                pass

    def _decided(self, event: Placed) -> None:
        self.decided += 1
        if self.found is None:
            self.found = (self.strides, event.t)
        if event.level != self.level:
            self.changes += self.level is not None
            self.level = event.level
            if len(self.levels) <= MOST_LISTED:
                self.levels.append((event.t, event.level))
