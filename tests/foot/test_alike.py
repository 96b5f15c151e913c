"""Code that exists twice, because a call is too expensive at sample rate, gives the same results to the bit."""

from __future__ import annotations

from math import atan2, pi, remainder
from typing import Any

from attrs import define
from hypothesis import given
from hypothesis import strategies as st
from own import StillDetector

from solepath.foot.attitude import Rest, SampleSpan
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.strapdown import Strapdown
from solepath.foot.settings import ErrorStateSettings
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.shoe import ShoeDetector
from solepath.foot.stance.stance import Stance
from solepath.foot.stride import StrideBuilder
from solepath.foot.tracker import FootTracker
from solepath.types import Foot, Quat, Sample, Site, Vec3
from solepath.types.vector import conjugate, heading_turned, multiply, normalise, rotate, rotate_back, single


def vectors(most: float) -> st.SearchStrategy[Vec3]:
    """Return a strategy for vectors of any size up to `most`, and as often small ones."""
    axis = st.floats(-most, most) | st.floats(-1.0, 1.0)
    return st.tuples(axis, axis, axis)


WAITS = st.sampled_from([0.0025, 0.01, 0.05]) | st.floats(1e-6, 0.25)
SAMPLES = st.lists(st.tuples(WAITS, vectors(500.0), vectors(100.0)), min_size=1, max_size=40)
"""Samples (dt in s, acc in m/s^2, gyro in rad/s) as large as a session accepts."""
ATTITUDES: st.SearchStrategy[Quat] = vectors(1.0).map(lambda v: normalise((1.0, *v)))


@given(ATTITUDES, SAMPLES)
def test_the_filter_integrates_as_the_strapdown_does(attitude: Quat, samples: list[tuple[float, Vec3, Vec3]]) -> None:
    error_state_filter, plain = ErrorStateFilter(ErrorStateSettings(recover=False)), Strapdown()  # type: ignore[abstract]
    error_state_filter.start(attitude, 0.02)
    plain.attitude = attitude
    for dt, acc, gyro in samples:
        error_state_filter.predict(dt, acc, gyro)
        plain.integrate(dt, acc, gyro)
        for name in ("attitude", "velocity", "position", "force", "rate"):
            assert repr(getattr(error_state_filter, name)) == repr(getattr(plain, name)), name


@given(SAMPLES)
def test_the_default_detector_sums_as_shoe_does(samples: list[tuple[float, Vec3, Vec3]]) -> None:
    cycle, shoe = Cycle(), ShoeDetector()
    t = 0.0
    for dt, acc, gyro in samples:
        t += dt
        of_cycle, of_shoe = cycle.update(t, dt, acc, gyro, None), shoe.update(t, dt, acc, gyro, None)
        assert repr(of_cycle.statistic) == repr(of_shoe.statistic)
        assert cycle.shoe == shoe


@given(SAMPLES)
def test_rest_sums_as_a_span_of_samples_does(samples: list[tuple[float, Vec3, Vec3]]) -> None:
    rest, span = Rest(), SampleSpan()
    for k, (dt, acc, gyro) in enumerate(samples):
        rest.update(0.01 * k + 1e-3 * dt, acc, gyro)  # a span of rest is longer than all of them
        span.add(acc, gyro)
        assert rest.span == span


@given(ATTITUDES, ATTITUDES, vectors(500.0))
def test_turns_that_are_written_out_are_those_of_the_quaternions(before: Quat, after: Quat, v: Vec3) -> None:
    assert rotate_back(before, v) == rotate(conjugate(before), v)
    w, _, _, z = multiply(after, conjugate(before))
    assert abs(remainder(heading_turned(before, after) - 2.0 * atan2(z, w), 2.0 * pi)) < 1e-12


@given(st.lists(st.floats(-50.0, 50.0), min_size=1, max_size=60))
def test_pitches_are_kept_as_singles(rates: list[float]) -> None:
    stride, pitch = StrideBuilder(Foot.LEFT), 0.0
    for k, rate in enumerate(rates):
        stride.add_motion(0.01 * k, 0.01, 0.0, 0.0, rate, False)
        pitch += rate * 0.01
        assert stride.pitches[stride.next_pitch - 1] == single(pitch)


@given(st.floats(0.8, 1.25), vectors(0.1), vectors(499.0), vectors(99.0))
def test_a_gap_is_crossed_with_the_scale_and_bias_of_any_other_sample(
    scale: float, bias: Vec3, acc: Vec3, gyro: Vec3
) -> None:
    received: list[tuple[Vec3, Vec3]] = []

    @define
    class Sees(StillDetector):
        def update(self, t: float, dt: float, acc: Vec3, gyro: Vec3, *rest: Any) -> Stance:
            received.append((acc, gyro))
            return StillDetector.update(self, t, dt, acc, gyro, *rest)

    tracker = FootTracker(Foot.LEFT, Sees(), ErrorStateFilter())
    tracker.rest.scale, tracker.rest.bias = scale, bias
    tracker.feed(Sample(0.0, Site.LEFT_FOOT, acc, gyro))
    assert received == [tracker.rest.calibrate(acc, gyro)]
