"""Learns the thresholds and the hidden Markov model of `TwoSecondWindows` from windows whose activity is known.

    python -m solepath.lab.train.footstep_activity HUGADB

writes footstep_activity.json beside the part. The same data give the same file.

Liu et al. 2015 take the thresholds from cumulative distributions (fig. 6). Here a threshold is where the two curves are
furthest apart, so that the sum of two shares is smallest: of what should be below and is not, and of what should be
above and is not. The mixture has one component for each activity and source of data. Running is a component of walking,
because it is none of the paper's activities."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ...papers.footstep_tracker.activity import window_model
from ...papers.footstep_tracker.activity.two_second_windows import MOVING
from ...papers.footstep_tracker.activity.window_model import LEAST_VARIANCE, Gaussian, WindowModel, window_features
from ...papers.footstep_tracker.activity.windows import HOP, WINDOW, FootWindow, FootWindows
from ...recording.decoded import decode_recording
from ...recording.samples import load_samples
from ...types import Activity, Foot, Sample
from . import emulated
from .hugadb import labels, recordings

LIFTS = (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)
SHRUNK = 0.1
"""Share of the common covariance in that of each class, because few windows determine it badly."""
AROUND = 10
"""Number of windows on either side whose median is the local mean of standing."""
BESIDE = 4
"""Number of windows before and after a ride that may hold its pulses; labels pressed by hand are about a second off."""
EDGE = 0.5
"""Time at both ends of a label that is not used, s, because labels are pressed by hand."""
WALKS = 12
"""Number of emulated walks."""
STILL_VARIANCE = 10.0
"""Variance of a_z, m^2/s^4, above which nobody stands still; used only to learn the other threshold."""


@frozen
class LabelledWindow:
    """One window of the feet that have samples."""

    index: int
    activity: Activity | None
    """Activity during the whole window; None when it changes or is not labelled."""
    middle: Activity | None
    """Activity in the middle of the window; None when it is not labelled."""
    feet: tuple[FootWindow, ...]


@frozen
class RecordingWindows:
    """The windows of one recording. `source`: the kind of data that it is of."""

    source: str
    windows: tuple[LabelledWindow, ...]


def features(
    source: str, samples: Iterable[Sample], t: NDArray[Any], activities: Sequence[Activity | None]
) -> RecordingWindows:
    """Return the windows of a recording, whose activities are `activities` at `t` (n,), s."""
    feet: dict[Foot, FootWindows] = {}
    origin: float | None = None
    found: dict[int, list[FootWindow]] = {}
    for sample in samples:
        if sample.acc is None or sample.site.foot is None:
            continue
        origin = sample.t if origin is None else origin
        feet.setdefault(sample.site.foot, FootWindows()).update(sample.t - origin, sample.acc, sample.gyro)
    for foot in Foot:
        for window in feet[foot].ready if foot in feet else ():
            found.setdefault(window.index, []).append(window)
    labelled = []
    for index, windows in sorted(found.items()):
        end = (origin or 0.0) + (index + 1) * HOP
        first, middle, last = np.searchsorted(t, [end - WINDOW - EDGE, end - 0.5 * WINDOW, end + EDGE])
        during = set(activities[first:last])
        at = activities[min(int(middle), len(activities) - 1)]
        labelled.append(LabelledWindow(index, during.pop() if len(during) == 1 else None, at, tuple(windows)))
    return RecordingWindows(source, tuple(labelled))


def of_recording(path: Path) -> RecordingWindows:
    """Return the windows of one of hugadb's recordings."""
    t, activities = labels(path)
    return features("hugadb", load_samples(path), np.array(t), activities)


def train(examples: Sequence[RecordingWindows], trained_on: str) -> WindowModel:
    """Return the model of those windows. Raise ValueError when they lack an activity of the paper."""
    still, moving = [], []
    for labelled in (labelled for one in examples for labelled in one.windows):
        level = _level(labelled)
        if labelled.activity is Activity.STANDING or labelled.activity in LIFTS:
            still.append(level)
        elif labelled.activity is not None:
            moving.append(level)
    if not still or not moving:
        raise ValueError("there are no windows of standing, or none of walking")
    standing, riding = _pulses(examples)
    mixtures = _mixtures(examples)
    return WindowModel(
        trained_on=trained_on,
        moving=_rounded(float(np.exp(threshold(still, moving)))),
        pulse=_rounded(threshold(standing, riding)),
        walking=mixtures[Activity.WALKING],
        stairs_up=mixtures[Activity.STAIRS_UP],
        stairs_down=mixtures[Activity.STAIRS_DOWN],
        transitions=_transitions(examples),
    )


def threshold(below: Sequence[float], above: Sequence[float]) -> float:
    """Return the value at which the cumulative distributions are furthest apart: the middle of all such values."""
    low, high = np.sort(below), np.sort(above)
    places = np.unique(np.concatenate([low, high]))
    between = 0.5 * (places[1:] + places[:-1])
    too_high = 1.0 - np.searchsorted(low, between) / len(low)
    too_low = np.searchsorted(high, between) / len(high)
    wrong = too_high + too_low
    best = np.flatnonzero(wrong <= wrong.min() + 1e-12)
    return float(0.5 * (places[best[0]] + places[best[-1] + 1]))


