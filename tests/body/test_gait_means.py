"""Gait cycles from any events of two feet, and the arithmetic of running means, symmetry and coordination."""

from __future__ import annotations

import json
from math import isfinite
from statistics import mean, stdev

import attrs
import pytest
from attrs import define, field
from hypothesis import given, settings
from hypothesis import strategies as st
from views import fed

from solepath import (
    FootFlat,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    SampleGap,
    Site,
    StrideFeatures,
    StrideTaken,
    ToeOff,
)
from solepath.body.gait.cycles import GaitCycles
from solepath.body.gait.means import MEMORY_STRIDES, GaitMeans, RunningMean, add_values
from solepath.events import Event
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
from solepath.saving import codec as machine
from solepath.types import OTHER, SITE_OF_FOOT, Foot, Sample, Vec3

L, R = Foot.LEFT, Foot.RIGHT


@define
class Walked:
    """Two feet with a given list of events."""

    strides: GaitCycles
    feet: dict[Foot, FootTracker]
    newest: dict[Foot, float] = field(factory=dict)
    """Time of the newest sample of each foot, s."""

    def add_sample(self, foot: Foot, t: float, *events: Event) -> list[GaitCycleMeasured]:
        """Add a sample at `t` s with these events, and return the gait cycles."""
        sample = Sample(t=t, site=SITE_OF_FOOT[foot], acc=(0.0, 0.0, 9.81), gyro=(0.0, 0.0, 0.0))
        self.newest[foot] = max(t, self.newest.get(foot, t))
        cycles = fed(self.strides, self.feet[foot], sample, events, self.newest.get(OTHER[foot]))
        return [event for event in cycles if isinstance(event, GaitCycleMeasured)]


def walked(*feet: Foot) -> Walked:
    return Walked(GaitCycles(), {foot: FootTracker(foot, Cycle(), ErrorStateFilter()) for foot in feet})


def taken(foot: Foot, toe_off: float, struck: float, start: Vec3, end: Vec3) -> StrideTaken:
    move = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    return StrideTaken(
        t=struck + 0.1, known_at=struck + 0.1, foot=foot, number=1, t_start=toe_off - 0.3, t_end=struck + 0.1,
        displacement=move, position=end, length=abs(move[0]), heading_change=0.0, height_change=move[2],
        covariance=(0.0,) * 6, t_toe_off=toe_off, t_heel_strike=struck, features=StrideFeatures(0.1, 4.0, 1.0),
    )  # fmt: skip


def walk_on(
    on: Walked, count: int, *, step: float = 0.5, late: float = 0.0, length: float | None = None, start: float = 0.0
) -> list[GaitCycleMeasured]:
    """Walk on with both feet: the right one comes down `step` after the left one, and `late` s more."""
    cycles: list[GaitCycleMeasured] = []
    for k in range(count):
        foot = L if k % 2 == 0 else R
        struck = start + k * step + (late if foot is R else 0.0)
        cleared = struck - 0.8 * step
        cycles += on.add_sample(foot, cleared, ToeOff(t=cleared, known_at=cleared, foot=foot))
        cycles += on.add_sample(foot, struck, HeelStrike(t=struck, known_at=struck, foot=foot))
        flat: list[Event] = [FootFlat(t=struck + 0.1, known_at=struck + 0.1, foot=foot)]
        if length is not None and k > 1:
            at = (0.5 * k * length, 0.1 if foot is L else -0.05, 0.0)
            flat.append(taken(foot, cleared, struck, (at[0] - length, at[1], 0.0), at))
        for other in on.feet:
            cycles += on.add_sample(other, struck + 0.1, *(flat if other is foot else ()))
    return cycles


def test_a_cycle_goes_from_contact_to_contact_and_the_other_foot_divides_it() -> None:
    cycles = walk_on(walked(L, R), 8)
    assert [(stride.foot, stride.t_start, stride.t) for stride in cycles[:2]] == [(L, 0.0, 1.0), (R, 0.5, 1.5)]
    for stride in cycles:
        assert (stride.stride_time, stride.cadence) == (1.0, 120.0)
        assert stride.stance_time == pytest.approx(0.6) and stride.swing_time == pytest.approx(0.4)
        assert stride.step_time == pytest.approx(0.5) and stride.phase == pytest.approx(0.5)
        assert stride.initial_double_support == pytest.approx(0.1)
        assert stride.terminal_double_support == pytest.approx(0.1)
        assert stride.single_support == pytest.approx(0.4)


