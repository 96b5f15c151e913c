"""Gait cycles of one foot, from its phase events.

"Contact" means initial contact (HeelStrike) here. A gait cycle goes from a contact to the next one of the same foot.
A stance or swing longer than `MAX_PHASE_TIME` is not part of a gait cycle: the wearer stood, or held the foot up."""

from __future__ import annotations

from ...events import StrideTaken
from ...types.attrs import define, field

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
