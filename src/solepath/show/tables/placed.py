"""What became known of the place on a floor plan, in words."""

from __future__ import annotations

from attrs import define, field

from ...events import Event, Placed, PlaceLost, StrideTaken
from ...recording import printable
from .table import number

MOST = 20
"""No more level changes, and no more losses, are told one by one."""


@define
class PlaceCounts:
    """Counts over a whole recording. Level changes and losses are told with their time, s."""

    steps: int = 0
    """Of both feet, since the place was sought."""
    places: int = 0
    decided: int = 0
    """Of them, those with one candidate only."""
    found: tuple[int, float] | None = None
    """After how many steps there was one candidate only for the first time, and when."""
    levels: list[tuple[float, str]] = field(factory=list)
    """The level of the first such place, and every other one later."""
    lost: list[tuple[float, str]] = field(factory=list)
    last: Placed | None = None
    """The newest place; None where there is none."""

    def add(self, event: Event) -> None:
        match event:
            case StrideTaken(final=True):
                self.steps += 1
            case Placed():
                self.last = event
                self.places += 1
                if len(event.candidates) == 1:
                    self.decided += 1
                    if self.found is None:
                        self.found = (self.steps, event.t)
                    if not self.levels or self.levels[-1][1] != event.level:
                        self.levels.append((event.t, event.level))
            case PlaceLost():
                self.lost.append((event.t, event.what))
                self.last = None
            case _:
                pass

    def lines(self) -> list[str]:
        """A line for each thing that is to be said."""
        lines = []
        if self.found is not None:
            steps, t = self.found
            share = f"; one place for {self.decided} of {self.places} steps"
            lines.append(f"place: found after {steps} step{'s' * (steps != 1)}, at {number(t, 1)} s{share}")
        else:
            lines.append(f"place: not found; {self.places} steps with several candidates")
        if self.last is not None:
            x, y, _ = self.last.position
            at = f"({number(x, 1)}, {number(y, 1)}) m"
            several = len(self.last.candidates)
            doubt = f", one of {several} candidates" if several > 1 else f", within {number(self.last.spread, 1)} m"
            lines.append(f"at the end: level {printable(self.last.level)}, {at}{doubt}")
        if self.levels:
            first, *others = [f"{printable(name)} from {number(t, 1)} s" for t, name in self.levels]
            lines.append(f"levels: {', '.join([first, *others[:MOST]])}{_more(len(others))}")
        for t, what in self.lost[:MOST]:
            lines.append(f"from {number(t, 1)} s without a place: {printable(what)}")
        if len(self.lost) > MOST:
            lines.append(f"and {len(self.lost) - MOST} times more")
        return lines


def here(place: Placed) -> str:
    """Where the wearer is now, in a line."""
    x, y, _ = place.position
    several = len(place.candidates)
    at = f"place: level {printable(place.level)}, ({number(x, 1)}, {number(y, 1)}) m"
    if several == 1:
        return f"{at}, within {number(place.spread, 1)} m"
    return f"{at}, {100.0 * place.candidates[0].weight:.0f} % sure, one of {several} candidates"


def _more(count: int) -> str:
    return f" and {count - MOST} more" if count > MOST else ""
