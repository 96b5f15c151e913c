"""Code that exists twice, because a call is too expensive at sample rate, gives the same results to the bit."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from solepath.foot.attitude import Rest, SampleSpan
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.strapdown import Strapdown
from solepath.foot.settings import ErrorStateSettings
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.shoe import ShoeDetector
from solepath.types import Quat, Vec3
from solepath.types.vector import normalise


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
