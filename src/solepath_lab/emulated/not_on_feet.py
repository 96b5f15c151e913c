"""Two sensors that somebody carries elsewhere than on the feet: in the hands, in trouser pockets, on the trunk.

The wearer walks through corridors with halts; pelvis and thighs are those of the emulated body, which has no shocks of
heel-strikes above the foot. An arm is a rod of 0.55 to 0.65 m from a shoulder 0.45 m above the hips to the sensor. It
swings ahead with the other foot's heel-strike, by 0.2 to 0.5 rad (Meyns, Bruijn and Duysens 2013, Gait & Posture 38),
and the wrist turns by 0.3 rad every few seconds (assumed). Each sensor is fixed with any attitude.

Idealised: nothing dangles or slips; trousers move with the thigh; the trunk above the pelvis is rigid."""

from __future__ import annotations

from math import pi

import numpy as np

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.limbs import SIDE_SIGNS
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, rotation, unit
from solepath.emulate.wearers.walker import Walker
from solepath.types import OTHER, Foot, Site, Vec3

from .courses import Course, Key, Pose, carried
from .heading_walks import wearer_of
from .on_the_spot import Posing

THIGHS = {Foot.LEFT: Site.LEFT_THIGH, Foot.RIGHT: Site.RIGHT_THIGH}


def walker(rng: Rng, duration: float) -> Walker:
    """Return somebody who walks through corridors for so many seconds, and longer."""
    speed = rng.uniform(0.9, 1.5)
    route = Route(speed=speed).stand(3.0)
    for _ in range(int(duration * speed / 12.0) + 1):
        route = route.walk(rng.uniform(6.0, 18.0)).turn(float(rng.choice((0.5, -0.5, 1.0))) * pi, 0.8)
        if rng.uniform() < 0.2:
            route = route.walk(2.0).stand(rng.uniform(2.0, 6.0))
    seed = int(rng.integers(1, 10**6))
    return Walker(route.walk(4.0).stop(3.0), wearer_of(seed), seed)


def _fixed(place: Vec3, rng: Rng) -> Pose:
    """Return the pose of a sensor that is fixed at a place of a segment, with any attitude, (1, 3) and (1, 3, 3)."""
    axis = unit(rng.standard_normal((1, 3)))
    return np.array([place]), matrices(from_rotation_vectors(rng.uniform(0.0, pi) * axis))


def on_trunk(rng: Rng, duration: float) -> Posing:
    """Return two sensors on the trunk of a walker: on the belt, and on the chest or back."""
    body = walker(rng, duration).body
    places: dict[Foot, Vec3] = {
        Foot.LEFT: (0.1, rng.uniform(-0.15, 0.15), 0.05),
        Foot.RIGHT: (float(rng.choice((-0.12, 0.12))), rng.uniform(-0.1, 0.1), rng.uniform(0.2, 0.45)),
    }
    fixed = {foot: _fixed(places[foot], rng) for foot in Foot}
    return lambda foot, t: carried(body.pelvis(t), fixed[foot])


def in_pockets(rng: Rng, duration: float) -> Posing:
    """Return two sensors in the trouser pockets of a walker, a hand's breadth in front of the thighs."""
    body = walker(rng, duration).body
    fixed = {foot: _fixed((0.07, 0.04 * SIDE_SIGNS[foot], rng.uniform(-0.22, -0.1)), rng) for foot in Foot}
    return lambda foot, t: carried(body.segment(THIGHS[foot], t), fixed[foot])


def in_hands(rng: Rng, duration: float) -> Posing:
    """Return a sensor in each hand of a walker."""
    one = walker(rng, duration)
    body, reach, swing = one.body, rng.uniform(0.55, 0.65), rng.uniform(0.2, 0.5)
    arms: dict[Foot, Course] = {}
    wrists: dict[Foot, tuple[Course, Course]] = {}
    for foot in Foot:
        strikes = [(stride.heel_strike, -0.6 * swing) for stride in one.plan.strides[foot]]
        strikes += [(stride.heel_strike, swing) for stride in one.plan.strides[OTHER[foot]]]
        arms[foot] = Course.through(
            (0.0, 0.05), *[(t, angle + 0.05 * rng.standard_normal()) for t, angle in sorted(strikes)]
        )
        wrists[foot] = _wandering(rng, one.duration), _wandering(rng, one.duration)
    fixed = {foot: _fixed((0.0, 0.0, -reach), rng) for foot in Foot}

    def pose(foot: Foot, t: Array) -> Pose:
        place, turn = body.pelvis(t)
        shoulder = place + turn @ np.array((0.0, 0.2 * SIDE_SIGNS[foot], 0.45))
        still, (twist, bend) = np.zeros_like(t), wrists[foot]
        arm = carried((shoulder, turn), (np.zeros((len(t), 3)), rotation(still, -arms[foot].at(t), still)))
        place, turn = carried(arm, (fixed[foot][0], np.eye(3)[None]))
        return place, turn @ rotation(twist.at(t), bend.at(t), still) @ fixed[foot][1]

    return pose


def _wandering(rng: Rng, duration: float) -> Course:
    t, keys = 0.0, list[Key]()
    while t < duration:
        keys.append((t, 0.3 * rng.standard_normal()))
        t += rng.uniform(1.0, 4.0)
    return Course.through(*keys)
