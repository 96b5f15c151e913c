"""Contours of pressure under the heel, and the velocity of their centre.

Equations (1) and (2) of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE
Trans. Instrum. Meas. 59, 2010). Rays leave a fixed centre, the centroid of the heel's cells, at equal angles. The point
where the pressure along a ray first falls below a level belongs to that level's contour, at the radius r(theta).

    v(theta) = (r(theta, t) - r(theta, t - dt)) / dt        along the ray r_hat (1), as a backward difference
    v_cntr = 1/pi integral of v(theta) r_hat dtheta         (2)

The paper leaves out the factor 1/pi. A contour that moves as a whole with velocity u has v(theta) = u . r_hat, and the
integral of (u . r_hat) r_hat is pi u. The paper leaves two more points open:

- Rays end at the outermost cells. A contour that lies partly beyond them has no radius there. The integral is then
  taken over those rays that have a radius, as their opposite rays do, and normalised by least squares; with all rays
  the factor is 1/pi again. An elliptic contour that only grows or shrinks has equal v on opposite rays, which cancel
  wherever the centre is. With a ray whose opposite ray is missing such a contour would seem to move.
- The pressure levels. The paper's figure 4 has 20 to 70 kPa. But a contour of fixed pressure shrinks, by some cm/s, as
  the weight leaves the heel, and the gains of cells differ by some per cent. On emulated insoles a heel that lies still
  then seems to move at 5 to 20 mm/s. The contours are slower than 4 mm/s in a third of the true stance with 96 cells,
  and in a twentieth with the paper's 24 cells. A level that is a fixed share of the heel's present mean pressure
  does not depend on the weight or on the cells' scale. With such levels a still heel seems to move at 1 to 2 mm/s, and
  the contours are slower than 4 mm/s in two thirds of the stance with 96 and with 24 cells. So shares are the default.
  That holds for a patch of fixed size. With one that spreads with the load, levels in kPa do about as well beside a
  threshold of the wearer's own. The setting `pascals` selects fixed levels, as in the paper.

Cost of a sample: a weighted sum of three cells for each of some 60 points, and one pass along each ray. Numbers without
a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from itertools import combinations, pairwise
from math import cos, fsum, hypot, inf, pi, sin
from operator import mul

from ...types import Cell, Floats, Layout, Vec2
from ...types.attrs import field, frozen, state, stateful
from ...types.vector import TIME_EPSILON

HEEL_SHARE = 0.33
"""End of the heel's cells, measured from the heel's end, as a share of the insole's length."""
CONTOUR_SHARE = 0.50
"""End of the cells that contours use, from the heel's end, as a share of the length: 43 cells of our layout of 99.

The paper uses the 54 of 99 "in the heel portion"; on our layout that would be a share of 0.56."""
FEWEST_CELLS = 4
"""Least number of heel cells for contours."""
PAPER_LEVELS = (20e3, 30e3, 40e3, 50e3, 60e3, 70e3)
"""Levels of the paper's figure 4, Pa."""
RAY_PAIRS = 6
"""Number of pairs of opposite rays."""
POINTS_PER_RAY = 8
"""Number of points on the longest ray, without the centre."""
NEAREST_CELLS = 10
"""Number of a point's nearest cells among which the triangle around it is searched."""
COMPARISON_TIME = 0.05
"""Delta t of (1), s, long enough that the cells' noise stays below the paper's threshold.

The noise of the velocity is sigma_v = sqrt(2 / RAY_PAIRS) sigma_r / Delta t, per axis and level. The noise of a radius,
sigma_r, is that of the pressure divided by its slope. A cell of 12-bit resistive insoles has 0.12 N rms
(emulate/sensors/parts.py). This is 0.8 kPa on 1.6 cm^2, and half a kPa as weighted mean of three cells. A heel that
bears 200 N has a slope of 2 kPa/mm, so sigma_r is 0.25 mm. Over all rays that makes 0.14 mm. sigma_v is below the
paper's 4 mm/s from 36 ms on; 50 ms are used."""
NO_CONTOUR = 100.0
"""Speed without a contour, m/s: faster than any foot."""
NO_RADIUS = -1.0
"""Value in the place of a radius when the contour does not cross the ray."""

WeightedCells = tuple[int, int, int, float, float, float]
"""Indices of three cells and their weights, 1/m^2: the weighted sum of their loads is the pressure at a point."""


