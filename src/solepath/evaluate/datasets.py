"""The recorded data that have a truth, and how each is scored. The folder's README says where they come from.

Every scorer takes the recording's path, its entry in dataset.json and how to compute. The session gets the samples
and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from attrs import frozen

from .. import recipes
from ..types import Foot
from .activity import CLIMBED, score_labelled, score_stairs
from .alignment import at_times, path_length, track_error
from .confusion import CLASSES
from .gathered import FootRun
from .insoles import in_dataset
from .recorded import Arrays, Meta, scored, truth_of
from .run import How, run
from .score import Figures, Scored
from .strides import StrideScore, position_errors, surveyed_score
from .timing import score_borders, score_force, score_pressed, score_swings, score_switches, score_treadmill


@frozen
class DataSet:
    """`folders`: their names below the data directory. `has_truth`: of a recording's name and entry. `figures`: what
    its table shows, in order."""

    name: str
    folders: tuple[str, ...]
    title: str
    has_truth: Callable[[str, Meta], bool]
    score: Callable[[Path, Meta, How], Scored]
    figures: tuple[str, ...]
    each: bool = True
    """Whether the table has a line for every recording."""
    pressed: bool = False
    """Whether the session gets pressure."""
    folds: bool = False
    """Whether what says the activity is taught on other wearers' recordings of this data set (learning.py)."""

    def suits(self, recipe: str) -> bool:
        """Whether the recipe has something to say of these data."""
        return self.pressed or not recipes.BY_NAME[recipe].needs_pressure


def _always(name: str, meta: Meta) -> bool:
    return True


# --- tracks ---------------------------------------------------------------------------------------------------------


def score_vicon(path: Path, meta: Meta, how: How) -> Scored:
    """The live position at every sample against the marker's."""
    truth, went = truth_of(path), run(path, how)
    foot = went.feet[Foot.RIGHT]
    bipedal = meta.get("llio_tag") == 1
    strides = _surveyed(truth, foot) if bipedal and "gt_stride_xy" in truth else None
    figures = _track_figures(foot, truth["t"], truth["gt_pos"])
    return scored(path, went, figures=figures, strides=strides, groups=("all", "bipedal") if bipedal else ("all",))


def score_optitrack(path: Path, meta: Meta, how: How) -> Scored:
    """The marker has a clock and a span of its own: scored where both are known."""
    truth, went = truth_of(path), run(path, how, calibration=in_dataset(path))
    both = (truth["gt_t"] >= truth["t"][0]) & (truth["gt_t"] <= truth["t"][-1])
    figures = _track_figures(went.feet[Foot.RIGHT], truth["gt_t"][both], truth["gt_pos"][both])
    return scored(path, went, figures=figures)


def _track_figures(foot: FootRun, t: Any, truth: Any) -> Figures:
    if not len(foot.t):
        return {}
    error, path = track_error(at_times(foot.t, foot.positions, t), truth), path_length(truth)
    return {
        "armse_2d": error.armse_2d,
        "rms_2d": error.rms_2d,
        "rms_3d": error.rms_3d,
        "path": path,
        "relative": error.rms_2d / path,
    }


def score_loop(path: Path, meta: Meta, how: How) -> Scored:
    """From the last live position to the first: the foot ended where it began."""
    went = run(path, how)
    foot = went.feet[Foot.RIGHT]
    figures: Figures = {}
    if len(foot.t):
        away = foot.positions[-1] - foot.positions[0]
        end = float(np.linalg.norm(away))
        figures = {
            "end_error": end,
            "end_error_2d": float(np.linalg.norm(away[:2])),
            "path": float(meta["path_m_about"]),
            "relative": end / float(meta["path_m_about"]),
        }
    return scored(path, went, figures=figures)


# --- strides --------------------------------------------------------------------------------------------------------


def score_surveyed(path: Path, meta: Meta, how: How) -> Scored:
    truth, went = truth_of(path), run(path, how)
    foot = went.feet[Foot.RIGHT]
    figures: Figures = {}
    if len(foot.t):
        errors = position_errors(truth["t"][truth["gt_stride_index"]], truth["gt_stride_xy"], foot.t, foot.positions)
        surveyed = path_length(truth["gt_stride_xy"])
        figures = {
            "position_mean": float(np.mean(errors)),
            "position_max": float(np.max(errors)),
            "path": surveyed,
            "relative": float(np.mean(errors)) / surveyed,
        }
    return scored(path, went, figures=figures, strides=_surveyed(truth, foot))


def _surveyed(truth: Arrays, foot: FootRun) -> StrideScore:
    times, places = truth["t"][truth["gt_stride_index"]], truth["gt_stride_xy"]
    if not len(foot.t):
        return StrideScore(n_true=len(times) - 1)
    return surveyed_score(times, places, foot.t, foot.positions, foot.step_lengths)


