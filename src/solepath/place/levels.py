"""Levels: what stairs and elevators make of particles, and levels between which walls cannot decide.

Activities are uncertain: level walking may be reported as stairs, and stairs down as stairs up. Therefore, after a
possible change of level, there are particles for both levels and both directions, each with its probability. The walls
of the plan and later events decide between them."""

from __future__ import annotations

from math import dist, exp, fsum, hypot, inf

from ..events import Placed, PlanContradicted, WearerMoved
from ..floorplan.index import IndexedPlan, Landing
from ..floorplan.plan import ConnectorKind, Point
from .particles import (
    CANDIDATE_RADIUS,
    MAX_MOVE,
    MIN_CANDIDATE_WEIGHT,
    NOISE_ENTRIES,
    NOISE_TABLE,
    Cloud,
    Particle,
    resample,
    scaled,
    total_weight,
)
from .references import HEIGHT_ERROR, HEIGHT_ERROR_SHARE, LevelReached, Passage, find_exits, rise_between

LANDING_REACH = 5.0
"""Largest distance between the track and the stairs or elevator that the wearer enters, m."""
DISTANCE_DEVIATION = 2.5
"""Standard deviation of the distance between the track and the landing that is entered, m."""
EXIT_ERROR = 0.5
"""Largest distance between a landing and the place at which the wearer leaves it, on each axis, m."""
TURN_ERROR, STRETCH_ERROR = 0.07, 0.02
"""Largest errors of the track's heading, rad, and of its stretch that stairs or a ride add."""
ON_STAIRS_WEIGHT = 2.0
"""Likelihood of being on stairs divided by that of walking past them, when climbing is reported near stairs."""
LEAST_REVISED_SHARE = 1e-3
"""Least probability of a level after a revision, because its particles are gone with less (assumed)."""
LEAST_OPPOSITE_SHARE = {ConnectorKind.STAIRS: 0.1, ConnectorKind.LIFT: 0.01}
"""Least probability that the wearer's direction, up or down, is not the reported one: feet move alike in both."""
BOTH_LEVELS_LIMITS = (0.3, 0.8)
"""Limits, as shares of the climb to the next landing, between which the wearer may be on either level."""


def entering(plan: IndexedPlan, particles: Cloud, kind: ConnectorKind, displacement: Point) -> Cloud:
    """Return a particle that changes level for each particle near stairs or an elevator, as `kind` says.

    `displacement` is that of the track since the change may have started, m."""
    back = (-displacement[0], -displacement[1])
    found: Cloud = []
    for particle in particles:
        place = particle.after(back)
        landings = [one for one in plan.landings if one.kind is kind and one.level == particle.level]
        distance, index = min([(dist(one.place, place), one.index) for one in landings], default=(inf, 0))
        if distance <= LANDING_REACH:
            likelihood = exp(-0.5 * (distance / DISTANCE_DEVIATION) ** 2)
            weight = ON_STAIRS_WEIGHT * particle.weight * likelihood
            found.append(particle._replace(weight=weight, landing=index))
    return found


def weigh_exits(plan: IndexedPlan, entered: Landing, arrived: LevelReached) -> list[tuple[Landing, float]]:
    """Return the possible exits after entering at a landing, each with its probability, in both directions."""
    opposite = max(arrived.opposite_share, LEAST_OPPOSITE_SHARE[arrived.kind])
    return [
        (landing, likelihood * share)
        for up, share in ((arrived.up, 1.0 - opposite), (not arrived.up, opposite))
        for landing, likelihood in find_exits(plan, entered, up, arrived.height, arrived.flights)
    ]


def place_near(plan: IndexedPlan, level: int, place: Point, offset: Point) -> Point:
    """Return the place at an offset, m, or the place itself if there is a wall between them."""
    x, y = place[0] + offset[0], place[1] + offset[1]
    return place if plan.crosses(level, *place, x, y) else (x, y)


def leaving(plan: IndexedPlan, changing: Cloud, arrived: LevelReached, random: int) -> Cloud:
    """Return a particle at each possible exit of each one that changes level; the other direction weighs less."""
    exits = {at: weigh_exits(plan, plan.landings[at - 1], arrived) for at in landings_of(changing)}
    found: Cloud = []
    for k, one in enumerate(changing):
        ex, ey, eh, es = NOISE_TABLE[(random + k) % NOISE_ENTRIES]
        turn, stretch = TURN_ERROR * eh, 1.0 + STRETCH_ERROR * es
        a, b = stretch * (one.a - one.b * turn), stretch * (one.b + one.a * turn)
        for landing, share in exits[one.landing]:
            x, y = place_near(plan, landing.level, landing.place, (EXIT_ERROR * ex, EXIT_ERROR * ey))
            origin = one.origin or landing.connector + 1
            found.append(Particle(x, y, a, b, one.weight * share, landing.level, origin))
    return found


