"""Measurement of every gait cycle of both feet from their events, with running means of the steady cycles.

Latency: see GaitCycleMeasured. Samples without events cost almost no computing time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...events import Defect, DefectFound, FootFlat, HeelOff, HeelStrike, SampleGap, StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import SITE_OF_FOOT, Foot, Site
from ...types.attrs import define, field
from ..part import ClockUnsettled, Part, PartInput, PartOutput
from .footfalls import Footfalls
from .means import GaitMeans, GaitParameters
from .measuring import measure_cycle

MAX_WAIT = 0.5
"""Longest time for which a cycle waits for the other foot's samples, s."""


@define
class FootProgress:
    """The progress of one foot's samples."""

    t: float | None = None
    """Time of the newest sample, s; None before any."""
    tracked: bool = False
    """Flag: velocity and position of the foot are known."""


@define
class GaitCycles(Part):
    """Measures gait cycles from the events of both feet and returns GaitCycleMeasured; `means` has running means."""

    needs_samples: ClassVar[bool] = True

    left: Footfalls = field(factory=Footfalls, init=False)
    right: Footfalls = field(factory=Footfalls, init=False)
    left_progress: FootProgress = field(factory=FootProgress, init=False)
    right_progress: FootProgress = field(factory=FootProgress, init=False)
    means: GaitMeans = field(factory=GaitMeans, init=False)
    idle: bool = field(default=True, init=False)
    """Flag: no cycle waits for samples of the other foot."""
    left_unsettled: float | None = field(default=None, init=False)
    """Time up to which the left foot's clock cannot be compared with the right one's, s; None: it can."""
    right_unsettled: float | None = field(default=None, init=False)
    """Time up to which the right foot's clock cannot be compared with the left one's, s; None: it can."""
    clocks_apart: bool = field(default=False, init=False)
    """Flag: the feet have separate clocks, so that nothing between the feet is measured."""

    @property
    def parameters(self) -> GaitParameters | None:
        """Running means of walking or of running, by the newest cycle in the means; None before any."""
        return self.means.parameters

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add a sample of a foot with its events and return the cycles that are complete."""
        outputs = () if view is None else self._add_sample(view, events)
        for event in events:
            if isinstance(event, DefectFound) and event.defect is Defect.CLOCKS:
                self.clocks_apart = True
                self.means.separate_feet()
            elif isinstance(event, ClockUnsettled) and event.site is Site.LEFT_FOOT:
                self.left_unsettled = event.until
            elif isinstance(event, ClockUnsettled) and event.site is Site.RIGHT_FOOT:
                self.right_unsettled = event.until
        return outputs

    def _add_sample(self, view: FootView, events: Sequence[PartInput]) -> Sequence[PartOutput]:
        if self.idle and view.after is None:
            return ()
        is_left = view.foot is Foot.LEFT
        progress, other = self.left_progress, self.right_progress
        if not is_left:
            progress, other = other, progress
        if progress.t is None or view.t > progress.t:
            progress.t = view.t
        if view.after is not None:
            other.t = view.after.other_t
        progress.tracked = view.levelled
        this = self.left if is_left else self.right
        for event in events:
            if isinstance(event, HeelStrike):
                this.add_contact(event.t, event.inferred)
            elif isinstance(event, FootFlat):
                if this.toe_off is not None:  # the heel-strike was not detected
                    this.add_contact(event.t, event.inferred)
                if this.ended_cycle is not None:
                    this.ended_cycle.foot_was_flat = True
            elif isinstance(event, HeelOff):
                this.close_cycle()
            elif isinstance(event, ToeOff):
                this.close_cycle()
                this.add_toe_off(event.t, event.inferred)
            elif isinstance(event, StrideTaken):
                this.add_stride(event)
            elif isinstance(event, SampleGap) and event.site is SITE_OF_FOOT[view.foot]:
                this.add_gap(event.t, event.duration)
        if this.ended_cycle is not None and this.ended_cycle.foot_was_flat:
            this.close_cycle()
        return self._release(view.known_at)

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the cycles that still wait, because no more samples come."""
        for falls in (self.left, self.right):
            falls.close_cycle()
        self.idle = True
        counts = (len(self.left.waiting_cycles), len(self.right.waiting_cycles))
        return [*self._measure(Foot.LEFT, now, counts[0]), *self._measure(Foot.RIGHT, now, counts[1])]

    def reset(self, site: Site) -> None:
        """Discard the cycles and the times of a foot whose clock restarts."""
        if site.foot is not None:
            self.clocks_apart = False
            self.means.reset(site.foot)
            if site.foot is Foot.LEFT:
                self.left, self.left_progress.t = Footfalls(count=self.left.count), None
            else:
                self.right, self.right_progress.t = Footfalls(count=self.right.count), None

    def _release(self, known_at: float) -> Sequence[PartOutput]:
        """Return the cycles that end before the other foot's newest sample, or that have waited for `MAX_WAIT`."""
        outputs: list[PartOutput] = []
        left, right = self.left_progress.t, self.right_progress.t
        for foot, falls, own, other in ((Foot.LEFT, self.left, left, right), (Foot.RIGHT, self.right, right, left)):
            ready_count = 0
            for cycle in falls.waiting_cycles:
                other_is_past = other is None or other >= cycle.end
                has_waited = own is None or own - cycle.end >= MAX_WAIT
                if not other_is_past and not has_waited:
                    break
                ready_count += 1
            if ready_count:
                outputs += self._measure(foot, known_at, ready_count)
        self.idle = not (self.left.waiting_cycles or self.right.waiting_cycles)
        return outputs

    def _measure(self, foot: Foot, known_at: float, count: int) -> list[PartOutput]:
        """Measure the first `count` of the waiting cycles and return their events."""
        is_left = foot is Foot.LEFT
        falls, other = (self.left, self.right) if is_left else (self.right, self.left)
        cycles, falls.waiting_cycles = falls.waiting_cycles[:count], falls.waiting_cycles[count:]
        tracked = self.left_progress.tracked if is_left else self.right_progress.tracked
        unsettled = (self.left_unsettled, self.right_unsettled)
        outputs: list[PartOutput] = []
        for cycle in cycles:
            falls.count += 1
            is_unsettled = any([until is not None and until > cycle.start for until in unsettled])
            comparable = not (self.clocks_apart or is_unsettled)
            previous = self.means.left if is_left else self.means.right
            measured = measure_cycle(foot, falls.count, cycle, previous, other, tracked, comparable, known_at)
            self.means.add(measured)
            outputs.append(measured)
        return outputs
