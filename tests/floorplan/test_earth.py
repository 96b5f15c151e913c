"""Conversion from degrees to the plan's metres."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from solepath.floorplan.importers.earth import Tangent, south_west
from solepath.floorplan.plan import Anchor, FloorPlanError

anchors = st.builds(Anchor, st.floats(-80.0, 80.0), st.floats(-180.0, 180.0), st.floats(-3.2, 3.2))
metres = st.floats(-500.0, 500.0)


def vincenty(a: tuple[float, float], b: tuple[float, float]) -> float:
    """Return the length of the geodesic on the WGS84 ellipsoid, m, between (latitude, longitude) in degrees (Vincenty
    1975, Survey Review 23, inverse formula)."""
    major, f = 6378137.0, 1.0 / 298.257223563
    minor = (1.0 - f) * major
    u1, u2 = (math.atan((1.0 - f) * math.tan(math.radians(p[0]))) for p in (a, b))
    difference = math.radians((b[1] - a[1] + 180.0) % 360.0 - 180.0)
    lam = difference
    for _ in range(100):
        s, c = math.sin(lam), math.cos(lam)
        sin_sigma = math.hypot(math.cos(u2) * s, math.cos(u1) * math.sin(u2) - math.sin(u1) * math.cos(u2) * c)
        if sin_sigma == 0.0:
            return 0.0
        cos_sigma = math.sin(u1) * math.sin(u2) + math.cos(u1) * math.cos(u2) * c
        sigma = math.atan2(sin_sigma, cos_sigma)
        sin_alpha = math.cos(u1) * math.cos(u2) * s / sin_sigma
        cos2_alpha = 1.0 - sin_alpha**2
        cos_2m = cos_sigma - 2.0 * math.sin(u1) * math.sin(u2) / cos2_alpha if cos2_alpha > 1e-12 else 0.0
        k = f / 16.0 * cos2_alpha * (4.0 + f * (4.0 - 3.0 * cos2_alpha))
        previous, lam = (
            lam,
            difference
            + (1.0 - k) * f * sin_alpha * (sigma + k * sin_sigma * (cos_2m + k * cos_sigma * (2.0 * cos_2m**2 - 1.0))),
        )
        if abs(lam - previous) < 1e-15:
            break
    square = cos2_alpha * (major**2 - minor**2) / minor**2
    big_a = 1.0 + square / 16384.0 * (4096.0 + square * (-768.0 + square * (320.0 - 175.0 * square)))
    big_b = square / 1024.0 * (256.0 + square * (-128.0 + square * (74.0 - 47.0 * square)))
    correction = big_b * sin_sigma * (cos_2m + big_b / 4.0 * cos_sigma * (2.0 * cos_2m**2 - 1.0))
    return minor * big_a * (sigma - correction)


@given(anchors, metres, metres)
def test_a_place_comes_back_from_degrees(anchor: Anchor, x: float, y: float) -> None:
    tangent = Tangent(anchor)
    place = tangent.plan(*tangent.degrees((x, y)))
    assert place == pytest.approx((x, y), abs=1e-6)


@given(anchors, metres, metres, metres, metres)
def test_within_500_m_lengths_are_those_on_the_ellipsoid_to_a_millimetre(
    anchor: Anchor, ax: float, ay: float, bx: float, by: float
) -> None:
    assume(math.hypot(bx - ax, by - ay) > 1.0)
    tangent = Tangent(anchor)
    length = vincenty(tangent.degrees((ax, ay)), tangent.degrees((bx, by)))
    assert math.hypot(bx - ax, by - ay) == pytest.approx(length, abs=1e-3)


def test_a_bearing_turns_the_plan_clockwise_from_north() -> None:
    north_up, turned = Tangent(Anchor(48.15, 11.57)), Tangent(Anchor(48.15, 11.57, math.radians(30.0)))
    east, north = north_up.plan(*turned.degrees((0.0, 100.0)))  # the plan's +y, 30 degrees east of north
    assert (east, north) == pytest.approx((50.0, 100.0 * math.cos(math.radians(30.0))), abs=1e-6)


def test_places_without_an_anchor_get_their_south_west_corner() -> None:
    assert south_west([(48.151, 11.57), (48.15, 11.58)]) == Anchor(48.15, 11.57, 0.0)


@pytest.mark.parametrize(("latitude", "longitude"), [(48.5, 11.57), (-48.15, -168.43), (91.0, 0.0), (math.nan, 0.0)])
def test_what_is_far_from_the_anchor_is_rejected(latitude: float, longitude: float) -> None:
    with pytest.raises(FloorPlanError):
        Tangent(Anchor(48.15, 11.57)).plan(latitude, longitude)
