"""The recordings of hugadb with their labels: what a wearer did at each sample, as the experimenter pressed it.

Chereshnev, Kertesz-Farkas, "HuGaDB: Human Gait Database for Activity Recognition from Wearable Inertial Sensor
Networks", AIST 2017. Sitting counts as standing: a foot on the ground cannot tell. Sitting down and standing up are
between two of our activities, and bicycling and a car are none of them: those samples have no label.
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
"""Our activity of each label of theirs; 6, 7, 9 and 12 are left out."""


@frozen
class Labelled:
    """One recording and who wore it."""

    path: Path
    subject: int


def recordings(folder: Path) -> list[Labelled]:
    """The recordings in `folder` (that of hugadb itself), by name. RecordingError when it does not hold them."""
    about = folder / "dataset.json"
    try:
        told = json.loads(about.read_text(encoding="utf-8"))["recordings"]
        found = [Labelled(folder / f"{name}.npz", int(told[name]["subject"])) for name in sorted(told)]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RecordingError(about, "does not say which recordings there are and who wore them") from error
    return [one for one in found if one.path.is_file()]


def labels(path: Path) -> tuple[Sequence[float], list[Activity | None]]:
    """(times of the samples in s, the activity at each; None where it has no label of ours)."""
    with np.load(path, allow_pickle=False) as archive:
        times: list[float] = archive["t"].tolist()
        codes: list[int] = archive["activity"].tolist()
    return times, [LABELS.get(code) for code in codes]
