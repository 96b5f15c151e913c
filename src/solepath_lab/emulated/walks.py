"""Scores the session's position on emulated walks over stairs. Scorers have the form that datasets.py describes.

Both feet wear insoles of 96 cells (odd seeds) or 24 cells (even seeds) with the errors of an LSM6DSOX, at 100 Hz. The
session receives all their samples, without a radio link. Route, gait and devices are drawn from the seed. Seeds 1 to 50
are for scores, seeds from 101 on for tuning.

`session.position` is read twice a second and compared with the mean of the true positions of both sensors. Heading and
origin of a track are arbitrary, so the track is turned about the vertical and shifted to fit the truth by least squares
over the first ALIGNED_LENGTH m. A heading error after that counts over the rest of the walk. The figures are:

- `position_end`, `position_max`: horizontal distance from the truth at the end, and the largest one, m
- `end_relative`, `largest_relative`: these two distances as shares of the path length
- `rms_2d`: horizontal RMS error after the best turn and shift over the whole walk, m, as for a VICON track
- `height_end`, `height_max`: error at the end, and the largest error, of the height above the first position, m"""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np

from solepath.emulate.routes.path import ahead
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import sampled
from solepath.emulate.wearers.gait import Wearer
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Site
from solepath.validate.alignment import Floats, aligned_at_start, distances, track_error
from solepath.validate.comparison import compare
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Matching

from ..evaluate.run import Meta, RunSettings, run_session
from ..measures.score import Figures, Scored
from ..measures.strides import StrideScore
from .heading import middle

ALIGNED_LENGTH = 10.0
"""Length of path over which a track is aligned with the truth, m."""
POSITION_INTERVAL = 0.5
"""Interval between positions, s."""
STANDING_TIME = 3.0
"""Duration of standing at the start and at the end, s."""
STOREYS = 4
RISERS, RISE, GOING = 10, 0.16, 0.30
"""Number, height (m) and depth (m) of the stairs in a flight. Two flights make a storey of 3.2 m."""
LANDING_LENGTH = 1.0
"""Length of the straight walk on a landing before and after the turn, m. The turn's radius is 0.7 of that."""


def four_floors(seed: int) -> Route:
    """Return a route up four storeys, to and fro along a corridor, and down again."""
    rng = np.random.default_rng([seed, 11])
    side = 0.5 * pi if rng.uniform() < 0.5 else -0.5 * pi
    speed = float(rng.uniform(1.1, 1.4))
    route = Route(speed=speed).stand(STANDING_TIME).walk(12.0)
    for up in (True, False):
        for _ in range(STOREYS):
            for _ in range(2):
                route = (
                    route.walk(LANDING_LENGTH).stairs(RISERS, up, RISE, GOING).walk(LANDING_LENGTH + ahead(up, GOING))
                )
                route = route.turn(2.0 * side, 0.7 * LANDING_LENGTH)
        if up:
            route = route.walk(10.0).turn(pi).walk(10.0)
    return route.walk(6.0).stop(STANDING_TIME)


def insoles_of(seed: int) -> dict[Site, Insole]:
    """Return the insoles of a seed's wearer."""
    return {SITE_OF_FOOT[foot]: Insole(cells=96 if seed % 2 else 24) for foot in Foot}


def score_floors(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the walk over four floors that is drawn from the seed in the entry `meta`."""
    seed: int = meta["seed"]
    walk = sampled(four_floors(seed), wearer=Wearer(), insoles=insoles_of(seed), seed=seed)
    session, truth = Session(settings.recipe, calibration=settings.calibration), walk.truth
    found, track = run_session(session, walk.samples, POSITION_INTERVAL)
    heel_strike, toe_off, strides = Matching(), Matching(), StrideScore()
    for foot in compare(truth, {foot: FootRun.of(found, foot) for foot in Foot}):
        heel_strike += foot.events["heel_strike"]
        toe_off += foot.events["toe_off"]
        strides += StrideScore(foot.strides_true, foot.strides_found, foot.strides_invented, foot.length_errors)
    return Scored(
        path.stem,
        figures=place_figures(track.t, track.positions, middle(truth, track.t)),
        events={"heel_strike": heel_strike, "toe_off": toe_off},
        strides=strides,
    )


def place_figures(t: Floats, positions: Floats, truth: Floats) -> Figures:
    """Return the figures of `positions` (n,3), m, at `t` (n,), s, against `truth` (n,3); the module defines them."""
    if len(t) < 2:
        return {}
    errors = np.linalg.norm(aligned_at_start(positions, truth, ALIGNED_LENGTH)[:, :2] - truth[:, :2], axis=1)
    height_errors = np.abs((positions[:, 2] - positions[0, 2]) - (truth[:, 2] - truth[0, 2]))
    path = float(distances(truth)[-1])
    return {
        "rms_2d": track_error(positions, truth).rms_2d,
        "position_end": float(errors[-1]),
        "end_relative": float(errors[-1]) / path,
        "position_max": float(np.max(errors)),
        "largest_relative": float(np.max(errors)) / path,
        "height_end": float(height_errors[-1]),
        "height_max": float(np.max(height_errors)),
        "path": path,
    }
