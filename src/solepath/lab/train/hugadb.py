"""The recordings of hugadb with the activity of each sample, which the experimenter labelled by pressing keys.

Chereshnev, Kertesz-Farkas, "HuGaDB: Human Gait Database for Activity Recognition from Wearable Inertial Sensor
Networks", AIST 2017. Sitting counts as standing, because a foot on the ground moves in neither of them. Sitting down,
standing up, bicycling and driving are none of the activities of this library, so these samples have no label."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from attrs import frozen

from ...recording import RecordingError
from ...recording.samples.npz import read_arrays
from ...types import Activity
from ..descriptions import read_description

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
"""Activity of each label code of hugadb; codes 6, 7, 9 and 12 have no activity."""


Span = tuple[float, float, Activity]
"""Start (s), end (s) and activity of a span of time."""
SPAN_GAP = 0.5
"""Smallest time between two samples of one activity that parts them into two spans, s."""


@frozen
class LabelledRecording:
    """One recording and its wearer."""

    path: Path
    subject: int


def recordings(folder: Path) -> list[LabelledRecording]:
    """Return the recordings in the folder of hugadb, sorted by name. Raise RecordingError when they are not listed."""
    about = folder / "dataset.json"
    try:
        entries = read_description(about)["recordings"]
        found = [LabelledRecording(folder / f"{name}.npz", int(entries[name]["subject"])) for name in sorted(entries)]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RecordingError(about, "does not say which recordings there are and who wore them") from error
    return [one for one in found if one.path.is_file()]


def labels(path: Path) -> tuple[Sequence[float], list[Activity | None]]:
    """Return the times of the samples, s, and the activity of each; None for a sample without one of LABELS."""
    arrays = read_arrays(path, lambda key: key in ("t", "activity"))
    times: list[float] = arrays["t"].tolist()
    return times, [LABELS.get(code) for code in arrays["activity"].tolist()]


FOLDS: tuple[frozenset[int], ...] = tuple(frozenset(wearers) for wearers in ((1, 12), (3, 15), (6,), (8,), (10,)))
"""Wearers (`subject` in dataset.json) of each fold. Scores on a fold come from training on the other four.

No wearer is in two folds, because a part recognises too easily a gait that it was trained on. Five wearers have all but
46 s of the recordings, so each fold has one of them. The other two are added where they change least. Wearer 12, with
one elevator ride down, is with wearer 1, who takes no elevator. Wearer 15, with 30 s of sitting and standing, is with
wearer 3, who has the fewest minutes after wearer 10. The folds are fixed, so that later scores can be compared."""


def fold_of(subject: int) -> int:
    """Return the number of the wearer's fold, from 0. Raise ValueError when no fold has the wearer."""
    for number, wearers in enumerate(FOLDS):
        if subject in wearers:
            return number
    raise ValueError(f"wearer {subject} is in none of the {len(FOLDS)} folds")


def spans(t: Sequence[float], labels: Sequence[Activity | None]) -> list[Span]:
    """Return the spans of consecutive samples with the same label, each from its first to its last sample."""
    found: list[Span] = []
    for k, (time, activity) in enumerate(zip(t, labels, strict=True)):
        if activity is not None:
            continues = k > 0 and labels[k - 1] is activity and time - t[k - 1] < SPAN_GAP
            found.append((found.pop()[0] if continues else time, time, activity))
    return found
