"""Contours of heel pressure: equations (1) and (2) against a contour worked out by hand, whatever the cells."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest
from hypothesis import strategies as st

from solepath.papers.pressure_contour.contour import PAPER_LEVELS, Contours, ContourSettings
from solepath.types import Cell, Foot, Layout

LENGTH = 0.28
INTERVAL = 0.05
"""Time between two samples, s."""
PEAK, SLOPE = 2e5, 5e6
"""Height, Pa, and slope, Pa/m, of a cone of pressure with a base radius of 40 mm."""


def grid(spacing: float = 0.006, scale: float | None = 1.0) -> Layout:
    """Return a layout with a square grid of cells, 84 mm wide, around (0.046, 0), all under the heel."""
    half = round(0.042 / spacing)
    places = [(0.046 + spacing * i, spacing * j) for i in range(-half, half + 1) for j in range(-half, half + 1)]
    cells = tuple(Cell(x, y, spacing * spacing) for x, y in places)
    return Layout(len(cells), Foot.LEFT, cells, LENGTH, scale)


def cone_loads(where: Layout, x: float, y: float, part: float = 1.0) -> list[float]:
    """Return the loads, N, under a cone of pressure with its tip at (x, y) m, multiplied by `part`."""
    return [part * cell.area * max(0.0, PEAK - SLOPE * hypot(cell.x - x, cell.y - y)) for cell in where.cells]


def measured_velocity(
    contours: Contours, where: Layout, first: list[float], second: list[float]
) -> tuple[float, float]:
    assert contours.set_layout(where) is None
    assert contours.cells == list(range(len(where.cells)))
    assert contours.velocity(1.0, first) is None, "one look shows no movement"
    velocity = contours.velocity(1.0 + INTERVAL, second)
    assert velocity is not None
    return velocity


def circle_integral(x: float, y: float, radius: float) -> tuple[float, float]:
    """1/pi times the integral of dr/dt r_hat over theta for a circle that moves from the centre of the rays to (x, y)
    within STEP: r = d cos(theta - phi) + sqrt(R^2 - d^2 sin^2(theta - phi)), by hand."""
    theta = np.linspace(0.0, 2.0 * pi, 3600, endpoint=False)
    d, phi = hypot(x, y), np.arctan2(y, x)
    r = d * np.cos(theta - phi) + np.sqrt(radius**2 - (d * np.sin(theta - phi)) ** 2)
    rate = (r - radius) / INTERVAL
    per = 2.0 * pi / len(theta) / pi
    return float((rate * np.cos(theta)).sum() * per), float((rate * np.sin(theta)).sum() * per)


def test_the_integral_over_all_directions_divided_by_pi_is_how_fast_the_contour_moves() -> None:
    x, y = circle_integral(0.003, -0.001, 0.02)
    assert x == pytest.approx(0.003 / INTERVAL, rel=1e-6) and y == pytest.approx(-0.001 / INTERVAL, rel=1e-6)


@pytest.mark.parametrize("pascals", [None, PAPER_LEVELS])
def test_a_cone_of_pressure_that_moves_is_seen_to_move_as_fast(pascals: tuple[float, ...] | None) -> None:
    where = grid()
    centre = (0.046, 0.0)
    for dx, dy in ((0.002, 0.0), (0.0, 0.002), (-0.0015, 0.001)):
        contours, after = Contours(ContourSettings(pascals=pascals)), cone_loads(where, centre[0] + dx, centre[1] + dy)
        seen = measured_velocity(contours, where, cone_loads(where, *centre), after)
        true = circle_integral(dx, dy, 0.02)
        assert hypot(seen[0] - true[0], seen[1] - true[1]) < 0.06 * hypot(*true)


def test_a_contour_that_only_shrinks_does_not_move_wherever_the_rays_start() -> None:
    where = grid()
    for tip in ((0.046, 0.0), (0.051, 0.003)):
        contours = Contours(ContourSettings(pascals=(60e3, 100e3)))
        seen = measured_velocity(contours, where, cone_loads(where, *tip), cone_loads(where, *tip, part=0.9))
        # the level at 100 kPa comes in by 2.2 mm within 50 ms, 44 mm/s
        assert hypot(*seen) < 0.0025


def test_levels_that_follow_the_load_see_nothing_of_a_heel_that_is_unloaded() -> None:
    where = grid()
    seen = measured_velocity(
        Contours(), where, cone_loads(where, 0.051, 0.003), cone_loads(where, 0.051, 0.003, part=0.3)
    )
    assert hypot(*seen) < 1e-9


numbers = st.floats(-1e9, 1e9, allow_nan=False)
places = st.tuples(st.floats(-0.1, 0.4), st.floats(-0.1, 0.1), st.sampled_from([0.0, 1e-6, 1e-4]))
