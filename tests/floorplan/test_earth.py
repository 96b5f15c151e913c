"""Conversion from degrees to the plan's metres, and back."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solepath.floorplan.earth import Tangent, south_west
from solepath.floorplan.plan import Anchor, FloorPlan, FloorPlanError


def test_lengths_are_those_of_the_wgs84_ellipsoid_at_their_latitude_to_a_millimetre() -> None:
    """A tenth of a minute north and east, by the radii of curvature of WGS84 at 60 degrees."""
    # N = 6378137 m / root of (1 - 0.00669438 * 0.75) = 6394209.174 m along the parallel, times cos(60 degrees);
    # M = N * (1 - 0.00669438) / (1 - 0.00669438 * 0.75) = 6383453.857 m along the meridian; times pi / 108000
    tangent = Tangent(Anchor(60.0, 11.0))
    north, east = tangent.plan(60.0 + 0.1 / 60.0, 11.0), tangent.plan(60.0, 11.0 + 0.1 / 60.0)
    assert (north[1], east[0]) == pytest.approx((185.687146, 93.000003), abs=1e-3)


def test_a_bearing_turns_the_plan_clockwise_from_north() -> None:
    north_up, turned = Tangent(Anchor(48.15, 11.57)), Tangent(Anchor(48.15, 11.57, math.radians(30.0)))
    north = north_up.plan(48.151, 11.57)[1]  # of which the plan's +y is 30 degrees to the east
    assert turned.plan(48.151, 11.57) == pytest.approx((-0.5 * north, north * math.cos(math.radians(30.0))), abs=1e-6)


def test_places_without_an_anchor_get_their_south_west_corner() -> None:
    assert south_west([(11.57, 48.151), (11.58, 48.15)]) == Anchor(48.15, 11.57, 0.0)


@pytest.mark.parametrize(("latitude", "longitude"), [(48.5, 11.57), (-48.15, -168.43), (91.0, 0.0), (math.nan, 0.0)])
def test_what_is_far_from_the_anchor_is_rejected(latitude: float, longitude: float) -> None:
    with pytest.raises(FloorPlanError):
        Tangent(Anchor(48.15, 11.57)).plan(latitude, longitude)


far = st.floats(-14_000.0, 14_000.0)


@given(st.builds(Anchor, st.floats(-89.0, 89.0), st.floats(-180.0, 180.0), st.floats(-3.2, 3.2)), st.tuples(far, far))
def test_a_point_of_the_plan_has_the_degrees_that_lead_back_to_it(anchor: Anchor, point: tuple[float, float]) -> None:
    longitude, latitude = FloorPlan("", (), anchor=anchor).to_wgs84(point)
    assert math.dist(Tangent(anchor).plan(latitude, longitude), point) < 1e-6


def test_a_plan_without_an_anchor_and_a_point_far_from_it_have_no_degrees() -> None:
    with pytest.raises(FloorPlanError, match="give it an anchor"):
        FloorPlan("", ()).to_wgs84((1.0, 2.0))
    with pytest.raises(FloorPlanError, match="far from the anchor"):
        FloorPlan("", (), anchor=Anchor(48.15, 11.57)).to_wgs84((0.0, 21_000.0))
