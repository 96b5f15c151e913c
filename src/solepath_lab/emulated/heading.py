"""Scores heading, position and their covariance on long emulated walks (heading_walks.py).

`session.position` is read after every stride. The track is turned so that the first heading is the emulator's: by the
error of the attitudes of both feet after their first strides, so that no metre of the walk is used up to align it. The
figures are

- `end_relative`, `position_end`: horizontal distance from the truth at the end, as a share of the path and in m
- `heading_end`: mean error of the attitudes of both feet at the end, rad
- `radius_error`: `heading_end` divided by the turn of a walk that turns to one side only: the share by which circles
  are too large or too small
- `nees_T`: NEES/2 after T s (consistency.py): 1 on average for a filter that is right, 0.69 in the median
- `held_T`: 1 if the ellipse of 95 % held the wearer after T s, otherwise 0
- `heading_nees_T`: the square of the heading error divided by its variance, 1 on average"""

from __future__ import annotations

from math import inf, pi, radians
from pathlib import Path

import numpy as np
from attrs import define, evolve, field, frozen

from solepath.body.fuse.both_feet import BothFeet
from solepath.calibration.records import merged
from solepath.emulate.sensors.magnetic_field import UNDISTURBED
from solepath.emulate.sensors.parts import AK8963
from solepath.emulate.walk import SampledWalk, sampled
from solepath.emulate.wearers.truth import Truth
from solepath.events import StrideTaken
from solepath.session import Session
from solepath.session.heading_walk import heading_calibration, heading_walk
from solepath.types import Foot
from solepath.validate.alignment import Floats, distances

from ..evaluate.run import Meta, RunSettings
from ..measures.consistency import consistency, matrix, rotation, yaws
from ..measures.score import Figures, Scored
from .heading_walks import IsComplete, calibration_samples, heading_route, insoles_of, wearer_of
from .magnetic_field import DisturbedField

CHECKED_TIMES = (60, 300, 900, 1800)
"""Times after which the covariance is compared with the error, s."""
END_TOLERANCE = 60.0
"""Time by which a walk may be shorter than a checked time, s."""
ONE_SIDED = ("circle", "one_way_loops")
"""Names of the kinds that turn to one side only."""
LONG_WALK = 500.0
"""Shortest length of the shorter walks, m."""
HALF_HOUR = 1800.0
"""Shortest duration of the longer walks, s."""


def is_long(length: float, seconds: float) -> bool:
    """Return whether a walk has LONG_WALK metres."""
    return length >= LONG_WALK


def is_half_hour(length: float, seconds: float) -> bool:
    """Return whether a walk lasts for HALF_HOUR."""
    return seconds >= HALF_HOUR


LENGTHS: dict[str, IsComplete] = {"500m": is_long, "30min": is_half_hour}
"""Lengths of walks by name."""


@frozen
class Equipment:
    """The help that a wearer has besides two insoles."""

    name: str = ""
    """Words for the head of a table."""
    calibrated: bool = False
    """Flag: the calibration of a walk there and back on the day before."""
    disturbance: float | None = None
    """Disturbance of the field that a magnetometer in each insole measures, rad (magnetic_field.py); None without."""


EQUIPMENT: dict[str, Equipment] = {
    "": Equipment(),
    "_calibrated": Equipment(", calibration walk", True),
    "_compass20": Equipment(", compass disturbed by 20 degrees", False, radians(20.0)),
    "_compass30": Equipment(", compass disturbed by 30 degrees", False, radians(30.0)),
    "_calibrated_compass20": Equipment(", calibration walk, compass disturbed by 20 degrees", True, radians(20.0)),
}
"""Equipment of a wearer by the end of the name of a data set."""


@define
class HeadingTrack:
    """The wearer's track, a row for each stride from the second one of either foot on."""

    t: list[float] = field(factory=list)
    """Ends of the strides, s."""
    places: list[tuple[float, float]] = field(factory=list)
    """Positions of the wearer, m."""
    covariances: list[tuple[float, float, float]] = field(factory=list)
    """Covariances of the positions: xx, xy, yy, m^2."""
    headings: list[float] = field(factory=list)
    """Mean error of the attitudes of both feet about the vertical, truth minus track, rad."""
    heading_sigmas: list[float] = field(factory=list)
    """Standard deviations of the headings, rad; 0 if the recipe does not know them."""


