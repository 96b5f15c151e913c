"""Scores what is reported of slow walkers, and of wearers and sensors that do not walk. datasets.py describes scorers.

- `walking_share`: share of the time from the first to the last stride that is called walking; 0 without strides
- `flaws_share`: share of the strides with a flaw, among those whose values are not cut off at the end of a range
- `alarms`: number of findings about the data that nothing explains (measures/alarms.py)"""

from __future__ import annotations

from pathlib import Path

from solepath.events import Flaw
from solepath.types import Activity
from solepath.walk.walk import Walk

from ..descriptions import KNOWN
from ..measures.alarms import alarms
from ..measures.not_walking import NotWalking
from ..measures.score import Scored
from ..measures.strides import counted_score
from .run import Meta, RunSettings, run, truth_of

MOTIONS: dict[int, str] = {int(code): name for code, name in KNOWN["hugadb"]["not_walking"].items()}
"""Motion of each label code of hugadb and hugadb_daily in which nobody takes a step."""


def span_of(path: Path) -> tuple[float, float]:
    """Return the times of the first and the last sample in a recording's file, s."""
    times = [values for key, values in truth_of(path).items() if key == "t" or key.startswith("t_")]
    return min([float(one[0]) for one in times]), max([float(one[-1]) for one in times])


def score_slow_walk(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score a slow walk without halts, whose strides were counted."""
    walk = run(path, settings, poses=False).walk
    strides = [one for kept in walk.strides.values() for one in kept]
    whole = [one for one in strides if Flaw.RANGE not in one.flaws]
    return Scored(
        path.stem,
        figures={
            "walking_share": walking_share(walk),
            "flaws_share": sum([bool(one.flaws) for one in whole]) / len(whole) if whole else None,
            "alarms": _count_alarms(path, walk),
        },
        strides=counted_score(int(meta["swings"]), [one.length for one in strides]),
    )


def walking_share(walk: Walk) -> float:
    """Return the share of the time from the first to the last stride of a walk that is called walking.

    It starts at the first toe-off, because the first stride contains the standing before it."""
    strides = [one for kept in walk.strides.values() for one in kept]
    if not strides:
        return 0.0
    start = min([one.t_start if one.t_toe_off is None else one.t_toe_off for one in strides])
    times = NotWalking.of(walk, start, max([one.t_end for one in strides]))
    return times.times[Activity.WALKING] / times.duration


def score_not_walking(path: Path, meta: Meta, settings: RunSettings, true_rates: bool = False) -> Scored:
    """Score a recording of hugadb_daily in which the wearer takes no step.

    `true_rates` corrects angular rates that are eight times too large."""
    walk = run(path, settings, poses=False, true_rates=true_rates).walk
    motions = sorted({MOTIONS[int(code)] for code in meta["labels"]})
    return Scored(
        path.stem,
        figures={"alarms": _count_alarms(path, walk)},
        idle=NotWalking.of(walk, *span_of(path)),
        groups=("all", *motions),
    )


def score_alarms(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the alarms in a recording of sensors that are not on feet."""
    return Scored(path.stem, figures={"alarms": _count_alarms(path, run(path, settings, poses=False).walk)})


def _count_alarms(path: Path, walk: Walk) -> float:
    return float(len(alarms(path.parent.name, walk.found_defects)))
