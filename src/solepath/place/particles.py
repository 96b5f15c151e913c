"""Particles: hypotheses of where the wearer is on the plan, how they move, and the candidates that they stand for.

Every particle moves with random errors. One that would go through a wall tries again with larger errors and less
weight; when that fails, it is removed. The remaining particles are possible places of the wearer. Random numbers come
from a table, so they are equal on every platform. The numbers of a particle that is kept have few digits, because there
are many particles and a snapshot must be small."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain, cycle
from math import atan2, cos, dist, fsum, hypot, pi, sin, sqrt
from struct import Struct
from typing import NamedTuple

from ..events import Candidate
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import FloorPlan, Point
from ..types import Floats
from ..types.attrs import define


class Particle(NamedTuple):
    """One hypothesis. A move (dx, dy) of the track is (a dx - b dy, b dx + a dy) in the plan."""

    x: float
    """Place, m, plan frame."""
    y: float
    a: float
    """Rotation and stretch of the track in the plan: the stretch times the cosine of the angle, no unit."""
    b: float
    """The stretch times the sine of the angle, no unit."""
    weight: float
    level: int
    """Index of the level in the plan."""
    origin: int = 0
    """Where the hypothesis comes from: 0 for the start, else the index of a connector plus one."""
    landing: int = 0
    """`Landing.index` of the landing at which the particle may have started to change level; 0 for none."""

    def after(self, move: Point) -> Point:
        """Return the place after a move of the track, m, without errors."""
        dx, dy = move
        return self.x + self.a * dx - self.b * dy, self.y + self.b * dx + self.a * dy

    def at(self, x: float, y: float) -> Particle:
        """Return the particle at another place, m."""
        return _new(Particle, (x, y, *self[2:]))

    def turned(self, yaw: float) -> Particle:
        """Return the particle for a track that was turned by `yaw`, rad: its moves in the plan stay as they are."""
        c, s = cos(yaw), sin(yaw)
        return self._replace(a=c * self.a + s * self.b, b=c * self.b - s * self.a)

    def weighing(self, weight: float) -> Particle:
        """Return the particle with another weight."""
        x, y, a, b, _, level, origin, landing = self
        return _new(Particle, (x, y, a, b, weight, level, origin, landing))


Cloud = list[Particle]
"""Hypotheses that together say where the wearer may be."""

_new = tuple.__new__  # Particle(...) takes twice as long, where every particle is made anew
_DIGITS = Struct("<eee")
"""Stored form of a, b and the weight of a particle: float16."""
PLACES_PER_M = 128.0
"""Number of places of a particle in a metre, 1/m: 8 mm apart, a quarter of `PLACE_ERROR`, save 1 kB of a state."""
MIN_WEIGHT = 1e-5
"""Least weight of a particle that is kept, as a share of the largest weight."""


def total_weight(particles: Iterable[Particle]) -> float:
    """Return the sum of the weights."""
    return fsum([particle.weight for particle in particles])


def scaled(particles: Cloud, factors: Iterable[float]) -> Cloud:
    """Return the particles, the weight of each times its factor."""
    return [
        particle if k == 1.0 else particle.weighing(k * particle.weight)
        for particle, k in zip(particles, factors, strict=False)
    ]


def stored(particles: Cloud) -> Cloud:
    """Return the particles as stored, with the largest weight scaled to 1, without those that are too light.

    a, b and the weight keep three digits, because no track is more accurate than 0.0005 rad, and x and y 1/128 m."""
    most = max([particle.weight for particle in particles], default=0.0)
    if not most > 0.0:
        return []
    k, m, pack, unpack = 1.0 / most, PLACES_PER_M, _DIGITS.pack, _DIGITS.unpack
    return [
        _new(Particle, (round(m * x) / m, round(m * y) / m, *unpack(pack(a, b, w * k)), level, origin, landing))
        for x, y, a, b, w, level, origin, landing in particles
        if w * k > MIN_WEIGHT
    ]


def turned(particles: Cloud, yaw: float) -> Cloud:
    """Return the particles as stored, for a track that was turned by `yaw`, rad."""
    return stored([one.turned(yaw) for one in particles])


def resample(particles: Cloud, count: int, offset: float = 0.5) -> Cloud:
    """Return `count` particles that represent all, by systematic resampling with `offset` from 0 to 1.

    Each particle is drawn with a frequency proportional to the root of its weight, and gets that root as weight. The
    distribution stays the same, and more particles of low weight are kept."""
    roots = [sqrt(particle.weight) for particle in particles]
    step = fsum(roots) / count
    if not step > 0.0:
        return []
    threshold, cumulative = offset * step, 0.0
    drawn: Cloud = []
    for root, particle in zip(roots, particles, strict=True):
        cumulative += root
        while threshold < cumulative and len(drawn) < count:
            drawn.append(particle.weighing(root))
            threshold += step
    return drawn


def at_most(count: int, particles: Cloud) -> Cloud:
    """Return the particles, resampled if they are more than `count`."""
    return particles if len(particles) <= count else resample(particles, count)


def effective_count(particles: Cloud) -> float:
    """Return the effective number of particles, by the roots of their weights."""
    roots, total = fsum([sqrt(particle.weight) for particle in particles]), total_weight(particles)
    return roots * roots / total if total > 0.0 else 0.0


def have_not_moved(particles: Cloud, previous: Cloud) -> bool:
    """Return whether every particle has the place of a previous one."""
    places = {particle[:2] for particle in previous}
    return all(particle[:2] in places for particle in particles)


# Quasi-random numbers: the additive recurrence of Roberts 2018 in four dimensions. They are fractional parts of
# multiples of the powers of 1 / 1.16730..., where 1.16730... is the root of x^5 = x + 1. Consecutive entries cover all
# directions evenly; `next_random` chooses the first one.

NOISE_ENTRIES = 1021
"""Number of entries: a prime, so that no regular selection of entries repeats early."""
_STEPS = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101)
Noise = tuple[float, ...]
NOISE_TABLE: tuple[Noise, ...] = tuple(
    [tuple([2.0 * ((0.5 + k * step) % 1.0) - 1.0 for step in _STEPS]) for k in range(NOISE_ENTRIES)]
)
"""Table of quasi-random numbers; each entry has four numbers from -1 to 1."""


def next_random(state: int) -> int:
    """Return the next of 2^31 - 2 pseudo-random numbers (Park and Miller 1988)."""
    return state * 16807 % 2147483647


# Motion.

MAX_MOVE = 4.0
"""Longest move between two strides, m; a longer move is across a gap, in which the path is not known."""
GAP_ERROR = 0.3
"""Largest error of a move across a gap on each axis, as a share of its length."""
MOVE_ERROR = 0.06
"""Largest error of a move on each axis, as a share of its length; errors are evenly distributed."""
PLACE_ERROR = 0.03
"""Largest additional error of a move on each axis, m."""
HEADING_NOISE = 0.02
"""Largest error of the heading with each move, rad."""
TURN_NOISE = 0.12
"""Largest additional error of the heading, as a share of the wearer's turn."""
STRETCH_NOISE = 0.008
"""Largest change of the stretch with each move, as a share."""
STRETCH_DECAY = 0.01
"""Share by which the stretch returns to 1 with each move."""
BEND_ANGLES = (0.07, 0.16)
"""Changes of heading that a particle tries at a wall, to either side, rad."""
BEND_WEIGHT = 0.65
"""Factor of the particle's weight for each angle of these that is tried."""
WIDE_BEND_ANGLES = (0.1, 0.25, 0.45)
"""Changes of heading that all particles try when none is left, rad."""
STAY_WEIGHT = 0.6
"""Factor of the weight of a particle that stays near stairs or an elevator, because it may be on them already."""
NEAR_LANDING = 4.0
"""Largest distance from stairs or an elevator at which the wearer may be on them already, m."""


