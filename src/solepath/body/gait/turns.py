"""Classification of the wearer's turns as left turns, right turns and about-turns, from the angles of both feet.

Liu et al. 2015, IEEE MASS, section V.E: "we use the degree of both foot as features of the turn, and use SVM". A
linear classifier on the two angles cannot recognise about-turns, because they have larger angles than the turns to
either side. It can when the sizes of the angles are features too. The features of a turn are left, right, |left|,
|right| (in rad / pi) and 1. The class is the one whose linear function of the features is largest. The weights come
from `solepath-lab train turns`, which lists the training data. For a foot without samples, the other foot's
angle is used."""

from __future__ import annotations

from math import fsum, pi

from ...events import DefectFound, FootFlat, HeelOff, StrideTaken, TurnMade
from ...foot.view import AfterEvents, FootView
from ...types import OTHER, Foot, PerFoot, Quat, Site, Turn, per_foot
from ...types.attrs import define, field, frozen, state, stateful
from ...types.vector import heading_turned
from ..part import Inputs, Outputs, Part, PartOutput

# Separation of turning strides from straight strides (Liu et al. 2015, IEEE MASS, section IV.D).
#
# "FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The
# paper gives no filter. A foot's turn in a straight stride is not zero: it is a usual turn of that foot (by the motion
# of the ankle while the foot is off the ground) plus noise. A low-pass filter of the turns estimates the usual turn. A
# stride whose turn differs from it by more than `STRAIGHT_TOLERANCE` is a turning stride, and the path turns by the
# difference. Any other stride is straight.
#
# That loses two things, which `corner_turn` keeps. A filter that learns from turning strides learns a curve: after ten
# strides on a circle of 6 m radius, 15 degrees each, the circle is straight and the way after it bends. So only
# straight strides are learnt from. And a corner starts and ends with strides that turn by less than the tolerance, so
# it comes out too small. So the stride before and the stride after a turning one turn the path as well.

STRAIGHT_TOLERANCE = 0.12
"""Largest deviation of a straight stride from the usual turn, rad.

In recordings its standard deviation is 3 degrees. On a circle of 7 m radius a stride turns by 11 degrees."""
MAX_FILTERED_DEVIATION = 0.35
"""Limit of the deviation from the usual turn below which a stride updates that turn, rad."""
STRIDE_WEIGHT = 0.1
"""Weight of one stride in the low-pass filter."""
MAX_STRAIGHT_TURN = 0.3
"""Largest size of the estimated usual turn, rad."""


@stateful
class TurningStrideFilter:
    """The low-pass filter of one foot's turns; time and memory are O(1), and there is no latency."""

    straight_turn: float = 0.0
    """Usual turn of a straight stride, rad, counter-clockwise positive."""

    straight_deviation: float | None = 0.0
    """Deviation of the last stride from the usual turn, rad, or 0; None when the path has turned with it."""

    def turn(self, angle: float) -> float:
        """Add a stride that turned by `angle`, rad, and return the turn of the path, rad; 0 for a straight stride."""
        deviation = self._learn(angle, MAX_FILTERED_DEVIATION)
        return deviation if abs(deviation) > STRAIGHT_TOLERANCE else 0.0

    def corner_turn(self, angle: float) -> float:
        """Add a stride that turned by `angle`, rad, and return the turn of the path since the last one, rad.

        It includes the strides beside a turning stride. A usual turn above `STRAIGHT_TOLERANCE` is not learnt."""
        deviation, before = self._learn(angle, STRAIGHT_TOLERANCE), self.straight_deviation
        if abs(deviation) > STRAIGHT_TOLERANCE:
            self.straight_deviation = None
            return deviation + (before or 0.0)
        if before is None:
            self.straight_deviation = 0.0
            return deviation
        self.straight_deviation = deviation
        return 0.0

    def forget_corner(self) -> None:
        """Forget the last stride, which the next one does not follow."""
        self.straight_deviation = 0.0

    def _learn(self, angle: float, within: float) -> float:
        """Return the deviation from the usual turn, which it updates if it is below `within`; both in rad."""
        deviation = angle - self.straight_turn
        if abs(deviation) < within:
            self.straight_turn = min(
                max(self.straight_turn + STRIDE_WEIGHT * deviation, -MAX_STRAIGHT_TURN), MAX_STRAIGHT_TURN
            )
        return deviation


