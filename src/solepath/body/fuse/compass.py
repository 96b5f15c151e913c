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
than its length. How large both are follows from the residuals (`Disturbance`).

Only a proven compass moves the track (`CompassTrust`), and only in a place that is no more disturbed than usual.
Otherwise its own rows are learnt, and everything else is only considered (Schmidt 1966). A field that stays strange is
another one, which is learnt from then on."""

from __future__ import annotations

from cmath import phase, rect
from math import cos, exp, hypot, log, pi, sqrt

from ...events import StrideTaken
from ...foot.view import FootView
from ...types import OTHER, Foot, PerFoot, Quat, Vec2, Vec3, per_foot
from ...types.attrs import define, field
from ...types.vector import ZERO, add, dot, heading_turned, pair, rotate, scaled, turned, wrap_angle
from .common_error import HEADING, NO_MOVE, CommonError, Move, Term

MICRO = 1e6
"""Microteslas of a tesla, as everything in this room is in microteslas."""
ABSURD_FLUX = 1e4
"""Largest flux density, uT, two hundred times that of the earth; more is no number or another unit."""
IRON, FIELD = 12.0, 40.0
"""Standard deviations of the hard iron of a shoe and of the field before any stance, for each axis, uT."""
SHORT, LONG = 0.5 * sqrt(2.0 * pi) * 1.5, 0.25 * sqrt(2.0 * pi) * 15.0
"""Distances over which the correlation of both parts of the disturbance sums up to 1, m.

A part with the correlation exp(-x^2 / (2 L^2)) across the way has sqrt(2 pi) L, and along the way, a field without curl
has 0; L of 1.5 and 15 m is assumed (solepath_lab/emulated/magnetic_field.py). The long part has half as much as that: a
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
B, D, H, ROWS = 0, 2, {Foot.LEFT: 4, Foot.RIGHT: 6}, 8
"""First rows of b, of d, and of h of each foot, from the compass's first row on; their number."""
MOST_KAPPA = 4.0
"""Largest concentration of the turn of the field by disturbances, no unit: 30 degrees."""
OUTLIERS = 0.2
"""Likelihood of any turn of the field, where that of the likeliest one is 1: a turn changes the ratio by 6 at most."""
LEAST_TURN = 0.8
"""Least turn of a foot that is evaluated, rad: theta of 46 degrees."""
PROOF, DISPROOF, MOST = 6.0, -9.0, 12.0
"""Log-likelihood ratios that prove a compass (400 to 1: four turns) or disprove it (1 to 8000), and the largest."""
LEAST_FLUX, MOST_FLUX = 12.0, 200.0
"""Range of the flux density near floors, uT: the field of the earth has 22 to 67 (IGRF), which steel weakens or adds
to."""
WEAKEST = 1.0
"""Flux density below which the unit is wrong, uT: gauss instead of tesla give 0.2 to 0.7."""
TOO_STRONG = 10
"""Number of stances in a row outside the range after which the foot is reported."""
SENTENCES = {
    "unit": "the magnetometer's field is {:.3g} uT, where the earth's has 22 to 67: give tesla. It is not used",
    "changed": "something magnetic has come to this foot or has left it: its compass learns the iron of the shoe again",
    "strange": "for 100 m, the magnetic field has been another one than before, as over steel: the compass is not used "
    "there",
    "strength": "the magnetic field at the foot is {:.0f} uT, where the earth's has 22 to 67: a magnet or steel is "
    "close to the sensor, in the shoe or below it. The compass of this foot is not used while it lasts",
    "axes": "the magnetic field turns with the foot, twice as far: the axes of the magnetometer are mirrored or "
    "exchanged against those of the accelerometer. The compass is not used",
}
"""Faults of a magnetometer by their kind, for people."""
OF_BOTH = ("axes", "strange")
"""Faults that are reported once for both feet."""
FIRST_DISTURBANCE = 7.0
"""Standard deviation of the disturbance of a horizontal axis before any was seen, uT: 20 degrees of 20 uT."""
USUAL_MEMORY, NEAR_MEMORY = 300.0, 4.0
"""Number of stances of both feet, 200 m, over which the usual disturbance is averaged, and number of stances of a foot,
5 m, over which the near one is."""
FIRST_STANCES = 20
"""Number of stances before the first that is averaged, because the field and the iron are not known yet."""
VERTICAL_MEMORY = 50
"""Number of stances over which the vertical field of a foot is averaged."""
LEAST = 0.1
"""Least square of a residual that is averaged, uT^2: the noise of a magnetometer, 0.3 uT (MAG3110)."""
LARGEST = 9.0
"""Largest square of a residual that is averaged, as a multiple of the variance: three standard deviations."""
USUAL_SHARE = 0.1
"""Share of the usual variance in that about the newest stances, which few stances show."""
TAIL = 4.0
"""Degrees of freedom of the t distribution by which a stance weighs, no unit: heavy tails."""
MOST_OF_FIELD = 0.5
"""Largest disturbance of a place that shows the heading, as a share of the horizontal field: 26 degrees. Chosen on
tuning walks."""
STRANGE, STRANGE_FIELD = 1.5, 0.6
"""Least disturbance of a strange place: its variance as a multiple of the usual one, or its standard deviation as a
share of the horizontal field (31 degrees)."""
CHANGED = 6.0
"""Ratio of the near disturbance of a foot to that of the other one, and to the usual one, if its iron has changed."""


