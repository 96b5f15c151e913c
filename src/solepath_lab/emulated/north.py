"""Worth of a compass in the feet on a plan that knows its north, in the building whose halves are alike.

    solepath-lab emulated north [--walks N] [--seed S]

prints a table as Markdown, of which docs/device.md has some figures: walks without a start in `HALF_TURN`, with insoles
that have a magnetometer, on a plan without a north, on one with the right north, and on one whose north is wrong.
Magnetic north is off true north by `DECLINATION`."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from math import cos, fsum, hypot, pi, radians, sin

import numpy as np
from attrs import evolve

from solepath.emulate.routes.ways import BuildingWalk, wandering
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.magnetic_field import EARTH
from solepath.emulate.sensors.parts import AK8963
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import PlanContradicted
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Anchor
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot
from solepath.validate.place import NEAR_DISTANCE, PlaceScore, score

from ..tables import markdown
from .buildings import HALF_TURN
from .magnetic_field import DisturbedField

DECLINATION = radians(4.0)
"""Angle from true to magnetic north, clockwise, rad: that of Central Europe (WMM2025)."""
DISTURBANCE = radians(20.0)
"""Disturbance of the field by the building, rad (magnetic_field.py)."""
BEARINGS: dict[str, float | None] = {
    "no north": None,
    "right north": 0.0,
    "north a quarter-turn off": 0.5 * pi,
    "north half a turn off": pi,
}
"""Bearing of the plan, rad, by the name of a row; the true one is 0."""


def walk_with_compass(way: BuildingWalk, seed: int) -> SampledWalk:
    """Return the samples of a way, with magnetometers in the insoles and magnetic north as `DECLINATION` says.

    The field of the emulator has the frame of the wearer's first heading."""
    horizontal, direction = hypot(EARTH[0], EARTH[1]), 0.5 * pi - DECLINATION - (way.start.heading or 0.0)
    earth = (horizontal * cos(direction), horizontal * sin(direction), EARTH[2])
    insoles = {SITE_OF_FOOT[foot]: Insole(cells=8, mag=AK8963) for foot in Foot}
    return sampled(way.route, insoles=insoles, field=DisturbedField(DISTURBANCE, seed, earth), seed=seed)


def plan_with(bearing: float | None, way: BuildingWalk) -> IndexedPlan:
    """Return the plan of the way's building with this bearing, rad; None for a plan without a north."""
    anchor = None if bearing is None else Anchor(48.0, 11.0, bearing)
    return IndexedPlan(evolve(way.building.plan, anchor=anchor))


def score_north(way: BuildingWalk, walk: SampledWalk, bearing: float | None) -> tuple[PlaceScore, bool]:
    """Return the score of a walk on a plan with this bearing, and whether the walls contradicted the compass."""
    session = Session(floorplan=plan_with(bearing, way))
    events = session.feed(walk.samples) + session.finish()
    contradicted = any(isinstance(event, PlanContradicted) for event in events)
    return score(way, walk.walker, walk.truth, events), contradicted


def cells(name: str, scores: Sequence[tuple[PlaceScore, bool]]) -> list[str]:
    """Return the cells of a row of the table."""
    walks = len(scores)
    off = [distance for one, _ in scores for distance in one.off]
    kept = sum([one.strides > 0 and not one.dropped for one, _ in scores])
    right = sum([bool(one.off) and one.off[-1] < NEAR_DISTANCE for one, _ in scores])
    near = sum([distance < NEAR_DISTANCE for distance in off]) / max(len(off), 1)
    contradicted = sum([contradicted for _, contradicted in scores])
    quantile = float(np.quantile(off, 0.95)) if off else 0.0
    return [name, f"{kept} of {walks}", f"{right} of {walks}", f"{100.0 * near:.0f} %",
            f"{fsum(off) / max(len(off), 1):.2f} m", f"{quantile:.2f} m", str(contradicted)]  # fmt: skip


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    scores: dict[str, list[tuple[PlaceScore, bool]]] = {name: [] for name in BEARINGS}
    for seed in range(options.seed, options.seed + options.walks):
        way = wandering(seed, HALF_TURN)
        walk = walk_with_compass(way, seed)
        for name, bearing in BEARINGS.items():
            scores[name].append(score_north(way, walk, bearing))
    header = ("plan", "true place kept", "right at the end", "strides within 3 m", "mean error", "95 %", "contradicted")
    print("\n".join(markdown.table(header, [cells(name, found) for name, found in scores.items()])))
    return 0
