"""Counts the wearer's places on a floor plan, the changes of level, and the losses of the place."""

from __future__ import annotations

from attrs import define, field

from ..events import Event, Placed, PlaceLost, StrideTaken

MAX_LISTED = 20
"""Largest number of level changes, and of losses, that are kept with their times; chosen by hand."""


@define
class PlaceCounts:
    """The counts of places over a whole recording; times are in s."""

    strides: int = 0
    """Number of final strides of both feet."""
    places: int = 0
    decided_count: int = 0
    """Number of decided places (Placed.decided)."""
    first_decided: tuple[int, float] | None = None
    """Number of strides before the first decided place, and its time, s."""
    level_starts: list[tuple[float, str]] = field(factory=list)
    """Time and level of the first place whose level is decided, and of the first MAX_LISTED changes of level."""
    level: str | None = None
    """Level of the last place whose level is decided (Placed.level_decided)."""
    level_changes: int = 0
    """Number of changes of `level`."""
    first_losses: list[tuple[float, str]] = field(factory=list)
    """Time and reason of the first MAX_LISTED losses."""
    loss_count: int = 0
    last: Placed | None = None
    """The newest place; None before the first one and after a loss."""

    def add(self, event: Event) -> None:
        """Count an event of the session, of any class."""
        match event:
            case StrideTaken(final=True):
                self.strides += 1
            case Placed():
                self.last = event
                self.places += 1
                if event.decided:
                    self.decided_count += 1
                    self.first_decided = self.first_decided or (self.strides, event.t)
                if event.level_decided and event.level != self.level:
                    self._start_level(event)
            case PlaceLost():
                self.loss_count += 1
                if len(self.first_losses) < MAX_LISTED:
                    self.first_losses.append((event.t, event.what))
                self.last = None
            case _:
                pass

    def _start_level(self, event: Placed) -> None:
        self.level_changes += self.level is not None
        self.level = event.level
        if len(self.level_starts) <= MAX_LISTED:
            self.level_starts.append((event.t, event.level))