def sway(plan: IndexedPlan, particles: Cloud, move: Point, error_factor: float, turn: float, random: int) -> Cloud:
    """Return the particles after a move of the track, m, without those for which the plan forbids it.

    `error_factor` multiplies the track's usual errors, `turn` is the size of the wearer's turn, rad, and `random` the
    first index in the table."""
    walls, new = plan.walls, _new
    kept: Cloud = []
    for k, factor, bends in ((random, error_factor, BEND_ANGLES), (random + 499, 2.0 * error_factor, WIDE_BEND_ANGLES)):
        turn_error, stretch = factor * (HEADING_NOISE + TURN_NOISE * turn), factor * STRETCH_NOISE
        move_error = factor * (MOVE_ERROR * hypot(*move) + PLACE_ERROR)
        noise = chain(NOISE_TABLE[k % NOISE_ENTRIES + 1 :], cycle(NOISE_TABLE))
        (dx, dy), blocked = move, Cloud()
        for particle, (ex, ey, eh, es) in zip(particles, noise, strict=False):
            x, y, a, b, w, level, origin, _ = particle
            s = 1.0 + STRETCH_DECAY * (1.0 - a * a - b * b) + stretch * es
            h = turn_error * eh
            a1, b1 = a * s - b * h, b * s + a * h
            nx, ny = x + a1 * dx - b1 * dy + move_error * ex, y + b1 * dx + a1 * dy + move_error * ey
            if walls[level].crosses(x, y, nx, ny):
                blocked.append(particle)
            else:
                kept.append(new(Particle, (nx, ny, a1, b1, w, level, origin, 0)))
        k += len(particles)
        for x, y, a, b, weight, level, origin, _ in blocked:
            k += 367
            ex, ey, eh, es = NOISE_TABLE[k % NOISE_ENTRIES]
            count, side, w = len(kept), 1.0 if eh > 0.0 else -1.0, weight
            error_x, error_y = 2.0 * move_error * ex, 2.0 * move_error * ey
            for bend in bends:
                w *= BEND_WEIGHT
                # bend to one side, then to the other; the particle keeps the changed heading
                for h in (side * bend, -side * bend):
                    h, s = h + turn_error * es, 1.0 - 0.5 * h * h
                    a1, b1 = a * s - b * h, b * s + a * h
                    nx, ny = x + a1 * dx - b1 * dy + error_x, y + b1 * dx + a1 * dy + error_y
                    if not walls[level].crosses(x, y, nx, ny):
                        kept.append(new(Particle, (nx, ny, a1, b1, w, level, origin, 0)))
                        break
                if len(kept) > count:
                    break
            else:
                if any([dist(place, (x, y)) < NEAR_LANDING for place in plan.stop_places[level]]):
                    kept.append(Particle(x, y, a, b, weight * STAY_WEIGHT, level, origin))
        if kept:
            break
    return kept


