"""Emulated wearers who stand, walk, climb stairs and take lifts, at 20 Hz with sensors in the soles.

Each seed is another wearer. As in Liu et al. 2015, section V.C, they "ascend/descend the stairs, walk and take
elevator". Seeds from `FIRST_TO_LEARN_FROM` up to `LAST_TO_LEARN_FROM` are for training; scored walks have other seeds.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
from attrs import evolve

from ...emulate.routes.route import Route
from ...emulate.sensors.parts import MPU6050
from ...emulate.sensors.sensortags import CC2650
from ...emulate.walk import EmulatedWalk, emulate
from ...emulate.wearers.gait import Wearer, random_wearer
from ...emulate.wearers.shoe import IN_SOLE
from ...emulate.wearers.walker import Walker
from ...types import SITE_OF_FOOT, Foot

RATE = 20.0
"""Sampling rate, Hz (section IV: "we sample the accelerometer and gyroscope with 20 Hz")."""
FIRST_TO_LEARN_FROM = 101
LAST_TO_LEARN_FROM = 999

TIMES = 2
"""Number of times that each way to another level is taken."""

_Part = Callable[[Route, np.random.Generator], Route]


def of_seed(seed: int, *, jogging: bool = False) -> tuple[Route, Wearer]:
    """Return a route of four or five minutes through a house, and its wearer. `jogging`: some of it at a run."""
    rng = np.random.default_rng([seed, 5])
    who, _ = random_wearer(rng)
    route = Route(speed=float(rng.uniform(0.9, 1.5))).stand(_uniform(rng, 3.0, 8.0))
    levels = [_stairs(True), _stairs(False), _lift(True), _lift(False)]
    parts = [*levels * TIMES, _along, _along, _along, *[_jog] * jogging]
    for k in rng.permutation(len(parts)):
        route = parts[k](route, rng)
        if rng.uniform() < 0.6:
            route = route.stand(_uniform(rng, 3.0, 10.0))
    return route.stand(4.0), who


def walker(seed: int, *, jogging: bool = False) -> Walker:
    """Return the walker of the route of `of_seed`, for any sensors or none."""
    route, who = of_seed(seed, jogging=jogging)
    return Walker(route, who, seed)


def walk(seed: int, *, jogging: bool = False) -> EmulatedWalk:
    """Return the walk with two CC2650 in the soles whose inertial sensor is as noisy as an MPU-6050."""
    route, who = of_seed(seed, jogging=jogging)
    tag = CC2650(rate=RATE, part=MPU6050, mounting=IN_SOLE)
    return emulate(route, wearer=who, devices={SITE_OF_FOOT[foot]: evolve(tag) for foot in Foot}, seed=seed)


def _uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def _along(route: Route, rng: np.random.Generator) -> Route:
    """Add a corridor with a corner."""
    corner = pi / 2.0 if rng.uniform() < 0.5 else -pi / 2.0
    return route.walk(_uniform(rng, 8.0, 20.0)).turn(corner, _uniform(rng, 0.0, 1.5)).walk(_uniform(rng, 6.0, 15.0))


def _jog(route: Route, rng: np.random.Generator) -> Route:
    return route.stand(2.0).jog(_uniform(rng, 25.0, 40.0), _uniform(rng, 2.3, 3.2)).stand(2.0)


def _stairs(up: bool) -> _Part:
    def part(route: Route, rng: np.random.Generator) -> Route:
        """Add two flights and the landing between them, from corridor to corridor."""
        rise, going = _uniform(rng, 0.14, 0.18), _uniform(rng, 0.27, 0.32)
        for flight in range(2):
            route = route.walk(_uniform(rng, 2.0, 4.0) if flight == 0 else 1.2)
            route = route.stairs(int(rng.integers(9, 14)), up, rise, going).walk(1.2)
            if flight == 0:
                route = route.turn(pi, 0.6)
        return route.walk(_uniform(rng, 3.0, 6.0))

    return part


def _lift(up: bool) -> _Part:
    def part(route: Route, rng: np.random.Generator) -> Route:
        """Add a lift ride: in, turn round, up or down one to four storeys, and out."""
        height = 3.4 * float(rng.integers(1, 5))
        into = route.walk(_uniform(rng, 3.0, 6.0)).turn(pi)
        ridden = into.lift(
            height if up else -height,
            speed=_uniform(rng, 0.9, 1.8),
            acceleration=_uniform(rng, 0.6, 1.1),
            doors=_uniform(rng, 2.0, 4.0),
        )
        return ridden.walk(_uniform(rng, 3.0, 6.0))

    return part
