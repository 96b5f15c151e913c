"""Contours of pressure under the heel, and the velocity of their centre.

Equations (1) and (2) of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE
Trans. Instrum. Meas. 59, 2010). Rays leave a fixed centre, the centroid of the heel's cells, at equal angles. The point
where the pressure along a ray first falls below a level belongs to that level's contour, at the radius r(theta).

    v(theta) = (r(theta, t) - r(theta, t - dt)) / dt        along the ray r_hat (1), looking back instead of ahead
    v_cntr = 1/pi integral of v(theta) r_hat dtheta         (2)

The paper leaves out the factor 1/pi: a contour that moves as a whole with velocity u has v(theta) = u . r_hat, and the
integral of (u . r_hat) r_hat is pi u. Two more things are left open there:

- Rays end where the cells do, and a contour that lies partly beyond them has no radius there. The integral is then
  taken over the rays that have an opposite with a radius too, and normalised by least squares over those: with all rays
  that is the factor 1/pi again. An elliptic contour that grows or shrinks has equal v on opposite rays, wherever the
  centre is, and they cancel; half a contour that only grows would seem to move.
- Which pressures. The paper's figure 4 shows 20 to 70 kPa. But at a fixed pressure the contour also shrinks, by some
  cm/s, as the weight leaves the heel, and cells differ in gain by some per cent: on emulated insoles a heel that lies
  still then seems to move by 5 to 20 mm/s, and the contours are slower than 4 mm/s in a third of the true stance with
  96 cells and in a twentieth with the paper's 24. A level that is a fixed share of the heel's present mean pressure
  does not change with the weight (1 to 2 mm/s; two thirds of the stance with either), and it needs no scale. Shares are
  the default; `pascals` takes the paper's.

Work per sample: a weighted sum of three cells for each of some 60 points, and one pass along each ray."""

from __future__ import annotations

from collections import deque
from itertools import combinations
from math import cos, hypot, inf, pi, sin
from operator import mul, sub

from ...types import Cell, Layout
from ...types.attrs import define, field, frozen
from ...types.vector import TIE

HEEL_SHARE = 0.33
"""Share of the insole's length behind which cells are the heel's."""
CONTOUR_SHARE = 0.50
"""Share of the insole's length behind which cells carry contours: the paper takes 54 of the 99 cells of an insole."""
FEWEST_CELLS = 4
"""Fewest heel cells that have a contour."""
PAPER_LEVELS = (20e3, 30e3, 40e3, 50e3, 60e3, 70e3)
"""Levels of the paper's figure 4, Pa."""
AXES = 6
"""Number of pairs of opposite rays."""
RINGS = 8
"""Number of points on the longest ray, its centre not counted."""
NEAREST_CELLS = 10
"""Number of nearest cells of which three make the triangle about a point."""
INTERVAL = 0.05
"""Delta t of (1), s: long enough for the cells' noise.

With `AXES` pairs of rays sigma_v = sqrt(2 / AXES) sigma_r / interval an axis and a level, and a radius is as uncertain
as the pressure over its slope. A cell of 12-bit resistive insoles has 0.12 N rms (emulate/sensors/parts.py), 0.8 kPa on
1.6 cm^2, half a kPa once three are weighted; a heel that bears 200 N has slopes of 2 kPa/mm: 0.25 mm, and 0.14 mm over
all rays. To stay below the paper's 4 mm/s that takes 36 ms; 50 ms are taken."""
MISSING = -1.0
"""Value in the place of a radius when the contour does not cross the ray."""

Point = tuple[int, int, int, float, float, float]
"""Three cells and their weights; the weighted sum of the cells' loads is the pressure at the point."""


@frozen
class ContourSettings:
    """Settings of `Contours`."""

    shares: tuple[float, ...] = (1.4, 1.2, 1.0, 0.8, 0.6, 0.4)
    """Levels as shares of the present mean pressure of the heel's cells. 1.4 is still well below the peak of a patch of
    pressure; 0.4 lies at its edge, where a heel that leans has its only contours."""
    pascals: tuple[float, ...] | None = None
    """Fixed levels, Pa, instead of `shares`, for cells whose scale is known; None for shares."""


