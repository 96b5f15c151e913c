"""Classification of turns: left, right or about, by a linear classifier on the turns of both feet.

Liu et al. 2015, IEEE MASS, section V.E: "we use the degree of both foot as features of the turn, and use SVM". About
turns to the left and to the right lie on both sides of all others, which no line in the plane of the two angles
separates; with their magnitudes as features one does. Features of a turn, in half turns (rad / pi): left, right,
|left|, |right|, 1. The class is that of the largest of three linear functions of them. The weights come from `python -m
solepath.lab.train.turns`, which lists the training data. For a foot without samples the other foot's angle is used."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import ClassVar

from ...events import FootFlat, StrideTaken, TurnMade
from ...foot.view import FootView
from ...types import Foot, Quat, Site, Turn
from ...types.attrs import define, field
from ...types.vector import heading_turned
from ..part import Part, PartOutput
from .turn_detector import TurnDetector, TurnProcess

LEAST_TURN = 0.61
"""Angle below which a turn is a bend and has no class, rad.

It is half-way between 0 and the 70 degrees of the slightest turns to the side."""

WEIGHTS: dict[Turn, tuple[float, float, float, float, float]] = {
    Turn.LEFT: (2.79, 1.82, -4.51, -5.9, 4.24),
    Turn.RIGHT: (-1.82, -2.79, -5.9, -4.51, 4.24),
    Turn.ABOUT: (-1.32, 1.32, 4.05, 4.05, -5.55),
}
"""Weights of the five features for each class."""


def features(left: float, right: float) -> tuple[float, float, float, float, float]:
    """Return the features of a turn by the angles of both feet, rad."""
    x, y = left / pi, right / pi
    return (x, y, abs(x), abs(y), 1.0)


def classify(left: float | None, right: float | None) -> Turn | None:
    """Return the class of a turn by the angles of both feet, rad; None for a slight one."""
    one = right if left is None else left
    other = left if right is None else right
    if one is None or other is None or abs(one + other) < 2.0 * LEAST_TURN:
        return None
    known = features(one, other)
    scores = {turn: sum(w * x for w, x in zip(weights, known, strict=True)) for turn, weights in WEIGHTS.items()}
    return max(scores, key=lambda turn: scores[turn])


@define
class FlatFoot:
    """The newest foot-flat of a foot: its time, s, and the attitude at it, navigation frame."""

    t: float
    attitude: Quat


@define
class Turns(Part):
    """Detects and classifies turns from strides and from the pivots between them; latency: see `TurnDetector`."""

    needs_samples: ClassVar[bool] = True

    detector: TurnDetector = field(factory=TurnDetector, init=False)
    last_flat: dict[Foot, FlatFoot] = field(factory=dict, init=False)
    """Newest foot-flat of each foot."""
    idle: bool = field(default=True, init=False)
    """Flag: no turn is under way."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add one sample of a foot with its events, and return the turns that are over."""
        found: list[TurnProcess] = []
        known_at = view.t
        for event in view.events:
            turned = None
            if isinstance(event, StrideTaken):
                turned = self.detector.add_stride(event)
            elif isinstance(event, FootFlat) and view.levelled:
                turned = self._flat(view, event)
            if turned is not None:
                known_at = event.known_at
                found.append(turned)
        if not found and self.detector.t_start is not None:
            turned = self.detector.advance(view.t)
            if turned is not None:
                known_at = view.known_at
                found.append(turned)
        self.idle = self.detector.t_start is None
        return [turn_event(turned, known_at) for turned in found if abs(turned.angle) > 0.5 * LEAST_TURN]

    def _flat(self, view: FootView, event: FootFlat) -> TurnProcess | None:
        """Add a foot-flat: without a stride the foot may have pivoted."""
        before, now = self.last_flat.get(event.foot), view.after.stood
        self.last_flat[event.foot] = FlatFoot(event.t, now)
        stepped = view.after.covariance is not None and any(
            [isinstance(one, StrideTaken) and one.t == event.t for one in view.events]
        )
        if before is None or stepped or event.t < before.t:
            return None
        return self.detector.add_pivot(event.foot, before.t, event.t, heading_turned(before.attitude, now))

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the turn under way, if any: no more samples come."""
        turned = self.detector.finish()
        return [] if turned is None or abs(turned.angle) <= 0.5 * LEAST_TURN else [turn_event(turned, now)]

    def reset(self, site: Site) -> None:
        """Reset a foot whose clock restarts."""
        if site.foot is not None:
            self.detector.reset(site.foot)
            self.idle = True
            self.last_flat.pop(site.foot, None)


def turn_event(turned: TurnProcess, known_at: float) -> TurnMade:
    """Return the event of a turn that was known at `known_at`, s."""
    return TurnMade(
        t=turned.t_end,
        known_at=max(known_at, turned.t_end),
        t_start=turned.t_start,
        angle=turned.angle,
        turn=classify(turned.left, turned.right),
    )
