"""Emulated wearers who stand, walk, climb stairs and take elevators, with sensors in the soles at 20 Hz.

Each seed is another wearer. As in Liu et al. 2015, section V.C, they "ascend/descend the stairs, walk and take
elevator". Seeds from `FIRST_TRAINING_SEED` to 999 are for training. Scored walks have other seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import pi

import numpy as np
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import MPU6050
from solepath.emulate.sensors.sensortags import CC2650
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.curves import Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.emulate.wearers.walker import Walker
from solepath.types import SITE_OF_FOOT, Foot

from ..emulated.wearers import random_wearer

RATE = 20.0
"""Sampling rate, Hz (section IV: "we sample the accelerometer and gyroscope with 20 Hz")."""
FIRST_TRAINING_SEED = 101

Addition = Callable[[Route, Rng], Route]
"""Function that adds a part of a house to a route."""
REPEATS = 2
"""Number of times that each of stairs up, stairs down, elevator up and elevator down is in a route."""


def draw_route(seed: int, *, jogging: bool = False) -> tuple[Route, Wearer]:
    """Return a route of four or five minutes through a house, and its wearer. With `jogging` some of it is run."""
    rng = np.random.default_rng([seed, 5])
    wearer, _ = random_wearer(rng)
    route = Route(speed=float(rng.uniform(0.9, 1.5))).stand(_uniform(rng, 3.0, 8.0))
    levels = [partial(add, up=up) for add in (_add_stairs, _add_elevator) for up in (True, False)]
    additions: list[Addition] = [*levels * REPEATS, _add_corridor, _add_corridor, _add_corridor, *[_add_jog] * jogging]
    return _in_any_order(route, additions, (3.0, 10.0), rng), wearer


def walker(seed: int, *, jogging: bool = False) -> Walker:
    """Return the walker of the route of `draw_route`, from which samples of any sensor can be made."""
    route, wearer = draw_route(seed, jogging=jogging)
    return Walker(route, wearer, seed)


def other_ways(seed: int) -> Walker:
    """Return a walker who walks ahead, up and down ramps, backwards, sideways, and turns on the spot."""
    rng = np.random.default_rng([seed, 7])
    wearer, _ = random_wearer(rng)
    additions = [*[_add_ramp] * 4, *[_add_steps] * 2, _add_corridor]
    route = Route(speed=float(rng.uniform(0.8, 1.5))).stand(_uniform(rng, 3.0, 8.0))
    return Walker(_in_any_order(route, additions, (2.0, 6.0), rng), wearer, seed)


def walk(seed: int, *, jogging: bool = False) -> EmulatedWalk:
    """Return the walk with a CC2650 in each sole whose inertial sensor is as noisy as an MPU-6050."""
    route, wearer = draw_route(seed, jogging=jogging)
    tag = CC2650(rate=RATE, chip=MPU6050, mounting=IN_SOLE)
    return emulate(route, wearer=wearer, devices={SITE_OF_FOOT[foot]: evolve(tag) for foot in Foot}, seed=seed)


def _in_any_order(route: Route, additions: Sequence[Addition], rests: tuple[float, float], rng: Rng) -> Route:
    """Return the route with the additions in a random order, most of which rests, s, follow."""
    for k in rng.permutation(len(additions)):
        route = additions[k](route, rng)
        if rng.uniform() < 0.6:
            route = route.stand(_uniform(rng, *rests))
    return route.stand(4.0)


def _uniform(rng: Rng, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def _add_corridor(route: Route, rng: Rng) -> Route:
    corner = pi / 2.0 if rng.uniform() < 0.5 else -pi / 2.0
    return route.walk(_uniform(rng, 8.0, 20.0)).turn(corner, _uniform(rng, 0.0, 1.5)).walk(_uniform(rng, 6.0, 15.0))


def _add_jog(route: Route, rng: Rng) -> Route:
    return route.stand(2.0).jog(_uniform(rng, 25.0, 40.0), _uniform(rng, 2.3, 3.2)).stand(2.0)


def _add_ramp(route: Route, rng: Rng) -> Route:
    """Add a ramp up or down of 1 in 20 to 1 in 8, as in front of and in buildings."""
    slope = _uniform(rng, 1.0 / 20.0, 1.0 / 8.0) * float(rng.choice([-1.0, 1.0]))
    return route.walk(_uniform(rng, 2.0, 6.0)).walk(_uniform(rng, 8.0, 20.0), slope=slope).walk(_uniform(rng, 2.0, 6.0))


def _add_steps(route: Route, rng: Rng) -> Route:
    """Add some steps backwards, some to either side, and turns on the spot."""
    route = route.stand(1.0).walk(_uniform(rng, 3.0, 8.0), direction=pi).stand(1.0)
    for side in (0.5 * pi, -0.5 * pi):
        route = route.walk(_uniform(rng, 2.0, 4.0), direction=side).stand(1.0)
    return route.turn(pi).stand(1.0).turn(-pi)


def _add_stairs(route: Route, rng: Rng, up: bool) -> Route:
    """Add two flights and the landing between them, from corridor to corridor."""
    rise, going = _uniform(rng, 0.14, 0.18), _uniform(rng, 0.27, 0.32)
    for flight in range(2):
        route = route.walk(_uniform(rng, 2.0, 4.0) if flight == 0 else 1.2)
        route = route.stairs(int(rng.integers(9, 14)), up, rise, going).walk(1.2)
        if flight == 0:
            route = route.turn(pi, 0.6)
    return route.walk(_uniform(rng, 3.0, 6.0))


def _add_elevator(route: Route, rng: Rng, up: bool) -> Route:
    """Add an elevator ride: in, turn round, up or down one to four storeys, and out."""
    height = 3.4 * float(rng.integers(1, 5))
    entered = route.walk(_uniform(rng, 3.0, 6.0)).turn(pi)
    ridden = entered.lift(
        height if up else -height,
        speed=_uniform(rng, 0.9, 1.8),
        acceleration=_uniform(rng, 0.6, 1.1),
        doors=_uniform(rng, 2.0, 4.0),
    )
    return ridden.walk(_uniform(rng, 3.0, 6.0))
