"""Scores the session's position after long walks of emulated wearers. Scorers have the form that datasets.py describes.

Both feet wear insoles of 96 cells (odd seeds) or 24 (even ones) with the errors of an LSM6DSOX, at 100 Hz; the session
receives their samples as over a perfect link. Route, gait and devices are all drawn from the seed. Score seeds from 1
to 50; tune on seeds from 101 on.

The position is `session.position`, twice a second, compared with the mean of the true positions of both sensors. A
track has its own heading and origin, so one turn about the vertical and one shift, by least squares over the first
ALIGNED m, align it with the truth. Then `position_end` is the horizontal distance at the end and `position_max` the
largest one, in m; `end_relative` and `largest_relative` are the same two as shares of the path length. So the heading
error after ALIGNED m counts over the rest of the walk. `rms_2d` is what remains after the best turn and shift over the
whole walk, as for a VICON track. Heights are compared as they are, from the first: `height_end` is the error at the
end, `height_max` the largest one."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from pathlib import Path

import numpy as np

from ...emulate.routes.path import ahead
from ...emulate.routes.route import Route
from ...emulate.sensors.insole_device import Insole
from ...emulate.walk import sampled
from ...emulate.wearers.gait import Wearer
from ...emulate.wearers.truth import Truth
from ...session import Session
from ...types import SITE_OF_FOOT, Foot, Site
from ..evaluate.run import Meta, RunSettings, run_timed
from ..measures.alignment import Floats, aligned_at_start, distances, track_error
from ..measures.matching import Matching
from ..measures.score import Figures, Scored
from ..measures.strides import StrideScore
from .compare import compare

ALIGNED = 10.0
"""Length of path over which a track is aligned with the truth, m."""
EVERY = 0.5
"""Interval between positions, s."""
LONG_WAY = 500.0
"""Shortest length of the long walk, m."""
HALF_HOUR = 1800.0
"""Shortest duration of the half-hour walk, s."""
STILL = 3.0
"""Duration of standing at the start, at the end, and at every halt, s."""
BETWEEN_HALTS = 150.0
"""Approximate distance between two halts, m."""
FLOORS = 4
RISERS, RISE, GOING = 10, 0.16, 0.30
"""Number, height (m) and depth (m) of the steps in each of a storey's two flights: 3.2 m from floor to floor."""
LANDING = 1.0
"""Length of a landing before and after its turn, m; the turn's radius is 0.7 of it."""


def long_way(seed: int) -> Route:
    """Return a route of 500 m plus the rest of its last straight: straights of 8 to 40 m between turns."""
    return _wandered(seed, lambda length, seconds: length >= LONG_WAY)


def half_hour(seed: int) -> Route:
    """Return a route of straights and turns for thirty minutes of walking and halts, about 2 km."""
    return _wandered(seed, lambda length, seconds: seconds >= HALF_HOUR)


def four_floors(seed: int) -> Route:
    """Return a route up four storeys, to and fro along a corridor, and down; two flights and a landing a storey."""
    rng = np.random.default_rng([seed, 11])
    side = 0.5 * pi if rng.uniform() < 0.5 else -0.5 * pi
    speed = float(rng.uniform(1.1, 1.4))
    route = Route(speed=speed).stand(STILL).walk(12.0)
    for up in (True, False):
        for _ in range(FLOORS):
            for _ in range(2):
                route = route.walk(LANDING).stairs(RISERS, up, RISE, GOING).walk(LANDING + ahead(up, GOING))
                route = route.turn(2.0 * side, 0.7 * LANDING)
        if up:
            route = route.walk(10.0).turn(pi).walk(10.0)
    return route.walk(6.0).stop(STILL)


def _wandered(seed: int, enough: Callable[[float, float], bool]) -> Route:
    rng = np.random.default_rng([seed, 10])
    speed = float(rng.uniform(1.1, 1.5))
    route, length, seconds, halted = Route(speed=speed).stand(STILL), 0.0, STILL, 0.0
    while True:
        straight = float(rng.uniform(8.0, 40.0))
        route, length, seconds = route.walk(straight), length + straight, seconds + straight / speed
        if enough(length, seconds):
            return route.stop(STILL)
        if length - halted > BETWEEN_HALTS:
            route, seconds, halted = route.stand(STILL), seconds + STILL, length
        angle = float(rng.choice((0.5, 0.25, 1.0), p=(0.6, 0.2, 0.2)) * rng.choice((pi, -pi)))
        radius = float(rng.uniform(0.6, 2.5))
        route, length = route.turn(angle, radius), length + abs(angle) * radius
        seconds += abs(angle) * radius / (speed if radius >= 1.0 else min(speed, 0.8))


def worn(seed: int) -> dict[Site, Insole]:
    """Return the insoles of a seed's wearer."""
    return {SITE_OF_FOOT[foot]: Insole(cells=96 if seed % 2 else 24) for foot in Foot}


def score_way(way: Callable[[int], Route], path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the route of the seed in the entry `meta`; `way` is one of the routes above."""
    seed: int = meta["seed"]
    walked = sampled(way(seed), wearer=Wearer(), insoles=worn(seed), seed=seed)
    session, truth = Session(settings.recipe, calibration=settings.calibration), walked.truth
    gathering, track, seconds = run_timed(session, walked.samples, EVERY)
    heel_strike, toe_off, strides = Matching(), Matching(), StrideScore()
    for foot in compare(truth, {foot: gathering.foot(foot) for foot in Foot}):
        heel_strike += foot.events["heel_strike"]
        toe_off += foot.events["toe_off"]
        strides += StrideScore(foot.steps_true, foot.steps_found, foot.steps_invented, foot.length_errors)
    return Scored(
        path.stem,
        figures={} if track is None else place_figures(track.t, track.positions, middle(truth, track.t)),
        events={"heel_strike": heel_strike, "toe_off": toe_off},
        strides=strides,
        samples=len(walked.samples),
        seconds=seconds,
    )


def middle(truth: Truth, t: Floats) -> Floats:
    """Return the mean of both sensors' true positions at `t` (n,), relative to that at 0: (n,3), m."""
    feet = [truth.pose(foot, t).position for foot in Foot]
    return np.asarray(0.5 * (feet[0] + feet[1]), dtype=np.float64)


def place_figures(t: Floats, positions: Floats, truth: Floats) -> Figures:
    """Return the figures of `positions` (n,3) at `t` (n,) against `truth` (n,3); the module docstring defines them."""
    if len(t) < 2:
        return {}
    off = np.linalg.norm(aligned_at_start(positions, truth, ALIGNED)[:, :2] - truth[:, :2], axis=1)
    higher = np.abs((positions[:, 2] - positions[0, 2]) - (truth[:, 2] - truth[0, 2]))
    path = float(distances(truth)[-1])
    return {
        "rms_2d": track_error(positions, truth).rms_2d,
        "position_end": float(off[-1]),
        "end_relative": float(off[-1]) / path,
        "position_max": float(np.max(off)),
        "largest_relative": float(np.max(off)) / path,
        "height_end": float(higher[-1]),
        "height_max": float(np.max(higher)),
        "path": path,
    }
