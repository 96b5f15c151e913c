"""Left, right and about turns, told apart by a linear classifier on what both feet turned (Liu et al. 2015,
IEEE MASS, section V.E: "we use the degree of both foot as features of the turn, and use SVM").

An about turn to the left and one to the right lie on both sides of everything else, which no line through the plane of
two angles parts; with their magnitudes beside them one does. Features of a turn, in half turns (rad / pi):
left, right, |left|, |right|, 1. The class is that of the largest of three linear functions of them. The weights come
from `python -m solepath.lab.train.turns`, which says what they were trained on; of a foot that was not heard the
other's angle is taken.
"""

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
from .direction import Direction, TurnProcess

SLIGHT = 0.61
"""A turn by less than this is a bend and none of the three: half-way between 0 and the 70 degrees that the slightest
turns to the side come to, rad."""

WEIGHTS: dict[Turn, tuple[float, float, float, float, float]] = {
    Turn.LEFT: (2.79, 1.82, -4.51, -5.9, 4.24),
    Turn.RIGHT: (-1.82, -2.79, -5.9, -4.51, 4.24),
    Turn.ABOUT: (-1.32, 1.32, 4.05, 4.05, -5.55),
}


def features(left: float, right: float) -> tuple[float, float, float, float, float]:
    """Of what the feet turned, rad."""
    x, y = left / pi, right / pi
    return (x, y, abs(x), abs(y), 1.0)


def classified(left: float | None, right: float | None) -> Turn | None:
    """The class of a turn by what each foot turned, rad; None of a slight one."""
    one = right if left is None else left
    other = left if right is None else right
    if one is None or other is None or abs(one + other) < 2.0 * SLIGHT:
        return None
    known = features(one, other)
    scores = {turn: sum(w * x for w, x in zip(weights, known, strict=True)) for turn, weights in WEIGHTS.items()}
    return max(scores, key=lambda turn: scores[turn])


@define
class Lain:
    """When a foot was last flat, s, and its attitude then, navigation frame."""

    since: float
    attitude: Quat


@define
class Turns(Part):
    """What the wearer's steps turned, and what the feet did between them. Latency: as `Direction` has it."""

    needs_samples: ClassVar[bool] = True

    direction: Direction = field(factory=Direction, init=False)
    lain: dict[Foot, Lain] = field(factory=dict, init=False)
    idle: bool = field(default=True, init=False)
    """No turn is under way."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """The turns that are over."""
        found: list[TurnProcess] = []
        known_at = view.t
        for event in view.events:
            turned = None
            if isinstance(event, StrideTaken):
                turned = self.direction.step(event)
            elif isinstance(event, FootFlat) and view.levelled:
                turned = self._flat(view, event)
            if turned is not None:
                known_at = event.known_at
                found.append(turned)
        if not found and self.direction.began is not None:
            turned = self.direction.stood(view.t)
            if turned is not None:
                known_at = view.known_at
                found.append(turned)
        self.idle = self.direction.began is None
        return [made(turned, known_at) for turned in found if abs(turned.angle) > 0.5 * SLIGHT]

    def _flat(self, view: FootView, event: FootFlat) -> TurnProcess | None:
        """A foot that is flat without a stride may have pivoted."""
        lay, now = self.lain.get(event.foot), view.after.stood
        self.lain[event.foot] = Lain(event.t, now)
        stepped = view.after.covariance is not None and any(
            [isinstance(one, StrideTaken) and one.t == event.t for one in view.events]
        )
        if lay is None or stepped or event.t < lay.since:
            return None
        return self.direction.pivot(event.foot, lay.since, event.t, heading_turned(lay.attitude, now))

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Nobody steps any more: the turn under way, if any, is over."""
        turned = self.direction.finish()
        return [] if turned is None or abs(turned.angle) <= 0.5 * SLIGHT else [made(turned, now)]

    def reset(self, site: Site) -> None:
        """The clock of a site's samples restarts."""
        if site.foot is not None:
            self.direction.reset(site.foot)
            self.idle = True
            self.lain.pop(site.foot, None)


def made(turned: TurnProcess, known_at: float) -> TurnMade:
    """The event of a turn that was known at `known_at`, s."""
    return TurnMade(
        t=turned.t_end,
        known_at=max(known_at, turned.t_end),
        t_start=turned.t_start,
        angle=turned.angle,
        turn=classified(turned.left, turned.right),
    )
