"""Gait cycles from any events of two feet, and the arithmetic of running means, symmetry and coordination."""

from __future__ import annotations

import attrs
import pytest
from attrs import define, field
from views import fed

from solepath import FootFlat, GaitCycleMeasured, HeelStrike, StrideFeatures, StrideTaken, ToeOff
from solepath.body.gait.cycles import GaitCycles
from solepath.body.gait.means import GaitMeans
from solepath.events import Event
from solepath.foot.cues.gait_cues import GaitCues
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
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
    return Walked(GaitCycles(), {foot: FootTracker(foot, Cycle(), ErrorStateFilter(), GaitCues()) for foot in feet})


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


@pytest.mark.parametrize("late", [-0.3, 0.2, 0.45])
def test_a_cycle_with_a_flight_and_a_double_support_is_no_walk_and_no_run_and_compares_nothing(late: float) -> None:
    cycles = walk_on(walked(L, R), 16, late=late, start=1.0)
    assert len(cycles) > 8 and all(cycle.stance_time == pytest.approx(0.6) for cycle in cycles)
    between = {(c.step_time, c.phase, c.initial_double_support, c.terminal_double_support) for c in cycles[1:]}
    assert between == {(None, None, None, None)} and {cycle.single_support for cycle in cycles[1:]} == {None}


@pytest.mark.parametrize("late", [-0.14, 0.06])
def test_uneven_steps_of_a_walker_are_no_contradiction(late: float) -> None:
    cycles = walk_on(walked(L, R), 16, late=late, start=1.0)
    assert {cycle.initial_double_support is None for cycle in cycles[1:]} == {False}


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