@frozen
class ContourSettings:
    """Settings of `Contours`."""

    shares: Floats = (1.4, 1.2, 1.0, 0.8, 0.6, 0.4)
    """Levels as shares of the present mean pressure of the heel's cells. 1.4 is well below the peak pressure. 0.4 lies
    at the edge of the loaded area, where a heel that leans has its only contours."""
    pascals: Floats | None = None
    """Fixed levels, Pa, used instead of `shares`; they need cells of known scale. None for shares."""


@stateful
class Contours:
    """Measures the velocity of the heel's pressure contours from the loads of the cells while the heel is loaded.

    Latency: the velocity is the mean over the last `COMPARISON_TIME`."""

    settings: ContourSettings = field(default=ContourSettings())
    cells: list[int] = state(factory=list)
    """Indices in the layout of the cells used here, in the order of `per_area`; `points` has indices in this list."""
    per_area: list[float] = state(factory=list)
    """Weight of each cell's load in the heel's mean pressure, 1/m^2."""
    points: list[WeightedCells] = state(factory=list)
    """The centre, followed by the points of each ray from the inside out."""
    rays: list[tuple[int, float]] = state(factory=list)
    """Number of points on each ray, and their distance, m."""
    levels: Floats = ()
    """Levels in falling order, in Pa or as shares, as in `settings`."""
    history: deque[tuple[float, Floats]] = state(factory=deque)
    """Samples of the last `COMPARISON_TIME`, each with its time, s, and the radii, m, of all levels ray by ray."""

    def set_layout(self, layout: Layout) -> str | None:
        """Set the places of the cells; return the reason why they cannot have contours, or None if they can."""
        self.history.clear()
        self.cells, self.points, self.rays = [], [], []
        heel = [cell for cell in layout.cells if cell.x < HEEL_SHARE * layout.length]
        if len(heel) < FEWEST_CELLS:
            return f"{len(heel)} pressure cells under the heel have no contour, {FEWEST_CELLS} are the fewest"
        self.cells = [i for i, cell in enumerate(layout.cells) if cell.x < CONTOUR_SHARE * layout.length]
        shares, pascals = self.settings.shares, self.settings.pascals
        if pascals is not None and layout.scale is None:
            return "pressure cells of unknown scale have no contours of 20 to 70 kPa"
        self.levels = tuple(sorted(pascals or shares, reverse=True))
        used = [layout.cells[i] for i in self.cells]
        self.per_area = [
            1.0 / (max(cell.area, 1e-9) * len(heel)) if cell.x < HEEL_SHARE * layout.length else 0.0 for cell in used
        ]
        centre = (fsum(cell.x for cell in heel) / len(heel), fsum(cell.y for cell in heel) / len(heel))
        self._set_rays(used, centre)
        if not self.rays or sum(1 for count, _ in self.rays if count) < 2 * RAY_PAIRS - 2:
            self.points, self.rays = [], []
            return "the pressure cells under the heel do not surround a centre: they have no contour"
        return None

    def reset(self) -> None:
        """Discard the radii of earlier samples."""
        self.history.clear()

    def speed(self, t: float, cells: list[float]) -> float:
        """Return the speed of the contours' centre, m/s; `NO_CONTOUR` without contours. Arguments as for `velocity`."""
        velocity = self.velocity(t, cells)
        return NO_CONTOUR if velocity is None else min(hypot(*velocity), NO_CONTOUR)

    def velocity(self, t: float, cells: list[float]) -> Vec2 | None:
        """Return the velocity (forward, left) of the contours' centre, foot frame, m/s; None without contours.

        It is the mean over the levels that have contours now and had them `COMPARISON_TIME` ago. `cells` are the loads
        above tare of the cells in `self.cells`."""
        if not self.points:
            return None
        radii, history = self._radii(cells), self.history
        if history and not 0.0 < t - history[-1][0] <= 3.0 * COMPARISON_TIME:  # the clock restarted, or a gap
            history.clear()
        history.append((t, radii))
        while len(history) > 1 and history[1][0] <= t - COMPARISON_TIME + TIME_EPSILON:
            history.popleft()
        elapsed = t - history[0][0]
        if elapsed < COMPARISON_TIME - TIME_EPSILON:
            return None
        count = len(self.levels)
        fits = [_displacement(radii[level::count], history[0][1][level::count]) for level in range(count)]
        found = [fit for fit in fits if fit is not None]
        if not found:
            return None
        k = 1.0 / (elapsed * len(found))
        return fsum([x for x, _ in found]) * k, fsum([y for _, y in found]) * k

    def _radii(self, cells: list[float]) -> Floats:
        """Return the radii r(theta), m, ray by ray, each for all levels."""
        pressures = [a * cells[i] + b * cells[j] + c * cells[k] for i, j, k, a, b, c in self.points]
        mean = 1.0 if self.settings.pascals else fsum(map(mul, self.per_area, cells))
        levels = [share * mean for share in self.levels]
        radii: list[float] = []
        next_point = 1
        for points, step in self.rays:
            along = [pressures[0], *pressures[next_point : next_point + points]]
            radii += [_crossing(along, level, step) for level in levels]
            next_point += points
        return tuple(radii)

    def _set_rays(self, used: list[Cell], centre: Vec2) -> None:
        """Set the points on the rays from the centre (x, y), foot frame, m."""
        x, y = centre
        step = max((hypot(cell.x - x, cell.y - y) for cell in used if cell.x < 2.0 * x), default=0.0) / POINTS_PER_RAY
        middle = _triangle(used, x, y)
        if middle is None or step <= 0.0:
            return
        self.points = [middle]
        for c, s in _RAYS:
            first_point = len(self.points)
            for ring in range(1, POINTS_PER_RAY + 1):
                point = _triangle(used, x + step * ring * c, y + step * ring * s)
                if point is None:
                    break
                self.points.append(point)
            self.rays.append((len(self.points) - first_point, step))


