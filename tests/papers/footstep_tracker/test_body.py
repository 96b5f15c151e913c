"""Both feet and their turns: the one-metre rule, turning processes, the classifier, walks (recipe footstep-tracker)."""

from __future__ import annotations

from math import cos, degrees, pi, radians, sin

import pytest
from strides import stride

from solepath.body.gait.turns import WEIGHTS, TurnDetector, TurningStrideFilter, TurnProcess, classify
from solepath.calibration import Calibration
from solepath.events import StrideTaken
from solepath.papers.footstep_tracker.footsteps import Footsteps
from solepath.papers.footstep_tracker.projection import Projection
from solepath.papers.footstep_tracker.stride_length import printed_toe_out
from solepath.types import Foot, Turn
from solepath_lab.train.turns import read, train_weights


def stride_of(foot: Foot, t: float, turn: float = 0.0, way: tuple[float, float] = (1.0, 0.0)) -> StrideTaken:
    """Return a stride that ends at `t` s and turns by `turn` rad, left positive."""
    return stride(foot, t, (*way, 0.0), heading_change=turn)


def new_track() -> Footsteps:
    """Return the track of a wearer with sensors on both feet."""
    body = Footsteps()
    for path in body.paths.values():
        path.strides_alone = 0
    return body


def walked(count: int, left: float, right: float) -> Footsteps:
    """Return the track after `count` strides of each foot, `left` and `right` m long."""
    body = new_track()
    for k in range(count):
        body.add_stride(stride_of(Foot.LEFT, k + 0.5, way=(left, 0.0)))
        body.add_stride(stride_of(Foot.RIGHT, k + 1.0, way=(right, 0.0)))
    return body


def mean_position(body: Footsteps) -> tuple[float, float]:
    (lx, ly), (rx, ry), (x, y) = (*(path.displacement for path in body.paths.values()), body.restart_position)
    return (x + 0.5 * (lx + rx), y + 0.5 * (ly + ry))


def test_feet_that_are_no_metre_apart_do_not_restart() -> None:
    body = walked(4, 0.9, 1.0)
    assert body.restarts == 0 and body.paths[Foot.RIGHT].displacement == pytest.approx((4.0, 0.0))


def test_feet_that_are_more_than_a_metre_apart_restart_at_their_mean_and_then_at_every_stride() -> None:
    body = walked(6, 1.4, 1.2)
    assert body.restarts == 12
    assert mean_position(body) == pytest.approx((0.5 * 6 * 2.6, 0.0))


def test_a_foot_without_strides_moves_with_the_other() -> None:
    body = Footsteps()
    for k in range(5):
        body.add_stride(stride_of(Foot.LEFT, float(k), way=(1.4, 0.0)))
    assert body.restarts == 0 and mean_position(body) == pytest.approx((7.0, 0.0))


def test_both_feet_go_on_in_the_direction_of_the_mean_of_their_turns() -> None:
    body = new_track()
    # the left foot measures 80 degrees and the right one 100; each then goes straight by its own track
    for foot, turn in ((Foot.LEFT, radians(80.0)), (Foot.RIGHT, radians(100.0))):
        body.add_stride(stride_of(foot, 1.0, turn, way=(0.0, 0.0)))
    before = mean_position(body)
    for foot, own in ((Foot.LEFT, radians(80.0)), (Foot.RIGHT, radians(100.0))):
        body.add_stride(stride_of(foot, 2.0, way=(cos(own), sin(own))))
    x, y = mean_position(body)
    assert (x - before[0], y - before[1]) == pytest.approx((0.0, 1.0))


def turns_of(direction: TurnDetector, steps: list[StrideTaken]) -> list[TurnProcess]:
    return [found for one in steps if (found := direction.add_stride(one)) is not None]


def alternate_strides(turns: list[tuple[float, float]], first: float = 1.0) -> list[StrideTaken]:
    """Return alternate strides of both feet that turn by (left, right) degrees."""
    steps = []
    for k, (left, right) in enumerate(turns):
        steps.append(stride_of(Foot.LEFT, first + k, radians(left)))
        steps.append(stride_of(Foot.RIGHT, first + k + 0.5, radians(right)))
    return steps


