"""The default recipe with sensors that it was not tuned on: cheap, clipping, or switched on during a walk."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import deepcopy
from functools import cache
from math import radians
from random import Random

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import of

from solepath import Foot, Sample, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.settings import ErrorStateSettings
from solepath.foot.tracker import FootTracker
from solepath.recipes import DEFAULT
from solepath.types import Vec3
from solepath.types.vector import ZERO

ROUTE = Route().stand(2.0).walk(14.0, 1.3).stop(1.5)


@cache
def walk() -> tuple[Sample, ...]:
    return tuple(Walker(ROUTE, seed=101).samples(Foot.LEFT, 50.0, LSM6DSOX))


def tracked(samples: Iterable[Sample], recover: bool = True) -> tuple[FootTracker, list[StrideTaken]]:
    """Return a foot's tracker and strides by the default recipe; without `recover` clipped peaks are not restored."""
    parts = deepcopy(DEFAULT)
    corrector = ErrorStateFilter(ErrorStateSettings(recover=recover))
    tracker = FootTracker(Foot.RIGHT, parts.detector, corrector, parts.cues)
    strides: list[StrideTaken] = []
    for sample in samples:
        strides += of(StrideTaken, tracker.feed(sample))
    return tracker, strides


def clipped(
    samples: Iterable[Sample], rate: float = 1e3, force: float = 1e3, range_known: bool = False
) -> list[Sample]:
    """Return the samples of a sensor that clips at `rate` rad/s and `force` m/s^2; `range_known` adds its range."""
    clipped_samples: list[Sample] = []
    for sample in samples:
        assert sample.acc is not None and sample.gyro is not None
        gyro, acc = within(sample.gyro, rate), within(sample.acc, force)
        ends = range_known and (gyro, acc) != (sample.gyro, sample.acc)
        clipped_samples.append(evolve(sample, gyro=gyro, acc=acc, saturated=ends))
    return clipped_samples


def within(v: Vec3, end: float) -> Vec3:
    x, y, z = (min(max(a, -end), end) for a in v)
    return (x, y, z)


def total_length(strides: Sequence[StrideTaken]) -> float:
    return sum(stride.length for stride in strides)


def lengths(strides: Sequence[StrideTaken]) -> list[float]:
    return [stride.length for stride in strides]


def test_clipping_of_a_gyroscope_at_400_degrees_per_second_is_corrected() -> None:
    _, whole = tracked(walk())
    cut = clipped(walk(), rate=radians(400.0))
    _, corrected = tracked(cut)
    assert lengths(corrected) == pytest.approx(lengths(whole), rel=0.02)
    _, unmended = tracked(cut, recover=False)
    assert abs(total_length(corrected) - total_length(whole)) < 0.3 * abs(total_length(unmended) - total_length(whole))


@given(gap_start=st.floats(4.0, 5.2))
@settings(max_examples=4)
def test_a_foot_that_walks_from_the_first_sample_on_is_levelled_in_its_second_stance(gap_start: float) -> None:
    _, all_strides = tracked(walk())
    t = walk()[0].t + gap_start
    _, strides = tracked(sample for sample in walk() if sample.t >= t)
    assert strides[0].t_start - t < 3.0
    later_strides = [stride for stride in all_strides if stride.t_start > strides[1].t_start - 0.3]
    assert lengths(strides[1:]) == pytest.approx(lengths(later_strides), rel=0.06)


def test_a_cheap_sensors_noise_bias_and_scale_cost_little() -> None:
    noise = Random(1)
    _, usual = tracked(walk())
    cheap = []
    for sample in walk():
        (ax, ay, az), (gx, gy, gz) = sample.acc or ZERO, sample.gyro or ZERO
        g = [noise.gauss(0.0, 0.01) for _ in range(3)]
        a = [noise.gauss(0.0, 0.1) for _ in range(3)]
        cheap.append(
            evolve(
                sample,
                acc=(1.03 * ax + a[0], 1.03 * ay + a[1], 1.03 * az + a[2]),
                gyro=(gx + g[0] + 0.05, gy + g[1] - 0.05, gz + g[2] + 0.05),
            )
        )
    _, strides = tracked(cheap)
    assert len(strides) == len(usual)
    assert total_length(strides) == pytest.approx(total_length(usual), rel=0.03)
