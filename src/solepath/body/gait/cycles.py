"""Events of both feet in, every stride measured as clinicians do out, and running means of the steady ones.

Latency: as GaitCycleMeasured has it. Costs nothing on a sample of which no event came.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...events import FootFlat, HeelOff, HeelStrike, SampleGap, StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import SITE_OF_FOOT, Foot, Site
from ...types.attrs import define, field
from ..part import ClockUnsettled, Part, PartInput, PartOutput
from .footfalls import Footfalls
from .means import GaitMeans, GaitParameters
from .measuring import measured

PATIENCE = 0.5
"""For so long the other foot's samples are waited for, s."""


@define
class Followed:
    """How far the samples of one foot have come."""

    t: float | None = None
    """The newest sample, s; None before any."""
    tracked: bool = False
    """The foot has a track."""


@define
class GaitCycles(Part):
    """Events of both feet in, GaitCycleMeasured out; what it adds up is in `means`."""

    needs_samples: ClassVar[bool] = True

    left: Footfalls = field(factory=Footfalls, init=False)
    right: Footfalls = field(factory=Footfalls, init=False)
    left_followed: Followed = field(factory=Followed, init=False)
    right_followed: Followed = field(factory=Followed, init=False)
    means: GaitMeans = field(factory=GaitMeans, init=False)
    idle: bool = field(default=True, init=False)
    """No cycle waits for samples of the other foot."""
    left_unsettled: float | None = field(default=None, init=False)
    right_unsettled: float | None = field(default=None, init=False)
    """Up to which time of a foot's samples its clock cannot be compared with the other's, s; None where it can."""

    @property
    def parameters(self) -> GaitParameters | None:
        """The running means of walking or running, whichever the newest steady stride was; None before any."""
        return self.means.parameters

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A sample of a foot, and what came of it."""
        if self.idle and not view.events:
            return ()
        is_left = view.foot is Foot.LEFT
        followed, other = self.left_followed, self.right_followed
        if not is_left:
            followed, other = other, followed
        if followed.t is None or view.t > followed.t:
            followed.t = view.t
        if view.events:
            other.t = view.after.other_t
        followed.tracked = view.levelled
        this = self.left if is_left else self.right
        for event in view.events:
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
            elif isinstance(event, SampleGap) and event.site is SITE_OF_FOOT[view.foot]:
                this.lost(event.t, event.duration)
        if this.ended is not None and this.ended.flat:
            this.settle()
        return self._release(view.known_at)

    def finish(self, now: float) -> Sequence[PartOutput]:
        """No more samples come: what waited."""
        for falls in (self.left, self.right):
            falls.settle()
        self.idle = True
        counts = (len(self.left.waiting), len(self.right.waiting))
        return [*self._measured(Foot.LEFT, now, counts[0]), *self._measured(Foot.RIGHT, now, counts[1])]

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Whether the times of a site's samples can be compared with the other foot's."""
        if isinstance(event, ClockUnsettled):
            if event.site.foot is Foot.LEFT:
                self.left_unsettled = event.until
            elif event.site.foot is Foot.RIGHT:
                self.right_unsettled = event.until
        return ()

    def reset(self, site: Site) -> None:
        """The clock of a site's samples restarts: what is under way there has no length, and the other foot's times
        cannot be compared with it any more."""
        if site.foot is not None:
            self.means.reset(site.foot)
            if site.foot is Foot.LEFT:
                self.left, self.left_followed.t = Footfalls(count=self.left.count), None
            else:
                self.right, self.right_followed.t = Footfalls(count=self.right.count), None

    def _release(self, known_at: float) -> Sequence[PartOutput]:
        """The strides whose time both feet are past, or that waited long enough."""
        if not self.left.waiting and not self.right.waiting:
            self.idle = True
            return ()
        said: list[PartOutput] = []
        left, right = self.left_followed.t, self.right_followed.t
        for foot, falls, own, other in ((Foot.LEFT, self.left, left, right), (Foot.RIGHT, self.right, right, left)):
            ready = 0
            for cycle in falls.waiting:
                past = other is None or other >= cycle.end
                tired = own is None or own - cycle.end >= PATIENCE
                if not past and not tired:
                    break
                ready += 1
            if ready:
                said += self._measured(foot, known_at, ready)
        self.idle = not (self.left.waiting or self.right.waiting)
        return said

    def _measured(self, foot: Foot, known_at: float, count: int) -> list[PartOutput]:
        """The first `count` of the cycles that wait."""
        is_left = foot is Foot.LEFT
        falls, other = (self.left, self.right) if is_left else (self.right, self.left)
        cycles, falls.waiting = falls.waiting[:count], falls.waiting[count:]
        tracked = self.left_followed.tracked if is_left else self.right_followed.tracked
        unsettled = (self.left_unsettled, self.right_unsettled)
        said: list[PartOutput] = []
        for cycle in cycles:
            falls.count += 1
            compared = not any([until is not None and until > cycle.start for until in unsettled])
            before = self.means.left if is_left else self.means.right
            stride = measured(foot, falls.count, cycle, before, other, tracked, compared, known_at)
            self.means.hear(stride)
            said.append(stride)
        return said