@define
class StanceField:
    """The samples of the newest stance of one foot, when neither timing nor rotation blurs what it measures."""

    count: int = 0
    sum: Vec3 = ZERO
    """Sum of the flux densities, navigation frame, uT."""
    attitude: Quat | None = None
    """Attitude at the newest of them, sensor to navigation frame; None before any."""
    north: Vec2 = (1.0, 0.0)
    """Cosine and sine of the angle from navigation to world frame."""
    first: Quat | None = None
    """Attitude in the first stance; None before any."""

    def add_sample(self, view: FootView, mag: Vec3) -> None:
        """Add a sample of a foot that stands, with the flux density `mag`, T, sensor frame."""
        flux = rotate(view.attitude, scaled(mag, MICRO))
        if not dot(flux, flux) < ABSURD_FLUX * ABSURD_FLUX:
            flux = ABSURD_FLUX, 0.0, 0.0
        if view.north is not None:
            self.north = view.north
        self.count, self.sum, self.attitude = self.count + 1, add(self.sum, flux), view.attitude

    def take(self) -> tuple[Vec3, float] | None:
        """Return the stance that has ended and forget its samples; None if it had none.

        These are the mean flux density, world frame of the foot, uT, and the angle about the vertical by which the foot
        is turned against its first stance, rad."""
        if not self.count or self.attitude is None:
            return None
        k, (x, y, z) = 1.0 / self.count, self.sum
        if self.first is None:
            self.first = self.attitude
        self.count, self.sum = 0, ZERO
        flux = k * (complex(x, y) * complex(*self.north))
        return (flux.real, flux.imag, k * z), heading_turned(self.first, self.attitude)


@define
class FootTurns:
    """The turns of one foot and the strength of the field there."""

    reference: Vec2 | None = None
    """Direction of the field and angle of the foot before the next turn, common frame, rad; None before any stance."""
    outside: int = 0
    """Number of stances in a row in which the strength was out of range."""