def move_across_gap(plan: IndexedPlan, particles: Cloud, move: Point, random: int) -> Cloud:
    """Return the particles after a gap that are within the plan; the straight line to them may cross walls."""
    error = GAP_ERROR * hypot(*move)
    moved: Cloud = []
    for k in range(2 * len(particles)):
        (x, y), (ex, ey, _, _) = particles[k // 2].after(move), NOISE_TABLE[(random + k) % NOISE_ENTRIES]
        moved.append(particles[k // 2].at(x + error * ex, y + error * ey))
    return [one for one in moved if plan.inside(one.level, one.x, one.y)]


WRONG_TURN_SHARE = 0.1
"""Share of about-turns whose angle is wrong."""
HEADING_COUNT, PARTICLES_PER_HEADING = 12, 8
"""Number of headings that are tried after such a turn, and number of particles for each heading."""


def after_wrong_turn(plan: IndexedPlan, particles: Cloud, displacement: Point) -> Cloud:
    """Return a few particles of low weight in all headings, because the track's angle of an about-turn may be wrong.

    The walls decide between them. `displacement` is the track's since the turn, m."""
    (dx, dy), turned_back = displacement, Cloud()
    drawn = resample([particle for particle in particles if not particle.landing], PARTICLES_PER_HEADING)
    share = WRONG_TURN_SHARE * total_weight(particles) / (total_weight(drawn) or 1.0) / (HEADING_COUNT - 1)
    for k in range(1, HEADING_COUNT):
        for j, particle in enumerate(drawn):
            # evenly spaced over the sector of each heading
            turn = 2.0 * pi * (k + (j + 0.5) / len(drawn) - 0.5) / HEADING_COUNT
            start = particle.at(*particle.after((-dx, -dy))).turned(-turn)
            turned_back.append(start.weighing(share * particle.weight))
    return moved_freely(plan, turned_back, displacement)


def moved_freely(plan: IndexedPlan, particles: Cloud, move: Point) -> Cloud:
    """Return the particles after a move of the track, m, without those that cross a wall."""
    moved = [(one, *one.after(move)) for one in particles]
    return [one.at(x, y) for one, x, y in moved if not plan.crosses(one.level, one.x, one.y, x, y)]


# Candidates: groups of particles that are near each other.

CANDIDATE_RADIUS = 3.0
"""Largest distance of a particle from the mean of its candidate, m, when the track's heading is nearly equal."""
NARROW_RADIUS = 1.5
"""Largest distance of a particle from the mean of its candidate, m, for any heading of the track."""
MIN_TURN_COSINE = 0.87
"""Cosine of the largest angle between two headings of the track that count as nearly equal."""
MAX_CANDIDATES = 16
"""Largest number of candidates; further particles are added to the nearest candidate."""
FAR = 1e10
"""Area that is added to the square of the distance of a candidate on another level, m^2."""
MIN_CANDIDATE_WEIGHT = 0.002
"""Least share of the weight of a candidate; lighter candidates are added to the heaviest."""


@define
class _Group:
    """Particles that are near each other."""

    level: int
    origin: int
    """Where the first particle comes from."""
    landing: int
    """Landing of the first particle."""
    weight: float = 0.0
    """Sum of the weights."""
    sums: Floats = (0.0,) * 5
    """Weighted sums of x, y, a, b and the length of (a, b)."""

    @property
    def place(self) -> Point:
        """The mean place, m."""
        return self.sums[0] / self.weight, self.sums[1] / self.weight

    def add(self, particle: Particle) -> None:
        x, y, a, b, w, level, _, _ = particle
        if level == self.level:
            values = (x, y, a, b, sqrt(a * a + b * b))
            self.sums = tuple([total + w * value for total, value in zip(self.sums, values, strict=True)])
            self.weight += w
        else:  # the list is full: add the weight of the particle, not its place
            ratio = (self.weight + w) / self.weight
            self.sums, self.weight = tuple([total * ratio for total in self.sums]), self.weight * ratio

    def has_heading(self, particle: Particle) -> bool:
        """Return whether the heading of the track is nearly equal."""
        _, _, a, b, length = self.sums
        return a * particle.a + b * particle.b > MIN_TURN_COSINE * length * hypot(particle.a, particle.b)


def _group(particles: Cloud, limit: float) -> list[_Group]:
    """Return all particles as one group when their rms deviation is below `limit`, m; else grouped by distance."""
    whole = _Group(*particles[0][5:])
    if all([particle.level == whole.level for particle in particles]):
        for particle in particles:
            whole.add(particle)
        x, y = whole.place
        square = fsum([one.weight * (one.x * one.x + one.y * one.y) for one in particles])
        if square / whole.weight - (x * x + y * y) < limit * limit:
            return [whole]
    groups: list[_Group] = []
    for particle in sorted(particles, key=lambda one: one.weight, reverse=True):
        x, y, level = particle.x, particle.y, particle.level
        is_full, best = len(groups) >= MAX_CANDIDATES, None
        nearest = 2.0 * FAR if is_full else CANDIDATE_RADIUS * CANDIDATE_RADIUS
        for group in groups:
            is_here = group.level == level
            if is_here or is_full:
                at_x, at_y = group.place
                square = (at_x - x) ** 2 + (at_y - y) ** 2 + (0.0 if is_here else FAR)
                is_near = is_full or square < NARROW_RADIUS * NARROW_RADIUS
                if square < nearest and (is_near or group.has_heading(particle)):
                    best, nearest = group, square
        if best is None:
            best = _Group(*particle[5:])
            groups.append(best)
        best.add(particle)
    return groups


def candidates_of(
    particles: Cloud, plan: FloorPlan, heights: dict[int, float], track_height: float | None, limit: float
) -> tuple[tuple[Candidate, ...], float]:
    """Return the candidates, heaviest first, and the rms distance of all particles from the first candidate, m.

    `heights` has the height of particles that change level, m, plan frame, by landing of entry. `track_height` is the
    reported height when the plan has no heights, m, else None. All particles are one candidate when their rms deviation
    is below `limit`, m. There must be a particle. Places are rounded to a millimetre, because they are saved."""
    x0, y0 = plan.origin
    if (x0, y0) != (0.0, 0.0):  # sums of large coordinates would lose digits
        particles = [particle.at(particle.x - x0, particle.y - y0) for particle in particles]
    groups = sorted(_group(particles, limit), key=lambda group: group.weight, reverse=True)
    total = fsum([group.weight for group in groups])
    groups = [group for group in groups if group.weight >= MIN_CANDIDATE_WEIGHT * total]
    shares = [round(group.weight / total, 5) for group in groups[1:]]
    candidates = []
    for group, share in zip(groups, (1.0 - fsum(shares), *shares), strict=True):
        level, origin = plan.levels[group.level], group.origin
        height = heights.get(group.landing, level.elevation) if track_height is None else track_height
        (x, y), (_, _, a, b, length) = group.place, group.sums
        position = (round(x0 + x, 3), round(y0 + y, 3), round(height, 3))
        heading = round(atan2(b, a), 4) if hypot(a, b) > 0.5 * length else None
        name = plan.connectors[origin - 1].name if origin else "start"
        candidates.append(Candidate(level.id, position, heading, share, name))
    x, y = groups[0].place
    squares = fsum([one.weight * ((one.x - x) ** 2 + (one.y - y) ** 2) for one in particles])
    return tuple(candidates), sqrt(squares / total)
