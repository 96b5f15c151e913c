"""What became known of the place on a floor plan, counted."""

from __future__ import annotations

from attrs import define, field

from ..events import Event, Placed, PlaceLost, StrideTaken

MOST_LISTED = 20
"""No more level changes, and no more losses, are kept one by one."""


@define
class PlaceCounts:
    """Counts over a whole recording. Level changes and losses have their time, s."""

    strides: int = 0
    """Of both feet."""
    places: int = 0
    decided: int = 0
    """Of them, those with one candidate only."""
    found: tuple[int, float] | None = None
    """After how many strides there was one candidate only for the first time, and when."""
    levels: list[tuple[float, str]] = field(factory=list)
    """The level of the first such place, and the first MOST others later."""
    level: str | None = None
    """The level of the last such place."""
    changes: int = 0
    """How often that was another one than before."""
    lost: list[tuple[float, str]] = field(factory=list)
    """Of the first MOST losses, when and why."""
    losses: int = 0
    last: Placed | None = None
    """The newest place; None where there is none."""

    def add(self, event: Event) -> None:
        """Any event."""
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
