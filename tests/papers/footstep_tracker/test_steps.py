"""Strides by static zones, critical times and projection; expected values by hand (recipe footstep-tracker)."""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt

import pytest

from solepath.foot.phase import Cue
from solepath.foot.stance.stance import Stance
from solepath.papers.footstep_tracker.closed_stride import closed_stride, vertical_turn
from solepath.papers.footstep_tracker.critical_cues import CriticalCues
from solepath.papers.footstep_tracker.critical_times import CriticalTimes, Row, critical_times
from solepath.papers.footstep_tracker.projection import Projection
from solepath.papers.footstep_tracker.segment import StrideSegment
from solepath.papers.footstep_tracker.static_zones import PRINTED_ZONES, StaticZones
from solepath.papers.footstep_tracker.stride_length import stride_length
from solepath.types import Phase, Vec3
from solepath.types.vector import GRAVITY, ZERO

G = GRAVITY


def rows_of(dt: float, a_y: list[float], g_x: list[float]) -> list[Row]:
    """Return rows `dt` s apart with these signals, gravity on a_z and zero otherwise."""
    return [(k * dt, 0.0, a, -G, g, 0.0, 0.0) for k, (a, g) in enumerate(zip(a_y, g_x, strict=True))]


#        rest      heel rises         toe rises                 slap        rest
A_Y = [0.0, 0.0, -0.6, -2.0, -6.0, 2.0, 6.0, -4.0, -12.0, -8.0, 4.0, -4.0, 0.0, 0.0]
G_X = [0.0, 0.0, -1.0, -3.0, -4.0, 1.0, 4.0, 4.0, 3.0, 1.0, -1.0, -2.0, 0.0, 0.0]


def test_the_critical_times_of_a_step_drawn_by_hand_are_where_algorithm_1_has_them() -> None:
    times = critical_times(rows_of(0.05, A_Y, G_X))
    assert times is not None
    assert times.uplift == pytest.approx(0.05 + 0.05 * 0.2)  # g_x from 0 to -1 passes -0.2
    assert times.liftoff == pytest.approx(0.20 + 0.05 * 6.0 / 8.0)  # a_y from -6 to 2
    assert times.landing == pytest.approx(0.50 + 0.05 * 0.5)  # a_y from 4 to -4, the last time
    assert times.rest == pytest.approx(0.60)


def test_mid_swing_where_the_foot_starts_to_slow_down_is_no_landing() -> None:
    slows = [*A_Y[:10], -1.0, -4.0, 0.0, 0.0]  # a_y does not come up again as the heel strikes
    times = critical_times(rows_of(0.05, slows, G_X))
    assert times is not None
    assert times.landing == pytest.approx(0.45 + 0.05 * 0.5)  # where the instep moves downward: g_x from 1 to -1


def test_a_foot_that_lies_still_or_only_trembles_has_no_critical_times() -> None:
    assert critical_times(rows_of(0.05, [0.0] * 12, [0.0] * 12)) is None
    assert critical_times(rows_of(0.05, [0.4, -0.4] * 6, [0.3, -0.3] * 6)) is None
    assert critical_times([]) is None


def test_gravity_alone_moves_no_step_however_the_foot_is_tilted() -> None:
    # (2) and (3) with figure 8's signs: toe down by 1 rad/s for 1 s and up again by as much
    drawn: list[Row] = []
    for k in range(401):
        t = 0.005 * k
        theta = -t if t <= 1.0 else t - 2.0
        drawn.append((t, 0.0, G * sin(theta), -G * cos(theta), -1.0 if t < 1.0 else 1.0 if t > 1.0 else 0.0, 0.0, 0.0))
    times = CriticalTimes(0.0, 0.0, 2.0, 2.0)
    assert sum(stride_length(drawn, times)) == pytest.approx(0.0, abs=1e-3)
    assert closed_stride(drawn, times).length() == pytest.approx(0.0, abs=1e-3)


