"""Measurement of every gait cycle of both feet from their events, with running means of the steady cycles.

Latency: see GaitCycleMeasured. Samples without events cost almost no computing time."""

from __future__ import annotations

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
from ...events.link import is_harmless_loss
from ...foot.bearing import LONGEST_WAIT
from ...foot.view import FootView
from ...types import OTHER, Foot, PerFoot, Site, per_foot
from ...types.attrs import define, field, state, stateful
from ..part import ClockUnsettled, Inputs, Outputs, Part, PartOutput
from .means import GaitMeans, GaitParameters

# Gait cycles of one foot, from its phase events.
#
# "Contact" means initial contact (HeelStrike) here. A gait cycle goes from a contact to the next one of the same foot.
# A stance or swing longer than `MAX_PHASE_TIME` is not part of a gait cycle: the wearer stood, or held the foot up.

MAX_PHASE_TIME = 2.0
"""Longest stance, and longest swing, of a gait cycle, s."""
MIN_CYCLE_TIME = 0.35
"""Shortest gait cycle, also of a runner, s."""
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
    """Flag: an event of the cycle is inferred, a gap in it is a flaw, its stride has flaws, or its foot is spoilt."""
    foot_was_flat: bool = False
    """Flag: a foot-flat followed the cycle; if no stride ended there, the wearer stepped on the spot."""
    stride: StrideTaken | None = None
    """Stride that ends at the foot-flat after the cycle; None when there was none."""


