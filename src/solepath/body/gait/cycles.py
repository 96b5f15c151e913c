"""Measurement of every gait cycle of both feet from their events, with running means of the steady cycles.

Latency: see GaitCycleMeasured. Samples without events cost almost no computing time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...events import (
    Defect,
    DefectFound,
    FootFlat,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    SampleGap,
    StrideTaken,
    ToeOff,
)
from ...foot.view import FootView
from ...types import OTHER, SITE_OF_FOOT, Foot, PerFoot, Site, per_foot
from ...types.attrs import define, field
from ..part import ClockUnsettled, Notice, Part, PartInput, PartOutput
from .means import GaitMeans, GaitParameters

# Gait cycles of one foot, from its phase events.
#
# "Contact" means initial contact (HeelStrike) here. A gait cycle goes from a contact to the next one of the same foot.
# A stance or swing longer than `MAX_PHASE_TIME` is not part of a gait cycle: the wearer stood, or held the foot up.

MAX_PHASE_TIME = 2.0
"""Longest stance, and longest swing, of a gait cycle, s."""
MIN_CYCLE_TIME = 0.35
"""Shortest gait cycle, also of a runner, s."""
MAX_STEADY_GAP = 0.1
"""Longest gap in a steady cycle, s; with 1 packet in 30 lost, most cycles have shorter gaps, which are allowed."""
GAP_MARGIN = 0.05
"""Time after a gap in which an event is not trusted, s, because it may have happened in the gap."""
MAX_KEPT = 4
"""Largest number of contacts, of toe-offs and of waiting cycles of a foot that are kept."""


@define
class PendingCycle:
    """A finished gait cycle that waits for the following foot-flat and the stride that ends there; times in s."""

    start: float
    toe_off: float
    end: float
    follows_cycle: bool
    """Flag: the cycle directly before was accepted too."""
    degraded: bool
    """Flag: samples are missing in the cycle, or an event is inferred."""
    unsteady: bool
    """Flag: more samples or events are missing than a steady cycle allows."""
    foot_was_flat: bool = False
    """Flag: a foot-flat followed the cycle; if no stride ended there, the wearer stepped on the spot."""
    stride: StrideTaken | None = None
    """Stride that ends at the foot-flat after the cycle; None when there was none."""


@define
class Footfalls:
    """The gait cycle of one foot that is under way, and the finished cycles that are not measured yet."""

    contact: float | None = None
    """Contact at which the cycle under way started, s; None while there is none."""
    toe_off: float | None = None
    """Toe-off since the newest contact, s, also when no cycle is under way; None without one."""
    follows_cycle: bool = False
    """Flag: the cycle directly before the one under way was accepted."""
    degraded: bool = False
    """Flag: samples are missing in the cycle under way, or an event is inferred."""
    unsteady: bool = False
    """Flag: more is missing in the cycle under way than a steady cycle allows."""
    ended_cycle: PendingCycle | None = None
    """Newest finished cycle, while events may still be added to it."""
    waiting_cycles: list[PendingCycle] = field(factory=list)
    """Complete cycles that wait for the other foot's samples, oldest first."""
    count: int = 0
    """Number of cycles measured."""
    contacts: list[float] = field(factory=list)
    """Times of the newest contacts, without inferred ones, s."""
    toe_offs: list[float] = field(factory=list)
    """Times of the newest toe-offs, without inferred ones, s."""
    gap_start: float | None = None
    """Start of the newest gap that is longer than `MAX_STEADY_GAP`, s."""
    gap_end: float | None = None
    """End of the same gap, s."""

    def add_contact(self, t: float, inferred: bool) -> None:
        """Add a contact of the foot at `t`, s."""
        inferred = inferred or self._is_in_gap(t)
        start, toe_off = self.contact, self.toe_off
        if start is not None and toe_off is None:
            return  # the foot never left the ground
        if start is not None and toe_off is not None:
            is_cycle = (
                toe_off - start <= MAX_PHASE_TIME and t - toe_off <= MAX_PHASE_TIME and t - start >= MIN_CYCLE_TIME
            )
            if is_cycle:
                degraded, unsteady = self.degraded or inferred, self.unsteady or inferred
                self.ended_cycle = PendingCycle(start, toe_off, t, self.follows_cycle, degraded, unsteady)
            self.follows_cycle = is_cycle
        self.contact, self.toe_off = t, None
        self.degraded = self.unsteady = inferred
        if not inferred:
            self.contacts = [*self.contacts[1 - MAX_KEPT :], t]

    def add_toe_off(self, t: float, inferred: bool) -> None:
        """Add a toe-off at `t`, s."""
        inferred = inferred or self._is_in_gap(t)
        self.toe_off = t
        self.degraded, self.unsteady = self.degraded or inferred, self.unsteady or inferred
        if not inferred:
            self.toe_offs = [*self.toe_offs[1 - MAX_KEPT :], t]

    def add_gap(self, t: float, duration: float) -> None:
        """Add a gap that starts at `t`, s, and lasts `duration`, s."""
        self.degraded, self.unsteady = True, self.unsteady or duration > MAX_STEADY_GAP
        if duration > MAX_STEADY_GAP:
            self.gap_start, self.gap_end = t, t + duration

    def _is_in_gap(self, t: float) -> bool:
        """Return whether an event at `t`, s, may have happened in a gap and been detected after it."""
        return (
            self.gap_start is not None and self.gap_end is not None and self.gap_start < t <= self.gap_end + GAP_MARGIN
        )

    def add_stride(self, stride: StrideTaken) -> None:
        """Add a stride to the finished cycle that has the same heel-strike and toe-off."""
        contact = stride.t_end if stride.t_heel_strike is None else stride.t_heel_strike
        cycle = self.ended_cycle
        # a runner may have several cycles without foot-flat; the stride cannot be assigned then
        if cycle is not None and cycle.end == contact and cycle.toe_off == stride.t_toe_off:
            if stride.t_start >= cycle.start:
                cycle.stride = stride
            if stride.degraded and not cycle.degraded and not self.degraded:
                cycle.unsteady = True  # no sample is missing, so the reason is clipping
            cycle.degraded = cycle.degraded or stride.degraded

    def close_cycle(self) -> None:
        """Move the finished cycle to the waiting cycles, because all its events have been added."""
        if self.ended_cycle is not None:
            self.waiting_cycles = [*self.waiting_cycles[1 - MAX_KEPT :], self.ended_cycle]
            self.ended_cycle = None