# Detection of the wearer's turns from the strides of both feet (Liu et al. 2015, IEEE MASS, section IV.D).
#
# Turning strides are separated from straight strides as above. "For a n-step turning process, we then
# sum the alpha_i up to get the turning degree alpha for one foot. Then we use the mean of the two feet as the turning
# degree." By theorem 1 of the paper, the directions in which the feet point do not matter if they are constant. The
# detector works on the strides of any recipe.
#
# A wearer who turns on the spot hardly swings the feet, and such steps may be no strides. When a foot has turned
# between two foot-flats without a stride, it has pivoted. A pivot is not a stride, but part of a turn. The first
# strides of a bout become known later than their foot-flats, with which they have been taken for pivots. They count
# once.

MIN_PAUSE = 2.0
"""Least pause that ends a turn, s: a time without strides and pivots.

A turning stride that took longer, including the standing before it, makes the pause as long, up to `MAX_PAUSE`."""
MAX_PAUSE = 4.0
"""Longest pause that a turn needs to end, s."""
PAUSE_DECAY = 0.8
"""Factor by which each turning stride shortens a pause longer than `MIN_PAUSE`."""
KEPT_PIVOTS = 4
"""Number of pivots of a foot that may turn out to be strides: those that come late are the first few of a bout."""
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
    pivots: list[float] = field(factory=list)
    """Ends of the newest `KEPT_PIVOTS` pivots, s."""


