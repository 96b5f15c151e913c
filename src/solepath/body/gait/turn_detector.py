"""Detection of the wearer's turns from the strides of both feet (Liu et al. 2015, IEEE MASS, section IV.D).

Turning strides are separated from straight strides (body/gait/turning_steps.py). "For a n-step turning process, we then
sum the alpha_i up to get the turning degree alpha for one foot. Then we use the mean of the two feet as the turning
degree." By theorem 1 of the paper, the directions in which the feet point do not matter if they are constant. The
detector works on the strides of any recipe.

A wearer who turns on the spot hardly swings the feet. When a foot has turned between two foot-flats and no toe-off was
detected, it has pivoted. A pivot is not a stride, but part of a turn."""

from __future__ import annotations

from math import fsum, pi

from ...events import StrideTaken
from ...types import OTHER, Foot, PerFoot, per_foot
from ...types.attrs import define, field, frozen
from .turning_steps import STRAIGHT_TOLERANCE, TurningStrideFilter

MIN_PAUSE = 2.0
"""Least pause that ends a turn, s: a time without strides and pivots.

A turning stride that took longer, including the standing before it, makes the pause as long, up to `MAX_PAUSE`."""
MAX_PAUSE = 4.0
"""Longest pause that a turn needs to end, s."""
PAUSE_DECAY = 0.8
"""Factor by which each turning stride shortens a pause longer than `MIN_PAUSE`."""
STRAIGHT_STRIDES = 3
"""Number of straight strides that end a turn, counted over both feet when both have samples.

Two are too few, because one foot may take two strides on the spot while the other foot turns."""


@frozen
class TurnProcess:
    """A finished turning process: a sequence of turning strides and pivots without a pause."""

    t_start: float
    """Start of the first turning stride, s."""
    t_end: float
    """End of the last turning stride, s."""
    left: float | None
    """Sum of the left foot's turns, rad, counter-clockwise positive; None without samples."""
    right: float | None
    """Sum of the right foot's turns, rad, counter-clockwise positive; None without samples."""

    @property
    def angle(self) -> float:
        """Mean turn of the feet that have samples, rad, counter-clockwise positive."""
        angles = [angle for angle in (self.left, self.right) if angle is not None]
        return fsum(angles) / len(angles)


@define
class FootTurn:
    """The turn of one foot in the turning process under way."""

    stride_filter: TurningStrideFilter = field(factory=TurningStrideFilter)
    stride_end: float | None = None
    """End of the foot's last stride or pivot, s."""
    angle: float = 0.0
    """Sum of the foot's turns, rad."""
    straight_strides: int = 0
    """Number of straight strides since the foot's last turning stride."""