def _level(labelled: LabelledWindow) -> float:
    """Return the logarithm of the mean variance of the feet."""
    return float(np.log(np.mean([window.variance for window in labelled.feet]) + LEAST_VARIANCE))


def _pulses(examples: Sequence[RecordingWindows]) -> tuple[list[float], list[float]]:
    """Return how far each standing window's mean is from its neighbours', and the weaker pulse of each lift ride."""
    standing: list[float] = []
    riding: list[float] = []
    for one in examples:
        still_windows = [labelled for labelled in one.windows if _level(labelled) < np.log(STILL_VARIANCE)]
        means = np.array([np.mean([window.mean for window in labelled.feet]) for labelled in still_windows])
        off = [
            mean - float(np.median(means[max(0, k - AROUND) : k + AROUND + 1])) for k, mean in enumerate(means.tolist())
        ]
        of_ride = [labelled.middle in LIFTS for labelled in still_windows]
        for k, labelled in enumerate(still_windows):
            if labelled.activity is Activity.STANDING and not any(of_ride[max(0, k - BESIDE) : k + BESIDE + 1]):
                standing.append(abs(off[k]))
        for activity, ride in groupby(range(len(still_windows)), key=lambda k: still_windows[k].middle):
            if activity in LIFTS:
                numbers = list(ride)
                values = off[max(0, numbers[0] - BESIDE) : numbers[-1] + BESIDE + 1]
                riding.append(min(max(values), -min(values)))
    return standing, riding or [1.0]


def _mixtures(examples: Sequence[RecordingWindows]) -> dict[Activity, tuple[Gaussian, ...]]:
    """Return the Gaussians of each state of the hidden Markov model."""
    groups: dict[tuple[Activity, str], list[tuple[float, ...]]] = {}
    for one in examples:
        for labelled in one.windows:
            if labelled.activity in MOVING or labelled.activity is Activity.RUNNING:
                whole = [x for x in map(window_features, labelled.feet) if len(x) == len(window_model.FEATURES)]
                groups.setdefault((labelled.activity, one.source), []).extend(whole)
    fit = {key: np.array(rows) for key, rows in groups.items() if len(rows) > 2 * len(window_model.FEATURES)}
    every, size = sum(map(len, fit.values())), len(window_model.FEATURES)
    common = sum((np.cov(rows.T) * len(rows) for rows in fit.values()), np.zeros((size, size))) / max(every, 1)
    mixtures: dict[Activity, tuple[Gaussian, ...]] = {}
    for state in MOVING:
        own = [key for key in fit if key[0] is state or state is Activity.WALKING and key[0] is Activity.RUNNING]
        if not own:
            raise ValueError(f"there are no windows of {state.value}")
        mixtures[state] = tuple([_gaussian(fit[key], common, 1.0 / len(own)) for key in own])
    return mixtures


def _gaussian(rows: NDArray[Any], common: NDArray[Any], weight: float) -> Gaussian:
    factor = np.linalg.cholesky((1.0 - SHRUNK) * np.cov(rows.T) + SHRUNK * common)
    triangle = tuple([tuple([_rounded(value) for value in row[: k + 1]]) for k, row in enumerate(factor.tolist())])
    return Gaussian(_rounded(weight), tuple([_rounded(value) for value in rows.mean(axis=0).tolist()]), triangle)


def _transitions(examples: Sequence[RecordingWindows]) -> tuple[tuple[float, ...], ...]:
    """Return the transition probabilities from one window to the next, counted, with one more count for each."""
    counts = np.ones((3, 3))
    for one in examples:
        for before, after in zip(one.windows, one.windows[1:], strict=False):
            if before.middle in MOVING and after.middle in MOVING:
                counts[MOVING.index(before.middle), MOVING.index(after.middle)] += 1.0
    rows = counts / counts.sum(axis=1, keepdims=True)
    return tuple([tuple([_rounded(value) for value in row]) for row in rows.tolist()])


def _rounded(value: float) -> float:
    return float(f"{value:.5g}")


def of_emulated(seed: int) -> RecordingWindows:
    """Return the windows of an emulated walk with some jogging."""
    walked = emulated.walk(seed, jogging=True)
    truth = walked.truth
    t = np.arange(0.0, truth.duration, 1.0 / emulated.RATE)
    return features("emulated", decode_recording(walked.packets).samples, t, [truth.activity(float(at)) for at in t])


def main(folder: Path) -> None:
    """Write the model of all data beside the part that reads it."""
    examples = [of_recording(one.path) for one in recordings(folder)]
    first, last = emulated.FIRST_TO_LEARN_FROM, emulated.FIRST_TO_LEARN_FROM + WALKS - 1
    examples += [of_emulated(seed) for seed in range(first, last + 1)]
    model = train(examples, f"hugadb, all wearers, and emulated walks at 20 Hz, seeds {first} to {last}")
    file = Path(window_model.__file__).with_name("footstep_activity.json")
    file.write_text(json.dumps(attrs.asdict(model), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