def landings_of(particles: Cloud) -> dict[int, float]:
    """Return the weights of the particles that change level, by the index of the landing at which they do."""
    weights: dict[int, float] = {}
    for one in particles:
        if one.landing:
            weights[one.landing] = weights.get(one.landing, 0.0) + one.weight
    return {index: weights[index] for index in sorted(weights)}


def weights_of_exits(plan: IndexedPlan, entered: dict[int, float], arrived: LevelReached) -> dict[int, float]:
    """Return the weights of the landings by which the wearer may have left, by index, which add up to one.

    `entered` has those of the landings by which they may have entered; empty if it is any of the kind."""
    entered = entered or {landing.index: 1.0 for landing in plan.landings if landing.kind is arrived.kind}
    weights: dict[int, float] = {}
    for index, weight in entered.items():
        for landing, share in weigh_exits(plan, plan.landings[index - 1], arrived):
            weights[landing.index] = weights.get(landing.index, 0.0) + weight * share
    total = fsum(weights.values())
    return {index: weights[index] / total for index in sorted(weights) if weights[index] > 0.0}


def shares_of_levels(plan: IndexedPlan, entered: dict[int, float], arrived: LevelReached) -> dict[int, float]:
    """Return the probability of each level after an arrival."""
    shares: dict[int, float] = {}
    for index, weight in weights_of_exits(plan, entered, arrived).items():
        level = plan.landings[index - 1].level
        shares[level] = shares.get(level, 0.0) + weight
    return shares


def levels_on_the_way(
    plan: IndexedPlan, particles: Cloud, passage: Passage | None, here: WearerMoved
) -> tuple[Cloud, dict[int, float]]:
    """Return the particles, those that change level with a level, and their heights, m, by landing of entry.

    The level is the nearer one; about half-way, particles alternate between both. Heights end at the next landing."""
    up = passage is not None and passage.net_up > 0
    height = passage and passage.height(here.position) or 0.0
    heights: dict[int, float] = {}
    levels: dict[int, tuple[int, int]] = {}
    for index in landings_of(particles):
        entered = plan.landings[index - 1]
        exits = find_exits(plan, entered, up) or find_exits(plan, entered, not up)
        next_one = min([one for one, _ in exits], key=entered.distance, default=entered)
        rise = entered.distance(next_one)
        climbed = min(height, rise)
        heights[index] = entered.elevation + (climbed if next_one.elevation > entered.elevation else -climbed)
        levels[index] = (
            entered.level if climbed < BOTH_LEVELS_LIMITS[1] * rise else next_one.level,
            next_one.level if climbed > BOTH_LEVELS_LIMITS[0] * rise else entered.level,
        )
    if not levels:
        return particles, heights
    with_levels = [
        one._replace(level=levels[one.landing][k % 2]) if one.landing else one for k, one in enumerate(particles)
    ]
    return with_levels, heights


# Rides that the plan does not have.

HEIGHT_RATIO = 2.0
"""Deviation of a ride's height from every one of the plan, as a ratio to its error, at which the plan contradicts it.

With 2, half a storey of 2.7 m or more contradicts, and an error of 1.5 m does not."""


def contradicted_height(
    plan: IndexedPlan, ride: LevelReached, particles: Cloud, known_at: float
) -> list[PlanContradicted]:
    """Return an event if no lift of the plan makes a ride of this height and direction from a particle's level.

    If there are no particles, the place is not known, and any level counts."""
    levels = {particle.level for particle in particles}
    lifts = [landing for landing in plan.landings if landing.kind is ConnectorKind.LIFT]
    if ride.kind is ConnectorKind.STAIRS or not lifts:
        return []
    rides: list[tuple[float, float]] = []
    for entered in lifts:
        if not levels or entered.level in levels:
            for left, _ in find_exits(plan, entered, ride.up):
                low, high = rise_between(plan, entered, left)
                height = 0.5 * (low + high) if ride.height is None else ride.height
                allowed = min(max(height, low), high)
                rides.append((abs(height - allowed) / (HEIGHT_ERROR + HEIGHT_ERROR_SHARE * low), allowed))
    deviation, nearest = min(rides, default=(inf, 0.0))
    if deviation <= HEIGHT_RATIO:
        return []
    direction = "up" if ride.up else "down"
    way = direction if ride.height is None else f"{direction} by {ride.height:.1f} m"
    fault = f"the plan has none that goes {direction}{' from there' if levels else ''}"
    if rides:
        fault = f"the nearest landing of the plan is at {nearest:.1f} m"
    what = (
        f"a lift went {way}, and {fault}: it has stopped between two landings, or the plan lacks one. The wearer may "
        "be at the next landing or where they were"
    )
    off = round(ride.height - nearest, 3) if rides and ride.height is not None else None
    return [PlanContradicted(t=ride.t, known_at=max(ride.t, known_at), what=what, height_off=off)]