def follow(session: Session, walk: SampledWalk, until: float = inf) -> HeadingTrack:
    """Return the wearer's track in a session that receives the samples of a walk before `until`, s."""
    track, truth, errors = HeadingTrack(), walk.truth, dict.fromkeys(Foot, 0.0)
    counts = dict.fromkeys(Foot, 0)
    for sample in walk.samples:
        if sample.t >= until:
            break
        for event in session.feed(sample):
            if not isinstance(event, StrideTaken):
                continue
            foot = event.foot
            counts[foot] += 1
            attitudes = np.array([truth.pose(foot, event.t_end).attitude[0], session.feet[foot].attitude])
            true, ours = yaws(attitudes).tolist()
            error = true - ours - _placement(session, foot)
            errors[foot] += (error - errors[foot] + pi) % (2.0 * pi) - pi
            here = session.position
            if here is None or min(counts.values()) < 2:
                continue
            (px, py, _), (xx, xy, _, yy, _, _) = here.position, here.covariance
            track.t.append(event.t_end)
            track.places.append((px, py))
            track.covariances.append((xx, xy, yy))
            track.headings.append(0.5 * sum(errors.values()))
            track.heading_sigmas.append(here.heading_sigma or 0.0)
    return track


def _placement(session: Session, foot: Foot) -> float:
    """Return the turn from the world frame of a foot to that of the wearer, rad."""
    for part in session._state.parts:
        if isinstance(part, BothFeet):
            return part.tracks[foot].turn
    return 0.0


def score_heading(
    kind: str, is_complete: IsComplete, equipment: Equipment, path: Path, meta: Meta, settings: RunSettings
) -> Scored:
    """Score a walk of a kind of routes and of the seed in the entry `meta`, with this equipment."""
    seed: int = meta["seed"]
    walk = emulated_walk(kind, is_complete, seed, equipment.disturbance)
    calibration = settings.calibration
    if equipment.calibrated:
        calibration = merged(calibration, heading_calibration(heading_walk(calibration_samples(seed))))
    session = Session(settings.recipe, calibration=calibration)
    track = follow(session, walk)
    return Scored(path.stem, figures=heading_figures(track, walk.truth, kind in ONE_SIDED))


def emulated_walk(kind: str, is_complete: IsComplete, seed: int, disturbance: float | None = None) -> SampledWalk:
    """Return the walk of a kind of routes and of a seed.

    With a `disturbance`, rad, each insole has a magnetometer in a field that is disturbed so much."""
    insoles, magnetic_field = insoles_of(seed), UNDISTURBED
    if disturbance is not None:
        insoles = {site: evolve(insole, mag=AK8963) for site, insole in insoles.items()}
        magnetic_field = DisturbedField(disturbance, seed)
    route = heading_route(kind, seed, is_complete)
    return sampled(route, wearer=wearer_of(seed), insoles=insoles, seed=seed, field=magnetic_field)


def heading_figures(track: HeadingTrack, truth: Truth, one_sided: bool = False) -> Figures:
    """Return the figures of a track, which the module defines; none without strides.

    `one_sided` is true for a walk that turns to one side only."""
    if len(track.t) < 2:
        return {}
    t, headings = np.array(track.t), np.array(track.headings)
    turn = float(headings[0])
    to_truth = rotation(turn)
    errors = np.array(track.places) @ to_truth.T - (middle(truth, t) - middle(truth, np.zeros(1)))[:, :2]
    whole = middle(truth, np.arange(0.0, truth.duration, 0.5))[:, :2]
    path, end = float(distances(whole)[-1]), float(np.hypot(*errors[-1]))
    figures: Figures = {
        "position_end": end,
        "end_relative": end / path,
        "heading_end": abs(float(headings[-1] - turn)),
        "path": path,
    }
    if one_sided:
        turned = float(np.ptp(np.unwrap(yaws(truth.pose(Foot.LEFT, t).attitude))))
        figures["radius_error"] = abs(float(headings[-1] - turn)) / turned
    for checked in CHECKED_TIMES:
        if checked > t[-1] + END_TOLERANCE:
            continue
        k = min(int(np.searchsorted(t, checked)), len(t) - 1)
        covariance = to_truth @ matrix(track.covariances[k]) @ to_truth.T
        figures[f"nees_{checked}"], figures[f"held_{checked}"] = consistency(errors[k], covariance)
        if track.heading_sigmas[k] > 0.0:
            figures[f"heading_nees_{checked}"] = (float(headings[k] - turn) / track.heading_sigmas[k]) ** 2
    return figures


def middle(truth: Truth, t: Floats) -> Floats:
    """Return the true middle of both sensors at times `t`, s, (N, 3), m."""
    return np.asarray(0.5 * sum(truth.pose(foot, t).position for foot in Foot), dtype=np.float64)
