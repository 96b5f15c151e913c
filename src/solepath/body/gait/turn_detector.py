"""Detection of the wearer's turns from the strides of both feet (Liu et al. 2015, IEEE MASS, section IV.D).

Turning strides are separated from straight ones (body/gait/turning_steps.py). "For a n-step turning process, we then
sum the alpha_i up to get the turning degree alpha for one foot. Then we use the mean of the two feet as the turning
degree." By theorem 1 the feet may point anywhere, as long as they keep doing so. It works on the strides of any recipe.

A wearer who turns on the spot hardly swings the feet. A foot that was flat, left the ground undetected and is flat
again, turned, has pivoted. That is no stride, but part of a turn."""

from __future__ import annotations

from math import pi

from ...events import StrideTaken
from ...types import Foot
from ...types.attrs import define, field, frozen
from .turning_steps import NO_TURN, TurningSteps

SHORTEST_PAUSE = 2.0
"""Least time without a foot-flat that ends a turn, s.

The pause is longer, up to `LONGEST_PAUSE`, after a turning stride that took longer together with the time before it."""
LONGEST_PAUSE = 4.0
"""Largest time without a foot-flat that ends a turn, s."""
STRAIGHT_STRIDES = 3
"""Number of straight strides that end a turn, of both feet where both give samples.

One foot may stride twice on the spot while the other turns."""


@frozen
class TurnProcess:
    """A turning process that is over; `left` and `right`: sum of each foot's turns, rad, None of an absent foot."""

    t_start: float
    """Start of the first turning stride, s."""
    t_end: float
    """End of the last turning stride, s."""
    left: float | None
    right: float | None

    @property
    def angle(self) -> float:
        """Mean turn of the feet that gave samples, rad, counter-clockwise positive."""
        known = [one for one in (self.left, self.right) if one is not None]
        return sum(known) / len(known)


@define
class FootTurn:
    """The turn of one foot in the turning process under way."""

    turning: TurningSteps = field(factory=TurningSteps)
    stride_end: float | None = None
    """End of its last stride, s."""
    angle: float = 0.0
    """Sum of the foot's turns, rad."""
    straight: int = 0
    """Number of straight strides since the foot's last turning stride."""


@define
class TurnDetector:
    """Detects whole turns from strides.

    Latency: a turn is known after `STRAIGHT_STRIDES` straight strides of the feet (two where only one foot gives
    samples), or after they have stood for `SHORTEST_PAUSE`."""

    left: FootTurn = field(factory=FootTurn, init=False)
    right: FootTurn = field(factory=FootTurn, init=False)
    t_start: float | None = field(default=None, init=False)
    """Start of the first turning stride of the process, s; None while the wearer goes straight on."""
    t_end: float = field(default=0.0, init=False)
    """End of the last turning stride, s."""
    pause: float = field(default=SHORTEST_PAUSE, init=False)
    """Time without a foot-flat that ends the turn under way, s."""
    previous_end: float | None = field(default=None, init=False)
    """End of the last turn that was reported, s."""

    def add_stride(self, taken: StrideTaken) -> TurnProcess | None:
        """Add one stride of either foot, in the order in which they became known; return the turn that it ends."""
        foot, other = self._feet(taken.foot)
        angle = foot.turning.turn(taken.heading_change)
        foot.stride_end = taken.t_end
        if angle != 0.0:
            return self._add_turn(foot, other, taken.t_start, taken.t_end, angle)
        foot.straight += 1
        if self.t_start is None:
            return None
        if other.stride_end is None or taken.t_end - other.stride_end > self.pause:
            return self._end_turn() if foot.straight > 1 else None
        both = other.straight > 0 and foot.straight + other.straight >= STRAIGHT_STRIDES
        return self._end_turn() if both or foot.straight >= STRAIGHT_STRIDES else None

    def add_pivot(self, foot: Foot, t_start: float, t_end: float, angle: float) -> TurnProcess | None:
        """Add a turn of `angle` rad between two foot-flats without a stride, s; return the turn that it ends.

        A small angle is ignored."""
        this, other = self._feet(foot)
        if abs(angle) <= NO_TURN:
            return None
        this.stride_end = t_end
        return self._add_turn(this, other, t_start, t_end, angle)

    def _feet(self, foot: Foot) -> tuple[FootTurn, FootTurn]:
        return (self.left, self.right) if foot is Foot.LEFT else (self.right, self.left)

    def _add_turn(
        self, foot: FootTurn, other: FootTurn, t_start: float, t_end: float, angle: float
    ) -> TurnProcess | None:
        over = None
        if self.t_start is not None and t_start - self.t_end > self.pause:
            over = self._end_turn()
        if self.t_start is None:
            # a wearer who stood for long did not turn meanwhile, nor before the last turn was over
            start = max(t_start, t_end - LONGEST_PAUSE)
            self.t_start = self.t_end = (
                start if self.previous_end is None else max(start, min(self.previous_end, t_end))
            )
            foot.angle = other.angle = 0.0
        foot.angle += angle
        foot.straight = other.straight = 0
        self.t_end = max(self.t_end, t_end)
        self.pause = min(max(SHORTEST_PAUSE, 0.8 * self.pause, t_end - t_start), LONGEST_PAUSE)
        return over

    def advance(self, t: float) -> TurnProcess | None:
        """Return the turn that is over at `t`, s, because no foot has strode since."""
        if self.t_start is None or t - self.t_end <= self.pause:
            return None
        newest = max(-1e12 if foot.stride_end is None else foot.stride_end for foot in (self.left, self.right))
        return self._end_turn() if t - newest > self.pause else None

    def finish(self) -> TurnProcess | None:
        """Return the turn under way: no more strides come."""
        return None if self.t_start is None else self._end_turn()

    def reset(self, foot: Foot) -> None:
        """Reset a foot whose clock restarts: a turn under way has no duration and is discarded."""
        self.t_start = self.previous_end = None
        (self.left if foot is Foot.LEFT else self.right).stride_end = None

    def _end_turn(self) -> TurnProcess:
        start = self.t_end if self.t_start is None else self.t_start
        found = TurnProcess(
            start, self.t_end, *without_whole_turns(self._angle_of(self.left, start), self._angle_of(self.right, start))
        )
        self.t_start, self.previous_end = None, self.t_end
        self.left.angle = self.right.angle = 0.0
        self.left.straight = self.right.straight = 0
        return found

    @staticmethod
    def _angle_of(foot: FootTurn, start: float) -> float | None:
        return None if foot.stride_end is None or foot.stride_end < start else foot.angle


def without_whole_turns(left: float | None, right: float | None) -> tuple[float | None, float | None]:
    """Return the turns of both feet, rad, with the whole turn removed by which they may differ.

    A stride's turn is known except for whole turns (StrideTaken.heading_change), and a wearer who turns about may swing
    a foot by more than half a turn: a difference between the feet of more than that is not real."""
    if left is None or right is None or abs(left - right) <= pi:
        return left, right
    whole = 2.0 * pi if left < right else -2.0 * pi
    to_left, to_right = (left + whole, right), (left, right - whole)
    return to_left if abs(sum(to_left)) <= abs(sum(to_right)) else to_right
