"""Learns the thresholds and the hidden Markov model of `TwoSecondWindows` from windows whose activity is known.

    python -m solepath.lab.train.footstep_activity HUGADB

writes footstep_activity.json beside the part. Same data, same file.

Liu et al. 2015 take the thresholds from cumulative distributions (fig. 6): here a threshold is where the two curves lie
furthest apart, so the share of what should lie below and does not, plus that of what should lie above, is least. The
mixture has one component an activity and a source of data; what is running is one of walking's components, because
running is none of the paper's activities.
"""

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
from ...recording.decoded import recorded
from ...recording.samples import load_samples
from ...types import Activity, Foot, Sample
from . import emulated
from .hugadb import labels, recordings

LIFTS = (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)
SHRUNK = 0.1
"""Share of the covariance within all classes in that of each: few windows know little of it."""
AROUND = 10
"""Windows on either side whose median is the mean of standing here."""
BESIDE = 4
"""Windows before and after a ride that may hold its pulses too: labels pressed by hand are about a second off."""
EDGE = 0.5
"""s that labels pressed by hand are not believed at their ends."""
WALKS = 12
"""Emulated ones."""
QUIET = 10.0
"""Variance of a_z, m^2/s^4, above which nobody stands still: only for what the other threshold is learnt from."""


@frozen
class LabelledWindow:
    """One window of the feet that were heard."""

    index: int
    activity: Activity | None
    """What the wearer did all through it; None where that changed, or nobody says."""
    middle: Activity | None
    """The same in its middle."""
    feet: tuple[FootWindow, ...]


@frozen
class Taught:
    """The windows of one recording. `source`: the kind of data that it is of."""

    source: str
    windows: tuple[LabelledWindow, ...]


def features(source: str, samples: Iterable[Sample], t: NDArray[Any], activities: Sequence[Activity | None]) -> Taught:
    """The windows of a recording, whose activities are `activities` at `t` (n,), s."""
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
    told = []
    for index, windows in sorted(found.items()):
        end = (origin or 0.0) + (index + 1) * HOP
        first, middle, last = np.searchsorted(t, [end - WINDOW - EDGE, end - 0.5 * WINDOW, end + EDGE])
        during = set(activities[first:last])
        at = activities[min(int(middle), len(activities) - 1)]
        told.append(LabelledWindow(index, during.pop() if len(during) == 1 else None, at, tuple(windows)))
    return Taught(source, tuple(told))


def of_recording(path: Path) -> Taught:
    """The windows of one of hugadb's recordings."""
    t, activities = labels(path)
    return features("hugadb", load_samples(path), np.array(t), activities)


def train(taught: Sequence[Taught], trained_on: str) -> WindowModel:
    """The model of those windows. ValueError where an activity of the paper is missing among them."""
    still, moving = [], []
    for told in (told for one in taught for told in one.windows):
        level = _level(told)
        if told.activity is Activity.STANDING or told.activity in LIFTS:
            still.append(level)
        elif told.activity is not None:
            moving.append(level)
    if not still or not moving:
        raise ValueError("there are no windows of standing, or none of walking")
    standing, riding = _pulses(taught)
    mixtures = _mixtures(taught)
    return WindowModel(
        trained_on=trained_on,
        moving=_rounded(float(np.exp(threshold(still, moving)))),
        pulse=_rounded(threshold(standing, riding)),
        walking=mixtures[Activity.WALKING],
        stairs_up=mixtures[Activity.STAIRS_UP],
        stairs_down=mixtures[Activity.STAIRS_DOWN],
        transitions=_transitions(taught),
    )