# Measurement of one gait cycle, and the rule for steady strides.
#
# GaitCycleMeasured defines the values. Only steady cycles enter the running means. A gait cycle is steady when
#
# - no sample in it clipped, no gap in it is longer than `MAX_STEADY_GAP`, and none of its events is inferred;
# - it follows another cycle without a pause. This leaves out the first three steps of a walk, after which gait is
#   steady (Mann et al. 1979, J. Bone Joint Surg. Am. 61): the half stride from standing, and the first cycle;
# - neither its time nor its length differs from that of the cycle before by a factor of `STEADY_FACTOR` or more,
#   because a wearer who hesitates does not walk steadily;
# - it turns by less than `MAX_TURN`, and its height changes by less than `MAX_SLOPE` of its length;
# - a stride ends at the foot-flat after it, because stepping on the spot is not walking. This is checked only if the
#   foot's position is known and there is such a foot-flat (a runner may have none).
#
# A steady cycle enters the means when the next cycle of the foot follows, so the last cycle before a stop is left out.

STEADY_FACTOR = 1.5
"""Largest ratio of the times, and of the lengths, of two consecutive steady cycles."""
MAX_TURN = 0.2
"""Largest turn of a steady cycle, rad; straight strides vary by 0.05, and on a circle of 7 m radius it is 0.2."""
MAX_SLOPE = 0.15
"""Largest slope (height change / length) of a steady cycle; ramps for wheelchairs have 1 / 12, stairs have 1 / 2."""
MAX_VALUE = 1e4
"""Largest size of a reported value of a cycle, m or rad."""
CLEAR_SUPPORT = 0.05
"""Size from which a double support or a flight is not an error of heel-strike and toe-off, s.

A walk has no flight and a run no double support (Novacheck 1998, Gait & Posture 7), so a cycle with both is of feet
whose times do not belong together, or has a wrong event. With 30, 50 and 100 ms, 11, 9 and 4 of 1911 cycles of
ipol_10m_uturn are such; in none of them the events agree with the hand labels."""


