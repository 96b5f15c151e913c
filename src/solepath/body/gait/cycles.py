"""Measurement of every gait cycle of both feet from their events, with running means of the steady cycles.

Latency: see GaitCycleMeasured. Samples without events cost almost no computing time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...events import Defect, DefectFound, FootFlat, HeelOff, HeelStrike, SampleGap, StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import OTHER, SITE_OF_FOOT, Foot, PerFoot, Site, per_foot
from ...types.attrs import define, field
from ..part import ClockUnsettled, Notice, Part, PartInput, PartOutput
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
    notices: ClassVar[tuple[type[Notice], ...]] = (ClockUnsettled,)

    feet: PerFoot[Footfalls] = field(factory=lambda: per_foot(Footfalls), init=False)
    progress: PerFoot[FootProgress] = field(factory=lambda: per_foot(FootProgress), init=False)
    means: GaitMeans = field(factory=GaitMeans, init=False)
    idle: bool = field(default=True, init=False)
    """Flag: no cycle waits for samples of the other foot."""
    unsettled: PerFoot[float | None] = field(factory=lambda: dict.fromkeys(Foot), init=False)
    """Time up to which the clock of each foot cannot be compared with that of the other one, s; None: it can."""
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
            elif isinstance(event, ClockUnsettled) and event.site.foot is not None:
                self.unsettled[event.site.foot] = event.until
        return outputs

    def _add_sample(self, view: FootView, events: Sequence[PartInput]) -> Sequence[PartOutput]:
        if self.idle and view.after is None:
            return ()
        this, progress = self.feet[view.foot], self.progress[view.foot]
        if progress.t is None or view.t > progress.t:
            progress.t = view.t
        if view.after is not None:
            self.progress[OTHER[view.foot]].t = view.after.other_t
        progress.tracked = view.levelled
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
        for falls in self.feet.values():
            falls.close_cycle()
        self.idle = True
        waiting = [(foot, len(falls.waiting_cycles)) for foot, falls in self.feet.items()]
        return [output for foot, count in waiting for output in self._measure(foot, now, count)]

    def reset(self, site: Site) -> None:
        """Discard the cycles and the times of a foot whose clock restarts."""
        if site.foot is not None:
            self.clocks_apart = False
            self.means.reset(site.foot)
            self.feet[site.foot] = Footfalls(count=self.feet[site.foot].count)
            self.progress[site.foot].t = None

    def _release(self, known_at: float) -> Sequence[PartOutput]:
        """Return the cycles that end before the other foot's newest sample, or that have waited for `MAX_WAIT`."""
        outputs: list[PartOutput] = []
        for foot, falls in self.feet.items():
            own, other = self.progress[foot].t, self.progress[OTHER[foot]].t
            ready_count = 0
            for cycle in falls.waiting_cycles:
                other_is_past = other is None or other >= cycle.end
                has_waited = own is None or own - cycle.end >= MAX_WAIT
                if not other_is_past and not has_waited:
                    break
                ready_count += 1
            if ready_count:
                outputs += self._measure(foot, known_at, ready_count)
        self.idle = not any([falls.waiting_cycles for falls in self.feet.values()])
        return outputs

    def _measure(self, foot: Foot, known_at: float, count: int) -> list[PartOutput]:
        """Measure the first `count` of the waiting cycles and return their events."""
        falls, other = self.feet[foot], self.feet[OTHER[foot]]
        cycles, falls.waiting_cycles = falls.waiting_cycles[:count], falls.waiting_cycles[count:]
        tracked = self.progress[foot].tracked
        outputs: list[PartOutput] = []
        for cycle in cycles:
            falls.count += 1
            is_unsettled = any([until is not None and until > cycle.start for until in self.unsettled.values()])
            comparable = not (self.clocks_apart or is_unsettled)
            previous = self.means.newest[foot]
            measured = measure_cycle(foot, falls.count, cycle, previous, other, tracked, comparable, known_at)
            self.means.add(measured)
            outputs.append(measured)
        return outputs
