"""Classification of the wearer's turns as left turns, right turns and about-turns, from the angles of both feet.

Liu et al. 2015, IEEE MASS, section V.E: "we use the degree of both foot as features of the turn, and use SVM". A
linear classifier on the two angles cannot recognise about-turns, because they have larger angles than the turns to
either side. It can when the sizes of the angles are features too. The features of a turn are left, right, |left|,
|right| (in rad / pi) and 1. The class is the one whose linear function of the features is largest. The weights come
from `python -m solepath.lab.train.turns`, which lists the training data. For a foot without samples, the other foot's
angle is used."""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum, pi
from typing import ClassVar

from ...events import FootFlat, StrideTaken, TurnMade
from ...foot.view import AfterEvents, FootView
from ...types import Foot, Quat, Site, Turn
from ...types.attrs import define, field
from ...types.vector import heading_turned
from ..part import Part, PartInput, PartOutput
from .turn_detector import TurnDetector, TurnProcess

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
    known_left = right if left is None else left
    known_right = left if right is None else right
    if known_left is None or known_right is None or abs(known_left + known_right) < 2.0 * MIN_CLASSIFIED_TURN:
        return None
    values = features(known_left, known_right)
    scores = {turn: fsum(w * x for w, x in zip(weights, values, strict=True)) for turn, weights in WEIGHTS.items()}
    return max(scores, key=lambda turn: scores[turn])


@define
class FlatFoot:
    """The newest foot-flat of a foot: time, s, and attitude (sensor frame to navigation frame)."""

    t: float
    attitude: Quat


@define
class Turns(Part):
    """Detects and classifies turns from strides and pivots; see `TurnDetector` for the latency."""

    needs_samples: ClassVar[bool] = True

    detector: TurnDetector = field(factory=TurnDetector, init=False)
    last_flat: dict[Foot, FlatFoot] = field(factory=dict, init=False)
    """Newest foot-flat of each foot."""
    idle: bool = field(default=True, init=False)
    """Flag: no turn is under way."""

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add a sample of a foot with its events and return the turns that have ended."""
        if view is None:
            return ()
        ended_turns: list[TurnProcess] = []
        known_at = view.known_at
        for event in events:
            process = None
            if isinstance(event, StrideTaken):
                process = self.detector.add_stride(event)
            elif isinstance(event, FootFlat) and view.levelled and view.after is not None:
                process = self._add_foot_flat(events, view.after, event)
            if process is not None:
                ended_turns.append(process)
        if not ended_turns and self.detector.t_start is not None:
            process = self.detector.advance(view.t)
            if process is not None:
                ended_turns.append(process)
        self.idle = self.detector.t_start is None
        return [turn_event(process, known_at) for process in ended_turns if abs(process.angle) > MIN_REPORTED_TURN]

    def _add_foot_flat(self, events: Sequence[PartInput], after: AfterEvents, event: FootFlat) -> TurnProcess | None:
        """Add a foot-flat, before which the foot may have pivoted without a stride."""
        previous, attitude = self.last_flat.get(event.foot), after.flat_attitude
        self.last_flat[event.foot] = FlatFoot(event.t, attitude)
        has_stride = any([isinstance(other, StrideTaken) and other.t == event.t for other in events])
        if previous is None or has_stride or event.t < previous.t:
            return None
        return self.detector.add_pivot(event.foot, previous.t, event.t, heading_turned(previous.attitude, attitude))

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the turn under way, if any, because no more samples come."""
        process = self.detector.finish()
        return [] if process is None or abs(process.angle) <= MIN_REPORTED_TURN else [turn_event(process, now)]

    def reset(self, site: Site) -> None:
        """Reset a foot whose clock restarts."""
        if site.foot is not None:
            self.detector.reset(site.foot)
            self.idle = True
            self.last_flat.pop(site.foot, None)


def turn_event(process: TurnProcess, known_at: float) -> TurnMade:
    """Return the event of a finished turn."""
    return TurnMade(
        t=process.t_end,
        known_at=max(known_at, process.t_end),
        t_start=process.t_start,
        angle=process.angle,
        turn=classify(process.left, process.right),
    )
