"""Inertial cues: times of heel-strike, foot-flat and toe-off, and the middle of an impact."""

from __future__ import annotations

from math import hypot, pi, sin
from statistics import median

import pytest
from hypothesis import given
from hypothesis import strategies as st
from walks import of

from solepath import Foot, Sample, Session, ToeOff
from solepath.emulate import Route, Walker
from solepath.events import HeelStrike
from solepath.foot.cues.impact import Impact
from solepath.foot.cues.inertial import InertialCues
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.propagated import HEADING_DRIFT
from solepath.foot.phase import PHASES, Cue
from solepath.foot.stance.stance import Stance
from solepath.types import Phase, Quat, Vec3
from solepath.types.vector import GRAVITY, ZERO, from_rotation_vector, rotate


def walked(speed: float, rate: float = 100.0, far: float = 15.0) -> tuple[Walker, list[Sample]]:
    walker = Walker(Route().stand(2).walk(far, speed).stop(2), seed=5)
    return walker, [Sample(s.t, s.site, s.acc, s.gyro) for s in walker.samples(Foot.LEFT, rate)]


@pytest.mark.parametrize("speed", [0.9, 1.3, 1.7])
def test_without_cells_toe_off_and_heel_strike_are_seen_by_how_the_foot_turns(speed: float) -> None:
    walker, samples = walked(speed)
    events = Session().feed(samples)
    truth = walker.truth().feet[Foot.LEFT]
    for kind, true_times in ((ToeOff, truth.toe_offs), (HeelStrike, truth.heel_strikes)):
        detected = [event.t for event in events if isinstance(event, kind)]
        assert len(detected) == len(true_times)
        offsets = [a - b for a, b in zip(detected, true_times, strict=True)]
        assert abs(median(offsets)) < 0.045, kind.__name__
        assert max(offsets) - min(offsets[1:]) < 0.2, kind.__name__


@pytest.mark.parametrize("rate", [20.0, 50.0, 200.0, 400.0])
def test_heel_strike_is_where_the_ground_stops_the_foot_at_any_rate(rate: float) -> None:
    walker, samples = walked(1.2, rate, 8.0)
    detected = [event.t for event in of(HeelStrike, Session().feed(samples))]
    true_times = walker.truth().feet[Foot.LEFT].heel_strikes
    assert len(detected) == len(true_times)
    # the time between two samples is the limit
    assert abs(median(a - b for a, b in zip(detected, true_times, strict=True))) < 0.015 + 0.5 / rate


@pytest.mark.parametrize("speed", [0.7, 1.3, 1.8])
def test_heel_strike_and_toe_off_are_known_within_60_ms(speed: float) -> None:
    _, samples = walked(speed)
    events = Session().feed(samples)
    latencies = [event.known_at - event.t for kind in (HeelStrike, ToeOff) for event in of(kind, events)[1:-1]]
    assert len(latencies) > 10 and max(latencies) < 0.0605


def test_heel_strike_stays_where_it_is_when_the_accelerometer_clips_at_2_g() -> None:
    _, samples = walked(1.4)
    limit = 2.0 * GRAVITY

    def clipped(sample: Sample) -> Sample:
        assert sample.acc is not None
        x, y, z = (max(-limit, min(limit, value)) for value in sample.acc)
        return Sample(sample.t, sample.site, (x, y, z), sample.gyro)

    whole, cut = (of(HeelStrike, Session().feed(fed)) for fed in (samples, [clipped(sample) for sample in samples]))
    assert len(cut) == len(whole)
    assert abs(median(a.t - b.t for a, b in zip(cut, whole, strict=True))) < 0.02


def after_standing(speed: float, rate: float) -> list[Cue]:
    """Return the cues of a foot that stands, and whose heel then rises for 0.6 s.

    `speed` is that of the sensor, m/s, `rate` that of the foot, rad/s."""
    cues = InertialCues()
    phase, detected = Phase.STATIONARY, []
    for k in range(160):
        still = k < 100
        gyro = ZERO if still else (0.0, rate, 0.0)
        timed_cue = cues.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), gyro, still, 0.0 if still else speed, phase)
        if timed_cue is not None and PHASES[phase][timed_cue.cue] is not phase:
            phase = PHASES[phase][timed_cue.cue]
            detected.append(timed_cue.cue)
    return detected


def test_a_foot_that_slides_away_without_turning_has_left_its_place() -> None:
    assert after_standing(0.6, 0.1) == [Cue.LIFT, Cue.CLEAR]


