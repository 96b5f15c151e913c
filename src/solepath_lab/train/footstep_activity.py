"""Learns the thresholds and the hidden Markov model of `TwoSecondWindows` from windows whose activity is known.

    solepath-lab train footstep-activity HUGADB

writes footstep_activity.json beside the part. The same data give the same file.

Liu et al. 2015 take the thresholds from cumulative distributions (fig. 6). Here a threshold is the value at which the
two distributions are furthest apart. It minimises the share of the lower class above it plus the share of the upper
class below it. The mixture of Gaussians of an activity has one component for each source of data. Running is a
component of walking, because it is none of the paper's activities.

Numbers without a source were chosen by hand; no sweep of them is recorded."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Iterable, Sequence
from itertools import groupby, pairwise
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from solepath.papers.footstep_tracker.activity import window_model
from solepath.papers.footstep_tracker.activity.two_second_windows import MOVING_ACTIVITIES
from solepath.papers.footstep_tracker.activity.window_model import (
    LEAST_VARIANCE,
    Gaussian,
    WindowModel,
    window_features,
)
from solepath.papers.footstep_tracker.activity.windows import HOP, WINDOW, FootWindow, FootWindows
from solepath.recording.decoded import decode_recording
from solepath.recording.samples import load_samples
from solepath.types import Activity, Foot, Sample

from . import emulated
from .hugadb import labels, recordings

ELEVATOR_RIDES = (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)
SHRINKAGE = 0.1
"""Share of the common covariance in that of each component, because few windows alone determine a covariance badly."""
MEDIAN_REACH = 10
"""Number of windows before and after a still window; the median of their means of a_z is subtracted from its own."""
RIDE_MARGIN = 4
"""Number of windows before and after an elevator ride that may have its pulses, because labels are about 1 s off."""
LABEL_MARGIN = 0.5
"""Time at both ends of a label that is not used, s, because the labels were made by pressing keys."""
WALK_COUNT = 12
"""Number of emulated walks."""
STILL_VARIANCE = 10.0
"""Variance of a_z, m^2/s^4, above which nobody stands; used only to learn the threshold of elevator pulses."""

DEFAULT_PULSE = 1.0
"""Pulse that stands for those of rides when the data have no ride, m/s^2."""


@frozen
class LabelledWindow:
    """The windows at one time of both feet, or of the only foot with samples."""

    index: int
    """Number of the window in the recording."""
    activity: Activity | None
    """Activity during the whole window; None when it changes or is not labelled."""
    middle: Activity | None
    """Activity in the middle of the window; None when it is not labelled."""
    feet: tuple[FootWindow, ...]


@frozen
class RecordingWindows:
    """The windows of one recording. `source` names the data set."""

    source: str
    windows: tuple[LabelledWindow, ...]


def features(
    source: str, samples: Iterable[Sample], t: NDArray[Any], activities: Sequence[Activity | None]
) -> RecordingWindows:
    """Return the windows of a recording with the labels `activities` (n,) at `t` (n,), s."""
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
        first, middle, last = np.searchsorted(t, [end - WINDOW - LABEL_MARGIN, end - 0.5 * WINDOW, end + LABEL_MARGIN])
        during = set(activities[first:last])
        only = during.pop() if len(during) == 1 else None
        labelled.append(LabelledWindow(index, only, activities[min(int(middle), len(activities) - 1)], tuple(windows)))
    return RecordingWindows(source, tuple(labelled))


def of_recording(path: Path) -> RecordingWindows:
    """Return the windows of the recording of hugadb at `path`."""
    t, activities = labels(path)
    return features("hugadb", load_samples(path), np.array(t), activities)


def train(examples: Sequence[RecordingWindows], trained_on: str) -> WindowModel:
    """Return the model that is fitted to these recordings. Raise ValueError when they lack an activity of the paper."""
    still, moving = [], []
    for labelled in (labelled for one in examples for labelled in one.windows):
        log_variance = _log_variance(labelled)
        if labelled.activity is Activity.STANDING or labelled.activity in ELEVATOR_RIDES:
            still.append(log_variance)
        elif labelled.activity is not None:
            moving.append(log_variance)
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
    """Return the value at which the two cumulative distributions are furthest apart, the middle one of several."""
    low, high = np.sort(below), np.sort(above)
    places = np.unique(np.concatenate([low, high]))
    middles = 0.5 * (places[1:] + places[:-1])
    too_high = 1.0 - np.searchsorted(low, middles) / len(low)
    too_low = np.searchsorted(high, middles) / len(high)
    error_shares = too_high + too_low
    best = np.flatnonzero(error_shares <= error_shares.min() + 1e-12)
    return float(0.5 * (places[best[0]] + places[best[-1] + 1]))


def _log_variance(labelled: LabelledWindow) -> float:
    """Return the logarithm of the variance of a_z, averaged over the feet."""
    return float(np.log(np.mean([window.variance for window in labelled.feet]) + LEAST_VARIANCE))


def _pulses(examples: Sequence[RecordingWindows]) -> tuple[list[float], list[float]]:
    """Return each standing window's deviation from its neighbours, and each elevator ride's weaker pulse, m/s^2."""
    standing: list[float] = []
    riding: list[float] = []
    for one in examples:
        still_windows = [labelled for labelled in one.windows if _log_variance(labelled) < np.log(STILL_VARIANCE)]
        means = np.array([np.mean([window.mean for window in labelled.feet]) for labelled in still_windows])
        deviations = [
            mean - float(np.median(means[max(0, k - MEDIAN_REACH) : k + MEDIAN_REACH + 1]))
            for k, mean in enumerate(means.tolist())
        ]
        of_ride = [labelled.middle in ELEVATOR_RIDES for labelled in still_windows]
        for k, labelled in enumerate(still_windows):
            if labelled.activity is Activity.STANDING and not any(
                of_ride[max(0, k - RIDE_MARGIN) : k + RIDE_MARGIN + 1]
            ):
                standing.append(abs(deviations[k]))
        for activity, ride in groupby(range(len(still_windows)), key=lambda k: still_windows[k].middle):
            if activity in ELEVATOR_RIDES:
                ride_indices = list(ride)
                values = deviations[max(0, ride_indices[0] - RIDE_MARGIN) : ride_indices[-1] + RIDE_MARGIN + 1]
                riding.append(min(max(values), -min(values)))
    return standing, riding or [DEFAULT_PULSE]


def _mixtures(examples: Sequence[RecordingWindows]) -> dict[Activity, tuple[Gaussian, ...]]:
    """Return the Gaussians of each state of the hidden Markov model."""
    groups: dict[tuple[Activity, str], list[tuple[float, ...]]] = {}
    for one in examples:
        for labelled in one.windows:
            if labelled.activity in MOVING_ACTIVITIES or labelled.activity is Activity.RUNNING:
                complete_rows = [x for x in map(window_features, labelled.feet) if len(x) == len(window_model.FEATURES)]
                groups.setdefault((labelled.activity, one.source), []).extend(complete_rows)
    component_rows = {key: np.array(rows) for key, rows in groups.items() if len(rows) > 2 * len(window_model.FEATURES)}
    n_rows, size = sum(map(len, component_rows.values())), len(window_model.FEATURES)
    common = sum((np.cov(rows.T) * len(rows) for rows in component_rows.values()), np.zeros((size, size))) / max(
        n_rows, 1
    )
    mixtures: dict[Activity, tuple[Gaussian, ...]] = {}
    for state in MOVING_ACTIVITIES:
        component_keys = [
            key for key in component_rows if key[0] is state or state is Activity.WALKING and key[0] is Activity.RUNNING
        ]
        if not component_keys:
            raise ValueError(f"there are no windows of {state.value}")
        mixtures[state] = tuple(
            [_gaussian(component_rows[key], common, 1.0 / len(component_keys)) for key in component_keys]
        )
    return mixtures


def _gaussian(rows: NDArray[Any], common: NDArray[Any], weight: float) -> Gaussian:
    factor = np.linalg.cholesky((1.0 - SHRINKAGE) * np.cov(rows.T) + SHRINKAGE * common)
    triangle = tuple([tuple([_rounded(value) for value in row[: k + 1]]) for k, row in enumerate(factor.tolist())])
    return Gaussian(_rounded(weight), tuple([_rounded(value) for value in rows.mean(axis=0).tolist()]), triangle)


def _transitions(examples: Sequence[RecordingWindows]) -> tuple[tuple[float, ...], ...]:
    """Return the transition probabilities from one window to the next: counts plus one, over their sum."""
    counts = np.ones((3, 3))
    for one in examples:
        for before, after in pairwise(one.windows):
            if before.middle in MOVING_ACTIVITIES and after.middle in MOVING_ACTIVITIES:
                counts[MOVING_ACTIVITIES.index(before.middle), MOVING_ACTIVITIES.index(after.middle)] += 1.0
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


def run(options: Namespace) -> int:
    """Write the model that is fitted to all data beside the part that reads it; return the exit status."""
    examples = [of_recording(one.path) for one in recordings(options.dir)]
    first, last = emulated.FIRST_TRAINING_SEED, emulated.FIRST_TRAINING_SEED + WALK_COUNT - 1
    examples += [of_emulated(seed) for seed in range(first, last + 1)]
    model = train(examples, f"hugadb, all wearers, and emulated walks at 20 Hz, seeds {first} to {last}")
    file = Path(window_model.__file__).with_name("footstep_activity.json")
    file.write_text(json.dumps(attrs.asdict(model), indent=1) + "\n", encoding="utf-8")
    return 0