@define
class Contours:
    """Measures the velocity of the heel's pressure contours from the loads of the cells while the heel is loaded.

    Latency: none beyond `INTERVAL`, over which the contours are compared."""

    settings: ContourSettings = ContourSettings()
    cells: list[int] = field(factory=list, init=False)
    """Indices of the cells used here; `per_area` and `points` count in their order."""
    per_area: list[float] = field(factory=list, init=False)
    """Weights, 1 / m^2 over the number of heel cells, whose sum of loads is the heel's mean pressure."""
    points: list[Point] = field(factory=list, init=False)
    """Centre and, ray by ray, the points along each ray."""
    rays: list[tuple[int, float]] = field(factory=list, init=False)
    """Number of points on each ray, and their distance, m."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """Levels in falling order, as shares or, if `absolute`, in Pa."""
    absolute: bool = field(default=False, init=False)
    """Flag: the levels are pressures, not shares."""
    history: deque[tuple[float, tuple[float, ...]]] = field(factory=deque, init=False)
    """Time and radii, level by level and ray by ray, from `INTERVAL` ago until now."""

    def set_layout(self, layout: Layout) -> str | None:
        """Set the places of the cells, and return why they cannot have contours, None if they can."""
        self.history.clear()
        self.cells, self.points, self.rays = [], [], []
        heel = [cell for cell in layout.cells if cell.x < HEEL_SHARE * layout.length]
        if len(heel) < FEWEST_CELLS:
            return f"{len(heel)} pressure cells under the heel have no contour, {FEWEST_CELLS} are the fewest"
        self.cells = [i for i, cell in enumerate(layout.cells) if cell.x < CONTOUR_SHARE * layout.length]
        shares, pascals = self.settings.shares, self.settings.pascals
        self.absolute = pascals is not None and layout.scale is not None
        self.levels = tuple(sorted(pascals if self.absolute and pascals else shares, reverse=True))
        used = [layout.cells[i] for i in self.cells]
        self.per_area = [
            1.0 / (max(cell.area, 1e-9) * len(heel)) if cell.x < HEEL_SHARE * layout.length else 0.0 for cell in used
        ]
        centre = (sum(cell.x for cell in heel) / len(heel), sum(cell.y for cell in heel) / len(heel))
        self._set_rays(used, centre)
        if not self.rays or sum(1 for count, _ in self.rays if count) < 2 * AXES - 2:
            self.points, self.rays = [], []
            return "the pressure cells under the heel do not surround a centre: they have no contour"
        return None

    def reset(self) -> None:
        """Discard the radii before the clock restarts."""
        self.history.clear()

    def velocity(self, t: float, cells: list[float]) -> tuple[float, float] | None:
        """Return the (forward, left) velocity of the contours' centre, foot frame, m/s; None where there is none.

        It is the mean of the levels whose contours exist now and `INTERVAL` ago. `cells`: loads above tare of the cells
        in `self.cells`."""
        if not self.points:
            return None
        now = self._radii(cells)
        history = self.history
        if history and history[-1][0] >= t:  # the clock has restarted
            history.clear()
        before = None
        while history and history[0][0] <= t - INTERVAL + TIE:
            before = history.popleft()
        history.append((t, now))
        if before is None:
            return None
        history.appendleft(before)
        since = t - before[0]
        if since > 3.0 * INTERVAL:  # slow samples are not far apart, but a gap is
            history.popleft()
            return None
        return self._centre_velocity(now, before[1], 1.0 / since)

    def _radii(self, cells: list[float]) -> tuple[float, ...]:
        """Return r(theta) of every level, m."""
        pressures = [a * cells[i] + b * cells[j] + c * cells[k] for i, j, k, a, b, c in self.points]
        mean = 1.0 if self.absolute else sum(map(mul, self.per_area, cells))
        levels = [share * mean for share in self.levels]
        count = len(levels)
        middle = pressures[0]
        first = 0
        while first < count and middle <= levels[first]:
            first += 1
        missing = (MISSING,) * first
        levels.append(-inf)  # nothing is below it
        found: list[float] = []
        at = 1
        for points, step in self.rays:
            found += missing
            level, target, inner, r = first, levels[first], middle, 0.0
            for outer in pressures[at : at + points]:
                if outer < target:
                    along = step / (inner - outer)
                    while outer < target:
                        found.append(r + (inner - target) * along)
                        level += 1
                        target = levels[level]
                    if level == count:
                        break
                inner = outer
                r += step
            found += (MISSING,) * (count - level)
            at += points
        return tuple(found)

    def _centre_velocity(
        self, now: tuple[float, ...], before: tuple[float, ...], rate: float
    ) -> tuple[float, float] | None:
        """Return (1) and (2) for each level, as their mean."""
        sum_x = sum_y = 0.0
        contours = 0
        count = len(self.levels)
        for level in range(count):
            present, history = now[level::count], before[level::count]
            if max(present) < 0.0 or max(history) < 0.0:
                continue
            if min(present) >= 0.0 and min(history) >= 0.0:
                # all rays: the normal equations have AXES on their diagonal
                moved = list(map(sub, present, history))
                sum_x += sum(map(mul, moved, _COS)) / AXES
                sum_y += sum(map(mul, moved, _SIN)) / AXES
                contours += 1
                continue
            found = _fit_pairs(present, history)
            if found is None and not self.absolute:
                found = _fit_rays(present, history)
            if found is not None:
                sum_x += found[0]
                sum_y += found[1]
                contours += 1
        if not contours:
            return None
        k = rate / contours
        return sum_x * k, sum_y * k

    def _set_rays(self, used: list[Cell], centre: tuple[float, float]) -> None:
        """Set the points of the rays from the centre."""
        x, y = centre
        step = max((hypot(cell.x - x, cell.y - y) for cell in used if cell.x < 2.0 * x), default=0.0) / RINGS
        middle = _triangle(used, x, y)
        if middle is None or step <= 0.0:
            return
        self.points = [middle]
        for k in range(2 * AXES):
            c, s = cos(pi * k / AXES), sin(pi * k / AXES)
            first_point = len(self.points)
            for ring in range(1, RINGS + 1):
                point = _triangle(used, x + step * ring * c, y + step * ring * s)
                if point is None:
                    break
                self.points.append(point)
            self.rays.append((len(self.points) - first_point, step))


_COS = [cos(pi * k / AXES) for k in range(2 * AXES)]
"""Cosine of each ray's direction."""
_SIN = [sin(pi * k / AXES) for k in range(2 * AXES)]
"""Sine of each ray's direction."""
_RAYS = [(c, s, c * c, c * s, s * s) for c, s in zip(_COS, _SIN, strict=True)]
"""Direction of each ray, and its terms of the normal equations."""


