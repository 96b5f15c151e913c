"""Long walks of emulated wearers over routes of several kinds, on which headings are scored.

Wearers stroll, hurry, stop and turn back; how much their feet swerve in swing, how they wander about the path and how
they sway at rest differs between them. Routes, wearers and devices are drawn from the seed."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, radians

import numpy as np
from attrs import define, evolve

from solepath.emulate.routes.route import TIGHT_TURN_SPEED, Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX, Imu
from solepath.emulate.walk import sampled
from solepath.emulate.wearers.curves import Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.types import SITE_OF_FOOT, Foot, Sample, Site
from solepath.types.vector import GRAVITY

from .unsteady import Swaying, Wandering
from .wearers import random_wearer

STANDING_TIME = 3.0
"""Duration of standing at the start and at the end, s."""
HALT_DISTANCE = 150.0
"""Mean distance between two halts, m; a halt lasts 2 to 10 s."""
LEAST_SWERVE, MOST_SWERVE, SIDE_DIFFERENCE = 0.3, 1.4, 0.2
"""Least and largest swerve of a wearer (`Wearer.swerve`), and its standard deviation between both feet.

With them, a scale error of 1 % of one axis turns the heading by 2 to 16 degrees a minute; on recordings of eleven data
sets it is 2 to 20, and differs by a fifth, seldom by a factor of two, between the feet of a wearer."""
LEAST_WANDER, MOST_WANDER, FOOTFALL_VARIATION = 0.03, 0.08, 0.02
"""Least and largest wandering of a wearer about the path, and lateral variation of the footfalls, m (unsteady.py)."""
SWAY = radians(0.14)
"""Sway of a standing foot, rad (unsteady.py)."""
G_EFFECT = radians(0.1) / GRAVITY
"""False angular rate per specific force, rad/s per m/s^2: 0.1 degrees/s per g, as the sheets of the MPU-6050 and the
IMU-3000 specify; that of the LSM6DSOX does not specify any."""
SHOE_IMU = Imu("LSM6DSOX with g-effect", LSM6DSOX.acc, evolve(LSM6DSOX.gyro, g_effect=G_EFFECT))
"""The chip of the insoles."""

CALIBRATION_LAPS, CALIBRATION_LEG, CALIBRATION_SPEED = 5, 15.0, 1.3
"""Number of times that the wearer walks to and fro, length of a leg, m, and speed, m/s: two minutes."""
CALIBRATION_TURN_RADIUS, CALIBRATION_STAND = 0.6, 15.0
"""Radius of the turns at both ends, m, and time of standing before and after the walk, s."""
OTHER_DAY = 10_000
"""Number that is added to the seed of gait, bias and noise on the day of the calibration walk."""

IsComplete = Callable[[float, float], bool]
"""Function of the length of a route so far, m, and of its duration, s, that returns whether it is long enough."""


def wearer_of(seed: int) -> Wearer:
    """Return the wearer of a seed."""
    rng = np.random.default_rng([seed, 20])
    wearer, _ = random_wearer(rng)
    swerve = float(rng.uniform(LEAST_SWERVE, MOST_SWERVE))
    left, right = (swerve * float(1.0 + SIDE_DIFFERENCE * rng.standard_normal()) for _ in Foot)
    wander = Wandering(float(rng.uniform(LEAST_WANDER, MOST_WANDER)))
    return evolve(wearer, swerve=(left, right), wander=wander, sway=Swaying(SWAY), width_variation=FOOTFALL_VARIATION)


def insoles_of(seed: int) -> dict[Site, Insole]:
    """Return the insoles of a seed's wearer, which are the same on every day but for bias and noise."""
    insoles: dict[Site, Insole] = {}
    for number, foot in enumerate(Foot):
        acc, gyro = (
            evolve(one, specimen=4 * seed + 2 * number + k) for k, one in enumerate((SHOE_IMU.acc, SHOE_IMU.gyro))
        )
        chip = evolve(SHOE_IMU, acc=acc, gyro=gyro)
        insoles[SITE_OF_FOOT[foot]] = Insole(cells=96 if seed % 2 else 24, chip=chip)
    return insoles


def calibration_samples(seed: int) -> list[Sample]:
    """Return the samples of the calibration walk of a seed's wearer: five times to and fro, on the day before."""
    rng = np.random.default_rng([seed, 22])
    side = float(rng.choice((1.0, -1.0)))
    route = Route().stand(CALIBRATION_STAND)
    for leg in range(2 * CALIBRATION_LAPS):
        if leg:
            route = route.turn(side * pi, CALIBRATION_TURN_RADIUS)
            side = -side if leg % 2 else side
        route = route.walk(CALIBRATION_LEG, CALIBRATION_SPEED)
    walk = sampled(
        route.stop(CALIBRATION_STAND), wearer=wearer_of(seed), insoles=insoles_of(seed), seed=OTHER_DAY + seed
    )
    return list(walk.samples)


