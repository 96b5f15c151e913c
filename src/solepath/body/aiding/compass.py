"""The compass in the feet: the heading from the magnetic field, which a building and the iron of a shoe disturb.

While it stands, a foot measures the flux density

    m = b + d + s + R(yaw) h

in the world: the field of the place b, a disturbance over 15 m (d) and one over 1.5 m (s), and the hard iron h of the
shoe, which turns with the foot. None of them is known before; walking shows them: b and d turn against the feet, h with
them. They are rows of the filter of the errors that both tracks share (common_error.py): b and d, two numbers each, and
h, two for each foot, all in uT. With the error psi of the heading, truth minus track, the field on the track is turned
back, so to first order

    m - (b + d) - R(yaw) h = delta b + delta d + R(yaw) delta h - psi c (b + d) + s,

where c is a rotation by +90 degrees. The means over `BLOCK` stances of a foot are compared along b + d and across it,
as lengths and angles, which holds for any psi. d is a Gauss-Markov process of the distance walked; s is white over more
than its length. How large both are follows from the residuals (disturbance.py).

Only a proven compass moves the track (compass_trust.py), and only in a place that is no more disturbed than usual.
Otherwise its own rows are learnt, and everything else is only considered (Schmidt 1966). A field that stays strange is
another one, which is learnt from then on."""

from __future__ import annotations

from math import atan2, cos, exp, hypot, pi, sin, sqrt

from ...events import StrideTaken
from ...foot.view import FootView
from ...types import Vec3
from ...types.attrs import define, field
from ..fuse.common_error import HEADING, NO_MOVE, SIZE, CommonError, Move
from .compass_trust import CompassTrust
from .disturbance import Disturbance
from .stance_field import StanceField

IRON, FIELD = 12.0, 40.0
"""Standard deviations of the hard iron of a shoe and of the field before any stance, for each axis, uT."""
SHORT, LONG = 0.5 * sqrt(2.0 * pi) * 1.5, 0.25 * sqrt(2.0 * pi) * 15.0
"""Distances over which the correlation of both parts of the disturbance sums up to 1, m.

A part with the correlation exp(-x^2 / (2 L^2)) across the way has sqrt(2 pi) L, and along the way, a field without curl
has 0; L of 1.5 and 15 m is assumed (emulate/sensors/magnetic_field.py). The long part has half as much as that: a
disturbance that is thought to last longer than it does looks like a drift of the feet. Chosen on tuning walks."""
SHARE = 0.75
"""Variance of each part of the disturbance, as a share of the size of both: a half, times 1.5, because its size is that
of few stances, and because a way that is walked again has the same disturbance again. Chosen on tuning walks."""
BLOCK = 8
"""Number of stances of a foot that are compared at once: 10 m, about `LONG`."""
LEAST_STEP = 0.05
"""Least distance that a stance counts for, m, so that treading on the spot is not evidence without end."""
LOST_HEADING = 0.5
"""Standard deviation of the heading from which the direction of the field says nothing about its disturbance, rad."""
LEAST_SIZE = 1.0
"""Least size of the field that has a direction, uT."""
LONG_STRANGE, MOST_STRANGE = 20, 40
"""Number of strange blocks in a row, 110 m, after which that is reported, and 220 m, after which the field counts as
another one: steel floors end before."""
Pair = tuple[float, float]
"""A vector in the horizontal plane, or a cosine and a sine."""
B, D, H, ROWS = 0, 2, (4, 6), 8
"""First rows of b, of d, and of h of the left and of the right foot, from the compass's first row on; their number."""


@define
class Block:
    """Weighted sums over the stances of one foot that are compared at once, common frame."""

    count: int = 0
    weight: float = 0.0
    flux: Pair = (0.0, 0.0)
    """Sum of the horizontal flux densities, uT."""
    yaw: Pair = (0.0, 0.0)
    """Sums of cosine and sine of the yaw."""
    distance: float = 0.0
    """Distance that the foot has moved the wearer, m."""