@stateful
class TurnDetector:
    """Detects turns, each from its first to its last turning stride.

    Latency: a turn is known after `STRAIGHT_STRIDES` straight strides of the feet (two strides when only one foot has
    samples), or after the feet have stood for `MIN_PAUSE`."""

    feet: PerFoot[FootTurn] = state(factory=lambda: per_foot(FootTurn))
    t_start: float | None = None
    """Start of the first turning stride of the process, s; None outside a turn."""
    t_end: float = 0.0
    """End of the last turning stride, s."""
    pause: float = MIN_PAUSE
    """Pause that ends the turn under way, s."""
    previous_end: float | None = None
    """End of the previous turn, s; None before any."""

    def add_stride(self, event: StrideTaken) -> TurnProcess | None:
        """Add a stride of either foot, in order of `known_at`, and return the turn that it ends."""
        foot, other = self.feet[event.foot], self.feet[OTHER[event.foot]]
        angle = foot.stride_filter.turn(event.heading_change)
        if event.t_end in foot.pivots:
            return None
        # the first strides of a bout are known late
        foot.stride_end = event.t_end if foot.stride_end is None else max(event.t_end, foot.stride_end)
        if angle != 0.0:
            return self._add_turn(foot, other, event.t_start, event.t_end, angle)
        foot.straight_strides += 1
        if self.t_start is None:
            return None
        if other.stride_end is None or event.t_end - other.stride_end > self.pause:
            return self._end_turn(self.t_start) if foot.straight_strides > 1 else None
        both_straight = (
            other.straight_strides > 0 and foot.straight_strides + other.straight_strides >= STRAIGHT_STRIDES
        )
        is_straight = both_straight or foot.straight_strides >= STRAIGHT_STRIDES
        return self._end_turn(self.t_start) if is_straight else None

    def add_pivot(self, foot: Foot, t_start: float, t_end: float, angle: float) -> TurnProcess | None:
        """Add a pivot by `angle`, rad, between foot-flats at `t_start` and `t_end`, s; return the turn that it ends.

        A small angle is ignored."""
        this, other = self.feet[foot], self.feet[OTHER[foot]]
        if abs(angle) <= STRAIGHT_TOLERANCE:
            return None
        this.stride_end = t_end
        this.pivots = [*this.pivots[1 - KEPT_PIVOTS :], t_end]
        return self._add_turn(this, other, t_start, t_end, angle)

    def _add_turn(
        self, foot: FootTurn, other: FootTurn, t_start: float, t_end: float, angle: float
    ) -> TurnProcess | None:
        ended_turn = None
        if self.t_start is not None and t_start - self.t_end > self.pause:
            ended_turn = self._end_turn(self.t_start)
        if self.t_start is None:
            # leave out long standing before the first stride, and the time before the end of the previous turn
            earliest = t_start if self.previous_end is None else min(self.previous_end, t_end)
            self.t_start = self.t_end = max(t_start, t_end - MAX_PAUSE, earliest)
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
        is_past = all([foot.stride_end is None or t - foot.stride_end > self.pause for foot in self.feet.values()])
        return self._end_turn(self.t_start) if is_past else None

    def finish(self) -> TurnProcess | None:
        """Return the turn under way, because no more strides come."""
        return None if self.t_start is None else self._end_turn(self.t_start)

    def reset(self, foot: Foot) -> None:
        """Reset a foot whose clock restarts or that wears another device, and discard the turn under way."""
        self.t_start = self.previous_end = None
        self.feet[foot].stride_end, self.feet[foot].pivots = None, []

    def leave_out(self, foot: Foot) -> None:
        """Leave out a foot whose data cannot be right, and the turn under way if it alone showed it."""
        self.feet[foot], other_end = FootTurn(), self.feet[OTHER[foot]].stride_end
        if self.t_start is not None and (other_end is None or other_end < self.t_start):
            self.t_start = None

    def _end_turn(self, start: float) -> TurnProcess:
        """Return the turn under way, which began at `start`, s."""
        feet = self.feet.values()
        left, right = [None if foot.stride_end is None or foot.stride_end < start else foot.angle for foot in feet]
        self.t_start, self.previous_end = None, self.t_end
        for foot in feet:
            foot.angle, foot.straight_strides = 0.0, 0
        return TurnProcess(start, self.t_end, *remove_whole_turns(left, right))


def remove_whole_turns(left: float | None, right: float | None) -> tuple[float | None, float | None]:
    """Return the turns of both feet, rad, without the whole turn by which they may differ.

    A stride's turn is known except for multiples of 2 pi (StrideTaken.heading_change), and a wearer who turns about may
    swing a foot by more than pi. A difference of more than pi between the feet is therefore not real."""
    if left is None or right is None or abs(left - right) <= pi:
        return left, right
    whole_turn = 2.0 * pi if left < right else -2.0 * pi
    corrected_left, corrected_right = (left + whole_turn, right), (left, right - whole_turn)
    return corrected_left if abs(fsum(corrected_left)) <= abs(fsum(corrected_right)) else corrected_right


MIN_CLASSIFIED_TURN = 0.61
"""Least mean angle of both feet for a turn that has a class, rad; a smaller turn is a bend.

It is 35 degrees; in the training data the smallest turn to a side is one of 59 degrees."""
MIN_REPORTED_TURN = 0.5 * MIN_CLASSIFIED_TURN
"""Angle of a turn above which it is reported, rad."""
WEIGHTS: dict[Turn, tuple[float, float, float, float, float]] = {
    Turn.LEFT: (2.79, 1.82, -4.51, -5.9, 4.24),
    Turn.RIGHT: (-1.82, -2.79, -5.9, -4.51, 4.24),
    Turn.ABOUT: (-1.32, 1.32, 4.05, 4.05, -5.55),
}
"""Weights of the five features for each class."""


def features(left: float, right: float) -> tuple[float, float, float, float, float]:
    """Return the features of a turn from the angles of both feet, rad."""
    x, y = left / pi, right / pi
    return (x, y, abs(x), abs(y), 1.0)


