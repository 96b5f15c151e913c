"""Events of both feet in, every stride measured as clinicians do out, and running means of the steady ones.

Latency: as GaitCycleMeasured has it. Costs nothing on a sample of which no event came.
"""

from __future__ import annotations

from collections.abc import Mapping

from attrs import define, field

from ...events import Event, FootFlat, HeelOff, HeelStrike, SampleGap, StrideTaken, ToeOff
from ...foot.tracker import FootTracker
from ...types import SITE_OF_FOOT, Foot, Site
from .footfalls import Footfalls
from .means import GaitMeans, GaitParameters
from .measuring import OTHER, measured

PATIENCE = 0.5
"""For so long the other foot's samples are waited for, s."""


@define
class Strides:
    """Events of both feet in, GaitCycleMeasured out; what it adds up is in `means`."""

    # state
    left: Footfalls = field(factory=Footfalls, init=False)
    right: Footfalls = field(factory=Footfalls, init=False)
    means: GaitMeans = field(factory=GaitMeans, init=False)
    waits: bool = field(default=False, init=False)
    """A cycle waits for samples of the other foot."""
    left_doubt: float | None = field(default=None, init=False)
    right_doubt: float | None = field(default=None, init=False)
    """Up to which time of a foot's samples its clock cannot be compared with the other's, s; None without any doubt."""

    @property
    def parameters(self) -> GaitParameters | None:
        """The running means of walking or running, whichever the newest steady stride was; None before any."""
        return self.means.parameters

    def foot_moved(
        self, foot: FootTracker, feet: Mapping[Foot, FootTracker], known_at: float, events: list[Event], body: object
    ) -> list[Event]:
        """`events` are what came of a sample of `foot`, known at `known_at`, s. `feet`: all that were heard; `body`: of
        the recipe."""
        this = self._falls(foot.foot)
        for event in events:
            if isinstance(event, HeelStrike):
                this.landed(event.t, event.inferred)
            elif isinstance(event, FootFlat):
                if this.toe_off is not None:
                    this.landed(event.t, event.inferred)
                if this.ended is not None:
                    this.ended.flat = True
            elif isinstance(event, HeelOff):
                this.settle()
            elif isinstance(event, ToeOff):
                this.settle()
                this.lifted(event.t, event.inferred)
            elif isinstance(event, StrideTaken):
                this.stepped(event)
            elif isinstance(event, SampleGap) and event.site is SITE_OF_FOOT[foot.foot]:
                this.lost(event.t, event.duration)
        if this.ended is not None and this.ended.flat:
            this.settle()
        return self._release(feet, known_at, body)

    def finish(self, feet: Mapping[Foot, FootTracker], known_at: float, body: object) -> list[Event]:
        """No more samples come: what waited. `known_at`: s, now."""
        for falls in (self.left, self.right):
            falls.settle()
        self.waits = False
        counts = [(foot, len(self._falls(foot).waiting)) for foot in Foot]
        return [event for foot, count in counts for event in self._measured(foot, feet, known_at, body, count)]

    def doubted(self, site: Site, until: float | None) -> None:
        """The times of a site's samples up to `until`, s, are not to be compared with the other foot's."""
        if site.foot is Foot.LEFT:
            self.left_doubt = until
        elif site.foot is Foot.RIGHT:
            self.right_doubt = until

    def interrupt(self, site: Site) -> None:
        """The clock of a site's samples begins anew: what is under way there has no length, and the other foot's times
        cannot be compared with it any more."""
        if site.foot is not None:
            self.means.interrupt(site.foot)
            count = self._falls(site.foot).count
            if site.foot is Foot.LEFT:
                self.left = Footfalls(count=count)
            else:
                self.right = Footfalls(count=count)

    @property
    def _doubts(self) -> tuple[float | None, float | None]:
        return self.left_doubt, self.right_doubt

    def _falls(self, foot: Foot) -> Footfalls:
        return self.left if foot is Foot.LEFT else self.right

    def _release(self, feet: Mapping[Foot, FootTracker], known_at: float, body: object) -> list[Event]:
        """The strides whose time both feet are past, or that waited long enough."""
        if not self.left.waiting and not self.right.waiting:
            self.waits = False
            return []
        told: list[Event] = []
        for foot in Foot:
            own, other = feet.get(foot), feet.get(OTHER[foot])
            waiting = self._falls(foot).waiting
            ready = 0
            for cycle in waiting:
                past = other is None or other.t is None or other.t >= cycle.end
                tired = own is None or own.t is None or own.t - cycle.end >= PATIENCE
                if not past and not tired:
                    break
                ready += 1
            if ready:
                told += self._measured(foot, feet, known_at, body, ready)
        self.waits = bool(self.left.waiting or self.right.waiting)
        return told

    def _measured(
        self, foot: Foot, feet: Mapping[Foot, FootTracker], known_at: float, body: object, count: int
    ) -> list[Event]:
        """The first `count` of the cycles that wait."""
        falls, other = self._falls(foot), self._falls(OTHER[foot])
        cycles, falls.waiting = falls.waiting[:count], falls.waiting[count:]
        tracked = foot in feet and feet[foot].levelled
        told: list[Event] = []
        for cycle in cycles:
            falls.count += 1
            compared = not any([doubt is not None and doubt > cycle.start for doubt in self._doubts])
            before = self.means.newest(foot)
            stride = measured(foot, falls.count, cycle, before, other, tracked, compared, known_at, body)
            self.means.hear(stride)
            told.append(stride)
        return told