_RAYS = [(cos(pi * k / RAY_PAIRS), sin(pi * k / RAY_PAIRS)) for k in range(2 * RAY_PAIRS)]
"""Directions of the rays; the second ray of each pair is RAY_PAIRS after the first."""


def _displacement(radii: Floats, earlier_radii: Floats) -> Vec2 | None:
    """Return the displacement of one level's contour, m: the vector u that fits u . r_hat to the radii best (2).

    It is that by the pairs of opposite rays of which both have a radius, by least squares; None if they are too few, or
    all of them have nearly the same direction."""
    xx = xy = yy = bx = by = 0.0
    for k, (c, s) in enumerate(_RAYS[:RAY_PAIRS]):
        near, far, old_near, old_far = radii[k], radii[k + RAY_PAIRS], earlier_radii[k], earlier_radii[k + RAY_PAIRS]
        if min(near, far, old_near, old_far) >= 0.0:
            change = 0.5 * (near - old_near - far + old_far)
            xx += c * c
            xy += c * s
            yy += s * s
            bx += change * c
            by += change * s
    determinant = xx * yy - xy * xy
    if determinant < 1.0:  # it is 1.5 for three neighbouring directions, 9 for all six axes
        return None
    return (yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant


def _crossing(along: list[float], level: float, step: float) -> float:
    """Return the distance, m, at which the pressures at every `step` m of a ray first fall below a level, Pa."""
    for k, (inner, outer) in enumerate(pairwise(along)):
        if inner <= level:
            return NO_RADIUS
        if outer < level:
            return step * (k + (inner - level) / (inner - outer))
    return NO_RADIUS


def _twice_area(a: complex, b: complex, c: complex) -> float:
    """Return twice the area of a triangle, positive when its corners are counter-clockwise."""
    return ((b - a).conjugate() * (c - a)).imag


def _triangle(cells: list[Cell], x: float, y: float) -> WeightedCells | None:
    """Return the smallest triangle of cells around a point, with the weights that turn their loads into its pressure.

    It is None if no cells surround the point. The smallest triangle is that of least perimeter."""
    point, places = complex(x, y), [complex(cell.x, cell.y) for cell in cells]
    order = sorted(range(len(cells)), key=lambda i: (abs(places[i] - point), i))[:NEAREST_CELLS]
    tightest: WeightedCells | None = None
    least_perimeter = inf
    for i, j, k in combinations(order, 3):
        a, b, c = places[i], places[j], places[k]
        area = _twice_area(a, b, c)
        if abs(area) < 1e-7:  # m^2: the cells lie in one line
            continue
        first, second = _twice_area(point, b, c) / area, _twice_area(point, c, a) / area
        shares = (first, second, 1.0 - first - second)
        perimeter = abs(a - b) + abs(b - c) + abs(c - a)
        if min(shares) >= -1e-9 and perimeter < least_perimeter - 1e-9:
            least_perimeter = perimeter
            u, v, w = [share / max(cells[n].area, 1e-9) for share, n in zip(shares, (i, j, k), strict=True)]
            tightest = (i, j, k, u, v, w)
    return tightest
