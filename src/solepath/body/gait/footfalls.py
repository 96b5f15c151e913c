"""The gait cycles of one foot, from the events of its phases.

A cycle goes from a contact of the foot to its next one. A stance or a swing of more than `STANDS` is no part of a
stride: the wearer stood, or held the foot up.
"""

from __future__ import annotations

from ...events import StrideTaken
from ...types.attrs import define, field

STANDS = 2.0
"""Longer is no stance of a stride, and no swing, s."""
SHORTEST = 0.35
"""Nor is any stride of a runner shorter than this, s."""
GAP = 0.1
"""A steady stride lacks no samples for longer, s: a radio that loses 1 packet in 30 leaves few strides whole."""
FOUND = 0.05
"""Within so long after a gap a foot is found to be on the ground or off it, s, which is no event of that time."""
KEPT = 4
"""Newest contacts and toe-offs of a foot that are remembered for the other's strides."""


@define
class PendingCycle:
    """A cycle that is over but for its foot-flat, and the step that is told with that."""

    start: float
    toe_off: float
    end: float
    follows: bool
    """The foot's cycle before it was a stride too."""
    degraded: bool
    """Something is missing in it,"""
    spoilt: bool
    """and more than a steady stride may lack."""
    flat: bool = False
    """The foot lay flat after it: without a step it has stepped on the spot."""
    step: StrideTaken | None = None


@define
class Footfalls:
    """One foot: the cycle under way, and those that wait."""

    contact: float | None = None
    """At which the cycle under way began, s; None while there is none."""
    toe_off: float | None = None
    """Within it, s; of a foot in the air even without a cycle."""
    follows: bool = False
    degraded: bool = False
    spoilt: bool = False
    ended: PendingCycle | None = None
    waiting: list[PendingCycle] = field(factory=list)
    count: int = 0
    """Strides measured."""
    contacts: list[float] = field(factory=list)
    """The newest that were seen, s."""
    toe_offs: list[float] = field(factory=list)
    silent_from: float | None = None
    heard_from: float | None = None
    """The newest gap longer than GAP, s: of what the foot did meanwhile only is known that it had done it then."""

    def landed(self, t: float, inferred: bool) -> None:
        """The foot touched the ground at `t`, s."""
        inferred = inferred or self._unseen(t)
        start, toe_off = self.contact, self.toe_off
        if start is not None and toe_off is None:
            return  # it never left the ground
        if start is not None and toe_off is not None:
            stride = toe_off - start <= STANDS and t - toe_off <= STANDS and t - start >= SHORTEST
            if stride:
                lacks, spoilt = self.degraded or inferred, self.spoilt or inferred
                self.ended = PendingCycle(start, toe_off, t, self.follows, lacks, spoilt)
            self.follows = stride
        self.contact, self.toe_off = t, None
        self.degraded = self.spoilt = inferred
        if not inferred:
            self.contacts = [*self.contacts[1 - KEPT :], t]

    def lifted(self, t: float, inferred: bool) -> None:
        """The toe left the ground at `t`, s."""
        inferred = inferred or self._unseen(t)
        self.toe_off = t
        self.degraded, self.spoilt = self.degraded or inferred, self.spoilt or inferred
        if not inferred:
            self.toe_offs = [*self.toe_offs[1 - KEPT :], t]

    def lost(self, t: float, duration: float) -> None:
        """From `t` on there was no sample for so long, s."""
        self.degraded, self.spoilt = True, self.spoilt or duration > GAP
        if duration > GAP:
            self.silent_from, self.heard_from = t, t + duration

    def _unseen(self, t: float) -> bool:
        """Whether it happened in a gap: then it is told with the first samples after that."""
        return (
            self.silent_from is not None
            and self.heard_from is not None
            and self.silent_from < t <= self.heard_from + FOUND
        )

    def stepped(self, step: StrideTaken) -> None:
        """The foot is flat after a step."""
        contact = step.t_end if step.t_heel_strike is None else step.t_heel_strike
        cycle = self.ended
        # a runner's foot may go through several cycles without being flat: then nobody knows which way was whose
        if cycle is not None and cycle.end == contact and cycle.toe_off == step.t_toe_off:
            if step.t_start >= cycle.start:
                cycle.step = step
            if step.degraded and not cycle.degraded and not self.degraded:
                cycle.spoilt = True  # nothing is missing: samples were saturated
            cycle.degraded = cycle.degraded or step.degraded

    def settle(self) -> None:
        """All that belongs to the cycle that is over was told."""
        if self.ended is not None:
            self.waiting = [*self.waiting[1 - KEPT :], self.ended]
            self.ended = None
