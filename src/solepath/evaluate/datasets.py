"""The recorded data that have a truth, and how each is scored. The folder's README says where they come from.

Every scorer takes the recording's path, its entry in dataset.json and the recipe's name. The session gets the samples
and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from attrs import frozen

from ..types import Foot
from .alignment import at_times, path_length, track_error
from .contacts import merged, switch_contacts
from .gathered import FootRun
from .matching import TOLERANCE, Matching, match
from .run import Run, run
from .score import Figures, Scored
from .strides import StrideScore, position_errors, stride_score, surveyed_score

Meta = dict[str, Any]
Arrays = dict[str, Any]


@frozen
class DataSet:
    """`folder`: its name below the data directory. `figures`: what its table shows, in order."""

    name: str
    folder: str
    title: str
    has_truth: Callable[[Meta], bool]
    score: Callable[[Path, Meta, str], Scored]
    figures: tuple[str, ...]
    each: bool = True
    """Whether the table has a line for every recording."""


def _truth(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files if key == "t" or key.startswith(("t_", "gt_", "pressure"))}


def _scored(path: Path, went: Run, **parts: Any) -> Scored:
    return Scored(path.stem, samples=went.samples, seconds=went.seconds, **parts)


def _always(meta: Meta) -> bool:
    return True


# --- tracks ---------------------------------------------------------------------------------------------------------


def score_vicon(path: Path, meta: Meta, recipe: str) -> Scored:
    """The live position at every sample against the marker's."""
    truth, went = _truth(path), run(path, recipe)
    foot = went.feet[Foot.RIGHT]
    bipedal = meta.get("llio_tag") == 1
    strides = _surveyed(truth, foot) if bipedal and "gt_stride_xy" in truth else None
    figures = _track_figures(foot, truth["t"], truth["gt_pos"])
    return _scored(path, went, figures=figures, strides=strides, groups=("all", "bipedal") if bipedal else ("all",))


def score_optitrack(path: Path, meta: Meta, recipe: str) -> Scored:
    """The marker has a clock and a span of its own: scored where both are known."""
    truth, went = _truth(path), run(path, recipe)
    both = (truth["gt_t"] >= truth["t"][0]) & (truth["gt_t"] <= truth["t"][-1])
    figures = _track_figures(went.feet[Foot.RIGHT], truth["gt_t"][both], truth["gt_pos"][both])
    return _scored(path, went, figures=figures)


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


def score_loop(path: Path, meta: Meta, recipe: str) -> Scored:
    """From the last live position to the first: the foot ended where it began."""
    went = run(path, recipe)
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
    return _scored(path, went, figures=figures)


# --- strides --------------------------------------------------------------------------------------------------------


def score_surveyed(path: Path, meta: Meta, recipe: str) -> Scored:
    truth, went = _truth(path), run(path, recipe)
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
    return _scored(path, went, figures=figures, strides=_surveyed(truth, foot))


def _surveyed(truth: Arrays, foot: FootRun) -> StrideScore:
    times, places = truth["t"][truth["gt_stride_index"]], truth["gt_stride_xy"]
    if not len(foot.t):
        return StrideScore(n_true=len(times) - 1)
    return surveyed_score(times, places, foot.t, foot.positions, foot.step_lengths)


def score_counted(path: Path, meta: Meta, recipe: str) -> Scored:
    """Somebody counted the strides; where they were is not known."""
    went = run(path, recipe)
    true, found = int(meta["n_true_strides"]), len(went.feet[Foot.RIGHT].steps)
    return _scored(path, went, strides=StrideScore(true, min(true, found), max(0, found - true)))


# --- heel-strike and toe-off ----------------------------------------------------------------------------------------


def score_swings(path: Path, meta: Meta, recipe: str) -> Scored:
    """Labels of every swing: it starts with toe-off and ends with heel-strike."""
    truth, went = _truth(path), run(path, recipe)
    heel_strike, toe_off = Matching(), Matching()
    for foot, ran in went.feet.items():
        swings = truth[f"gt_{foot.value}"]
        toe_off += match(swings[:, 0].tolist(), ran.toe_offs)
        heel_strike += match(swings[:, 1].tolist(), ran.heel_strikes)
    return _scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off})


def score_borders(path: Path, meta: Meta, recipe: str) -> Scored:
    """Strides from heel-strike to heel-strike, known only while the walker is in view of the cameras."""
    truth, went = _truth(path), run(path, recipe)
    heel_strike = Matching()
    for foot, ran in went.feet.items():
        borders = [(float(a), float(b)) for a, b in truth[f"gt_borders_{foot.value}"]]
        seen = merged(borders)
        # a border that two strides share is one heel-strike
        strikes = [at for at, _ in merged([(at, at) for border in borders for at in border])]
        heel_strike += match(strikes, ran.heel_strikes, windows=seen)
    return _scored(path, went, events={"heel_strike": heel_strike})


