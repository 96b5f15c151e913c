"""Routes, radio and sensors of `solepath demo`: a default route, a straight walk, or one through a building."""

from __future__ import annotations

from math import pi

from attrs import evolve

from ..calibration import Limbs
from ..types import SITE_OF_FOOT, Site
from .radio import Radio
from .routes.route import Route
from .sensors.device import Device
from .sensors.parts import RESISTIVE
from .sensors.sensortags import CC2541
from .sensors.suit import suit
from .wearers.shoe import IN_SOLE

RADIO = Radio(loss=0.03, duplicate=0.005, corrupt=0.005, latency=0.015, jitter=0.030)
"""A crowded 2.4 GHz band (assumed): 3 in 100 notifications never arrive, the others arrive after 15 to 45 ms."""


def _u_turn(standing: float, distance: float, speed: float) -> Route:
    """Return standing, s, a U-shaped path whose last leg has this length, m, and speed, m/s, a halt, and a turn."""
    there = Route().stand(standing).walk(9.0, speed=1.3).turn(pi / 2, radius=1.5).walk(4.0).turn(pi / 2, radius=1.5)
    return there.walk(distance, speed=speed).stop(2.0).turn(-pi / 2)


ROUTE = _u_turn(3.0, 6.0, 1.1).walk(5.0, speed=1.2).turn(-pi / 2, radius=1.0).walk(10.0, speed=1.4).stop(2.0)
"""A route of about 40 m: a U-shaped path, a halt, a turn on the spot, and a second path."""
SITE_ROUTE = _u_turn(2.0, 9.0, 1.2).walk(6.0, speed=1.3).stop(2.0)
"""A route of 36 s for the site of `solepath web`, which holds the packets of this walk."""
BUILDING_WALK_SEED = 8
"""Seed of a walk through the emulated building: down by an elevator, along 130 m of corridors, up the stairs."""


def straight(distance: float) -> Route:
    """Return a route that stands, walks `distance` m straight on and stands."""
    return Route().stand(3.0).walk(distance, speed=1.3).stop(2.0)


def radio(loss: float | None = None, jitter: float | None = None) -> Radio:
    """Return RADIO with this share of lost packets and this jitter, s; None keeps the value of RADIO."""
    return evolve(RADIO, loss=RADIO.loss if loss is None else loss, jitter=RADIO.jitter if jitter is None else jitter)


def worn(recipe: str, limbs: Limbs, seed: int) -> tuple[str, dict[Site, Device] | None]:
    """Return what the wearer of these limbs wears for a recipe, in words and as devices; None for two insoles.

    The papers of walking-modes and footstep-tracker have other sensors: a suit, and tags at 20 Hz in the soles."""
    if recipe.startswith(("walking-modes", "touchdown-")):
        return "seven sensors at pelvis, thighs, shanks and feet", suit(limbs, seed, cell_part=RESISTIVE)
    if recipe.startswith("footstep-tracker"):
        return "a SensorTag in each shoe", {site: CC2541(mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    return "an insole in each shoe", None
