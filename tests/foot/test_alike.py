"""What is written twice, since a call would cost too much at sample rate, does the same to the bit."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.foot.attitude import Rest, SampleSpan
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.strapdown import Strapdown
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.shoe import ShoeDetector
from solepath.types import Quat, Vec3
from solepath.types.vector import normalise


def vectors(most: float) -> st.SearchStrategy[Vec3]:
    """Of any size up to that, and as often small ones."""
    axis = st.floats(-most, most) | st.floats(-1.0, 1.0)
    return st.tuples(axis, axis, axis)


WAITS = st.sampled_from([0.0025, 0.01, 0.05]) | st.floats(1e-6, 0.25)
SAMPLES = st.lists(st.tuples(WAITS, vectors(500.0), vectors(100.0)), min_size=1, max_size=40)
"""(dt in s, acc in m/s^2, gyro in rad/s): as large as a session lets in."""
ATTITUDES: st.SearchStrategy[Quat] = vectors(1.0).map(lambda v: normalise((1.0, *v)))


@settings(deadline=None)
@given(ATTITUDES, SAMPLES)
def test_the_filter_integrates_as_the_strapdown_does(attitude: Quat, samples: list[tuple[float, Vec3, Vec3]]) -> None:
    filter_, plain = ErrorStateFilter(recover=False), Strapdown()  # type: ignore[abstract]
    filter_.start(attitude, 0.02)
    plain.attitude = attitude
    for dt, acc, gyro in samples:
        filter_.predict(dt, acc, gyro)
        plain.integrate(dt, acc, gyro)
        for name in ("attitude", "velocity", "position", "force", "rate"):
            assert repr(getattr(filter_, name)) == repr(getattr(plain, name)), name


@settings(deadline=None)
@given(SAMPLES)
def test_the_default_detector_sums_as_shoe_does(samples: list[tuple[float, Vec3, Vec3]]) -> None:
    cycle, shoe = Cycle(), ShoeDetector()
    t = 0.0
    for dt, acc, gyro in samples:
        t += dt
        ours, textbook = cycle.update(t, dt, acc, gyro, None), shoe.update(t, dt, acc, gyro, None)
        assert repr(ours.statistic) == repr(textbook.statistic)
        assert cycle.shoe == shoe


@settings(deadline=None)
@given(SAMPLES)
def test_rest_sums_as_a_span_of_samples_does(samples: list[tuple[float, Vec3, Vec3]]) -> None:
    rest, span = Rest(length=1e9), SampleSpan()
    t = 0.0
    for dt, acc, gyro in samples:
        t += dt
        rest.update(t, acc, gyro)
        span.add(acc, gyro)
        assert rest.span == span
