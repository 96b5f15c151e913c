"""Two sensors that nobody wears on the feet: in the hands, in trouser pockets, on the trunk, on a table, in a bag.

The wearer walks through corridors with halts; pelvis and thighs are those of the emulated body, which has no shocks of
heel-strikes above the foot. An arm is a rod of 0.55 to 0.65 m from a shoulder 0.45 m above the hips to the sensor. It
swings ahead with the other foot's heel-strike, by 0.2 to 0.5 rad (Meyns, Bruijn and Duysens 2013, Gait & Posture 38),
and the wrist turns by 0.3 rad every few seconds (assumed). Each sensor is fixed with any attitude.

On a table, each sensor is picked up, turned and put down elsewhere, at moments of its own. A bag is shaken in bursts;
its sensors move with it, and each slips and turns a little by itself. How far and how often is drawn anew every half a
minute, from ranges that are assumed.

Idealised: nothing dangles or slips but in a bag; trousers move with the thigh; the trunk above the pelvis is rigid; a
sensor is put down as softly as a limb moves."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.limbs import SIDE_SIGNS
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, rotation, unit
from solepath.emulate.wearers.walker import Walker
from solepath.types import OTHER, Foot, Site, Vec3

from .courses import Course, Frames, Key, Motion, Pose, Vibration, carried
from .heading_walks import wearer_of
from .on_the_spot import LAST_MOVE, Posing, posing

BOUT = (20.0, 40.0)
"""Shortest and longest time for which sensors are handled or shaken as far and as often, s."""
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


def on_a_table(rng: Rng, duration: float) -> Posing:
    """Return two sensors on a table that are picked up and put down elsewhere, each by itself.

    A move takes 0.4 to 0.9 s and leads to a place 5 to 35 cm from the middle, where the sensor lies turned by 0.1 to 1
    rad about each axis, and rests for 0.2 s to 2 s."""
    return posing({foot: _put_elsewhere(rng, duration) for foot in Foot})


def _put_elsewhere(rng: Rng, duration: float) -> Motion:
    place, turn = {"x": 0.0, "y": 0.0, "z": 0.0}, {"pitch": 0.0, "roll": 0.0, "yaw": 0.0}
    frames, t = Frames(**place, **turn), rng.uniform(1.0, 5.0)
    while t < duration - LAST_MOVE:
        far, turned, longest_rest, end = rng.uniform(0.05, 0.35), rng.uniform(0.1, 1.0), rng.uniform(0.6, 2.0), t
        end += rng.uniform(*BOUT)
        while t < min(end, duration - LAST_MOVE):
            frames.add(t, **place, **turn)
            t += rng.uniform(0.4, 0.9)
            place = {name: far * rng.standard_normal() for name in place}
            turn = {name: turned * rng.standard_normal() for name in turn}
            frames.add(t, **place, **turn)
            t += rng.uniform(0.2, longest_rest)
    return frames.motion()


def in_a_bag(rng: Rng, duration: float) -> Posing:
    """Return two sensors in a bag that is shaken at up to 1 to 3 Hz, by 3 to 30 cm and 0.1 to 0.8 rad about each axis.

    Bursts and pauses last 0.5 to 5 s. Sensors lie in it with any attitude and move in it by a tenth of that."""
    bag = _shaken(rng, duration, 1.0)
    inside = {foot: _shaken(rng, duration, 0.1) for foot in Foot}
    fixed = {foot: _fixed((0.0, rng.uniform(0.02, 0.15) * SIDE_SIGNS[foot], 0.0), rng) for foot in Foot}
    return lambda foot, t: carried(carried(bag(t), inside[foot](t)), fixed[foot])


def _shaken(rng: Rng, duration: float, share: float) -> Callable[[Array], Pose]:
    """Return the poses of what is shaken in bursts by this share of what a bag is."""
    t, far, turned = 0.0, list[Key](), list[Key]()
    while t < duration:
        end, by, angle = t + rng.uniform(*BOUT), rng.uniform(0.03, 0.3), rng.uniform(0.1, 0.8)
        while t < end:
            for keys, value in ((far, by), (turned, angle)):
                keys.extend([(t, 0.0), (t + 0.5, share * value)])
            t += 0.5 + rng.uniform(0.0, 4.0)
            for keys, value in ((far, by), (turned, angle)):
                keys.extend([(t, share * value), (t + 0.5, 0.0)])
            t += 0.5 + rng.uniform(0.0, 4.0)
    sizes = Course.through(*far), Course.through(*turned)
    fastest = rng.uniform(1.0, 3.0)
    # the same speed at each frequency
    vibrations = [Vibration.drawn(lambda f: 0.4 / f**2, 0.3, fastest, rng) for _ in range(6)]

    def pose(t: Array) -> Pose:
        distance, angle = (size.at(t) for size in sizes)
        place, turn = ([one.at(t) for one in three] for three in (vibrations[:3], vibrations[3:]))
        return distance[:, None] * np.stack(place, axis=1), rotation(*[angle * one for one in turn])

    return pose