def measure_cycle(
    foot: Foot,
    number: int,
    cycle: PendingCycle,
    previous: GaitCycleMeasured | None,
    other: Footfalls,
    tracked: bool,
    comparable: bool,
    known_at: float,
) -> GaitCycleMeasured:
    """Return the measurement of one gait cycle of `foot`.

    `number` counts the foot's cycles from 1, `previous` is its previous cycle, and `other` has the other foot's events.
    `tracked` says that the foot's position is known, `comparable` that the feet's clocks can be compared over the whole
    cycle."""
    start, toe_off, end, stride = cycle.start, cycle.toe_off, cycle.end, cycle.stride
    time = end - start
    contacts_between = [t for t in other.contacts if start < t < end]
    other_contact = contacts_between[0] if len(contacts_between) == 1 else None
    other_toe_off = None
    if other_contact is not None:
        earlier_toe_offs = [t for t in other.toe_offs if start - 0.5 * time < t < other_contact]
        other_toe_off = earlier_toe_offs[-1] if earlier_toe_offs else None
    # a clearance is negative, and counts as 0, when the corrected foot-flat height is above all heights of the swing
    length, clearance, off_angle, strike_angle, turning, rise = (
        (None,) * 6
        if stride is None
        else _keep_plausible(
            stride.length,
            max(0.0, stride.features.clearance),
            stride.features.toe_off_angle,
            stride.features.heel_strike_angle,
            stride.heading_change,
            stride.height_change,
        )
    )
    if not comparable or is_contradictory(cycle, other_contact, other_toe_off):
        other_contact = other_toe_off = None
    contact = other_contact
    return GaitCycleMeasured(
        t=end,
        known_at=max(known_at, end),
        foot=foot,
        number=number,
        t_start=start,
        t_toe_off=toe_off,
        stride_time=time,
        stance_time=toe_off - start,
        swing_time=end - toe_off,
        cadence=120.0 / time,
        step_time=None if contact is None else end - contact,
        initial_double_support=None if other_toe_off is None else other_toe_off - start,
        terminal_double_support=None if contact is None else toe_off - contact,
        single_support=None
        if other_toe_off is None or contact is None
        else min(toe_off, contact) - max(start, other_toe_off),
        phase=None if contact is None else (contact - start) / time,
        stride_length=length,
        speed=None if length is None else length / time,
        clearance=clearance,
        toe_off_angle=off_angle,
        heel_strike_angle=strike_angle,
        turning_angle=turning,
        rise=rise,
        degraded=cycle.degraded,
        steady=is_steady(cycle, time, previous, tracked),
    )


def is_contradictory(cycle: PendingCycle, other_contact: float | None, other_toe_off: float | None) -> bool:
    """Return whether the other foot's events, s, would give the cycle a flight and a double support.

    Without the other foot's toe-off, a foot that is on the ground for half of the cycle or more is that of a walker,
    whose other foot lands before this one leaves the ground."""
    if other_contact is None:
        return False
    terminal = cycle.toe_off - other_contact
    if other_toe_off is None:
        return terminal < -CLEAR_SUPPORT and cycle.toe_off - cycle.start >= 0.5 * (cycle.end - cycle.start)
    initial = other_toe_off - cycle.start
    return min(initial, terminal) < -CLEAR_SUPPORT and max(initial, terminal) > CLEAR_SUPPORT


def is_steady(cycle: PendingCycle, time: float, previous: GaitCycleMeasured | None, tracked: bool) -> bool:
    """Return whether the cycle, whose duration is `time`, s, is steady by the rule above."""
    if cycle.unsteady or not cycle.follows_cycle or previous is None or previous.t != cycle.start:
        return False
    if not _is_similar(time, previous.stride_time):
        return False
    stride = cycle.stride
    if stride is None:
        return not (tracked and cycle.foot_was_flat)
    if abs(stride.heading_change) > MAX_TURN or abs(stride.height_change) > MAX_SLOPE * stride.length:
        return False
    return previous.stride_length is None or _is_similar(stride.length, previous.stride_length)


def _is_similar(first: float, second: float) -> bool:
    return first < STEADY_FACTOR * second and second < STEADY_FACTOR * first


def _keep_plausible(*values: float | None) -> list[float | None]:
    """Return the values, with None for a value that is missing or too large."""
    return [value if value is not None and abs(value) < MAX_VALUE else None for value in values]


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