@define
class TurnDetector:
    """Detects turns, each from its first to its last turning stride.

    Latency: a turn is known after `STRAIGHT_STRIDES` straight strides of the feet (two strides when only one foot has
    samples), or after the feet have stood for `MIN_PAUSE`."""

    feet: PerFoot[FootTurn] = field(factory=lambda: per_foot(FootTurn), init=False)
    t_start: float | None = field(default=None, init=False)
    """Start of the first turning stride of the process, s; None outside a turn."""
    t_end: float = field(default=0.0, init=False)
    """End of the last turning stride, s."""
    pause: float = field(default=MIN_PAUSE, init=False)
    """Pause that ends the turn under way, s."""
    previous_end: float | None = field(default=None, init=False)
    """End of the previous turn, s; None before any."""

    def add_stride(self, event: StrideTaken) -> TurnProcess | None:
        """Add a stride of either foot, in order of `known_at`, and return the turn that it ends."""
        foot, other = self.feet[event.foot], self.feet[OTHER[event.foot]]
        angle = foot.stride_filter.turn(event.heading_change)
        foot.stride_end = event.t_end
        if angle != 0.0:
            return self._add_turn(foot, other, event.t_start, event.t_end, angle)
        foot.straight_strides += 1
        if self.t_start is None:
            return None
        if other.stride_end is None or event.t_end - other.stride_end > self.pause:
            return self._end_turn() if foot.straight_strides > 1 else None
        both_straight = (
            other.straight_strides > 0 and foot.straight_strides + other.straight_strides >= STRAIGHT_STRIDES
        )
        return self._end_turn() if both_straight or foot.straight_strides >= STRAIGHT_STRIDES else None

    def add_pivot(self, foot: Foot, t_start: float, t_end: float, angle: float) -> TurnProcess | None:
        """Add a pivot by `angle`, rad, between foot-flats at `t_start` and `t_end`, s; return the turn that it ends.

        A small angle is ignored."""
        this, other = self.feet[foot], self.feet[OTHER[foot]]
        if abs(angle) <= STRAIGHT_TOLERANCE:
            return None
        this.stride_end = t_end
        return self._add_turn(this, other, t_start, t_end, angle)

    def _add_turn(
        self, foot: FootTurn, other: FootTurn, t_start: float, t_end: float, angle: float
    ) -> TurnProcess | None:
        ended_turn = None
        if self.t_start is not None and t_start - self.t_end > self.pause:
            ended_turn = self._end_turn()
        if self.t_start is None:
            # leave out long standing before the first stride, and the time before the end of the previous turn
            start = max(t_start, t_end - MAX_PAUSE)
            self.t_start = self.t_end = (
                start if self.previous_end is None else max(start, min(self.previous_end, t_end))
            )
            foot.angle = other.angle = 0.0
        foot.angle += angle
        foot.straight_strides = other.straight_strides = 0
        self.t_end = max(self.t_end, t_end)
        self.pause = min(max(MIN_PAUSE, PAUSE_DECAY * self.pause, t_end - t_start), MAX_PAUSE)
        return ended_turn

    def advance(self, t: float) -> TurnProcess | None:
        """Return the turn that has ended at `t`, s, because the feet have paused."""
        if self.t_start is None or t - self.t_end <= self.pause:
            return None
        newest = max(-1e12 if foot.stride_end is None else foot.stride_end for foot in self.feet.values())
        return self._end_turn() if t - newest > self.pause else None

    def finish(self) -> TurnProcess | None:
        """Return the turn under way, because no more strides come."""
        return None if self.t_start is None else self._end_turn()

    def reset(self, foot: Foot) -> None:
        """Reset a foot whose clock restarts, and discard the turn under way."""
        self.t_start = self.previous_end = None
        self.feet[foot].stride_end = None

    def _end_turn(self) -> TurnProcess:
        start = self.t_end if self.t_start is None else self.t_start
        left, right = [self._angle_of(foot, start) for foot in self.feet.values()]
        process = TurnProcess(start, self.t_end, *remove_whole_turns(left, right))
        self.t_start, self.previous_end = None, self.t_end
        for foot in self.feet.values():
            foot.angle, foot.straight_strides = 0.0, 0
        return process

    @staticmethod
    def _angle_of(foot: FootTurn, start: float) -> float | None:
        return None if foot.stride_end is None or foot.stride_end < start else foot.angle


def remove_whole_turns(left: float | None, right: float | None) -> tuple[float | None, float | None]:
    """Return the turns of both feet, rad, without the whole turn by which they may differ.

    A stride's turn is known except for multiples of 2 pi (StrideTaken.heading_change), and a wearer who turns about may
    swing a foot by more than pi. A difference of more than pi between the feet is therefore not real."""
    if left is None or right is None or abs(left - right) <= pi:
        return left, right
    whole_turn = 2.0 * pi if left < right else -2.0 * pi
    corrected_left, corrected_right = (left + whole_turn, right), (left, right - whole_turn)
    return corrected_left if abs(fsum(corrected_left)) <= abs(fsum(corrected_right)) else corrected_right