def test_a_step_of_constant_push_and_brake_is_as_long_as_its_double_integral() -> None:
    # 4 m/s^2 for half a second, then -4 for as long: 0.5 + 0.5 m by (5), all of it S_y of (6)
    drawn = [(0.01 * k, 0.0, 4.0 if k < 50 else -4.0 if k > 50 else 0.0, -G, 0.0, 0.0, 0.0) for k in range(101)]
    times = CriticalTimes(0.0, 0.0, 1.0, 1.0)
    s_x, s_y, s_z = stride_length(drawn, times)
    assert (s_x, s_z) == (0.0, 0.0)
    assert s_y == pytest.approx(1.0, abs=1e-3)
    assert closed_stride(drawn, times).length() == pytest.approx(1.0, abs=1e-3)


def test_the_toe_out_angle_turns_the_acceleration_from_the_foot_s_direction_to_the_way() -> None:
    # (1) and (4): a push of 1 m/s^2 along the way, seen by a foot that points 30 degrees to the left of it
    phi = radians(30.0)
    drawn = [(0.1 * k, sin(phi), cos(phi), -G, 0.0, 0.0, 0.0) for k in range(11)]
    times = CriticalTimes(0.0, 0.0, 1.0, 1.0)
    s_x, s_y, _ = stride_length(drawn, times, phi)
    assert s_x == pytest.approx(0.5 * sin(phi) ** 2) and s_y == pytest.approx(0.5 * cos(phi) ** 2)
    assert sum(stride_length(drawn, times)) == pytest.approx(0.5 * cos(phi))


def test_what_is_left_of_velocity_and_tilt_at_rest_is_taken_out() -> None:
    # an accelerometer that is off by 0.5 m/s^2 and a gyroscope by 0.1 rad/s, on a foot that goes nowhere
    drawn = [(0.01 * k, 0.0, 0.5, -G, 0.1, 0.0, 0.0) for k in range(101)]
    times = CriticalTimes(0.0, 0.0, 1.0, 1.0)
    assert abs(sum(stride_length(drawn, times))) > 0.05
    assert closed_stride(drawn, times).length() == pytest.approx(0.0, abs=1e-6)


def clip_rows(drawn: list[Row], most: float) -> list[Row]:
    """Return the rows of a gyroscope that clips at `most` rad/s."""
    return [(*row[:4], *[min(max(g, -most), most) for g in row[4:]]) for row in drawn]  # type: ignore[misc]


def swing_rows() -> list[Row]:
    """Toe down by 0.6 rad, up to as much, and flat again within 1 s, while the foot goes 1 m ahead: a push and a
    brake of 4 m/s^2 each along the ground, as a tilted foot feels them."""
    drawn: list[Row] = []
    for k in range(201):
        t = 0.005 * k
        theta = -0.6 * sin(2.0 * pi * t) * (1.0 - cos(2.0 * pi * t))
        rate = -1.2 * pi * (cos(2.0 * pi * t) - cos(4.0 * pi * t))
        push = 4.0 if t < 0.5 else -4.0 if t > 0.5 else 0.0
        a_y = push * cos(theta) + G * sin(theta)
        a_z = push * sin(theta) - G * cos(theta)
        drawn.append((t, 0.0, a_y, a_z, rate, 0.0, 0.0))
    return drawn


def test_the_clipped_angle_is_found_from_tilt_and_velocity_at_rest() -> None:
    drawn, times = swing_rows(), CriticalTimes(0.0, 0.0, 1.0, 1.0)
    assert closed_stride(drawn, times).length() == pytest.approx(1.0, abs=0.01)
    seen = clip_rows(drawn, 4.0)  # its toe rises at up to 7.5 rad/s and sinks at up to 4.2
    off = abs(closed_stride(seen, times).length() - 1.0)
    assert off > 0.05
    assert abs(closed_stride(seen, times, end=3.99).length() - 1.0) < 0.5 * off


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_foot_that_turns_faster_than_its_gyroscope_measures_has_turned_further(side: float) -> None:
    # a bell of 8 rad/s and 0.5 s: 2 rad, of which 5 rad/s leave some
    bell = [side * 4.0 * (1.0 - cos(4.0 * pi * 0.02 * k)) if k <= 25 else 0.0 for k in range(41)]
    drawn: list[Row] = [(0.02 * k, 0.0, 0.0, -G, 0.0, 0.0, g) for k, g in enumerate(bell)]
    times = CriticalTimes(0.0, 0.0, 0.8, 0.8)
    assert vertical_turn(drawn, times, closed_stride(drawn, times)) == pytest.approx(side * 2.0, abs=0.01)
    seen = clip_rows(drawn, 5.0)
    measured = abs(vertical_turn(seen, times, closed_stride(seen, times)))
    known = abs(vertical_turn(seen, times, closed_stride(seen, times, 4.99), 4.99))
    assert measured < 1.7
    assert 0.5 * (2.0 - measured) < known - measured < 1.1 * (2.0 - measured)