@define
class CompassTrust:
    """Evidence for and against a compass in the feet: the field must keep still while the feet turn.

    When a foot turns by theta, a compass that is right sees the same direction of the field in the world, apart from
    the iron of the shoe. One whose axes are mirrored sees it turn by 2 theta, and a strong magnet in the shoe by theta.
    For each turn of a foot, the logarithm of the likelihood ratio of "right" to "mirrored" grows by

        log (OUTLIERS + f(a)) - log (OUTLIERS + f(a - 2 theta)),    f(x) = exp(kappa (cos x - 1)),

    where a is the turn of the measured field in the world without the iron, with errors of a von Mises distribution of
    concentration kappa, and with outliers; a magnet adds 0. Besides, the strength must be possible."""

    feet: PerFoot[FootTurns] = field(factory=lambda: per_foot(FootTurns))
    evidence: float = 0.0
    """Log-likelihood ratio of right to mirrored axes."""
    reported: list[str] = field(factory=list)
    """Faults that were reported; those that concern one foot have its name."""
    pending: str | None = None
    """Fault to be reported next; None usually."""

    def add_strength(self, foot: Foot, flux: Vec3) -> bool:
        """Add the flux density of a stance of a foot, uT; return whether its strength is possible."""
        one, possible = self.feet[foot], LEAST_FLUX < hypot(*flux) < MOST_FLUX
        one.outside = 0 if possible else one.outside + 1
        return possible

    def add_direction(self, foot: Foot, direction: float, yaw: float, kappa: float) -> None:
        """Add the direction of the field without the iron at a stance of a foot, common frame, rad.

        `yaw` is the angle of the foot, common frame, rad, and `kappa` the concentration of the direction's turn."""
        one = self.feet[foot]
        if one.reference is not None:
            seen, turn = direction - one.reference[0], wrap_angle(yaw - one.reference[1])
            if abs(turn) < LEAST_TURN:
                return
            more = _log_likelihood(seen, kappa) - _log_likelihood(seen - 2.0 * turn, kappa)
            self.evidence = max(-MOST, min(MOST, self.evidence + more))
        one.reference = (direction, yaw)

    @property
    def is_proven(self) -> bool:
        """Flag: the compass may correct headings."""
        return self.evidence >= PROOF

    def note(self, foot: Foot, fault: str) -> None:
        """Queue a fault of a foot, a key of `SENTENCES`, unless it was reported before."""
        name = fault if fault in OF_BOTH else f"{fault} {foot}"
        if name not in self.reported:
            self.reported.append(name)
            self.pending = fault

    def fault(self, foot: Foot, flux: Vec3) -> str | None:
        """Return a sentence on a new fault of the magnetometer of a foot; None usually.

        `flux` is the newest flux density, uT."""
        outside = self.feet[foot].outside >= TOO_STRONG
        if not outside and self.evidence > DISPROOF and self.pending is None:
            return None
        size = hypot(*flux)
        if outside:
            self.note(foot, "unit" if size >= 0.5 * ABSURD_FLUX or size < WEAKEST else "strength")
        elif self.evidence <= DISPROOF:
            self.note(foot, "axes")
        fault, self.pending = self.pending, None
        return None if fault is None else SENTENCES[fault].format(size)

    def reset(self, foot: Foot) -> None:
        """Forget what depends on the device of a foot."""
        self.feet[foot] = FootTurns()
        self.reported = [one for one in self.reported if one not in OF_BOTH and not one.endswith(str(foot))]
        self.evidence = 0.0


def _log_likelihood(angle: float, kappa: float) -> float:
    return log(OUTLIERS + exp(min(kappa, MOST_KAPPA) * (cos(angle) - 1.0)))


@define
class Disturbance:
    """Variances of the disturbance of a horizontal axis by a building, uT^2: usually, and about the newest stances.

    Steel makes the disturbance much stronger in some places than in others, so a stretch of clean ones shows the
    heading best. The field of sources below the floor has no divergence and no curl there, so the vertical axis is
    disturbed as much as both horizontal axes together: all three show the size of the disturbance."""

    usual: float = FIRST_DISTURBANCE * FIRST_DISTURBANCE
    near: PerFoot[float] = field(factory=lambda: dict.fromkeys(Foot, FIRST_DISTURBANCE * FIRST_DISTURBANCE))
    """Variance about the newest stances of each foot, uT^2."""
    changed: PerFoot[int] = field(factory=lambda: per_foot(int))
    """Number of stances in a row of each foot that show a change of its iron."""
    count: int = 0
    """Number of stances so far."""
    vertical: PerFoot[tuple[int, float]] = field(factory=lambda: dict.fromkeys(Foot, (0, 0.0)))
    """Number of stances and mean vertical field of each foot, uT."""

    @property
    def here(self) -> float:
        """Variance about the newest stances of both feet, uT^2."""
        left, right = [min(near, LARGEST * self.usual) for near in self.near.values()]
        return USUAL_SHARE * self.usual + (1.0 - USUAL_SHARE) * 0.5 * (left + right)

    def add_stance(self, foot: Foot, residual: complex, vertical: float) -> float:
        """Add a stance of a foot and return its weight, up to 1.

        `residual` is how far the horizontal flux density is from the field, and `vertical` the vertical one, uT."""
        number, mean = self.vertical[foot]
        x, y, z = residual.real, residual.imag, vertical - mean if number else 0.0
        number = min(number + 1, VERTICAL_MEMORY)
        self.vertical[foot] = (number, mean + (vertical - mean) / number)
        square = 0.25 * (x * x + y * y + z * z)  # of two parts of four in the horizontal axes, and two in the vertical
        self.count += 1
        if self.count > FIRST_STANCES:
            square = max(square, LEAST)
            self.usual += (min(square, LARGEST * self.usual) - self.usual) / USUAL_MEMORY
            self.near[foot] += (square - self.near[foot]) / NEAR_MEMORY
        return min(1.0, (TAIL + 4.0) / (TAIL + 4.0 * square / self.here))

    def has_changed(self, foot: Foot) -> bool:
        """Return whether something magnetic came to a foot, or left it: the other foot sees nothing.

        Call it after each stance; two of a foot must show it, because one foot is the first to step into a lift."""
        shows = self.near[foot] > CHANGED * max(self.usual, self.near[OTHER[foot]])
        self.changed[foot] = self.changed[foot] + 1 if shows else 0
        return self.changed[foot] >= 2

    def judge(self, horizontal: complex) -> tuple[bool, bool]:
        """Return whether this place shows the heading, and whether it is strange; `horizontal` is the field, uT.

        It shows the heading if it is no more disturbed than usual."""
        square, here = (horizontal * horizontal.conjugate()).real, self.here
        shows = here <= min(self.usual, MOST_OF_FIELD * MOST_OF_FIELD * square)
        return shows, here > min(STRANGE * self.usual, STRANGE_FIELD * STRANGE_FIELD * square)


