"""A foot has the same strides at whatever rate its motion is sampled."""

from __future__ import annotations

from math import pi, sin
from pathlib import Path

import numpy as np
import pytest

from solepath import Sample, Session, Site, StrideTaken
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.propagated import LONGEST_INTERVAL, IndependentInterval
from solepath.types.vector import GRAVITY, IDENTITY, ZERO

MIRRORED = 64
"""Number of samples that are mirrored at both ends, so that the Fourier series does not jump there."""


def upsampled(values: np.ndarray, factor: int) -> np.ndarray:
    """Return the readings with `factor` times as many samples and the same spectrum, so with nothing new."""
    before, after = 2 * values[:1] - values[MIRRORED:0:-1], 2 * values[-1:] - values[-2 : -MIRRORED - 2 : -1]
    padded = np.concatenate([before, values, after])
    dense = factor * np.fft.irfft(np.fft.rfft(padded, axis=0), len(padded) * factor, axis=0)
    return np.asarray(dense[MIRRORED * factor : (MIRRORED + len(values)) * factor])


def lengths_of_strides(times: np.ndarray, acc: np.ndarray, gyro: np.ndarray) -> list[float]:
    """Return the lengths of the strides of one foot, m."""
    session = Session()
    rows = zip(times.tolist(), acc.tolist(), gyro.tolist(), strict=True)
    samples = [Sample(t=t, site=Site.LEFT_FOOT, acc=tuple(a), gyro=tuple(g)) for t, a, g in rows]
    return [event.length for event in session.feed(samples) + session.finish() if isinstance(event, StrideTaken)]


@pytest.mark.parametrize("factor", [2, 3, 4])
@pytest.mark.parametrize("foot, strides", [("left", 72), ("right", 74)])
def test_a_hard_landing_loses_no_stance_at_a_higher_rate(data_dir: Path, foot: str, strides: int, factor: int) -> None:
    """`ms_patient`, 102 Hz: its landings give an error of up to 1.5 m/s, at 410 Hz 60 strides were left of 74."""
    data = np.load(data_dir / "gaitmap_examples" / "ms_patient.npz")
    times, acc, gyro = (data[f"{key}_{foot}"] for key in ("t", "acc", "gyro"))
    dense = times[0] + np.arange(len(times) * factor) * (times[-1] - times[0]) / (len(times) - 1) / factor
    lengths = lengths_of_strides(dense, upsampled(acc, factor), upsampled(gyro, factor))
    assert len(lengths) == strides and max(lengths) < 2.2


def test_half_the_rate_has_the_same_strides(data_dir: Path) -> None:
    data = np.load(data_dir / "gaitmap_examples" / "ms_patient.npz")
    times, acc, gyro = (data[f"{key}_left"] for key in ("t", "acc", "gyro"))
    pairs = len(times) // 2
    t, a, g = (v[: 2 * pairs].reshape(pairs, 2, *v.shape[1:]).mean(axis=1) for v in (times, acc, gyro))
    lengths = lengths_of_strides(t, a, g)
    assert len(lengths) == 72 and max(lengths) < 2.2


def ratio(dt: float, readings: list[float]) -> float:
    """Return the estimated interval as a multiple of `dt`, s, after these readings."""
    interval = IndependentInterval()
    forces = [(reading, 0.0, 0.0) for reading in readings]
    triples = zip(forces, forces[1:], forces[2:], strict=False)
    return [interval.update(dt, acc, dt, last, earlier) for earlier, last, acc in triples][-1]


def test_readings_that_change_at_random_are_independent() -> None:
    readings = np.random.default_rng(1).normal(size=2000).cumsum().tolist()
    assert ratio(0.01, readings) < 1.1
    assert ratio(0.0025, readings) < 1.1


def test_readings_in_a_narrow_band_are_independent_at_the_same_interval_at_each_rate() -> None:
    """White readings at 100 Hz, resampled."""
    readings = np.random.default_rng(2).normal(size=(2000, 1)).cumsum(axis=0)
    at_400, at_800 = (
        ratio(0.01 / factor, upsampled(readings, factor)[MIRRORED * factor :, 0].tolist()) / factor for factor in (4, 8)
    )
    assert 0.6 < at_400 < 1.0
    assert at_800 == pytest.approx(at_400, rel=0.1)


def test_the_interval_is_limited_for_a_foot_that_sways_slowly() -> None:
    swaying = [sin(2.0 * pi * 0.5 * 0.01 * k) for k in range(1000)]
    assert ratio(0.01, swaying) == pytest.approx(LONGEST_INTERVAL / 0.01)
    assert ratio(0.1, swaying) == 1.0, "an interval that is longer than the limit stays"


def test_readings_that_never_change_have_the_interval_of_the_samples() -> None:
    assert ratio(0.01, [1.0] * 50) == 1.0


def test_a_gap_does_not_change_the_interval() -> None:
    filtered = ErrorStateFilter()
    filtered.start(IDENTITY, 0.02)
    for k in range(400):
        filtered.predict(0.0025, (sin(0.05 * k), 0.0, GRAVITY), ZERO)
    before = filtered.interval.jerk_square, filtered.interval.snap_square
    filtered.predict(filtered.bridge(1.0), (50.0, 0.0, GRAVITY), ZERO)
    filtered.predict(0.0025, (51.0, 0.0, GRAVITY), ZERO)
    assert (filtered.interval.jerk_square, filtered.interval.snap_square) == before
    filtered.predict(0.0025, (53.0, 0.0, GRAVITY), ZERO)
    assert (filtered.interval.jerk_square, filtered.interval.snap_square) != before