@pytest.mark.parametrize("late", [-0.3, -0.2, 0.2, 0.3, 0.45])
def test_a_cycle_with_a_flight_and_a_double_support_is_no_walk_and_no_run_and_compares_nothing(late: float) -> None:
    cycles = walk_on(walked(L, R), 16, late=late, start=1.0)
    assert len(cycles) > 8 and all(cycle.stance_time == pytest.approx(0.6) for cycle in cycles)
    between = {(c.step_time, c.phase, c.initial_double_support, c.terminal_double_support) for c in cycles[1:]}
    assert between == {(None, None, None, None)} and {cycle.single_support for cycle in cycles[1:]} == {None}


@pytest.mark.parametrize("late", [-0.14, -0.06, 0.06, 0.14])
def test_uneven_steps_of_a_walker_are_no_contradiction(late: float) -> None:
    cycles = walk_on(walked(L, R), 16, late=late, start=1.0)
    assert {cycle.initial_double_support is None for cycle in cycles[1:]} == {False}


def test_no_foot_is_cleared_by_less_than_nothing() -> None:
    """Correct the foot's height at the foot-flat to above the highest point of the swing."""
    on, step = walked(L), taken(L, 0.6, 1.0, (0.0, 0.0, 0.0), (1.4, 0.0, 0.27))
    step = attrs.evolve(step, features=StrideFeatures(-0.02, 4.0, 1.0))
    on.add_sample(L, 0.0, HeelStrike(t=0.0, known_at=0.0, foot=L))
    on.add_sample(L, 0.6, ToeOff(t=0.6, known_at=0.6, foot=L))
    on.add_sample(L, 1.0, HeelStrike(t=1.0, known_at=1.0, foot=L))
    cycles = on.add_sample(L, 1.1, FootFlat(t=1.1, known_at=1.1, foot=L), step)
    assert [stride.clearance for stride in cycles] == [0.0]


def test_a_stand_of_more_than_two_seconds_is_no_stride() -> None:
    on = walked(L, R)
    walk_on(on, 6)
    again = walk_on(on, 6, start=12.0)
    assert min(stride.t_start for stride in again) >= 12.0
    assert not [stride for stride in again if stride.steady and stride.t_start < 12.9]


def test_a_heel_that_comes_down_again_without_the_toe_leaving_is_no_contact() -> None:
    on = walked(L)
    cues = [(ToeOff, 0.0), (HeelStrike, 0.4), (FootFlat, 0.5), (HeelOff, 0.8), (HeelStrike, 0.9), (FootFlat, 0.95),
               (HeelOff, 1.0), (ToeOff, 1.1), (HeelStrike, 1.5), (FootFlat, 1.6)]  # fmt: skip
    cycles = [s for kind, t in cues for s in on.add_sample(L, t, kind(t=t, known_at=t, foot=L))]
    assert [(stride.t_start, stride.t) for stride in cycles] == [(0.4, 1.5)]


def test_a_stride_waits_for_the_other_foots_samples_but_not_for_ever() -> None:
    on = walked(L, R)
    walk_on(on, 4)
    on.add_sample(L, 1.2, ToeOff(t=1.2, known_at=1.2, foot=L))
    on.add_sample(L, 2.0, HeelStrike(t=2.0, known_at=2.0, foot=L))
    assert not on.add_sample(L, 2.1, FootFlat(t=2.1, known_at=2.1, foot=L)) and not on.strides.idle
    assert not on.add_sample(L, 2.4)
    (late,) = on.add_sample(L, 2.5)
    assert (late.t, late.known_at) == (2.0, 2.5) and on.strides.idle


def test_a_clock_that_restarts_ends_the_cycle_under_way() -> None:
    on = walked(L, R)
    before = walk_on(on, 6)
    on.strides.reset(Site.LEFT_FOOT)
    after = walk_on(on, 6, start=100.0)
    assert all(stride.t_start >= 100.0 for stride in after if stride.foot is L)
    assert [s.number for s in (*before, *after) if s.foot is L] == [1, 2, 3, 4]


def test_a_long_gap_spoils_a_steady_stride_and_a_short_one_does_not() -> None:
    for duration, steady in ((0.03, True), (0.3, False)):
        on = walked(L, R)
        walk_on(on, 8)
        on.add_sample(L, 3.6, SampleGap(t=3.5, known_at=3.6, site=SITE_OF_FOOT[L], duration=duration))
        (stride,) = [stride for stride in walk_on(on, 1, start=4.0) if stride.foot is L]
        assert stride.degraded and stride.steady is steady


def test_the_last_stride_before_a_stop_does_not_count() -> None:
    on = walked(L, R)
    cycles = walk_on(on, 12)
    left = on.strides.means.of(False)
    assert left is not None and left.feet[L].stride_time is not None
    assert left.feet[L].stride_time.strides == len([s for s in cycles if s.foot is L]) - 2


