"""The data sets with a reference ("truth"), and the scorer of each. The README in the data folder names their sources.

Every scorer takes the recording's path, its entry in dataset.json and the settings of the run. The session receives
only the samples. For emulated data the path is only a name, and the entry has the seed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from attrs import frozen

from solepath.recipes import Recipe

from ..emulated.heading import CHECKED_TIMES, EQUIPMENT, LENGTHS, score_heading
from ..emulated.heading_walks import KINDS, WITH_COMPASS
from ..emulated.reports import TIMES, score_reports
from ..emulated.walks import score_floors
from ..measures.confusion import CHECKS, CLASSES
from ..measures.score import Scored
from .activity import STAIR_SPANS, score_labelled, score_stairs
from .run import Meta, RunSettings
from .timing import (
    score_borders,
    score_force,
    score_insoles,
    score_pressed,
    score_pressed_insoles,
    score_swings,
    score_switches,
    score_treadmill,
)
from .tracking import (
    EIGHT_STRIDES,
    score_counted,
    score_eight,
    score_loop,
    score_optitrack,
    score_surveyed,
    score_vicon,
)


@frozen
class DataSet:
    """A data set, its scorer and the figures of its table."""

    name: str
    title: str
    score: Callable[[Path, Meta, RunSettings], Scored]
    figures: tuple[str, ...]
    """Names of the figures in JSON, in the order of the table's columns."""
    folders: tuple[str, ...] = ()
    """Names of the folders below the data directory; empty when the only folder has the name of the data set."""
    has_truth: Callable[[str, Meta], bool] = lambda name, meta: True
    """Function of a recording's name and entry that returns whether the recording has a reference."""
    lists_recordings: bool = True
    """True when the table has a line for every recording."""
    has_pressure: bool = False
    """True when the session receives the pressure of the soles."""
    folds: bool = False
    """True when the data set is divided by wearer, and activity parts are trained on other wearers (learning.py)."""

    def suits(self, recipe: Recipe) -> bool:
        """Return whether the recipe can be scored on these data: pressure recipes need data with pressure."""
        return self.has_pressure or not recipe.needs_pressure


def _is_surveyed(name: str, meta: Meta) -> bool:
    return bool(meta.get("every_stride_surveyed"))


TRACK_FIGURES = ("armse_2d", "rms_2d", "rms_3d", "rms_z", "path", "relative")
STRIDE_FIGURES = ("strides_found", "strides_true", "strides_invented", "stride_error", "stride_error_median")
LOOP_FIGURES = ("end_error", "end_error_2d", "end_height", "path", "relative", "drift", "drift_stride")
HEEL_STRIKE_FIGURES = (
    "heel_strike_true", "heel_strike_found", "heel_strike_f1", "heel_strike_bias", "heel_strike_mad",
    "heel_strike_scatter", "heel_strike_off",
)  # fmt: skip
ACTIVITY_FIGURES = ("accuracy", *CHECKS, "most_frequent", *(f"f1_{activity.value.lower()}" for activity in CLASSES))
RIDE_FIGURES = ("rides_true", "rides_found", "rides_invented")
TOE_OFF_FIGURES = (
    "toe_off_true", "toe_off_found", "toe_off_f1", "toe_off_bias", "toe_off_mad", "toe_off_scatter", "toe_off_off",
)  # fmt: skip
LEG_FIGURES = ("leg_error_median", "leg_error", "leg_bias")
BODY_LEG_FIGURES = ("body_leg_error_median", "body_leg_error", "body_leg_bias")
STRIDE_TIME_FIGURES = ("stride_time_error_median", "stride_time_error", "stride_time_bias")
CONTACT_FIGURES = HEEL_STRIKE_FIGURES + TOE_OFF_FIGURES + STRIDE_TIME_FIGURES + STRIDE_FIGURES