def score_counted(path: Path, meta: Meta, how: How) -> Scored:
    """Somebody counted the strides; where they were is not known."""
    went = run(path, how)
    true, found = int(meta["n_true_strides"]), len(went.feet[Foot.RIGHT].steps)
    return scored(path, went, strides=StrideScore(true, min(true, found), max(0, found - true)))


# --- all of them ----------------------------------------------------------------------------------------------------


def _surveyed_strides(name: str, meta: Meta) -> bool:
    return bool(meta.get("every_stride_surveyed"))


def _counted_strides(name: str, meta: Meta) -> bool:
    return "n_true_strides" in meta and not _surveyed_strides(name, meta)


def _closed_loop(name: str, meta: Meta) -> bool:
    return bool(meta.get("closed_loop"))


def _tracked(name: str, meta: Meta) -> bool:
    return bool(meta.get("optitrack"))


def _borders_known(name: str, meta: Meta) -> bool:
    return "gt_borders_left" in meta["keys"]


def _climbed(name: str, meta: Meta) -> bool:
    return name in CLIMBED


TRACK = ("armse_2d", "rms_2d", "rms_3d", "path", "relative")
STRIDES = ("strides_found", "strides_true", "strides_invented", "stride_error", "stride_error_median")
HEEL_STRIKE = ("heel_strike_true", "heel_strike_found", "heel_strike_f1", "heel_strike_bias", "heel_strike_mad")
ACTIVITIES = ("accuracy", "most_frequent", *(f"f1_{activity.value.lower()}" for activity in CLASSES))
RIDES = ("rides_true", "rides_found", "rides_invented")
TOE_OFF = ("toe_off_true", "toe_off_found", "toe_off_f1", "toe_off_bias", "toe_off_mad")

DATASETS = (
    DataSet("pyshoe_vicon", ("pyshoe_vicon",), "VICON tracks, one shoe", _always, score_vicon, TRACK + STRIDES[:4]),
    DataSet(
        "gumushane_surveyed",
        ("gumushane_gcp",),
        "every footprint surveyed, one shoe",
        _surveyed_strides,
        score_surveyed,
        ("position_mean", "position_max", "path", "relative", *STRIDES, "stride_error_track"),
    ),
    DataSet(
        "gumushane_counted", ("gumushane_gcp",), "strides counted, one shoe", _counted_strides, score_counted,
        STRIDES[:3],
    ),
    DataSet(
        "xio_closed_walks",
        ("xio_closed_walks",),
        "a closed loop, one shoe",
        _closed_loop,
        score_loop,
        ("end_error", "end_error_2d", "path", "relative"),
    ),
    DataSet(
        "smart_insole_35", ("smart_insole_35",), "OptiTrack tracks, one insole", _tracked, score_optitrack, TRACK,
        pressed=True,
    ),
    DataSet(
        "ipol_10m_uturn",
        ("ipol_10m_uturn",),
        "10 m and back, both feet, radio losses",
        _always,
        score_swings,
        HEEL_STRIKE + TOE_OFF + ("uturn_found", "uturn_angle", "uturn_invented"),
        each=False,
    ),
    DataSet(
        "tripod_treadmill", ("tripod_treadmill",), "a treadmill, both feet", _always, score_treadmill,
        HEEL_STRIKE + TOE_OFF + STRIDES,
    ),
    DataSet(
        "gaitmap_examples", ("gaitmap_examples",), "4 x 10 m, both feet", _borders_known, score_borders, HEEL_STRIKE
    ),
    DataSet(
        "marpino_heel_toe",
        ("marpino_heel_toe",),
        "heel and toe switches, both feet, inertial samples only",
        _always,
        score_switches,
        HEEL_STRIKE + TOE_OFF,
    ),
    DataSet(
        "marpino_pressed",
        ("marpino_heel_toe",),
        "heel and toe switches as an insole of two cells, both feet",
        _always,
        score_pressed,
        HEEL_STRIKE + TOE_OFF,
        pressed=True,
    ),
    DataSet(
        "gaitpdb_vgrf",
        ("gaitpdb_vgrf",),
        "eight force sensors below each foot and nothing else",
        _always,
        score_force,
        HEEL_STRIKE + TOE_OFF,
        pressed=True,
    ),
    DataSet(
        "hugadb",
        ("hugadb",),
        "activities, both feet, five folds by wearer",
        _always,
        score_labelled,
        ACTIVITIES + RIDES,
        each=False,
        folds=True,
    ),
    DataSet(
        "stairs",
        ("gaitmap_examples", "xio_closed_walks"),
        "stairs and level ways, and what of them is called stairs",
        _climbed,
        score_stairs,
        ("stairs_called", "stairs_direction", "level_called"),
    ),
)  # fmt: skip
