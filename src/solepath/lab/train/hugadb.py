"""The recordings of hugadb with the activity of each sample, as the experimenter labelled it by pressing a key.

Chereshnev, Kertesz-Farkas, "HuGaDB: Human Gait Database for Activity Recognition from Wearable Inertial Sensor
Networks", AIST 2017. Sitting counts as standing, because a foot on the ground cannot distinguish them. Sitting down and
standing up are between two of our activities, and bicycling and driving are none of them: those samples have no label.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from attrs import frozen

from ...recording import RecordingError
from ...types import Activity

LABELS: dict[int, Activity] = {
    1: Activity.WALKING,
    2: Activity.RUNNING,
    3: Activity.STAIRS_UP,
    4: Activity.STAIRS_DOWN,
    5: Activity.STANDING,
    8: Activity.STANDING,
    10: Activity.ELEVATOR_UP,
    11: Activity.ELEVATOR_DOWN,
}
"""Activity of each label code of hugadb; 6, 7, 9 and 12 are left out."""


Span = tuple[float, float, Activity]
"""Start (s), end (s) and activity of a span of time."""
APART = 0.5
"""Time between two labelled samples that separates two spans, s."""


@frozen
class Labelled:
    """One recording and its wearer."""

    path: Path
    subject: int


def recordings(folder: Path) -> list[Labelled]:
    """Return the recordings in the folder of hugadb, by name. Raise RecordingError when it does not hold them."""
    about = folder / "dataset.json"
    try:
        entries = json.loads(about.read_text(encoding="utf-8"))["recordings"]
        found = [Labelled(folder / f"{name}.npz", int(entries[name]["subject"])) for name in sorted(entries)]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RecordingError(about, "does not say which recordings there are and who wore them") from error
    return [one for one in found if one.path.is_file()]


def labels(path: Path) -> tuple[Sequence[float], list[Activity | None]]:
    """Return the times of the samples, s, and the activity at each; None where it has no label of ours."""
    with np.load(path, allow_pickle=False) as archive:
        times: list[float] = archive["t"].tolist()
        codes: list[int] = archive["activity"].tolist()
    return times, [LABELS.get(code) for code in codes]


FOLDS: tuple[frozenset[int], ...] = tuple(frozenset(wearers) for wearers in ((1, 12), (3, 15), (6,), (8,), (10,)))
"""The wearers (`subject` in dataset.json) of each fold; scores on a fold come from training on the other four.

A wearer is never in two folds, because a gait that was learnt is easily recognised. Five of the wearers have all but 46
s of the recordings, so each fold has one of them. The two others (one lift ride down, 30 s of sitting and standing) are
in the folds where they weigh least: wearer 12 with wearer 1, who rides no lift, wearer 15 with wearer 3, who has the
fewest minutes after wearer 10. The folds are fixed, so that figures of two days and of two methods compare."""


def fold_of(subject: int) -> int:
    """Return the number of the wearer's fold, from 0. Raise ValueError when no fold has the wearer."""
    for number, wearers in enumerate(FOLDS):
        if subject in wearers:
            return number
    raise ValueError(f"wearer {subject} is in none of the {len(FOLDS)} folds")


def spans(t: Sequence[float], labels: Sequence[Activity | None]) -> list[Span]:
    """Return the labelled samples as spans, each up to its last sample."""
    found: list[Span] = []
    for k, (at, activity) in enumerate(zip(t, labels, strict=True)):
        if activity is not None:
            goes_on = k > 0 and labels[k - 1] is activity and at - t[k - 1] < APART
            found.append((found.pop()[0] if goes_on else at, at, activity))
    return found