def feed(zones: StaticZones, samples: list[tuple[float, Vec3, Vec3]]) -> list[Stance]:
    found = []
    last = samples[0][0]
    for t, acc, gyro in samples:
        found.append(zones.update(t, t - last, acc, gyro, None))
        last = t
    return found


def samples_at_rest(
    n: int, rate: float, acc: Vec3 = (0.0, 0.0, G), gyro: Vec3 = ZERO
) -> list[tuple[float, Vec3, Vec3]]:
    return [(k / rate, acc, gyro) for k in range(n)]


def test_six_samples_at_20_hz_make_a_static_zone_and_five_do_not_while_the_foot_turns() -> None:
    turning = samples_at_rest(6, 20.0, gyro=(0.0, 0.0, 2.0))
    found = feed(StaticZones(PRINTED_ZONES), turning)
    assert [one.hint for one in found] == [None] * 5 + [Phase.STATIONARY]


def test_a_sample_away_from_the_others_restarts_the_zone() -> None:
    samples = samples_at_rest(12, 20.0, gyro=(0.0, 0.0, 2.0))
    t, (x, y, z), gyro = samples[4]
    samples[4] = (t, (x + 1.0, y, z), gyro)  # half of this may be a count
    found = feed(StaticZones(PRINTED_ZONES), samples)
    # the sixth after the odd one, which itself was a zone's first
    assert [k for k, one in enumerate(found) if one.hint is Phase.STATIONARY][0] == 10


def swing_segment(turn: float = 0.0) -> StrideSegment:
    """Return a stride of 1 m in 1 s that turns left by `turn` rad; the sensor's x points forward."""
    drawn = tuple([(0.01 * k, 0.0, 4.0 if k < 50 else -4.0 if k > 50 else 0.0, -G, 0.0, 0.0, turn) for k in range(101)])
    return StrideSegment(drawn, CriticalTimes(0.0, 0.0, 1.0, 1.0), (1.0, 0.0, 0.0), 0.01)


def end_stride(projection: Projection, segment: StrideSegment) -> None:
    projection.predict(0.01, (0.0, 0.0, G), ZERO)
    projection.correct(1.0, Stance(ZERO, 0.01, 0.0, Phase.STATIONARY, segment))


def test_a_step_moves_the_foot_by_its_length_and_a_turn_by_its_chord() -> None:
    projection = Projection()
    projection.start((1.0, 0.0, 0.0, 0.0), 0.0)
    end_stride(projection, swing_segment())
    assert projection.position == pytest.approx((1.0, 0.0, 0.0), abs=1e-3)
    end_stride(projection, swing_segment(pi / 2.0))
    assert projection.position == pytest.approx((1.0 + sqrt(0.5), sqrt(0.5), 0.0), abs=2e-2)
    end_stride(projection, swing_segment())
    x, y, z = projection.position
    assert y == pytest.approx(1.0 + sqrt(0.5), abs=3e-2) and z == 0.0


def test_the_cues_of_a_step_come_all_at_once_with_their_own_times() -> None:
    cues = CriticalCues()
    segment = StrideSegment((), CriticalTimes(1.0, 1.2, 1.6, 1.7), (1.0, 0.0, 0.0), 0.01)
    stance = Stance(ZERO, 0.01, 0.0, Phase.STATIONARY, segment)
    seen = cues.update(1.8, 0.01, ZERO, ZERO, True, 0.0, Phase.STATIONARY, None, stance)
    assert [one.cue for one in seen] == [Cue.LIFT, Cue.CLEAR, Cue.CONTACT, Cue.FLAT]
    assert [one.t for one in seen] == [1.0, 1.2, 1.6, 1.7]
    assert not cues.update(1.9, 0.01, ZERO, ZERO, True, 0.0, Phase.STATIONARY, None, stance._replace(detail=None))
