"""Scores what a person who says where they are is worth on long emulated walks (heading_walks.py).

Places are true, but for a normal error of 1 m on each axis, and in the session's world frame: turned by the error of
the attitudes of both feet after their first strides. Three sessions share a walk of half an hour: nothing is reported;
one place after 15 minutes; places after 10 and 20 minutes and at the end. A place that is wrong is 20 m off in a random
direction, and is reported to a copy of a session. The figures are

- `end_without`, `end_return`: distance from the truth at the end without a place, and with the one after 15 minutes, m
- `way_places`: mean distance from the truth along the way with three places, after the last revision, m
- `nees_return`, `held_return`: NEES/2 at the end after the one place (consistency.py), and 1 if the ellipse held
- `rejected_first`, `rejected_later`: 1 if a place that is wrong is rejected after 10 minutes without any other, and 10
  minutes after a right one
- `used`: share of right places that are used"""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import numpy as np
from attrs import define, field

from solepath.emulate.walk import SampledWalk
from solepath.events import PositionRejected, StrideTaken, TrackRevised
from solepath.session import Session
from solepath.show.page.scene.bending import bend_of, bent
from solepath.show.page.scene.lists import TrackPoint
from solepath.validate.alignment import Floats

from ..evaluate.run import Meta, RunSettings
from ..measures.consistency import consistency, matrix, rotation
from ..measures.score import Figures, Scored
from .heading import emulated_walk, follow, middle
from .heading_walks import IsComplete

REPORT_SIGMA, WRONG = 1.0, 20.0
"""Standard deviation of a place on each axis, m, and distance of one that is wrong, m."""
TIMES = (600.0, 900.0, 1200.0)
"""Times of the first place, of the one place, and of the second place, s."""
FIRST_STRIDES = 20.0
"""Time by which both feet have taken strides, s."""


@define
class Reported:
    """A session with reported places, and the wearer's track as a person sees it in the end."""

    session: Session
    points: list[TrackPoint] = field(factory=list)
    used: list[bool] = field(factory=list)

    def feed(self, walk: SampledWalk, since: float, until: float) -> None:
        """Feed the samples from `since` to before `until`, s."""
        for sample in walk.samples:
            if since <= sample.t < until and any(isinstance(e, StrideTaken) for e in self.session.feed(sample)):
                here = self.session.position
                if here is not None:
                    self.points.append((here.t, *here.position))

    def report(self, place: tuple[float, float]) -> None:
        """Report a place, m, and revise the track if it is used."""
        events = self.session.here(place, REPORT_SIGMA)
        for event in events:
            if isinstance(event, TrackRevised):
                self.points = bent(self.points, bend_of(event, self.points))
        self.used.append(any(isinstance(event, TrackRevised) for event in events))

    def rejects(self, place: tuple[float, float]) -> float:
        """Return 1 if a copy of the session rejects a place, m, otherwise 0."""
        return float(
            any(isinstance(event, PositionRejected) for event in self.copy().session.here(place, REPORT_SIGMA))
        )

    def copy(self) -> Reported:
        """Return a copy that goes on by itself."""
        return Reported(Session.unpack(self.session.pack(), self.session.recipe), list(self.points), list(self.used))


def score_reports(
    kind: str, is_complete: IsComplete, times: tuple[float, float, float], path: Path, meta: Meta, settings: RunSettings
) -> Scored:
    """Score a walk of a kind of routes and of the seed in the entry `meta`, with places at these `times`, s."""
    seed: int = meta["seed"]
    walk, rng = emulated_walk(kind, is_complete, seed), np.random.default_rng([seed, 40])
    first, once, second = times
    end = walk.truth.duration + 1.0
    turn = follow(Session(settings.recipe), walk, FIRST_STRIDES).headings[0]
    to_truth = rotation(turn)

    def truth_at(t: Floats) -> Floats:
        """Return where the wearer is at times `t`, s, in the session's world frame, (N, 2), m."""
        return np.asarray((middle(walk.truth, t) - middle(walk.truth, np.zeros(1)))[:, :2] @ to_truth)

    def place(t: float, off: float = 0.0) -> tuple[float, float]:
        angle = rng.uniform(0.0, 2.0 * pi)
        x, y = truth_at(np.array([t]))[0] + rng.normal(0.0, REPORT_SIGMA, 2) + off * np.array([cos(angle), sin(angle)])
        return float(x), float(y)

    def errors(one: Reported) -> Floats:
        points = np.array([point[:3] for point in one.points], dtype=np.float64)
        return np.asarray(points[:, 1:] - truth_at(points[:, 0]))

    plain = Reported(Session(settings.recipe, calibration=settings.calibration))
    plain.feed(walk, 0.0, first)
    places, rejected_first = plain.copy(), plain.rejects(place(first, WRONG))
    plain.feed(walk, first, once)
    back = plain.copy()
    plain.feed(walk, once, end)
    back.report(place(once))
    back.feed(walk, once, end)
    places.report(place(first))
    places.feed(walk, first, second)
    rejected_later = places.rejects(place(second, WRONG))
    places.report(place(second))
    places.feed(walk, second, end)
    places.report(place(places.points[-1][0] or second))
    here = back.session.position
    if here is None:
        return Scored(path.stem)
    xx, xy, _, yy, _, _ = here.covariance
    nees, held = consistency(errors(back)[-1], matrix((xx, xy, yy)))
    figures: Figures = {
        "end_without": float(np.hypot(*errors(plain)[-1])),
        "end_return": float(np.hypot(*errors(back)[-1])),
        "way_places": float(np.mean(np.hypot(*errors(places).T))),
        "nees_return": nees,
        "held_return": held,
        "rejected_first": rejected_first,
        "rejected_later": rejected_later,
        "used": float(np.mean(back.used + places.used)),
    }
    return Scored(path.stem, figures=figures)
