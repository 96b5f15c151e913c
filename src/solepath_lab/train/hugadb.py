"""The recordings of hugadb with the activity of each sample, which the experimenter labelled by pressing keys.

Chereshnev, Kertesz-Farkas, "HuGaDB: Human Gait Database for Activity Recognition from Wearable Inertial Sensor
Networks", AIST 2017. Sitting counts as standing, because a foot on the ground moves in neither of them. Sitting down,
standing up, bicycling and driving are none of the activities of this library, so these samples have no label."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from attrs import evolve, frozen

from solepath.recording import RecordingError
from solepath.recording.samples.npz import read_arrays
from solepath.types import Activity, Sample
from solepath.types.vector import ZERO, add

from ..descriptions import KNOWN, read_description

Span = tuple[float, float, Activity]
"""Start (s), end (s) and activity of a span of time."""
SPAN_GAP = 0.5
"""Smallest time between two samples of one activity that parts them into two spans, s."""
LABELS = {int(code): Activity(name) for code, name in KNOWN["hugadb"]["labels"].items()}
"""Activity of each label code of hugadb."""


def known_spans(spans: dict[str, Any]) -> dict[str, list[Span]]:
    """Return spans of known.toml by recording."""
    return {
        recording: [(start, end, Activity(name)) for start, end, name in spans] for recording, spans in spans.items()
    }


CORRECTIONS = known_spans(KNOWN["hugadb"]["corrections"])
"""Spans whose labels contradict the signal, with the right activity, by recording."""


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


def labels(path: Path, corrected: bool = False) -> tuple[Sequence[float], list[Activity | None]]:
    """Return the times of the samples, s, and the activity of each; None for a sample without one of LABELS.

    With `corrected`, labels that contradict the signal are replaced (`CORRECTIONS`)."""
    arrays = read_arrays(path, lambda key: key in ("t", "activity"))
    times: list[float] = arrays["t"].tolist()
    activities = [LABELS.get(code) for code in arrays["activity"].tolist()]
    for start, end, activity in CORRECTIONS.get(path.stem, ()) if corrected else ():
        activities = [activity if start <= t < end else old for t, old in zip(times, activities, strict=True)]
    return times, activities


EIGHT_TIMES = frozenset(KNOWN["hugadb_daily"]["gyroscope_eight_times"])
"""Recordings of hugadb_daily whose angular rates are eight times too large."""


def with_true_rates(samples: Iterable[Sample]) -> list[Sample]:
    """Return the samples of one of EIGHT_TIMES with an eighth of their angular rates."""
    return [evolve(one, gyro=None if one.gyro is None else add(ZERO, one.gyro, 0.125)) for one in samples]


FOLDS = tuple([frozenset[int](wearers) for wearers in KNOWN["hugadb"]["folds"]])
"""Wearers of each fold."""


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
