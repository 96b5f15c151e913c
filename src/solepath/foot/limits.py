"""What one foot must do without: each is said once."""

from __future__ import annotations

from attrs import define, field

from ..events import Event, Limitation
from ..types import SITE_OF_FOOT, Foot

WITHOUT = 1.0
"""For this long samples may lack something before the foot is said to have none, s."""


@define
class Limits:
    """Sentences that were said, and that wait for a sample to be said with."""

    foot: Foot
    # state
    said: list[str] = field(factory=list, init=False)
    waiting: list[str] = field(factory=list, init=False)
    since: float | None = field(default=None, init=False)
    """Since when samples lack something, s."""

    def later(self, what: str | None) -> None:
        """To be said with the next sample; None is nothing."""
        if what is not None and what not in self.said and what not in self.waiting:
            self.waiting.append(what)

    def flush(self, t: float, known_at: float, events: list[Event]) -> None:
        """A sample came: say what waits."""
        for what in self.waiting:
            self.say(what, t, known_at, events)
        self.waiting = []

    def say(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """Now, unless it was said before."""
        if what not in self.said:
            self.said.append(what)
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], what=what))

    def lacks(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """This sample lacks something, as those before it did; it is said when that has lasted."""
        if self.since is None:
            self.since = t
        if t - self.since >= WITHOUT:
            self.say(what, t, known_at, events)
