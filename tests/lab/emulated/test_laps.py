"""Laps over marks on the floor: where the marks are, how near the feet land, and which bend a step belongs to."""

from itertools import pairwise
from math import hypot, pi

import numpy as np
import pytest

from solepath.emulate import Route
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, WalkingMode
from solepath_lab.emulated.heading_walks import KINDS, heading_route, wearer_of
from solepath_lab.emulated.laps import (
    MARK_SPACING,
    STEPS_OVER_MARKS,
    corners,
    corridor,
    field_walk,
    marked,
    marks,
    mode_of,
    rectangle,
    square,
)


@pytest.fixture(scope="module")
def laps() -> Walker:
    return Walker(square(laps=2), seed=4)


@pytest.mark.parametrize("route", [square(laps=2), corridor(), field_walk(120.0, 1.0), rectangle()])
def test_laps_end_at_their_start(route: Route) -> None:
    assert hypot(route.end.x, route.end.y) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("mode", [None, WalkingMode.STRAIGHT, WalkingMode.LEFT_TIGHT, WalkingMode.RIGHT_WIDE])
def test_feet_land_on_their_marks_within_centimetres(laps: Walker, mode: WalkingMode | None) -> None:
    walker = laps if mode is None else Walker(marked(mode), seed=5)
    found, truth, errors = marks(walker), walker.truth(), []
    for mark in found:
        stride = walker.plan.strides[mark.foot][mark.step - 1]
        assert mark.t == stride.foot_flat == truth.strides(mark.foot)[mark.step - 1].t_end
        errors.append(hypot(stride.end.x - mark.x, stride.end.y - mark.y))
    assert max(errors) < 0.06 and np.sqrt(np.mean(np.square(errors))) == pytest.approx(0.0156, rel=0.3)
    if mode is not None:
        assert len(found) == STEPS_OVER_MARKS and {mark.mode for mark in found} == {mode}
        apart = [hypot(a.x - b.x, a.y - b.y) for a, b in pairwise(found)]
        assert np.mean(apart) == pytest.approx(MARK_SPACING, abs=0.04)


def test_steps_are_labelled_by_the_bend_in_which_they_land() -> None:
    route = Route().stand(1.0).walk(6.0, 1.1).turn(pi, 2.0).walk(4.0).turn(-pi / 2, 4.0).walk(4.0).stop(1.0)
    walker = Walker(route, seed=3)
    straight, bends = WalkingMode.STRAIGHT, (WalkingMode.LEFT_TIGHT, WalkingMode.RIGHT_WIDE)
    for foot in Foot:
        found = [mode_of(stride) for stride in walker.plan.strides[foot]]
        labels = [label for label, before in zip(found, [None, *found], strict=False) if label != before]
        assert labels[:5] == [straight, bends[0], straight, bends[1], straight]


def test_the_corners_of_the_rectangle_are_passed_in_order_and_a_is_stood_on() -> None:
    walker = Walker(rectangle(), seed=6)
    found = corners(walker)
    assert [corner.name for corner in found] == ["B", "C", "D", "A"]
    assert [corner.place[:2] for corner in found] == [(2.8, 0.0), (2.8, 4.0), (0.0, 4.0), (0.0, 0.0)]
    assert all(a.t < b.t for a, b in pairwise(found))
    for corner in found:
        # a bend of 0.5 m passes its corner 0.21 m away; the body leans inwards besides
        assert hypot(corner.body[0] - corner.place[0], corner.body[1] - corner.place[1]) < 0.4
        for foot in Foot:
            assert abs(walker.truth().strides(foot)[corner.stride_numbers[foot] - 1].t_end - corner.t) < 1.0
    assert hypot(*found[3].body[:2]) < 0.08


@pytest.mark.parametrize("kind", KINDS)
def test_a_route_of_every_kind_is_as_long_as_it_should_be_and_the_same_for_the_same_seed(kind: str) -> None:
    route, again = (heading_route(kind, 3, lambda length, seconds: length >= 200.0) for _ in range(2))
    assert route == again and 200.0 <= route.length < (2600.0 if kind == "circle" else 720.0)
    assert wearer_of(3) == wearer_of(3) != wearer_of(4)
