"""Contact and flight time, strike angle and vertical oscillation of emulated runners, against the truth.

    solepath-lab emulated runs [--runs N] [--seed S]

prints a table as Markdown. The emulated force under a foot is half a sine wave, as in the model from
which the oscillation is estimated: the table shows how errors of contact and flight time act on it, not how well the
model fits people. Its true value is twice the integral of that force."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from itertools import pairwise
from math import degrees, fsum, sqrt

import numpy as np
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.walk import SampledWalk, sampled
from solepath.emulate.wearers.walker import Walker
from solepath.events import GaitCycleMeasured
from solepath.session import Session
from solepath.show.report.running import Running, running_cycle
from solepath.types import OTHER, Foot
from solepath.types.vector import GRAVITY

from ..tables import markdown
from .heading_walks import insoles_of, wearer_of

SLOWEST, FASTEST = 2.2, 3.8
"""Least and largest speed of a run, m/s."""
DISTANCE = 60.0
"""Distance that is run, m."""
MATCH_TIME = 0.15
"""Largest difference of the time of a contact from the true one, s."""
STEP = 0.001
"""Interval by which the force is integrated, s."""


Cycle = tuple[Running, Running]
"""Measures of a steady cycle of running, and their true values."""


def run_of(seed: int, speed: float) -> SampledWalk:
    """Return a run on the level by the wearer of a seed, with a few walked metres before and after it."""
    route = Route().stand(3.0).walk(5.0, 1.3).jog(DISTANCE, speed).walk(5.0, 1.3).stop(2.0)
    return sampled(route, wearer=wearer_of(seed), insoles=insoles_of(seed), seed=seed)


def oscillation_of(walker: Walker, contact: float, next_contact: float) -> float:
    """Return the rise of the centre of mass from its lowest to its highest point from one contact, s, to the next, m.

    In a steady run it is as high at the second contact as at the first."""
    t = np.arange(contact, next_contact, STEP)
    acceleration = GRAVITY * (walker.loads.body(t) / walker.loads.weight - 1.0)
    height = STEP * np.cumsum(STEP * np.cumsum(acceleration))
    height -= (height[-1] - height[0]) * (t - t[0]) / (t[-1] - t[0])
    return float(height.max() - height.min())


def true_cycles(walker: Walker) -> dict[tuple[Foot, float], Running]:
    """Return the true measures of cycles of running, by foot and time of the contact that starts the cycle, s."""
    found: dict[tuple[Foot, float], Running] = {}
    for foot in Foot:
        strides, others = walker.plan.strides[foot], walker.plan.strides[OTHER[foot]]
        for before, after in pairwise(strides):
            between = [one for one in others if before.heel_strike < one.heel_strike < after.heel_strike]
            if len(between) != 1 or {before.kind, between[0].kind, after.kind} != {StrideKind.RUN}:
                continue
            found[foot, before.heel_strike] = Running(
                contact_time=after.toe_off - before.heel_strike,
                flight_time=between[0].heel_strike - after.toe_off,
                strike_angle=after.strike_pitch,
                vertical_oscillation=oscillation_of(walker, before.heel_strike, between[0].heel_strike),
            )
    return found


def score_run(walk: SampledWalk, with_cells: bool) -> list[Cycle]:
    """Return the steady cycles of running by the default recipe, with the true ones.

    The pressure cells of the insoles are used or, without `with_cells`, their inertial sensors only."""
    samples = walk.samples if with_cells else [evolve(sample, pressure=None) for sample in walk.samples]
    session, truth, cycles = Session(), true_cycles(walk.walker), list[Cycle]()
    for event in session.feed(samples) + session.finish():
        if isinstance(event, GaitCycleMeasured) and event.steady and (run := running_cycle(event)) is not None:
            near = [
                one for (foot, t), one in truth.items() if foot is event.foot and abs(t - event.t_start) < MATCH_TIME
            ]
            cycles += [(run, one) for one in near[:1]]
    return cycles


ROWS: tuple[tuple[str, str, str, float, int], ...] = (
    ("contact time", "contact_time", "ms", 1000.0, 0),
    ("flight time", "flight_time", "ms", 1000.0, 0),
    ("strike angle", "strike_angle", "degrees", degrees(1.0), 1),
    ("vertical oscillation", "vertical_oscillation", "mm", 1000.0, 0),
)
"""Label, field, unit, factor from the SI unit, and digits of each row."""


def errors_of(cycles: Sequence[Cycle], name: str) -> tuple[list[float], list[float]]:
    """Return the errors of a measure in all cycles that have it, and its true values there, in SI units."""
    pairs = [(getattr(measured, name), getattr(true, name)) for measured, true in cycles]
    known = [(value, true) for value, true in pairs if value is not None]
    return [value - true for value, true in known], [true for _, true in known]


def cells(
    sensors: str, cycles: Sequence[Cycle], label: str, name: str, unit: str, factor: float, digits: int
) -> list[str]:
    """Return the cells of a row of the table."""
    errors, values = errors_of(cycles, name)
    figures = ["-"] * 3
    if errors:
        bias = fsum(errors) / len(errors)
        spread = sqrt(fsum([(error - bias) ** 2 for error in errors]) / len(errors))
        figures = [f"{factor * one:.{digits}f}" for one in (fsum(values) / len(values), bias, spread)]
    return [sensors, f"{label}, {unit}", f"{len(errors)} of {len(cycles)}", *figures]


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    speeds = np.linspace(SLOWEST, FASTEST, options.runs).tolist()
    walks = [run_of(options.seed + number, speed) for number, speed in enumerate(speeds)]
    rows = []
    for sensors, with_cells in (("insoles", True), ("inertial only", False)):
        cycles = [cycle for walk in walks for cycle in score_run(walk, with_cells)]
        rows += [cells(sensors, cycles, *one) for one in ROWS]
    header = ("sensors", "measure", "cycles", "true mean", "mean error", "SD of the errors")
    print("\n".join(markdown.table(header, rows, left=2)))
    return 0