def threshold(below: Sequence[float], above: Sequence[float]) -> float:
    """Where the cumulative distributions lie furthest apart: the middle of all such places."""
    low, high = np.sort(below), np.sort(above)
    places = np.unique(np.concatenate([low, high]))
    between = 0.5 * (places[1:] + places[:-1])
    too_high = 1.0 - np.searchsorted(low, between) / len(low)
    too_low = np.searchsorted(high, between) / len(high)
    wrong = too_high + too_low
    best = np.flatnonzero(wrong <= wrong.min() + 1e-12)
    return float(0.5 * (places[best[0]] + places[best[-1] + 1]))


def _level(told: LabelledWindow) -> float:
    """Logarithm of the mean variance of the feet."""
    return float(np.log(np.mean([window.variance for window in told.feet]) + LEAST_VARIANCE))


def _pulses(taught: Sequence[Taught]) -> tuple[list[float], list[float]]:
    """(how far the mean of each window of standing is from its neighbours', the weaker pulse of each lift ride)."""
    standing: list[float] = []
    riding: list[float] = []
    for one in taught:
        quiet = [told for told in one.windows if _level(told) < np.log(QUIET)]
        means = np.array([np.mean([window.mean for window in told.feet]) for told in quiet])
        off = [
            mean - float(np.median(means[max(0, k - AROUND) : k + AROUND + 1])) for k, mean in enumerate(means.tolist())
        ]
        of_ride = [told.middle in LIFTS for told in quiet]
        for k, told in enumerate(quiet):
            if told.activity is Activity.STANDING and not any(of_ride[max(0, k - BESIDE) : k + BESIDE + 1]):
                standing.append(abs(off[k]))
        for activity, ride in groupby(range(len(quiet)), key=lambda k: quiet[k].middle):
            if activity in LIFTS:
                numbers = list(ride)
                values = off[max(0, numbers[0] - BESIDE) : numbers[-1] + BESIDE + 1]
                riding.append(min(max(values), -min(values)))
    return standing, riding or [1.0]


def _mixtures(taught: Sequence[Taught]) -> dict[Activity, tuple[Gaussian, ...]]:
    """The Gaussians of each state of the hidden Markov model."""
    groups: dict[tuple[Activity, str], list[tuple[float, ...]]] = {}
    for one in taught:
        for told in one.windows:
            if told.activity in MOVING or told.activity is Activity.RUNNING:
                whole = [x for x in map(window_features, told.feet) if len(x) == len(window_model.FEATURES)]
                groups.setdefault((told.activity, one.source), []).extend(whole)
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


def _transitions(taught: Sequence[Taught]) -> tuple[tuple[float, ...], ...]:
    """From one window to the next, counted; as if each had been seen once more."""
    counts = np.ones((3, 3))
    for one in taught:
        for before, after in zip(one.windows, one.windows[1:], strict=False):
            if before.middle in MOVING and after.middle in MOVING:
                counts[MOVING.index(before.middle), MOVING.index(after.middle)] += 1.0
    rows = counts / counts.sum(axis=1, keepdims=True)
    return tuple([tuple([_rounded(value) for value in row]) for row in rows.tolist()])


def _rounded(value: float) -> float:
    return float(f"{value:.5g}")


def of_emulated(seed: int) -> Taught:
    """The windows of an emulated walk with some jogging."""
    walked = emulated.walk(seed, jogging=True)
    truth = walked.truth
    t = np.arange(0.0, truth.duration, 1.0 / emulated.RATE)
    return features("emulated", recorded(walked.packets).samples, t, [truth.activity(float(at)) for at in t])


def main(folder: Path) -> None:
    """Write the model of all there is beside the part that reads it."""
    taught = [of_recording(one.path) for one in recordings(folder)]
    first, last = emulated.FIRST_TO_LEARN_FROM, emulated.FIRST_TO_LEARN_FROM + WALKS - 1
    taught += [of_emulated(seed) for seed in range(first, last + 1)]
    model = train(taught, f"hugadb, all wearers, and emulated walks at 20 Hz, seeds {first} to {last}")
    file = Path(window_model.__file__).with_name("footstep_activity.json")
    file.write_text(json.dumps(attrs.asdict(model), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
