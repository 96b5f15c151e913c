"""The data sets with a reference ("truth"), and the scorer of each. The README in the data folder names their sources.

Every scorer takes the recording's path, its entry in dataset.json and the settings of the run. The session receives
only the samples. For emulated data the path is only a name, and the entry has the seed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from attrs import frozen

from solepath.recipes import Recipe

from ..emulated.heading import EQUIPMENT, LENGTHS, score_heading
from ..emulated.heading_walks import KINDS, WITH_COMPASS
from ..emulated.reports import TIMES, score_reports
from ..emulated.walks import score_floors
from ..measures.score import Scored
from ..train.hugadb import EIGHT_TIMES
from .activity import STAIR_SPANS, score_labelled, score_stairs
from .not_walking import MOTIONS, score_alarms, score_not_walking, score_slow_walk
from .run import Meta, RunSettings
from .timing import (
    score_borders,
    score_force,
    score_insoles,
    score_soles,
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
    """A data set and its scorer."""

    name: str
    title: str
    score: Callable[[Path, Meta, RunSettings], Scored]
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


def _has_contacts(name: str, meta: Meta) -> bool:
    return "gt_ic_left" in meta["keys"]


def _takes_no_step(name: str, meta: Meta) -> bool:
    return all(int(code) in MOTIONS for code in meta["labels"])


def _is_surveyed(name: str, meta: Meta) -> bool:
    return bool(meta.get("every_stride_surveyed"))


DATASETS = (
    DataSet("pyshoe_vicon", "VICON tracks, one shoe", score_vicon),
    DataSet(
        "gumushane_surveyed", "every footprint surveyed, one shoe", score_surveyed, ("gumushane_gcp",), _is_surveyed
    ),
    DataSet(
        "gumushane_counted", "strides counted, some corners surveyed, one shoe", score_counted, ("gumushane_gcp",),
        lambda name, meta: "n_true_strides" in meta and not _is_surveyed(name, meta),
    ),
    DataSet(
        "xio_closed_walks", "a closed loop, one shoe", score_loop,
        has_truth=lambda name, meta: bool(meta.get("closed_loop")),
    ),
    DataSet(
        "openshoe_loops", "closed figures of eight at a brisk pace, one sole", score_eight,
        has_truth=lambda name, meta: name in EIGHT_STRIDES,
    ),
    DataSet(
        "smart_insole_35", "OptiTrack tracks, one insole", score_optitrack,
        has_truth=lambda name, meta: bool(meta.get("optitrack")), has_pressure=True,
    ),
    DataSet(
        "ipol_10m_uturn", "10 m and back, both feet, radio losses", score_swings, lists_recordings=False,
    ),
    DataSet("tripod_treadmill", "a treadmill, both feet", score_treadmill),
    DataSet(
        "gaitmap_examples", "4 x 10 m, both feet", score_borders,
        has_truth=lambda name, meta: "gt_borders_left" in meta["keys"],
    ),
    DataSet("marpino_heel_toe", "heel and toe switches, both feet, inertial samples only", score_switches),
    DataSet(
        "marpino_pressed", "heel and toe switches as an insole of two cells, both feet",
        partial(score_switches, pressed=True),
        ("marpino_heel_toe",), has_pressure=True,
    ),
    DataSet(
        "moticon_opengo", "the vendor's contacts and strides, both insoles, inertial only", score_insoles,
        has_truth=_has_contacts,
    ),
    DataSet(
        "moticon_pressed", "the vendor's contacts and strides, both insoles with their 16 cells",
        partial(score_insoles, pressed=True),
        ("moticon_opengo",), _has_contacts, has_pressure=True,
    ),
    DataSet(
        "gaitpdb_vgrf", "eight force sensors below each foot; no other sensor", score_force, has_pressure=True,
    ),
    DataSet(
        "fsr_treadmill", "two pressure cells below each foot, unloaded voltage unknown; no other sensor",
        score_soles, lists_recordings=False, has_pressure=True,
    ),
    DataSet(
        "fsr_treadmill_learnt", "the same from the fifth contact, once that voltage is learnt",
        partial(score_soles, first=4), ("fsr_treadmill",), lists_recordings=False, has_pressure=True,
    ),
    DataSet(
        "hugadb", "activities, both feet, five folds by wearer", score_labelled, lists_recordings=False, folds=True,
    ),
    DataSet(
        "hugadb_corrected", "the same, after labels that contradict the signal were corrected",
        partial(score_labelled, corrected=True), ("hugadb",), lists_recordings=False, folds=True,
    ),
    DataSet(
        "stairs", "stairs and level walking", score_stairs,
        ("gaitmap_examples", "xio_closed_walks"), lambda name, meta: name in STAIR_SPANS,
    ),
    DataSet("slow_gait", "slow walks on the level, strides counted, one foot", score_slow_walk),
    DataSet(
        "hugadb_daily", "bicycling, sitting, in a car: no steps, both feet", score_not_walking,
        has_truth=_takes_no_step,
    ),
    DataSet(
        "hugadb_daily_corrected", "the same, after angular rates eight times too large were corrected",
        partial(score_not_walking, true_rates=True), ("hugadb_daily",),
        lambda name, meta: name in EIGHT_TIMES and _takes_no_step(name, meta),
    ),
    DataSet("sevivi_hops", "two sensors that are not on feet", score_alarms),
)  # fmt: skip

EMULATED = (
    *(
        DataSet(
            f"emulated_{kind}_{length}{suffix}",
            f"{kind.replace('_', ' ')}, {length}, insoles on both feet{equipment.name}",
            partial(score_heading, kind, is_complete, equipment), has_pressure=True,
        )
        for length, is_complete in LENGTHS.items()
        for kind in KINDS
        for suffix, equipment in EQUIPMENT.items()
        if equipment.disturbance is None or kind in WITH_COMPASS
    ),
    *(
        DataSet(
            f"emulated_{kind}_30min_here", f"{kind.replace('_', ' ')}, 30min, a person who says where they are",
            partial(score_reports, kind, LENGTHS["30min"], TIMES), has_pressure=True,
        )
        for kind in WITH_COMPASS
    ),
    DataSet(
        "emulated_four_floors", "four floors of stairs up and down, emulated insoles on both feet", score_floors,
        has_pressure=True,
    ),
)  # fmt: skip
"""Emulated data sets, which need no files: a recording is a seed."""