DATASETS = (
    DataSet("pyshoe_vicon", "VICON tracks, one shoe", score_vicon, TRACK_FIGURES + STRIDE_FIGURES[:4]),
    DataSet(
        "gumushane_surveyed", "every footprint surveyed, one shoe", score_surveyed,
        ("position_mean", "position_max", "authors", "authors_beaten", "rms_z", "path", "relative", "drift",
         "drift_stride", "nees_end", "held_end", *STRIDE_FIGURES, "stride_error_track"),
        folders=("gumushane_gcp",), has_truth=_is_surveyed,
    ),
    DataSet(
        "gumushane_counted", "strides counted, some corners surveyed, one shoe", score_counted,
        (*STRIDE_FIGURES[:3], "stride_longest", *LEG_FIGURES, "end_error_2d", "end_height"),
        folders=("gumushane_gcp",),
        has_truth=lambda name, meta: "n_true_strides" in meta and not _is_surveyed(name, meta),
    ),
    DataSet(
        "xio_closed_walks", "a closed loop, one shoe", score_loop, LOOP_FIGURES,
        has_truth=lambda name, meta: bool(meta.get("closed_loop")),
    ),
    DataSet(
        "openshoe_loops", "closed figures of eight at a brisk pace, one sole", score_eight,
        (*LOOP_FIGURES, *STRIDE_FIGURES[:3], "stride_longest"), has_truth=lambda name, meta: name in EIGHT_STRIDES,
    ),
    DataSet(
        "smart_insole_35", "OptiTrack tracks, one insole", score_optitrack, TRACK_FIGURES + STRIDE_FIGURES,
        has_truth=lambda name, meta: bool(meta.get("optitrack")), has_pressure=True,
    ),
    DataSet(
        "ipol_10m_uturn", "10 m and back, both feet, radio losses", score_swings,
        (*HEEL_STRIKE_FIGURES, *TOE_OFF_FIGURES, *STRIDE_TIME_FIGURES, *LEG_FIGURES, *BODY_LEG_FIGURES,
         "end_error_2d", "end_height", "uturn_found", "uturn_angle", "uturn_invented"),
        lists_recordings=False,
    ),
    DataSet(
        "tripod_treadmill", "a treadmill, both feet", score_treadmill,
        ("drift", "drift_left", "drift_right", "drift_stride", *CONTACT_FIGURES),
    ),
    DataSet(
        "gaitmap_examples", "4 x 10 m, both feet", score_borders,
        (*HEEL_STRIKE_FIGURES, *STRIDE_TIME_FIGURES, *LEG_FIGURES, *BODY_LEG_FIGURES, "leg_spread",
         "end_error_2d", "end_height"),
        has_truth=lambda name, meta: "gt_borders_left" in meta["keys"],
    ),
    DataSet(
        "marpino_heel_toe", "heel and toe switches, both feet, inertial samples only", score_switches,
        HEEL_STRIKE_FIGURES + TOE_OFF_FIGURES + LEG_FIGURES,
    ),
    DataSet(
        "marpino_pressed", "heel and toe switches as an insole of two cells, both feet", score_pressed,
        HEEL_STRIKE_FIGURES + TOE_OFF_FIGURES + LEG_FIGURES, folders=("marpino_heel_toe",), has_pressure=True,
    ),
    DataSet(
        "moticon_opengo", "the vendor's contacts and strides, both insoles, inertial only", score_insoles,
        CONTACT_FIGURES, has_truth=lambda name, meta: "gt_ic_left" in meta["keys"],
    ),
    DataSet(
        "moticon_pressed", "the vendor's contacts and strides, both insoles with their 16 cells", score_pressed_insoles,
        CONTACT_FIGURES,
        folders=("moticon_opengo",), has_truth=lambda name, meta: "gt_ic_left" in meta["keys"], has_pressure=True,
    ),
    DataSet(
        "gaitpdb_vgrf", "eight force sensors below each foot and nothing else", score_force,
        HEEL_STRIKE_FIGURES + TOE_OFF_FIGURES, has_pressure=True,
    ),
    DataSet(
        "hugadb", "activities, both feet, five folds by wearer", score_labelled, ACTIVITY_FIGURES + RIDE_FIGURES,
        lists_recordings=False, folds=True,
    ),
    DataSet(
        "hugadb_corrected", "the same, labels that contradict the signal corrected",
        partial(score_labelled, corrected=True), ACTIVITY_FIGURES + RIDE_FIGURES, folders=("hugadb",),
        lists_recordings=False, folds=True,
    ),
    DataSet(
        "stairs", "stairs and level ways, and what of them is called stairs", score_stairs,
        ("stairs_called", "stairs_direction", "level_called"),
        folders=("gaitmap_examples", "xio_closed_walks"), has_truth=lambda name, meta: name in STAIR_SPANS,
    ),
)  # fmt: skip

WALK_FIGURES = (
    "rms_2d", "position_end", "end_relative", "position_max", "largest_relative", "height_end", "height_max", "path",
)  # fmt: skip
HEADING_FIGURES = (
    "end_relative", "position_end", "heading_end", "radius_error", "path",
    *(f"{figure}_{t}" for t in CHECKED_TIMES for figure in ("nees", "held", "heading_nees")),
)  # fmt: skip
REPORT_FIGURES = (
    "end_without", "end_return", "way_places", "nees_return", "held_return", "rejected_first", "rejected_later", "used",
)  # fmt: skip
EMULATED = (
    *(
        DataSet(
            f"emulated_{kind}_{length}{suffix}",
            f"{kind.replace('_', ' ')}, {length}, insoles on both feet{equipment.name}",
            partial(score_heading, kind, is_complete, equipment), HEADING_FIGURES, has_pressure=True,
        )
        for length, is_complete in LENGTHS.items()
        for kind in KINDS
        for suffix, equipment in EQUIPMENT.items()
        if equipment.disturbance is None or kind in WITH_COMPASS
    ),
    *(
        DataSet(
            f"emulated_{kind}_30min_here", f"{kind.replace('_', ' ')}, 30min, a person who says where they are",
            partial(score_reports, kind, LENGTHS["30min"], TIMES), REPORT_FIGURES, has_pressure=True,
        )
        for kind in WITH_COMPASS
    ),
    DataSet(
        "emulated_four_floors", "four floors of stairs up and down, emulated insoles on both feet", score_floors,
        WALK_FIGURES + STRIDE_FIGURES, has_pressure=True,
    ),
)  # fmt: skip
"""Emulated data sets, which need no files: a recording is a seed."""