@define
class Block:
    """Weighted sums over the stances of one foot that are compared at once, common frame."""

    count: int = 0
    weight: float = 0.0
    flux: Vec2 = (0.0, 0.0)
    """Sum of the horizontal flux densities, uT."""
    yaw: Vec2 = (0.0, 0.0)
    """Sums of cosine and sine of the yaw."""
    distance: float = 0.0
    """Distance that the foot has moved the wearer, m."""


@define
class Compass:
    """The field, its disturbance and the iron of the shoes, as rows of the common errors."""

    feet: PerFoot[StanceField] = field(factory=lambda: per_foot(StanceField))
    trust: CompassTrust = field(factory=CompassTrust)
    disturbance: Disturbance = field(factory=Disturbance)
    blocks: PerFoot[Block] = field(factory=lambda: per_foot(Block))
    """Newest stances of each foot."""
    distance: float = 0.0
    """Distance walked since the newest comparison, m."""
    strange: int = 0
    """Number of strange blocks in a row."""
    is_another: bool = False
    """Flag: the field was learnt again, so it may be that of steel, whose direction is not north."""
    first: int = -1
    """First row of the compass among the common errors; -1 before any stance."""

    def add_stride(self, event: StrideTaken, turn: float, error: CommonError) -> tuple[Move, str | None]:
        """Add the stance before a stride of a foot, whose track is turned by `turn`, rad.

        Returns the correction of both tracks, and a sentence on a fault of the magnetometer, once."""
        foot, move = event.foot, NO_MOVE
        step, block = error.shares[foot] * event.length, self.blocks[foot]
        block.distance, self.distance = block.distance + step, self.distance + step
        stance = self.feet[foot].take()
        if stance is None:
            return NO_MOVE, None
        flux = turned(stance[0], turn)
        if self.trust.add_strength(foot, flux):
            self._add_stance(foot, stance[1] + turn, flux, error)
            if self.blocks[foot].count >= BLOCK:
                move = self._add_block(foot, error)
        return move, self.trust.fault(foot, flux)

    def _add_stance(self, foot: Foot, angle: float, flux: Vec3, error: CommonError) -> None:
        (x, y, z), yaw, disturbance = flux, rect(1.0, angle), self.disturbance
        across = complex(x, y)
        if self.first < 0:
            variances = [FIELD * FIELD] * 2 + [SHARE * disturbance.usual] * 2 + [IRON * IRON] * 4
            self.first = error.add_aids((x, y, *[0.0] * 6), variances)
        iron, b = self.first + H[foot], error.aid(self.first)
        without = _without_iron(across, yaw, iron, error)
        kappa = 0.5 * (b * b.conjugate()).real / (disturbance.usual + error.covariance[iron][iron])
        self.trust.add_direction(foot, phase(without), angle, kappa)
        residual = off = without - b
        if error.covariance[HEADING][HEADING] > LOST_HEADING * LOST_HEADING:
            residual = complex(hypot(*pair(without)) - hypot(*pair(b)))
        weight = disturbance.add_stance(foot, residual, z)
        if disturbance.has_changed(foot):
            self.trust.note(foot, "changed")
            disturbance.near[foot], self.blocks[foot] = disturbance.near[OTHER[foot]], Block()
            disturbance.changed[foot] = 0
            (hx, hy), (ux, uy), (c, s) = pair(error.aid(iron)), pair(off), pair(yaw)
            error.renew_aid(iron, complex(hx + c * ux + s * uy, hy + c * uy - s * ux), IRON * IRON)
            return
        block = self.blocks[foot]
        block.count, block.weight = block.count + 1, block.weight + weight
        block.flux = pair(complex(*block.flux) + weight * across)
        block.yaw = pair(complex(*block.yaw) + weight * yaw)

    def _add_block(self, foot: Foot, error: CommonError) -> Move:
        """Compare the block of a foot with the estimates, and start the next one."""
        block, self.blocks[foot], here = self.blocks[foot], Block(), self.disturbance.here
        self._fade(error)
        k, first, distance = 1.0 / block.weight, self.first, max(block.distance, LEAST_STEP * block.count)
        mean, yaw, iron = k * complex(*block.flux), k * complex(*block.yaw), first + H[foot]
        shows_heading, is_strange = self.disturbance.judge(error.aid(first))
        self.strange = self.strange + 1 if is_strange else 0
        if self.strange == LONG_STRANGE:
            self.trust.note(foot, "strange")
        elif self.strange >= MOST_STRANGE:
            self.strange, self.is_another = 0, True
            error.renew_aid(first + B, _without_iron(mean, yaw, iron, error), FIELD * FIELD)
            error.renew_aid(first + D, 0j, SHARE * self.disturbance.usual)
            return NO_MOVE
        rows = None if self.trust.is_proven and shows_heading else range(first, first + ROWS)
        noise = SHARE * here * max(1.0, SHORT * block.count / distance) * k
        # along the field
        seen, (field, size) = _without_iron(mean, yaw, iron, error), self._field(error)
        terms = self._terms(field / size, yaw, iron)
        move = error.correct_by(terms, hypot(*pair(seen)) - size, noise, rows)
        # across it, after the correction along it
        seen, (field, size) = _without_iron(mean, yaw, iron, error), self._field(error)
        terms = [*self._terms(1j * field / size, yaw, iron), (HEADING, -size)]
        angle = phase(field.conjugate() * seen) + move[HEADING]
        return add(move, error.correct_by(terms, size * angle, noise, rows))

    def _field(self, error: CommonError) -> tuple[complex, float]:
        """Return the estimate of b + d, and its size, which has a least value, uT."""
        field = error.aid(self.first + B) + error.aid(self.first + D)
        return field, max(LEAST_SIZE, hypot(*pair(field)))

    def _terms(self, along: complex, yaw: complex, iron: int) -> list[Term]:
        """Return how the errors of b, d and h, whose rows begin at `iron`, add to the flux density along a vector."""
        (x, y), (hx, hy), b, d = pair(along), pair(along * yaw.conjugate()), self.first + B, self.first + D
        return [(b, x), (b + 1, y), (d, x), (d + 1, y), (iron, hx), (iron + 1, hy)]

    def _fade(self, error: CommonError) -> None:
        """Let d become another disturbance over the distance since the newest comparison."""
        keep, p = exp(-2.0 * self.distance / LONG), error.covariance
        self.distance = 0.0
        for row in (self.first + D, self.first + D + 1):
            for j in range(len(p)):
                p[row][j] *= keep
                p[j][row] = p[row][j]
            p[row][row] = keep * p[row][row] + SHARE * self.disturbance.here * (1.0 - keep * keep)
            error.estimates[row] *= keep

    def turned(self, yaw: float) -> None:
        """Turn the blocks with both tracks by `yaw`, rad."""
        by = rect(1.0, yaw)
        for block in self.blocks.values():
            block.flux, block.yaw = pair(complex(*block.flux) * by), pair(complex(*block.yaw) * by)

    def north(self, error: CommonError) -> Vec2 | None:
        """Return the direction of magnetic north, common frame, and its standard deviation, rad.

        None until turns have proven the compass, and when the field has become another one. It is the direction of b:
        both disturbances are 0 on average. The heading of the track is among its errors."""
        if self.first < 0 or self.is_another or not self.trust.is_proven:
            return None
        field = error.aid(self.first)
        x, y, square = field.real, field.imag, (field * field.conjugate()).real
        if square < LEAST_SIZE * LEAST_SIZE:
            return None
        terms = [(self.first + B, -y / square), (self.first + B + 1, x / square), (HEADING, -1.0)]
        return (phase(field), sqrt(error.variance_of(terms)))

    def reset(self, foot: Foot, error: CommonError) -> None:
        """Forget the iron of the shoe of a foot, and its stance: another device may be worn."""
        self.feet[foot], self.blocks[foot] = StanceField(), Block()
        self.trust.reset(foot)
        if self.first >= 0:
            error.renew_aid(self.first + H[foot], 0j, IRON * IRON)


def _without_iron(flux: complex, yaw: complex, iron: int, error: CommonError) -> complex:
    """Return a flux density without the iron h whose rows begin at `iron`, uT."""
    (x, y), (c, s), (hx, hy) = pair(flux), pair(yaw), pair(error.aid(iron))
    return complex(x - c * hx + s * hy, y - s * hx - c * hy)