def classify(left: float | None, right: float | None) -> Turn | None:
    """Return the class of a turn from the feet's angles, rad (None: no samples); None for a bend."""
    left = right if left is None else left
    right = left if right is None else right
    if left is None or right is None or abs(left + right) < 2.0 * MIN_CLASSIFIED_TURN:
        return None
    values = features(left, right)
    scores = {turn: fsum(w * x for w, x in zip(weights, values, strict=True)) for turn, weights in WEIGHTS.items()}
    return max(scores, key=lambda turn: scores[turn])


@define
class FlatFoot:
    """The newest foot-flat of a foot: time, s, and attitude (sensor frame to navigation frame)."""

    t: float
    attitude: Quat


@stateful
class Turns(Part):
    """Detects and classifies turns from strides and pivots; see `TurnDetector` for the latency."""

    needs_samples = True

    detector: TurnDetector = state(factory=TurnDetector)
    last_flat: dict[Foot, FlatFoot] = state(factory=dict)
    """Newest foot-flat of each foot."""
    spoilt: list[Foot] = state(factory=list)
    """Feet whose data cannot be right, so that they show no turns."""
    idle: bool = True
    """Flag: no turn is under way."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a sample of a foot with its events and return the turns that have ended."""
        for found in events:
            if isinstance(found, DefectFound) and (foot := found.spoilt_foot) is not None and foot not in self.spoilt:
                self.spoilt.append(foot)
                self.detector.leave_out(foot)
        if view is None:
            return ()
        outputs: list[PartOutput] = []
        for event in () if view.foot in self.spoilt else events:
            ended = None
            if isinstance(event, StrideTaken):
                ended = self.detector.add_stride(event)
            elif isinstance(event, FootFlat) and view.levelled and view.after is not None:
                ended = self._add_foot_flat(events, view.after, event)
            elif isinstance(event, HeelOff) and view.levelled and view.after is not None:
                # before its first step the foot stands without a foot-flat
                self.last_flat.setdefault(event.foot, FlatFoot(event.t, view.after.flat_attitude))
            if ended is not None:
                outputs += turn_made(ended, view.known_at)
        if not outputs and self.detector.t_start is not None:
            outputs = turn_made(self.detector.advance(view.t), view.known_at)
        self.idle = self.detector.t_start is None
        return outputs

    def _add_foot_flat(self, events: Inputs, after: AfterEvents, event: FootFlat) -> TurnProcess | None:
        """Add a foot-flat, before which the foot may have pivoted without a stride."""
        previous, attitude = self.last_flat.get(event.foot), after.flat_attitude
        self.last_flat[event.foot] = FlatFoot(event.t, attitude)
        if previous is None or event.t < previous.t:
            return None
        for other in events:
            if isinstance(other, StrideTaken) and other.t == event.t:
                return None
        return self.detector.add_pivot(event.foot, previous.t, event.t, heading_turned(previous.attitude, attitude))

    def finish(self, now: float) -> Outputs:
        """Return the turn under way, if any, because no more samples come."""
        return turn_made(self.detector.finish(), now)

    def reset(self, site: Site) -> None:
        """Reset a foot whose clock restarts or that wears another device."""
        if site.foot is not None:
            self.detector.reset(site.foot)
            self.idle = True
            self.last_flat.pop(site.foot, None)
            self.spoilt = [foot for foot in self.spoilt if foot is not site.foot]


def turn_made(process: TurnProcess | None, known_at: float) -> list[PartOutput]:
    """Return the event of a turn that has ended, if one has and it is large enough."""
    if process is None or abs(process.angle) <= MIN_REPORTED_TURN:
        return []
    known_at = max(known_at, process.t_end)
    turn = classify(process.left, process.right)
    return [TurnMade(t=process.t_end, known_at=known_at, t_start=process.t_start, angle=process.angle, turn=turn)]