def _fit_pairs(now: tuple[float, ...], before: tuple[float, ...]) -> tuple[float, float] | None:
    """Return how far the centre of one level's contour has moved, m, by its rays that have an opposite."""
    opposites = zip(now[:AXES], now[AXES:], before[:AXES], before[AXES:], strict=True)
    return _least_squares([0.5 * (r - p - q + o) if min(r, q, p, o) >= 0.0 else None for r, q, p, o in opposites])


def _fit_rays(now: tuple[float, ...], before: tuple[float, ...]) -> tuple[float, float] | None:
    """Return how far the centre of one level's contour has moved, m, by all its rays."""
    return _least_squares([r - p if r >= 0.0 and p >= 0.0 else None for r, p in zip(now, before, strict=True)])


def _least_squares(moved: list[float | None]) -> tuple[float, float] | None:
    """Return the vector u for which u . r_hat is nearest to `moved`, m, along the first rays, by least squares.

    None where too few directions, or too similar ones, have a value."""
    xx = xy = yy = bx = by = 0.0
    for (c, s, cc, cs, ss), along in zip(_RAYS, moved, strict=False):
        if along is not None:
            xx += cc
            xy += cs
            yy += ss
            bx += along * c
            by += along * s
    determinant = xx * yy - xy * xy
    if determinant < 1.0:  # three neighbouring directions have 1.5, all six axes 9
        return None
    return (yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant


def _triangle(cells: list[Cell], x: float, y: float) -> Point | None:
    """Return the tightest triangle of cells about a point and the cells' weights there; None if no cells surround it.

    The weights turn loads into pressures."""
    order = sorted(range(len(cells)), key=lambda i: (hypot(cells[i].x - x, cells[i].y - y), i))[:NEAREST_CELLS]
    best: Point | None = None
    tightest = 0.0
    for i, j, k in combinations(order, 3):
        a, b, c = cells[i], cells[j], cells[k]
        area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
        if abs(area) < 1e-7:  # m^2: in one line
            continue
        first = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area
        second = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area
        third = 1.0 - first - second
        if min(first, second, third) < -1e-9:
            continue
        around = hypot(a.x - b.x, a.y - b.y) + hypot(b.x - c.x, b.y - c.y) + hypot(c.x - a.x, c.y - a.y)
        if best is None or around < tightest - 1e-9:
            tightest = around
            best = (i, j, k, first / max(a.area, 1e-9), second / max(b.area, 1e-9), third / max(c.area, 1e-9))
    return best
