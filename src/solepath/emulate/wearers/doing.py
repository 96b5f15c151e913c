"""What the wearer of a plan does at any time, and how high up."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Activity, Foot
from ..routes.styles import Manner
from .curves import Array
from .gait import WalkPlan


@frozen
class TrueFlight:
    """A flight from when the first foot leaves the one floor until both are on the other, s. `steps`: its risers;
    `height`: from floor to floor, m, negative down."""

    t_start: float
    t_end: float
    up: bool
    steps: int
    height: float


@frozen
class TrueRide:
    """A ride from when the car moves until it stands, s; `height` in m, negative down."""

    t_start: float
    t_end: float
    height: float


def flights(plan: WalkPlan) -> tuple[TrueFlight, ...]:
    return tuple(
        TrueFlight(climb.begin, climb.end, climb.flight.rise > 0.0, climb.flight.steps, climb.flight.height)
        for climb in plan.climbs
    )


def rides(plan: WalkPlan) -> tuple[TrueRide, ...]:
    return tuple(TrueRide(car.begin, car.end, car.height) for car in plan.rides)


def activities(plan: WalkPlan) -> tuple[tuple[float, float, Activity], ...]:
    """One after the other from 0 to the plan's end. Turning on the spot is walking. Running lasts from where its first
    swing begins to where its last foot comes down, so that stretches of walking in between count as walking."""
    found = [(begin, end, Activity.WALKING) for begin, end in plan.bouts]
    found += _runs(plan)
    for climb in plan.climbs:
        found.append((climb.begin, climb.end, Activity.STAIRS_UP if climb.flight.rise > 0.0 else Activity.STAIRS_DOWN))
    for car in plan.rides:
        found.append((car.begin, car.end, Activity.ELEVATOR_UP if car.height > 0.0 else Activity.ELEVATOR_DOWN))
    told: list[tuple[float, float, Activity]] = []
    marks = sorted({0.0, plan.duration, *(t for begin, end, _ in found for t in (begin, end))})
    for begin, end in zip(marks, marks[1:], strict=False):
        middle = 0.5 * (begin + end)
        # What is told later is more special.
        what = next((a for b, e, a in reversed(found) if b <= middle < e), Activity.STANDING)
        if told and told[-1][2] is what:
            told[-1] = (told[-1][0], end, what)
        else:
            told.append((begin, end, what))
    return tuple(told)


def _runs(plan: WalkPlan) -> list[tuple[float, float, Activity]]:
    steps = sorted((s.heel_strike, s.toe_off, s.manner is Manner.RUN) for foot in Foot for s in plan.strides[foot])
    found: list[tuple[float, float, Activity]] = []
    running = False
    for strike, off, run in steps:
        if run and running:
            found[-1] = (found[-1][0], strike, Activity.RUNNING)
        elif run:
            found.append((off, strike, Activity.RUNNING))
        running = run
    return found


def elevation(plan: WalkPlan, t: Array) -> Array:
    """How much higher than at t = 0 the wearer is, m: the mean of what both feet stand on."""
    total = np.zeros(len(t))
    for foot in Foot:
        when, climbed = [0.0], [0.0]
        for stride in plan.strides[foot]:
            when += [stride.toe_off, stride.heel_strike]
            climbed += [climbed[-1], climbed[-1] + stride.end.z - stride.start.z]
        total += 0.5 * np.interp(t, when, climbed)
    for car in plan.rides:
        total += car.at(t)[0][:, 2]
    return total
