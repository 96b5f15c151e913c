"""Scores tracks and strides against markers, surveys and closed loops; datasets.py describes what a scorer is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from solepath.types import Foot
from solepath.validate.alignment import at_times, path_length, position_errors, track_error
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Errors

from ..descriptions import KNOWN
from ..measures.consistency import consistency_at_end
from ..measures.drift import drift_figures, drift_of_strides, drift_that_opens
from ..measures.legs import leg_errors
from ..measures.score import Figures, Scored
from ..measures.strides import StrideScore, counted_score, marker_stances, surveyed_score
from .insoles import smart_insole
from .run import Arrays, Meta, RecordingRun, RunSettings, run, truth_of


def score_vicon(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the live position at every sample against the marker's."""
    truth, result = truth_of(path), run(path, settings)
    foot = result.feet[Foot.RIGHT]
    bipedal = meta.get("llio_tag") == 1
    strides = _survey_score(truth, foot) if bipedal and "gt_stride_xy" in truth else None
    figures = _track_figures(foot, truth["t"], truth["gt_pos"])
    return Scored(path.stem, figures=figures, strides=strides, groups=("all", "bipedal") if bipedal else ("all",))


def score_optitrack(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against a marker with its own clock, over the time in which both marker and samples were recorded."""
    truth, result = truth_of(path), run(path, settings, calibration=smart_insole(path))
    in_both = (truth["gt_t"] >= truth["t"][0]) & (truth["gt_t"] <= truth["t"][-1])
    t, places, foot = truth["gt_t"][in_both], truth["gt_pos"][in_both], result.feet[Foot.RIGHT]
    times, stances = marker_stances(t, places)
    strides = surveyed_score(times, stances, foot)
    return Scored(path.stem, figures=_track_figures(foot, t, places), strides=strides)


def _track_figures(foot: FootRun, t: Any, truth: Any) -> Figures:
    if not len(foot.t):
        return {}
    error, path = track_error(at_times(foot.t, foot.positions, t), truth), path_length(truth)
    return {
        "armse_2d": error.armse_2d,
        "rms_2d": error.rms_2d,
        "rms_3d": error.rms_3d,
        "rms_z": error.rms_z,
        "path": path,
        "relative": error.rms_2d / path,
    }


def score_loop(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the distance between the first and the last live position of a foot that ends where it started."""
    result = run(path, settings)
    return Scored(path.stem, figures=_loop_figures(result, float(meta["path_m_about"])))


EIGHT_LENGTH = 78.0
"""Length of each figure of eight in openshoe_loops, m, from the description of the data."""
EIGHT_STRIDES: dict[str, int] = KNOWN["openshoe_loops"]
"""Number of strides of each recording of openshoe_loops."""


def score_eight(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score a figure of eight like a loop, and the number of its strides against the count by eye."""
    result = run(path, settings)
    strides = counted_score(EIGHT_STRIDES[path.stem], [stride.length for stride in result.feet[Foot.RIGHT].strides])
    return Scored(path.stem, figures=_loop_figures(result, EIGHT_LENGTH), strides=strides)


def _loop_figures(result: RecordingRun, length: float) -> Figures:
    """Return the errors of a foot that ends where it started, after a walk of `length` m."""
    foot = result.feet[Foot.RIGHT]
    if not len(foot.t):
        return {}
    figures = _closing_errors(foot.positions[0], foot.positions[-1])
    t = np.array([foot.strides[0].t_start, *(stride.t_end for stride in foot.strides)]) if foot.strides else foot.t
    drift = drift_figures(drift_that_opens(t, at_times(foot.t, foot.positions, t)), t)
    return {**figures, "path": length, "relative": (figures["end_error"] or 0.0) / length, **drift}


def _closing_errors(first: Any, last: Any) -> Figures:
    """Return the distances, m, between the positions at the start and the end of a closed walk."""
    displacement = last - first
    return {
        "end_error": float(np.linalg.norm(displacement)),
        "end_error_2d": float(np.linalg.norm(displacement[:2])),
        "end_height": abs(float(displacement[2])),
    }


def score_surveyed(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score positions and strides against the survey of every footprint."""
    truth, result = truth_of(path), run(path, settings, body=True)
    foot, body = result.feet[Foot.RIGHT], result.body
    figures: Figures = {}
    if len(foot.t):
        times, authors = truth["t"][truth["gt_stride_index"]], KNOWN["gumushane_authors"].get(path.stem)
        errors = position_errors(times, truth["gt_stride_xy"], foot.t, foot.positions)
        heights = np.interp(times, foot.t, foot.positions[:, 2])
        surveyed = path_length(truth["gt_stride_xy"])
        drift = drift_of_strides(times, at_times(foot.t, foot.positions, times), truth["gt_stride_xy"])
        figures = {
            **drift_figures(drift, times),
            "position_mean": float(np.mean(errors)),
            "position_max": float(np.max(errors)),
            "authors": authors,
            "authors_beaten": None if authors is None else float(np.mean(errors) < authors),
            "rms_z": float(np.std(heights)),
            "path": surveyed,
            "relative": float(np.mean(errors)) / surveyed,
        }
        k = np.minimum(np.searchsorted(body.t, times), len(body.t) - 1)
        places = body.positions[k, :2], body.covariances[k], truth["gt_stride_xy"][:, :2].astype(np.float64)
        figures |= consistency_at_end(*places)
    return Scored(path.stem, figures=figures, strides=_survey_score(truth, foot))


def _survey_score(truth: Arrays, foot: FootRun) -> StrideScore:
    times, places = truth["t"][truth["gt_stride_index"]], truth["gt_stride_xy"]
    return surveyed_score(times, places, foot)


def score_counted(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the number of strides against a count, and the lengths of the legs between surveyed corners.

    Only some corners have surveyed positions, and a leg is the straight line from one of them to the next. A walk that
    ends at the corner where it started is a closed loop on one level."""
    truth, result = truth_of(path), run(path, settings)
    foot = result.feet[Foot.RIGHT]
    true = int(meta["n_true_strides"])
    strides = counted_score(true, [stride.length for stride in foot.strides])
    if not meta["corner_points_valid"] or not len(foot.t):
        return Scored(path.stem, strides=strides)
    ends, corners = truth["t"][truth["gt_stride_index"]], truth["gt_corner_xy"].astype(np.float64)
    legs, figures = Errors(), Figures()
    if meta["n_detected_strides"] == true:
        times = ends[truth["gt_corner_stride"]]
        legs = leg_errors(times, np.linalg.norm(np.diff(corners, axis=0), axis=1), foot)
    if float(np.linalg.norm(corners[-1] - corners[0])) == 0.0:
        first, last = at_times(foot.t, foot.positions, ends[[0, -1]])
        figures = _closing_errors(first, last)
    return Scored(path.stem, figures=figures, strides=strides, errors={"leg": legs})