KINDS = st.sampled_from([HeelStrike, FootFlat, HeelOff, ToeOff, StrideTaken, SampleGap])
TIMES = st.one_of(st.floats(0.0, 0.7), st.sampled_from([0.0, 1e-9, 5.0, 1e9, 1e300]))
PLACES = st.one_of(st.floats(-3.0, 3.0), st.sampled_from([1e30, -1e200, 1e308]))


@given(st.lists(st.tuples(st.sampled_from(Foot), KINDS, TIMES, PLACES, st.booleans()), max_size=60))
@settings(max_examples=60)
def test_whatever_the_feet_do_strides_are_sound_and_can_be_saved(
    does: list[tuple[Foot, type, float, float, bool]],
) -> None:
    on = walked(L, R)
    t, last_toe_off = 0.0, 0.0
    cycles: list[Event] = []
    for foot, kind, passed, place, inferred in does:
        t += passed
        if kind is StrideTaken:
            event: Event = taken(foot, last_toe_off, t, (0.0, 0.0, 0.0), (place, 0.5 * place, 0.1))
        elif kind is SampleGap:
            event = SampleGap(t=t, known_at=t, site=SITE_OF_FOOT[foot], duration=passed)
        else:
            event = kind(t=t, known_at=t, foot=foot, inferred=inferred)
        last_toe_off = t if kind is ToeOff else last_toe_off
        cycles += on.add_sample(foot, t, event)
        copy = machine.load(GaitCycles, json.loads(json.dumps(machine.save(on.strides), allow_nan=False)))
        assert copy == on.strides
    cycles += on.strides.finish(t)
    for stride in cycles:
        assert isinstance(stride, GaitCycleMeasured)
        assert stride.t_start <= stride.t_toe_off <= stride.t <= stride.known_at
        for one in attrs.fields(GaitCycleMeasured):
            value = getattr(stride, one.name)
            assert not isinstance(value, float) or isfinite(value)
    parameters = on.strides.parameters
    assert parameters is None or (parameters.cadence or 0.0) > 0.0


@given(st.lists(st.floats(-10.0, 10.0), min_size=2, max_size=MEMORY_STRIDES))
def test_up_to_two_minutes_of_walking_mean_and_deviation_are_plain_ones(values: list[float]) -> None:
    running = RunningMean()
    for value in values:
        add_values([(running, value)], MEMORY_STRIDES)
    assert running.figure.strides == len(values)
    assert running.figure.mean == pytest.approx(mean(values), abs=1e-9)
    assert running.figure.sd == pytest.approx(stdev(values), abs=1e-6)


def test_after_that_what_is_old_fades() -> None:
    running = RunningMean()
    for value in [1.0] * 500 + [2.0] * 500:
        add_values([(running, value)], MEMORY_STRIDES)
    assert running.figure.mean == pytest.approx(2.0, abs=0.02)
    assert running.count == MEMORY_STRIDES


def test_one_stride_has_no_deviation() -> None:
    running = RunningMean()
    add_values([(running, 1.0)], MEMORY_STRIDES)
    assert running.figure.sd is running.figure.cv is None


def test_walking_alternately_is_symmetric_and_limping_is_not() -> None:
    even, limping = walked(L, R), walked(L, R)
    walk_on(even, 20)
    walk_on(limping, 20, late=0.05)
    same, other = even.strides.parameters, limping.strides.parameters
    assert same is not None and other is not None
    assert same.asymmetry("step_time") == pytest.approx(0.0) and same.coordination == pytest.approx(0.0, abs=1e-9)
    # the right foot's step takes 0.55 s, the left one's 0.45 s: 2 (0.55 - 0.45) / (0.55 + 0.45)
    assert other.asymmetry("step_time") == pytest.approx(0.2)
    # at 0.55 of the cycle instead of at 0.5
    assert other.coordination == pytest.approx(0.1)


def test_a_difference_between_the_feet_is_no_variability() -> None:
    on = walked(L, R)
    walk_on(on, 20, late=0.05)
    parameters = on.strides.parameters
    assert parameters is not None and parameters.both.step_time is not None
    assert parameters.both.step_time.mean == pytest.approx(0.5)
    assert parameters.both.step_time.sd == pytest.approx(0.0, abs=1e-6)


def test_walking_and_running_are_added_up_apart() -> None:
    cycles = walk_on(walked(L, R), 12)
    means = GaitMeans()
    for stride in cycles:
        means.add(stride)
    assert means.of(True) is None and means.of(False) is not None
    for stride in cycles:
        ran = attrs.evolve(stride, t=stride.t + 10.0, t_start=stride.t_start + 10.0, stance_time=0.3, steady=True)
        means.add(ran)
    both = means.of(True), means.of(False)
    assert both[0] is not None and both[1] is not None
    assert means.parameters == both[0] and both[0].running and not both[1].running