@define
class Way:
    """A route that grows at random until it is long enough."""

    rng: Rng
    is_complete: IsComplete
    usual_speed: float
    """Usual speed of the wearer, m/s."""
    route: Route = Route().stand(STANDING_TIME)
    length: float = 0.0
    """Length so far, m."""
    seconds: float = STANDING_TIME
    """Duration so far, s."""
    halt_at: float = HALT_DISTANCE
    """Length from which the wearer halts, m."""

    def uniform(self, low: float, high: float) -> float:
        """Return a random number from `low` to `high`."""
        return float(self.rng.uniform(low, high))

    def side(self) -> float:
        """Return 1 (left) or -1 (right) at random."""
        return float(self.rng.choice((1.0, -1.0)))

    def speed(self) -> float:
        """Return the speed of the next move, m/s: usually about the usual one; the wearer strolls or hurries too."""
        manner = float(self.rng.choice((1.0, 0.7, 1.25), p=(0.8, 0.1, 0.1)))
        return self.usual_speed * manner * self.uniform(0.92, 1.08)

    def walk(self, distance: float) -> bool:
        """Walk straight on, then perhaps halt; return whether the route is long enough."""
        speed = self.speed()
        self.route = self.route.walk(distance, speed)
        return self._move(distance, distance / speed)

    def turn(self, angle: float, radius: float) -> bool:
        """Turn by `angle` rad on an arc, or on the spot when `radius` is 0 m; return whether that was long enough."""
        speed = self.speed() if radius >= 1.0 else TIGHT_TURN_SPEED
        self.route = self.route.turn(angle, radius, speed)
        if not radius:
            self.seconds += 3.0
            return False
        return self._move(abs(angle) * radius, abs(angle) * radius / speed)

    def _move(self, distance: float, duration: float) -> bool:
        self.length, self.seconds = self.length + distance, self.seconds + duration
        if self.length >= self.halt_at:
            duration = self.uniform(2.0, 10.0)
            self.route, self.seconds = self.route.stand(duration), self.seconds + duration
            self.halt_at = self.length + HALT_DISTANCE * self.uniform(0.5, 1.5)
        return self.is_complete(self.length, self.seconds)


def _corridors(way: Way, angles: Callable[[], float]) -> Route:
    """Return straights of 8 to 40 m with bends by `angles` between them; the wearer turns back after one in ten."""
    while not way.walk(way.uniform(8.0, 40.0)):
        if way.uniform(0.0, 1.0) < 0.1:
            way.turn(way.side() * pi, 0.0)
        else:
            way.turn(way.side() * angles(), way.uniform(0.6, 2.5))
    return way.route


def right_angles(way: Way) -> Route:
    """Return corridors with turns by 45, 90 and 180 degrees."""
    return _corridors(way, lambda: float(way.rng.choice((0.5, 0.25, 1.0), p=(0.6, 0.2, 0.2))) * pi)


def any_angles(way: Way) -> Route:
    """Return corridors with turns by any angle from 20 to 160 degrees."""
    return _corridors(way, lambda: way.uniform(radians(20.0), radians(160.0)))


def there_and_back(way: Way) -> Route:
    """Return a corridor of 15 to 60 m that is walked to and fro."""
    distance = way.uniform(15.0, 60.0)
    while not way.walk(distance):
        way.turn(way.side() * pi, float(way.rng.choice((0.0, 0.6))))
    return way.route


def one_way_loops(way: Way) -> Route:
    """Return rectangles with sides of 8 to 35 m, all in one direction."""
    side, sides = way.side(), (way.uniform(8.0, 35.0), way.uniform(8.0, 35.0))
    radius, number = way.uniform(0.7, 3.0), 0
    while not way.walk(sides[number % 2]):
        way.turn(side * 0.5 * pi, radius)
        number += 1
    return way.route


def arcs(way: Way) -> Route:
    """Return arcs of 6 to 80 m radius to either side, without a straight."""
    way.walk(3.0)
    while not way.turn(way.side() * way.uniform(radians(30.0), radians(200.0)), 6.0 * way.uniform(1.0, 13.3)):
        pass
    return way.route


def plaza(way: Way) -> Route:
    """Return a stroll over a plaza: arcs of 3 to 30 m radius and straights of 3 to 20 m in any direction."""
    while not way.walk(way.uniform(3.0, 20.0)):
        way.turn(way.side() * way.uniform(radians(10.0), radians(180.0)), way.uniform(3.0, 30.0))
    return way.route


def circle(way: Way) -> Route:
    """Return a circle of 40 m radius that is walked ten times, whatever the way's length should be."""
    side = way.side()
    for _ in range(20):
        way.turn(side * pi, 40.0)
    return way.route


def ring(way: Way) -> Route:
    """Return a ring corridor of 15 to 60 m radius in which the wearer turns back now and then."""
    side, radius = way.side(), way.uniform(15.0, 60.0)
    while not way.turn(side * way.uniform(0.5 * pi, 2.0 * pi), radius):
        if way.uniform(0.0, 1.0) < 0.2:
            way.turn(way.side() * pi, 0.0)
            side = -side
    return way.route


def weave(way: Way) -> Route:
    """Return a slow weave: arcs of 60 to 150 m radius and 12 to 30 degrees, in turn to the left and to the right."""
    side, angle, radius = way.side(), radians(way.uniform(12.0, 30.0)), way.uniform(60.0, 150.0)
    way.turn(0.5 * side * angle, radius)
    while not way.turn(-side * angle, radius):
        side = -side
    return way.route


KINDS: dict[str, Callable[[Way], Route]] = {
    one.__name__: one
    for one in (right_angles, any_angles, there_and_back, one_way_loops, arcs, plaza, circle, ring, weave)
}
"""The kinds of routes by name."""
WITH_COMPASS = ("right_angles", "any_angles", "arcs", "one_way_loops")
"""Names of the kinds that are walked with a compass too."""


def heading_route(kind: str, seed: int, is_complete: IsComplete) -> Route:
    """Return the route of a kind and a seed, from one stand to another."""
    rng = np.random.default_rng([seed, 21, *kind.encode()])
    route = KINDS[kind](Way(rng, is_complete, float(rng.uniform(1.1, 1.5))))
    return route.stop(STANDING_TIME)