@define
class Footfalls:
    """The gait cycle of one foot that is under way, and the finished cycles that are not measured yet."""

    t: float | None = None
    """Time of the foot's newest sample, s; None before any."""
    tracked: bool = False
    """Flag: velocity and position of the foot are known."""
    stride_at: float | None = None
    """End of the foot's newest stride, s; None before any."""
    unsettled: float | None = None
    """Time up to which the clock of the foot cannot be compared with that of the other one, s; None: it can."""
    contact: float | None = None
    """Contact at which the cycle under way started, s; None while there is none."""
    toe_off: float | None = None
    """Toe-off since the newest contact, s, also when no cycle is under way; None without one."""
    follows_cycle: bool = False
    """Flag: the cycle directly before the one under way was accepted."""
    degraded: bool = False
    """Flag: an event of the cycle under way is inferred, or a gap in it is a flaw."""
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
    gap: tuple[float, float] | None = None
    """Start and end of the newest gap that is a flaw, s; None before any."""

    def add_contact(self, event: HeelStrike | FootFlat) -> None:
        """Add a contact of the foot."""
        t, start, toe_off = event.t, self.contact, self.toe_off
        uncertain = self._is_uncertain(event)
        if start is not None:
            if toe_off is None:
                return  # the foot never left the ground
            is_cycle = max(toe_off - start, t - toe_off) <= MAX_PHASE_TIME and t - start >= MIN_CYCLE_TIME
            if is_cycle:
                self.ended_cycle = PendingCycle(start, toe_off, t, self.follows_cycle, self.degraded or uncertain)
            self.follows_cycle = is_cycle
        self.contact, self.toe_off, self.degraded = t, None, uncertain
        if not uncertain:
            self.contacts = [*self.contacts[1 - MAX_KEPT :], t]

    def add_toe_off(self, event: ToeOff) -> None:
        """Add a toe-off."""
        uncertain = self._is_uncertain(event)
        self.toe_off, self.degraded = event.t, self.degraded or uncertain
        if not uncertain:
            self.toe_offs = [*self.toe_offs[1 - MAX_KEPT :], event.t]

    def add_gap(self, gap: SampleGap) -> None:
        """Add a gap between samples; one that is no flaw of a stride is none of a cycle either."""
        if not is_harmless_loss(gap):
            self.degraded, self.gap = True, (gap.t, gap.t + gap.duration)

    def _is_uncertain(self, event: HeelStrike | FootFlat | ToeOff) -> bool:
        """Return whether an event is inferred, or may have happened in a gap and been detected after it."""
        return event.inferred or (self.gap is not None and self.gap[0] < event.t <= self.gap[1] + GAP_MARGIN)

    def add_stride(self, stride: StrideTaken) -> None:
        """Add a stride to the finished cycle that has the same heel-strike and toe-off."""
        self.stride_at = stride.t_end
        contact = stride.t_end if stride.t_heel_strike is None else stride.t_heel_strike
        cycle = self.ended_cycle
        # a runner may have several cycles without foot-flat; the stride cannot be assigned then
        if cycle is not None and cycle.end == contact and cycle.toe_off == stride.t_toe_off:
            if stride.t_start >= cycle.start:
                cycle.stride = stride
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
# - it is not degraded: its stride has no flaw, no gap in it would be one, none of its events is inferred, and nothing
#   was found that makes the data of its foot wrong;
# - it follows another cycle without a pause. This leaves out the first three steps of a walk, after which gait is
#   steady (Mann et al. 1979, J. Bone Joint Surg. Am. 61): the half stride from standing, and the first cycle;
# - neither its time nor its length differs from that of the cycle before by a factor of `STEADY_FACTOR` or more,
#   because a wearer who hesitates does not walk steadily;
# - it turns by less than `MAX_TURN`, and its height changes by less than `MAX_SLOPE` of its length;
# - a stride ends at the foot-flat after it, because stepping on the spot is not walking. If there is no such foot-flat
#   (a runner may have none), the foot's newest stride is one of the same bout. Both are checked only if the foot's
#   position is known.
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
    cycle: PendingCycle,
    previous: GaitCycleMeasured | None,
    this: Footfalls,
    other: Footfalls,
    comparable: bool,
    known_at: float,
) -> GaitCycleMeasured:
    """Return the measurement of one gait cycle of `foot`, the newest of those that `this` counts.

    `previous` is the foot's previous cycle, `other` has the other foot's events, and `comparable` says that the feet's
    clocks can be compared over the whole cycle."""
    start, toe_off, end, stride = cycle.start, cycle.toe_off, cycle.end, cycle.stride
    time = end - start
    contacts = [t for t in other.contacts if start < t < end]
    contact = contacts[0] if comparable and len(contacts) == 1 else None
    toe_offs = [] if contact is None else [t for t in other.toe_offs if start - 0.5 * time < t < contact]
    other_toe_off = toe_offs[-1] if toe_offs else None
    if is_contradictory(cycle, contact, other_toe_off):
        contact = other_toe_off = None
    # a clearance is negative, and counts as 0, when the corrected foot-flat height is above all heights of the swing
    values: list[float | None] = [None] * 6
    if stride is not None:
        features = stride.features
        values = [
            stride.length, max(0.0, features.clearance), features.toe_off_angle, features.heel_strike_angle,
            stride.heading_change, stride.height_change,
        ]  # fmt: skip
        for k, value in enumerate(values):
            if value is not None and not abs(value) < MAX_VALUE:
                values[k] = None
    length, clearance, off_angle, strike_angle, turning, rise = values
    return GaitCycleMeasured(
        t=end,
        known_at=max(known_at, end),
        foot=foot,
        number=this.count,
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
        steady=is_steady(cycle, time, previous, this),
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


def is_steady(cycle: PendingCycle, time: float, previous: GaitCycleMeasured | None, foot: Footfalls) -> bool:
    """Return whether the cycle, whose duration is `time`, s, is steady by the rule above."""
    if cycle.degraded or not cycle.follows_cycle or previous is None or previous.t != cycle.start:
        return False
    if max(time, previous.stride_time) >= STEADY_FACTOR * min(time, previous.stride_time):
        return False
    stride = cycle.stride
    if stride is None:
        walks = foot.stride_at is not None and cycle.end - foot.stride_at < LONGEST_WAIT
        return not foot.tracked or (walks and not cycle.foot_was_flat)
    length, before = stride.length, previous.stride_length
    if abs(stride.heading_change) > MAX_TURN or abs(stride.height_change) > MAX_SLOPE * length:
        return False
    return before is None or max(length, before) < STEADY_FACTOR * min(length, before)


MAX_WAIT = 0.5
"""Longest time for which a cycle waits for the other foot's samples, s."""


@stateful
class GaitCycles(Part):
    """Measures gait cycles from the events of both feet and returns GaitCycleMeasured; `means` has running means."""

    needs_samples = True
    notices = (ClockUnsettled,)

    feet: PerFoot[Footfalls] = state(factory=lambda: per_foot(Footfalls))
    means: GaitMeans = state(factory=GaitMeans)
    idle: bool = True
    """Flag: no cycle waits for samples of the other foot."""
    spoilt: list[Foot] = state(factory=list)
    """Feet whose data cannot be right, so that their cycles are degraded and nothing is compared with them."""
    clocks_apart: bool = False
    """Flag: the feet have separate clocks, so that nothing between the feet is measured."""

    @property
    def parameters(self) -> GaitParameters | None:
        """Running means of walking or of running, by the newest cycle in the means; None before any."""
        return self.means.parameters

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a sample of a foot with its events and return the cycles that are complete."""
        for event in events:
            if isinstance(event, DefectFound):
                self.clocks_apart |= event.defect is Defect.CLOCKS
                if (foot := event.spoilt_foot) is not None and foot not in self.spoilt:
                    self.spoilt.append(foot)
                self.means.withhold(event)
            elif isinstance(event, SampleGap) and event.site.foot is not None:
                self.feet[event.site.foot].add_gap(event)
            elif isinstance(event, ClockUnsettled) and event.site.foot is not None:
                self.feet[event.site.foot].unsettled = event.until
        return () if view is None else self._add_sample(view, events)

    def _add_sample(self, view: FootView, events: Inputs) -> Outputs:
        if self.idle and view.after is None:
            return ()
        this = self.feet[view.foot]
        if this.t is None or view.t > this.t:
            this.t = view.t
        if view.after is not None:
            self.feet[OTHER[view.foot]].t = view.after.other_t
        this.tracked = view.levelled
        for event in events:
            if isinstance(event, HeelStrike):
                this.add_contact(event)
            elif isinstance(event, FootFlat):
                if this.toe_off is not None:  # the heel-strike was not detected
                    this.add_contact(event)
                if this.ended_cycle is not None:
                    this.ended_cycle.foot_was_flat = True
            elif isinstance(event, HeelOff):
                this.close_cycle()
            elif isinstance(event, ToeOff):
                this.close_cycle()
                this.add_toe_off(event)
            elif isinstance(event, StrideTaken):
                this.add_stride(event)
        if this.ended_cycle is not None and this.ended_cycle.foot_was_flat:
            this.close_cycle()
        return self._release(view.known_at)

    def finish(self, now: float) -> Outputs:
        """Return the cycles that still wait, because no more samples come."""
        for falls in self.feet.values():
            falls.close_cycle()
        self.idle = True
        waiting = {foot: falls.waiting_cycles for foot, falls in self.feet.items()}
        return [self._measure(foot, cycle, now) for foot, cycles in waiting.items() for cycle in cycles]

    def reset(self, site: Site) -> None:
        """Discard the cycles and the times of a foot whose clock restarts or that wears another device."""
        if site.foot is not None:
            self.clocks_apart, self.spoilt = False, [foot for foot in self.spoilt if foot is not site.foot]
            self.means.reset(site.foot)
            falls = self.feet[site.foot]
            self.feet[site.foot] = Footfalls(count=falls.count, unsettled=falls.unsettled)

    def _release(self, known_at: float) -> Outputs:
        """Return the cycles that end before the other foot's newest sample, or that have waited for `MAX_WAIT`."""
        outputs: list[PartOutput] = []
        self.idle = True
        for foot, falls in self.feet.items():
            own, other = falls.t, self.feet[OTHER[foot]].t
            for cycle in falls.waiting_cycles:
                other_is_past = other is None or other >= cycle.end
                has_waited = own is None or own - cycle.end >= MAX_WAIT
                if not other_is_past and not has_waited:
                    self.idle = False
                    break
                outputs.append(self._measure(foot, cycle, known_at))
        return outputs

    def _measure(self, foot: Foot, cycle: PendingCycle, known_at: float) -> GaitCycleMeasured:
        """Measure the first of the waiting cycles and return its event."""
        this, other = self.feet[foot], self.feet[OTHER[foot]]
        this.count, this.waiting_cycles = this.count + 1, this.waiting_cycles[1:]
        comparable = not self.clocks_apart and not self.spoilt
        for falls in (this, other):
            comparable &= falls.unsettled is None or falls.unsettled <= cycle.start
        cycle.degraded |= foot in self.spoilt
        measured = measure_cycle(foot, cycle, self.means.newest[foot], this, other, comparable, known_at)
        self.means.add(measured)
        return measured
