"""Routes of published experiments: they close, marks lie under steps, and every step has its mode."""

from itertools import pairwise
from math import hypot, pi

import numpy as np
import pytest

from solepath.emulate.routes.laps import (
    BEND_RADII,
    MARK_SPACING,
    MARKS_PER_LAP,
    STEPS_OVER_MARKS,
    corners,
    corridor,
    field_walk,
    marked,
    marks,
    modes,
    rectangle,
    square,
)
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, WalkingMode


@pytest.fixture(scope="module")
def laps() -> Walker:
    return Walker(square(laps=3), seed=4)


@pytest.mark.parametrize("route", [square(laps=2), corridor(), field_walk(120.0, 1.0), rectangle()])
def test_laps_end_at_their_start(route: Route) -> None:
    end = route.end
    assert hypot(end.x, end.y) == pytest.approx(0.0, abs=1e-9)
    walker = Walker(route, seed=2)
    for foot in Foot:
        moved = walker.truth().pose(foot, walker.duration).position[0]
        assert hypot(moved[0], moved[1]) < 0.5  # the feet stand the other way round, perhaps


def test_a_lap_of_the_square_has_forty_marks_for_each_foot(laps: Walker) -> None:
    found = marks(laps, MARKS_PER_LAP)
    for foot in Foot:
        own = [mark for mark in found if mark.foot is foot]
        assert [(mark.lap, mark.number) for mark in own] == [divmod(k, MARKS_PER_LAP) for k in range(3 * MARKS_PER_LAP)]
        assert [mark.step for mark in own] == list(range(1, 3 * MARKS_PER_LAP + 1))
        for lap in (1, 2):
            for one, again in zip(
                own[:MARKS_PER_LAP], own[lap * MARKS_PER_LAP : (lap + 1) * MARKS_PER_LAP], strict=True
            ):
                assert hypot(one.x - again.x, one.y - again.y) < 1e-6
        apart = [hypot(a.x - b.x, a.y - b.y) for a, b in pairwise(own)]
        assert max(apart) < 1.35 and min(apart) > 0.75


@pytest.mark.parametrize("mode", [None, WalkingMode.STRAIGHT, *BEND_RADII])
def test_feet_land_on_their_marks_within_centimetres(laps: Walker, mode: WalkingMode | None) -> None:
    walker = laps if mode is None else Walker(marked(mode), seed=5)
    found = marks(walker)
    errors = []
    for mark in found:
        stride = walker.plan.strides[mark.foot][mark.step - 1]
        assert mark.t == stride.foot_flat == walker.truth().strides(mark.foot)[mark.step - 1].t_end
        errors.append(hypot(stride.end.x - mark.x, stride.end.y - mark.y))
    assert max(errors) < 0.06 and np.sqrt(np.mean(np.square(errors))) == pytest.approx(0.0156, rel=0.3)
    if mode is not None:
        assert len(found) == STEPS_OVER_MARKS
        assert {mark.mode for mark in found} == {mode}
        apart = [hypot(a.x - b.x, a.y - b.y) for a, b in pairwise(found)]
        assert np.mean(apart) == pytest.approx(MARK_SPACING, abs=0.04)


def test_steps_are_labelled_by_the_bend_in_which_they_land() -> None:
    route = (
        Route().stand(1.0).walk(6.0, 1.1).turn(pi, 2.0).walk(4.0).turn(-pi / 2, 4.0).walk(4.0).turn(pi / 2).stop(1.0)
    )
    walker = Walker(route, seed=3)
    found = modes(walker)
    for foot in Foot:
        labels = [label for label, before in zip(found[foot], [None, *found[foot]], strict=False) if label != before]
        straight, bends = WalkingMode.STRAIGHT, (WalkingMode.LEFT_TIGHT, WalkingMode.RIGHT_WIDE)
        assert labels[:5] == [straight, bends[0], straight, bends[1], straight]
        assert len(found[foot]) == len(walker.truth().strides(foot))
        assert WalkingMode.STANDING in found[foot][-3:]


def test_the_corners_of_the_rectangle_are_passed_in_order_and_a_is_stood_on() -> None:
    walker = Walker(rectangle(), seed=6)
    found = corners(walker)
    assert [corner.name for corner in found] == ["B", "C", "D", "A"]
    assert [corner.place[:2] for corner in found] == [(2.8, 0.0), (2.8, 4.0), (0.0, 4.0), (0.0, 0.0)]
    assert all(a.t < b.t for a, b in pairwise(found))
    for corner in found:
        # A bend of 0.5 m passes its corner 0.21 m away; the body leans inwards besides.
        assert hypot(corner.body[0] - corner.place[0], corner.body[1] - corner.place[1]) < 0.4
        for foot in Foot:
            stride = walker.truth().strides(foot)[corner.stride_numbers[foot] - 1]
            assert abs(stride.t_end - corner.t) < 1.0
            assert hypot(*(corner.footprints[foot][axis] - corner.body[axis] for axis in (0, 1))) < 0.7
    (a,) = found[3:]
    assert hypot(a.body[0], a.body[1]) < 0.08