# Levels whose walls are alike where the wearer is: walls cannot decide between them.
#
# Each level has few particles, and which of them bend at a wall or end there is chance. Without a remedy the weights of
# two equal floors walk at random in the course of a walk, until the true one is gone. Therefore the particles of alike
# levels at one place keep the ratio of their weights in each move, unless their walls differ there. Stairs, lifts and
# reported places still change it, and so does the fading of light levels (`FADE_FACTOR` in placing.py): this keeps an
# open choice open, and fading ends one that is nearly made.

PLACE_RADIUS = 2.0 * CANDIDATE_RADIUS
"""Largest distance on each axis of particles at one place, m: twice that of a candidate, as they move apart."""
EVERY = 5
"""One of so many particles is moved on both levels to see whether their walls are alike (saves time)."""
TWINS = 30
"""Number of particles that an alike level gets when it has none left: as many as are kept for a light candidate."""


def hold_alike_levels(plan: IndexedPlan, before: Cloud, after: Cloud, move: Point, placed: Placed) -> Cloud:
    """Return the particles `after` a move of the track, m, with the ratios that alike levels at one place had `before`.

    The place is that which was reported before the move, and its level the one to which others are compared. If an
    alike level has no particle left there, it gets those of this level. A move across a gap of the track passes walls,
    so it changes nothing here."""
    length, level = hypot(*move), before[0].level
    if length > MAX_MOVE or all([particle.level == level for particle in before]):
        return after
    level, (x, y, _), (dx, dy) = plan.number(placed.level), placed.position, move
    old = _near(before, x, y)
    if len(old) < 2 or level not in old:
        return after
    # the place moves with its particles, otherwise those at its edge would leave it and seem to be gone
    weight = total_weight(old[level])
    x += fsum([one.weight * (one.a * dx - one.b * dy) for one in old[level]]) / weight
    y += fsum([one.weight * (one.b * dx + one.a * dy) for one in old[level]]) / weight
    new, around = _near(after, x, y), _near(after, x, y, PLACE_RADIUS + length)
    if level not in new:
        return after
    factors, twins = dict[int, float](), Cloud()
    new_weight = total_weight(new[level])
    for other, particles in old.items():
        share = total_weight(particles) / weight
        if other == level or share < MIN_CANDIDATE_WEIGHT or not _are_alike(plan, old, move, level, other):
            continue
        if other in new:
            factors[other] = share * new_weight / total_weight(new[other])
        elif other not in around:
            drawn = resample(new[level], TWINS)
            k = share * new_weight / total_weight(drawn)
            twins += [one._replace(weight=k * one.weight, level=other) for one in drawn]
    return scaled(after, [factors.get(one.level, 1.0) if _is_near(one, x, y) else 1.0 for one in after]) + twins


def _near(particles: Cloud, x: float, y: float, radius: float = PLACE_RADIUS) -> dict[int, Cloud]:
    """Return the particles near (x, y) that do not change level, by level."""
    near: dict[int, Cloud] = {}
    for particle in particles:
        if _is_near(particle, x, y, radius):
            near.setdefault(particle.level, []).append(particle)
    return near


def _is_near(particle: Particle, x: float, y: float, radius: float = PLACE_RADIUS) -> bool:
    return not particle.landing and -radius < particle.x - x < radius and -radius < particle.y - y < radius


def _are_alike(plan: IndexedPlan, near: dict[int, Cloud], move: Point, level: int, other: int) -> bool:
    """Return whether the walls of two levels allow and stop the same moves of the particles on both."""
    moves = [(one.x, one.y, *one.after(move)) for one in (near[level] + near[other])[::EVERY]]
    return all([plan.crosses(level, *one) is plan.crosses(other, *one) for one in moves])