def score_treadmill(path: Path, meta: Meta, recipe: str) -> Scored:
    """Contact times of a light barrier. The belt is an inertial frame of its own, in which the standing foot rests, so
    stride lengths compare as they are; positions in the room do not."""
    truth, went = _truth(path), run(path, recipe)
    heel_strike, toe_off, strides = Matching(), Matching(), StrideScore()
    for foot, ran in went.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        strikes = truth["gt_hs_t"][rows]
        heel_strike += match(strikes.tolist(), ran.heel_strikes)
        toe_off += match((strikes + truth["gt_contact_s"][rows]).tolist(), ran.toe_offs)
        # the stride that a heel-strike ends, ours ending at the foot-flat after it: well before the next heel-strike
        strides += stride_score(strikes, truth["gt_stride_len"][rows][:-1], ran.step_lengths, slack=-TOLERANCE)
    return _scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off}, strides=strides)


def score_switches(path: Path, meta: Meta, recipe: str) -> Scored:
    """Heel and toe switches under the foot are the truth here, so the session does without them."""
    truth, went = _truth(path), run(path, recipe, without_pressure=True)
    heel_strike, toe_off = Matching(), Matching()
    for foot, ran in went.feet.items():
        t, counts = truth[f"t_{foot.value}"], truth[f"pressure_{foot.value}"]
        heel, toe = switch_contacts(t, counts[:, 1]), switch_contacts(t, counts[:, 0])
        if heel:
            heel_strike += match([begin for begin, _ in heel], ran.heel_strikes)
        if toe:
            toe_off += match([end for _, end in toe], ran.toe_offs)
    return _scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off})


# --- all of them ----------------------------------------------------------------------------------------------------


def _surveyed_strides(meta: Meta) -> bool:
    return bool(meta.get("every_stride_surveyed"))


def _counted_strides(meta: Meta) -> bool:
    return "n_true_strides" in meta and not _surveyed_strides(meta)


def _closed_loop(meta: Meta) -> bool:
    return bool(meta.get("closed_loop"))


def _tracked(meta: Meta) -> bool:
    return bool(meta.get("optitrack"))


def _borders_known(meta: Meta) -> bool:
    return "gt_borders_left" in meta["keys"]


TRACK = ("armse_2d", "rms_2d", "rms_3d", "path", "relative")
STRIDES = ("strides_found", "strides_true", "strides_invented", "stride_error", "stride_error_median")
HEEL_STRIKE = ("heel_strike_true", "heel_strike_found", "heel_strike_f1", "heel_strike_bias", "heel_strike_mad")
TOE_OFF = ("toe_off_true", "toe_off_found", "toe_off_f1", "toe_off_bias", "toe_off_mad")

DATASETS = (
    DataSet("pyshoe_vicon", "pyshoe_vicon", "VICON tracks, one shoe", _always, score_vicon, TRACK + STRIDES[:4]),
    DataSet(
        "gumushane_surveyed",
        "gumushane_gcp",
        "every footprint surveyed, one shoe",
        _surveyed_strides,
        score_surveyed,
        ("position_mean", "position_max", "path", "relative", *STRIDES, "stride_error_track"),
    ),
    DataSet(
        "gumushane_counted", "gumushane_gcp", "strides counted, one shoe", _counted_strides, score_counted, STRIDES[:3]
    ),
    DataSet(
        "xio_closed_walks",
        "xio_closed_walks",
        "a closed loop, one shoe",
        _closed_loop,
        score_loop,
        ("end_error", "end_error_2d", "path", "relative"),
    ),
    DataSet("smart_insole_35", "smart_insole_35", "OptiTrack tracks, one insole", _tracked, score_optitrack, TRACK),
    DataSet(
        "ipol_10m_uturn",
        "ipol_10m_uturn",
        "10 m and back, both feet, radio losses",
        _always,
        score_swings,
        HEEL_STRIKE + TOE_OFF,
        each=False,
    ),
    DataSet(
        "tripod_treadmill", "tripod_treadmill", "a treadmill, both feet", _always, score_treadmill,
        HEEL_STRIKE + TOE_OFF + STRIDES,
    ),
    DataSet("gaitmap_examples", "gaitmap_examples", "4 x 10 m, both feet", _borders_known, score_borders, HEEL_STRIKE),
    DataSet(
        "marpino_heel_toe",
        "marpino_heel_toe",
        "heel and toe switches, both feet, inertial samples only",
        _always,
        score_switches,
        HEEL_STRIKE + TOE_OFF,
    ),
)  # fmt: skip