def test_a_foot_that_rolls_over_its_toe_has_not_left_the_ground_however_fast_the_sensor_goes() -> None:
    assert after_standing(0.6, 3.5) == [Cue.LIFT]


def test_a_jolt_in_the_middle_of_a_long_swing_is_no_heel_strike() -> None:
    cues = InertialCues()
    cues.make_hidden_toe_off(0.0)
    cues.lowest_rate = 0.0
    for k in range(1, 80):
        acc = (40.0 if k == 30 else 0.0, 0.0, GRAVITY)
        assert cues.update(0.01 * k, 0.01, acc, (0.0, -3.0, 0.0), False, 2.0, Phase.SWING) is None


def test_gravity_rights_a_standing_foot_even_when_the_filter_is_sure_of_its_tilt() -> None:
    filter_ = ErrorStateFilter()
    filter_.start(from_rotation_vector((0.02, -0.01, 0.0)), 0.0)
    still = Stance(ZERO, 0.01, 100.0, Phase.STATIONARY)
    for k in range(600):
        filter_.predict(0.005, (0.0, 0.0, GRAVITY), ZERO)
        assert filter_.correct(0.005 * k, still)
    x, y, _ = rotate(filter_.attitude, (0.0, 0.0, 1.0))
    assert hypot(x, y) < 0.001


def test_heading_grows_less_certain_with_time() -> None:
    _, samples = walked(1.3)
    session = Session()
    session.feed(samples)
    foot = session.feet[Foot.LEFT]
    lasted = samples[-1].t - 2.0  # without the stretch before the first heel-off and the current one
    assert foot.gait.path.yaw == pytest.approx(HEADING_DRIFT**2 * lasted, rel=0.4)
    assert session.position is not None and session.position.covariance[3] > foot.gait.path.yaw * 10.0**2 / 4


LANDED, LASTS = 0.52, 0.03
"""Middle and duration of the push of the ground in `simulate_push`, s."""


def simulate_push(rate: float, mounting: Quat = (1.0, 0.0, 0.0, 0.0)) -> Impact:
    """Return the impact of a swing of 0.6 s at 2 m/s that ends in a push of 40 m/s^2 upwards, for this mounting."""
    impact = Impact()
    impact.start_swing(0.0)
    previous_acc: Vec3 | None = None
    for k in range(int(0.6 * rate)):
        t = k / rate
        share = (t - LANDED) / LASTS + 0.5
        push = 40.0 * sin(pi * share) if 0.0 < share < 1.0 else 0.0
        acc = rotate(mounting, (3.0 * sin(5.0 * t), 0.0, GRAVITY + push))
        if previous_acc is not None:
            impact.add_sample(t, 1.0 / rate, previous_acc, acc, 2.0, t > LANDED - LASTS)
        previous_acc = acc
    return impact


@pytest.mark.parametrize("rate", [50.0, 100.0, 200.0, 400.0])
def test_the_middle_of_an_impact_is_found_at_any_rate(rate: float) -> None:
    assert simulate_push(rate).mean_time == pytest.approx(LANDED, abs=0.004 + 0.25 / rate)


@given(st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_how_the_sensor_is_mounted_does_not_matter(turn: Vec3) -> None:
    assert simulate_push(100.0, from_rotation_vector(turn)).mean_time == pytest.approx(
        simulate_push(100.0).mean_time, abs=1e-6
    )


def test_the_jolt_of_leaving_the_ground_is_not_that_of_landing() -> None:
    impact = Impact()
    impact.start_swing(0.0)
    for k in range(1, 60):
        pushed, landed = 90.0 if k == 5 else 0.0, 20.0 if k == 50 else 0.0
        impact.add_sample(0.01 * k, 0.01, ZERO, (pushed, 0.0, landed), 1.0, False)
        assert (impact.peak_shock > 0.0) is (k >= 50)
    assert impact.peak_shock_time == pytest.approx(0.495)


@given(st.lists(st.tuples(st.floats(0.0, 1e6), *[st.floats(-1e300, 1e300)] * 3), max_size=20))
def test_an_impact_stays_finite_for_any_force_and_interval(rows: list[tuple[float, float, float, float]]) -> None:
    impact, t, previous_acc = Impact(), 0.0, (0.0, 0.0, GRAVITY)
    impact.start_swing(t)
    for dt, x, y, z in rows:
        t += dt
        impact.add_sample(t, dt, previous_acc, (x, y, z), 1.0, False)
        previous_acc = (x, y, z)
        assert 0.0 <= impact.mean_time <= t * (1.0 + 1e-15) and 0.0 <= impact.shock < 1e300
