"""Strides of one foot while the other foot stands, which nobody can take.

While one foot stands, the other one can get from a step behind it to a step in front of it, and no further. If it goes
further in several strides, and the standing foot's samples go on, then the times of the feet may be seconds apart, or
one of the two sensors is not worn or does not measure. Turns, stairs, steps on the spot and a leg that swings stay
within reach, because the displacement counts and not the number of strides."""

from __future__ import annotations

from math import hypot

from ....events import FootFlat, GaitEvent, HeelStrike, SampleGap, StrideTaken
from ....foot.view import FootView
from ....types import OTHER, Foot, Phase
from ....types.attrs import define, field

LONGEST_STEP = 1.0
"""Longest step of a walk, m: of legs of 1.15 m that are 52 degrees apart.

In 204 recordings of feet on one clock, no foot gets further than 1.7 m while the other one stands. With steps of 0.8,
1.0, 1.2 and 1.4 m, clocks that are 5 or 10 s apart are found in 93, 92, 86 and 78 % of the walks of ipol_10m_uturn and
marpino_heel_toe, and one recording of feet on one clock is reported with 0.8 m, none with more."""
MIN_STRIDES = 2
"""Least number of strides; a single one that is too long is of a runner, or two that were taken for one."""
MAX_GAP = 0.3
"""Longest gap in which a foot cannot have taken a step, s; the swing of a walker lasts longer."""
MAX_LAG = 0.5
"""Longest time by which the samples of the standing foot may be behind the other foot's, s."""


@define
class LoneFoot:
    """The strides of one foot since the other foot moved."""

    newest: float | None = None
    """Time of the newest sample of this foot, s; None before any."""
    stood_since: float | None = None
    """Time from which on this foot is on the ground, s: of its newest event, or before any of a sample; else None."""
    is_known: bool = False
    """Flag: this foot had an event, or a sample with which it is tracked."""
    strides: int = 0
    """Number of strides since the other foot moved."""
    x: float = 0.0
    """Displacement by these strides along the x axis of the world, m."""
    y: float = 0.0
    """Displacement by these strides along the y axis of the world, m."""

    def restart(self) -> None:
        """Restart the count, because the other foot moved, or may have moved."""
        self.strides, self.x, self.y = 0, 0.0, 0.0


@define
class LoneStrides:
    """Detects a foot that walked while the other foot stood; the sentences are those of the right foot."""

    left: LoneFoot = field(factory=LoneFoot, init=False)
    right: LoneFoot = field(factory=LoneFoot, init=False)
    requested: Foot | None = field(default=None, init=False)
    """Foot of which a sample without events is needed, to know whether it is tracked; None mostly."""

    def see(self, view: FootView) -> None:
        """Take a sample with events, or one of the foot that was requested."""
        foot = view.foot
        this, other = self._feet(foot)
        if not this.is_known and view.levelled and view.moved_at is not None:
            self.set_standing(foot, view.t if view.phase in (Phase.STATIONARY, Phase.LOADING) else None)
        if self.requested is foot:
            self.requested = None
        if view.after is not None:
            self.set_newest(foot, view.t, view.after.other_t)
            if not other.is_known and other.newest is not None:
                self.requested = OTHER[foot]

    def set_newest(self, foot: Foot, t: float, other_t: float | None) -> None:
        """Set the time of the newest sample of a foot and of the other foot, s."""
        this, other = self._feet(foot)
        this.newest, other.newest = t, other_t

    def set_standing(self, foot: Foot, since: float | None) -> None:
        """Set that a foot is tracked, and the time from which on it is on the ground, s, or None if it is not."""
        this, _ = self._feet(foot)
        this.is_known, this.stood_since = True, since

    def add(self, event: GaitEvent) -> str | None:
        """Add an event of a foot; return sentences for the person if the foot has walked while the other one stood."""
        this, other = self._feet(event.foot)
        other.restart()
        if not isinstance(event, StrideTaken):
            self.set_standing(event.foot, event.t if isinstance(event, HeelStrike | FootFlat) else None)
            return None
        stood_since, newest = other.stood_since, other.newest
        is_lone = stood_since is not None and stood_since <= event.t_start
        if event.degraded or not is_lone or newest is None or newest < event.t_end - MAX_LAG:
            this.restart()
            return None
        x, y, _ = event.displacement
        this.strides, this.x, this.y = this.strides + 1, this.x + x, this.y + y
        if this.strides < MIN_STRIDES or hypot(this.x, this.y) <= 2.0 * LONGEST_STEP:
            return None
        contradiction = "stood while the left foot walked" if this is self.left else "walked while the left foot stood"
        return (
            f"it {contradiction}: the clocks are seconds apart, or one sensor is not worn or does not measure. Step "
            "time and double support are left out. Record both feet with one clock"
        )

    def add_gap(self, gap: SampleGap) -> None:
        """Restart the count after a gap in which a foot may have taken a step."""
        if gap.duration > MAX_GAP:
            self.left.restart()
            self.right.restart()

    def _feet(self, foot: Foot) -> tuple[LoneFoot, LoneFoot]:
        """Return this foot and the other one."""
        return (self.left, self.right) if foot is Foot.LEFT else (self.right, self.left)