@define
class Compass:
    """The field, its disturbance and the iron of the shoes, as rows of the common errors (an `Aid`)."""

    feet: list[StanceField] = field(factory=lambda: [StanceField(), StanceField()], init=False)
    trust: CompassTrust = field(factory=CompassTrust, init=False)
    disturbance: Disturbance = field(factory=Disturbance, init=False)
    blocks: list[Block] = field(factory=lambda: [Block(), Block()], init=False)
    """Newest stances of the left and of the right foot."""
    distance: float = field(default=0.0, init=False)
    """Distance walked since the newest comparison, m."""
    strange: int = field(default=0, init=False)
    """Number of strange blocks in a row."""
    is_another: bool = field(default=False, init=False)
    """Flag: the field was learnt again, so it may be that of steel, whose direction is not north."""
    first: int = field(default=-1, init=False)
    """First row of the compass among the common errors; -1 before any stance."""

    def add_sample(self, foot: int, view: FootView, mag: Vec3) -> None:
        """Add a sample of foot 0 (left) or 1, which stands, with the flux density `mag`, T, sensor frame."""
        self.feet[foot].add_sample(view, mag)

    def add_stride(self, event: StrideTaken, foot: int, turn: float, error: CommonError) -> tuple[Move, str | None]:
        """Add the stance before a stride of foot 0 (left) or 1, whose track is turned by `turn`, rad.

        Returns the correction of both tracks, and a sentence on a fault of the magnetometer, once."""
        step = error.shares[foot] * event.length
        self.blocks[foot].distance, self.distance = self.blocks[foot].distance + step, self.distance + step
        stance = self.feet[foot].take()
        if stance is None:
            return NO_MOVE, None
        (x, y, z), c, s = stance.flux, cos(turn), sin(turn)
        flux, move = (c * x - s * y, s * x + c * y, z), NO_MOVE
        if self.trust.add_strength(foot, flux):
            self._add_stance(foot, stance.yaw + turn, flux, error)
            if self.blocks[foot].count >= BLOCK:
                move = self._add_block(foot, error)
        return move, self.trust.fault(foot, flux)

    def _add_stance(self, foot: int, yaw: float, flux: Vec3, error: CommonError) -> None:
        (x, y, z), c, s = flux, cos(yaw), sin(yaw)
        if self.first < 0:
            variances = [FIELD * FIELD] * 2 + [SHARE * self.disturbance.usual] * 2 + [IRON * IRON] * 4
            self.first = error.add_aids((x, y, *[0.0] * 6), variances)
        iron = self.first + H[foot]
        px, py = _without_iron((x, y), (c, s), iron, error)
        bx, by = error.aids[self.first - SIZE : self.first - SIZE + 2]
        kappa = 0.5 * (bx * bx + by * by) / (self.disturbance.usual + error.covariance[iron][iron])
        self.trust.add_direction(foot, atan2(py, px), yaw, kappa)
        zx, zy = px - bx, py - by
        lost = error.covariance[HEADING][HEADING] > LOST_HEADING * LOST_HEADING
        residual = (hypot(px, py) - hypot(bx, by), 0.0) if lost else (zx, zy)
        weight = self.disturbance.add_stance(foot, residual, z)
        if self.disturbance.has_changed(foot):
            self.trust.note(foot, "changed")
            self.disturbance.near[foot], self.blocks[foot] = self.disturbance.near[1 - foot], Block()
            self.disturbance.changed[foot] = 0
            hx, hy = error.aids[iron - SIZE], error.aids[iron - SIZE + 1]
            self._renew(iron, (hx + c * zx + s * zy, hy + c * zy - s * zx), IRON * IRON, error)
            return
        block = self.blocks[foot]
        (fx, fy), (yc, ys) = block.flux, block.yaw
        block.count, block.weight = block.count + 1, block.weight + weight
        block.flux, block.yaw = (fx + weight * x, fy + weight * y), (yc + weight * c, ys + weight * s)

    def _add_block(self, foot: int, error: CommonError) -> Move:
        """Compare the block of a foot with the estimates, and start the next one."""
        block, self.blocks[foot], here = self.blocks[foot], Block(), self.disturbance.here
        self._fade(error)
        k, first, distance = 1.0 / block.weight, self.first, max(block.distance, LEAST_STEP * block.count)
        iron = first + H[foot]
        mean, yaw = (k * block.flux[0], k * block.flux[1]), (k * block.yaw[0], k * block.yaw[1])
        bx, by = error.aids[first - SIZE : first - SIZE + 2]
        shows_heading, is_strange = self.disturbance.judge((bx, by))
        self.strange = self.strange + 1 if is_strange else 0
        if self.strange == LONG_STRANGE:
            self.trust.note(foot, "strange")
        elif self.strange >= MOST_STRANGE:
            self.strange, self.is_another = 0, True
            self._renew(first + B, _without_iron(mean, yaw, iron, error), FIELD * FIELD, error)
            self._renew(first + D, (0.0, 0.0), SHARE * self.disturbance.usual, error)
            return NO_MOVE
        rows = None if self.trust.is_proven and shows_heading else range(first, first + ROWS)
        noise = SHARE * here * max(1.0, SHORT * block.count / distance) * k
        # along the field
        (px, py), (vx, vy) = _without_iron(mean, yaw, iron, error), _field(first, error)
        size = max(LEAST_SIZE, hypot(vx, vy))
        terms = _terms((vx / size, vy / size), yaw, first, iron)
        column = error.column(terms)
        x, y, heading = error.correct(column, hypot(px, py) - size, noise + error.along(column, terms), 1.0, rows)
        # across it, after the correction along it
        (px, py), (vx, vy) = _without_iron(mean, yaw, iron, error), _field(first, error)
        size = max(LEAST_SIZE, hypot(vx, vy))
        angle = atan2(vx * py - vy * px, vx * px + vy * py) + heading
        terms = [*_terms((-vy / size, vx / size), yaw, first, iron), (HEADING, -size)]
        column = error.column(terms)
        more = error.correct(column, size * angle, noise + error.along(column, terms), 1.0, rows)
        return (x + more[0], y + more[1], heading + more[2])

    def _fade(self, error: CommonError) -> None:
        """Let d become another disturbance over the distance since the newest comparison."""
        keep, p = exp(-2.0 * self.distance / LONG), error.covariance
        self.distance = 0.0
        for row in (self.first + D, self.first + D + 1):
            for j in range(len(p)):
                p[row][j] *= keep
                p[j][row] = p[row][j]
            p[row][row] = keep * p[row][row] + SHARE * self.disturbance.here * (1.0 - keep * keep)
            error.aids[row - SIZE] *= keep

    def _renew(self, row: int, values: Pair, variance: float, error: CommonError) -> None:
        """Give two rows new estimates with this variance, uT^2."""
        for number, value in enumerate(values):
            error.renew(row + number, variance)
            error.aids[row + number - SIZE] = value

    def turned(self, yaw: float) -> None:
        """Turn the blocks with both tracks by `yaw`, rad."""
        c, s = cos(yaw), sin(yaw)
        for block in self.blocks:
            (x, y), (p, q) = block.flux, block.yaw
            block.flux, block.yaw = (c * x - s * y, s * x + c * y), (c * p - s * q, s * p + c * q)

    def north(self, error: CommonError) -> Pair | None:
        """Return the direction of magnetic north, common frame, and its standard deviation, rad.

        None until turns have proven the compass, and when the field has become another one. It is the direction of b:
        both disturbances are 0 on average. The heading of the track is among its errors."""
        if self.first < 0 or self.is_another or not self.trust.is_proven:
            return None
        bx, by = error.aids[self.first - SIZE : self.first - SIZE + 2]
        square = bx * bx + by * by
        if square < LEAST_SIZE * LEAST_SIZE:
            return None
        terms = [(self.first + B, -by / square), (self.first + B + 1, bx / square), (HEADING, -1.0)]
        return (atan2(by, bx), sqrt(error.along(error.column(terms), terms)))

    def reset(self, foot: int, error: CommonError) -> None:
        """Forget the iron of the shoe of foot 0 (left) or 1, and its stance: another device may be worn."""
        self.feet[foot], self.blocks[foot] = StanceField(), Block()
        self.trust.reset(foot)
        if self.first >= 0:
            self._renew(self.first + H[foot], (0.0, 0.0), IRON * IRON, error)


def _field(first: int, error: CommonError) -> Pair:
    """Return the estimate of b + d, uT, of a compass whose rows begin at `first`."""
    bx, by, dx, dy = error.aids[first - SIZE : first - SIZE + H[0]]
    return (bx + dx, by + dy)


def _terms(u: Pair, yaw: Pair, first: int, iron: int) -> list[tuple[int, float]]:
    """Return how the errors of b, d and h, whose rows begin at `iron`, add to the flux density along a unit vector."""
    (x, y), (c, s), b, d = u, yaw, first + B, first + D
    return [(b, x), (b + 1, y), (d, x), (d + 1, y), (iron, x * c + y * s), (iron + 1, y * c - x * s)]


def _without_iron(flux: Pair, yaw: Pair, iron: int, error: CommonError) -> Pair:
    """Return a flux density without the iron h whose rows begin at `iron`, uT."""
    (x, y), (c, s), hx, hy = flux, yaw, error.aids[iron - SIZE], error.aids[iron - SIZE + 1]
    return (x - c * hx + s * hy, y - s * hx - c * hy)