def test_a_turn_over_several_steps_is_their_sum_and_the_mean_of_both_feet() -> None:
    (found,) = turns_of(TurnDetector(), alternate_strides([(0, 0), (30, 50), (40, 50), (0, 0), (0, 0)]))
    assert found.left is not None and found.right is not None
    assert degrees(found.left) == pytest.approx(70.0) and degrees(found.right) == pytest.approx(100.0)
    assert degrees(found.angle) == pytest.approx(85.0)
    assert (found.t_start, found.t_end) == (1.0, 3.5)


def test_a_turn_ends_when_the_wearer_stands() -> None:
    direction = TurnDetector()
    assert turns_of(direction, alternate_strides([(0, 0), (90, 90)])) == []
    assert direction.advance(3.0) is None
    found = direction.advance(6.0)
    assert found is not None and degrees(found.angle) == pytest.approx(90.0)
    assert direction.advance(9.0) is None


def test_one_foot_stepping_on_the_spot_does_not_end_the_other_s_turn() -> None:
    found = turns_of(TurnDetector(), alternate_strides([(0, 0), (100, 0), (0, 90), (70, 80), (0, 0), (0, 0)]))
    assert len(found) == 1 and degrees(found[0].angle) == pytest.approx(170.0)


@pytest.mark.parametrize(
    ("left", "right", "turn"),
    [
        (90.0, 85.0, Turn.LEFT),
        (-90.0, -80.0, Turn.RIGHT),
        (175.0, 180.0, Turn.ABOUT),
        (-170.0, -185.0, Turn.ABOUT),
        (60.0, 70.0, Turn.LEFT),
        (20.0, 25.0, None),
        (0.0, 0.0, None),
    ],
)
def test_turns_are_called_left_right_and_about(left: float, right: float, turn: Turn | None) -> None:
    assert classify(radians(left), radians(right)) is turn
    assert classify(radians(left), None) is turn
    assert classify(None, radians(right)) is turn


@pytest.mark.soak
def test_the_weights_are_those_that_the_training_turns_give() -> None:
    examples = read()
    assert {turn for turn, _, _ in examples} == set(Turn)
    assert train_weights(examples) == WEIGHTS


def test_the_printed_toe_out_is_an_arc_cosine_that_a_shorter_way_along_the_foot_does_not_have() -> None:
    assert degrees(printed_toe_out(20.2, 20.0) or 0.0) == pytest.approx(8.07, abs=0.01)  # arccos(20 / 20.2)
    assert printed_toe_out(20.0 * cos(radians(7.0)), 20.0) is None


def test_the_angle_of_a_calibration_is_the_one_that_the_foot_uses() -> None:
    known = Calibration(toe_out={foot: 0.2 for foot in Foot})
    left, right = (Projection().calibrated(foot, known).settings for foot in Foot)
    assert (left.phi, right.phi) == (0.2, -0.2)
    assert Projection().calibrated(Foot.LEFT, Calibration()) == Projection()


def test_a_curve_stays_a_curve_and_a_corner_keeps_its_first_and_last_turn() -> None:
    """A circle of 24 strides of 15 degrees, most of which `turn` takes for straight; a corner of 5, 40, 40 and 5."""
    ours, printed = TurningStrideFilter(), TurningStrideFilter()
    circle = [radians(15.0)] * 24
    assert sum([ours.corner_turn(turn) for turn in circle]) == pytest.approx(2.0 * pi)
    assert sum([printed.turn(turn) for turn in circle]) < 0.3 * 2.0 * pi
    corner = [radians(turn) for turn in (0.0, 5.0, 40.0, 40.0, 5.0, 0.0)]
    turns = [ours.corner_turn(turn) for turn in corner]
    assert turns[:2] == [0.0, 0.0] and turns[5] == 0.0
    # the usual turn follows the first 5 degrees by a tenth: 5 + 39.5 + 39.5 + 4.5
    assert sum(turns) == pytest.approx(radians(88.5))
