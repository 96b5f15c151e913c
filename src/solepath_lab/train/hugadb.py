"""The recordings of hugadb with the activity of each sample, which the experimenter labelled by pressing keys.

Chereshnev, Kertesz-Farkas, "HuGaDB: Human Gait Database for Activity Recognition from Wearable Inertial Sensor
Networks", AIST 2017. Sitting counts as standing, because a foot on the ground moves in neither of them. Sitting down,
standing up, bicycling and driving are none of the activities of this library, so these samples have no label."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from attrs import frozen

from solepath.recording import RecordingError
from solepath.recording.samples.npz import read_arrays
from solepath.types import Activity

from ..descriptions import read_description

Span = tuple[float, float, Activity]
"""Start (s), end (s) and activity of a span of time."""
SPAN_GAP = 0.5
"""Smallest time between two samples of one activity that parts them into two spans, s."""
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


DOWN, STANDING, CLIMBING = Activity.ELEVATOR_DOWN, Activity.STANDING, Activity.STAIRS_UP
CORRECTIONS: dict[str, tuple[Span, ...]] = {
    # eight flights are labelled as stairs down, but each stride rises by 0.3 to 0.6 m: two stairs at a time
    "various_03_05": (
        (5.75, 9.68, CLIMBING),
        (13.66, 17.81, CLIMBING),
        (21.31, 25.51, CLIMBING),
        (29.06, 33.16, CLIMBING),
    ),
    "various_03_06": (
        (6.4, 10.13, CLIMBING),
        (13.56, 17.78, CLIMBING),
        (22.24, 26.38, CLIMBING),
        (30.05, 34.49, CLIMBING),
    ),
    # the first pulse of three rides that are labelled up is downwards, the second one upwards
    "various_06_18": ((65.49, 80.14, DOWN), (88.46, 97.29, DOWN), (107.27, 119.6, DOWN)),
    # two labelled rides have no pulses; each comes after a ride that is labelled too
    "various_08_18": ((50.55, 56.71, STANDING), (80.97, 91.53, STANDING)),
    # 13 s after its last pulse a ride is still labelled; 43 s up are a ride of 10 s up and one of 13 s down
    "various_10_00": ((69.0, 82.36, STANDING), (95.5, 107.5, STANDING), (107.5, 120.0, DOWN), (120.0, 128.9, STANDING)),
}
"""Activities between two times, s, whose labels contradict the signal: pulses of specific force, or rises of strides.

Whoever starts upwards is pressed down first: |acc| rises by 0.3 to 1.2 m/s^2 for two seconds, and falls when the
elevator stops. Start and end of the other rides stay as labelled, up to 5 s from their pulses."""


def labels(path: Path, corrected: bool = False) -> tuple[Sequence[float], list[Activity | None]]:
    """Return the times of the samples, s, and the activity of each; None for a sample without one of LABELS.

    With `corrected`, labels that contradict the signal are replaced (`CORRECTIONS`)."""
    arrays = read_arrays(path, lambda key: key in ("t", "activity"))
    times: list[float] = arrays["t"].tolist()
    activities = [LABELS.get(code) for code in arrays["activity"].tolist()]
    for start, end, activity in CORRECTIONS.get(path.stem, ()) if corrected else ():
        activities = [activity if start <= t < end else old for t, old in zip(times, activities, strict=True)]
    return times, activities


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
