"""Gait cycles of one foot, from the events of its phases.

A cycle goes from a contact of the foot to its next one. A stance or a swing of more than `LONGEST_PHASE` is no part of
a stride: the wearer stood, or held the foot up."""

from __future__ import annotations

from ...events import StrideTaken
from ...types.attrs import define, field

LONGEST_PHASE = 2.0
"""Longest stance and longest swing of a gait cycle, s."""
SHORTEST_CYCLE = 0.35
"""Shortest gait cycle, also of a runner, s."""
LONGEST_GAP = 0.1
"""Longest gap in a steady stride, s: a radio that loses 1 packet in 30 leaves few strides whole."""
GAP_MARGIN = 0.05
"""Time after a gap in which an event is not trusted, s: it may have happened in the gap."""
MOST_CONTACTS = 4
"""Number of newest contacts and toe-offs of a foot that are kept for the other foot's cycles."""


@define
class PendingCycle:
    """A finished gait cycle that waits for its foot-flat and for the stride reported with it; times in s."""

    start: float
    toe_off: float
    end: float
    follows: bool
    """Flag: the foot's cycle before was accepted too."""
    degraded: bool
    """Flag: samples are missing in the cycle, or an event is inferred."""
    unsteady: bool
    """Flag: more is missing than a steady stride may lack."""
    flat: bool = False
    """Flag: the foot was flat after the cycle; without a stride the wearer stepped on the spot."""
    stride: StrideTaken | None = None


@define
class Footfalls:
    """The gait cycle of one foot under way, and its finished cycles that wait."""

    contact: float | None = None
    """Contact at which the cycle under way started, s; None while there is none."""
    toe_off: float | None = None
    """Toe-off in the cycle under way, s; also set for a foot in the air without a cycle."""
    follows: bool = False
    """Flag: the foot's cycle before the one under way was accepted."""
    degraded: bool = False
    """Flag: samples are missing in the cycle under way, or an event is inferred."""
    unsteady: bool = False
    """Flag: more is missing in the cycle under way than a steady stride may lack."""
    ended: PendingCycle | None = None
    waiting: list[PendingCycle] = field(factory=list)
    count: int = 0
    """Number of cycles measured."""
    contacts: list[float] = field(factory=list)
    """Times of the newest contacts that were detected, s."""
    toe_offs: list[float] = field(factory=list)
    """Times of the newest toe-offs that were detected, s."""
    gap_start: float | None = None
    """Start of the newest gap longer than `LONGEST_GAP`, s."""
    gap_end: float | None = None
    """End of that gap, s; events in it are only known to have happened by then."""

    def add_contact(self, t: float, inferred: bool) -> None:
        """Add a contact of the foot at `t`, s."""
        inferred = inferred or self._unseen(t)
        start, toe_off = self.contact, self.toe_off
        if start is not None and toe_off is None:
            return  # the foot never left the ground
        if start is not None and toe_off is not None:
            is_stride = (
                toe_off - start <= LONGEST_PHASE and t - toe_off <= LONGEST_PHASE and t - start >= SHORTEST_CYCLE
            )
            if is_stride:
                lacks, unsteady = self.degraded or inferred, self.unsteady or inferred
                self.ended = PendingCycle(start, toe_off, t, self.follows, lacks, unsteady)
            self.follows = is_stride
        self.contact, self.toe_off = t, None
        self.degraded = self.unsteady = inferred
        if not inferred:
            self.contacts = [*self.contacts[1 - MOST_CONTACTS :], t]

    def add_toe_off(self, t: float, inferred: bool) -> None:
        """Add a toe-off at `t`, s."""
        inferred = inferred or self._unseen(t)
        self.toe_off = t
        self.degraded, self.unsteady = self.degraded or inferred, self.unsteady or inferred
        if not inferred:
            self.toe_offs = [*self.toe_offs[1 - MOST_CONTACTS :], t]

    def add_gap(self, t: float, duration: float) -> None:
        """Add a gap from `t` on, of `duration` s."""
        self.degraded, self.unsteady = True, self.unsteady or duration > LONGEST_GAP
        if duration > LONGEST_GAP:
            self.gap_start, self.gap_end = t, t + duration

    def _unseen(self, t: float) -> bool:
        """Return whether the event happened in a gap: such an event is reported with the first samples after it."""
        return (
            self.gap_start is not None and self.gap_end is not None and self.gap_start < t <= self.gap_end + GAP_MARGIN
        )

    def add_stride(self, stride: StrideTaken) -> None:
        """Add the stride that ends with a foot-flat to the finished cycle it belongs to."""
        contact = stride.t_end if stride.t_heel_strike is None else stride.t_heel_strike
        cycle = self.ended
        # a runner's foot may go through several cycles without being flat: then the stride cannot be assigned
        if cycle is not None and cycle.end == contact and cycle.toe_off == stride.t_toe_off:
            if stride.t_start >= cycle.start:
                cycle.stride = stride
            if stride.degraded and not cycle.degraded and not self.degraded:
                cycle.unsteady = True  # nothing is missing: samples were saturated
            cycle.degraded = cycle.degraded or stride.degraded

    def close_cycle(self) -> None:
        """Move the finished cycle to those that wait: everything that belongs to it was reported."""
        if self.ended is not None:
            self.waiting = [*self.waiting[1 - MOST_CONTACTS :], self.ended]
            self.ended = None
