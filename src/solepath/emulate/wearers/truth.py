"""What really happened, for comparing with.

"Position of a foot" is everywhere the position of the sensor that is mounted on it, relative to where that sensor was
at t = 0, in the world frame (z up, x along the route's first heading, y left), m. `FootTruth.origin` says where that
was, measured from the point between the feet, so that both feet can be drawn on one floor.
"""

from __future__ import annotations

from math import atan2, cos, hypot, sin

import numpy as np
from attrs import evolve, frozen

from ...types import Activity, Foot, Phase, Vec3
from ..routes.lift import CarRide
from ..routes.styles import StrideKind
from .curves import Array
from .gait import Climb, WalkPlan
from .motion import FootMotion, Kinematics
from .shoe import Mounting


def activities(plan: WalkPlan) -> tuple[tuple[float, float, Activity], ...]:
    """One after the other from 0 to the plan's end. Turning on the spot is walking. Running lasts from where its first
    swing begins to where its last foot comes down, so that stretches of walking in between count as walking."""
    found = [(start, end, Activity.WALKING) for start, end in plan.bouts]
    found += _runs(plan)
    for climb in plan.climbs:
        found.append((climb.start, climb.end, Activity.STAIRS_UP if climb.up else Activity.STAIRS_DOWN))
    for car in plan.rides:
        found.append((car.start, car.end, Activity.ELEVATOR_UP if car.height > 0.0 else Activity.ELEVATOR_DOWN))
    found_spans: list[tuple[float, float, Activity]] = []
    marks = sorted({0.0, plan.duration, *(t for start, end, _ in found for t in (start, end))})
    for start, end in zip(marks, marks[1:], strict=False):
        middle = 0.5 * (start + end)
        # What is told later is more special.
        what = next((a for b, e, a in reversed(found) if b <= middle < e), Activity.STANDING)
        if found_spans and found_spans[-1][2] is what:
            found_spans[-1] = (found_spans[-1][0], end, what)
        else:
            found_spans.append((start, end, what))
    return tuple(found_spans)


def _runs(plan: WalkPlan) -> list[tuple[float, float, Activity]]:
    steps = sorted((s.heel_strike, s.toe_off, s.kind is StrideKind.RUN) for foot in Foot for s in plan.strides[foot])
    found: list[tuple[float, float, Activity]] = []
    running = False
    for strike, off, run in steps:
        if run and running:
            found[-1] = (found[-1][0], strike, Activity.RUNNING)
        elif run:
            found.append((off, strike, Activity.RUNNING))
        running = run
    return found


@frozen
class TrueStride:
    """One foot from foot-flat to its next foot-flat; for the first step from t = 0, when it stood already."""

    foot: Foot
    number: int
    t_start: float
    t_end: float
    t_heel_off: float
    t_toe_off: float
    t_heel_strike: float
    displacement: Vec3
    """Of the sensor, m."""
    length: float
    """Horizontal, m."""
    heading_change: float
    """rad, in (-pi, pi]."""


@frozen(eq=False)
class FootTruth:
    """One foot. Times are true times, s; the stand before the first step has no events."""

    foot: Foot
    heel_strikes: tuple[float, ...]
    foot_flats: tuple[float, ...]
    heel_offs: tuple[float, ...]
    toe_offs: tuple[float, ...]
    steps: tuple[TrueStride, ...]
    origin: Vec3
    motion: FootMotion
    mounting: Mounting

    def pose(self, t: Array | float) -> Kinematics:
        """Everything about the sensor at any instants, its position relative to the first one."""
        found = self.motion.at(np.atleast_1d(np.asarray(t, dtype=np.float64)), self.mounting)
        return evolve(found, position=found.position - np.array(self.origin))

    def phases(self, t: Array | float) -> list[Phase]:
        return self.motion.phases(np.atleast_1d(np.asarray(t, dtype=np.float64)))


@frozen(eq=False)
class Truth:
    """The whole walk: `duration` in s.

    `activities`: what the wearer does from when to when, s, without a gap. `flights` and `rides` are the stairs that
    were walked and the lifts that were taken, in order.
    """

    duration: float
    feet: dict[Foot, FootTruth]
    activities: tuple[tuple[float, float, Activity], ...]
    flights: tuple[Climb, ...]
    rides: tuple[CarRide, ...]
    plan: WalkPlan

    def pose(self, foot: Foot, t: Array | float) -> Kinematics:
        """Everything about a foot's sensor at any instants, its position relative to the foot's first."""
        return self.feet[foot].pose(t)

    def steps(self, foot: Foot) -> tuple[TrueStride, ...]:
        return self.feet[foot].steps

    def activity(self, t: float) -> Activity:
        """What the wearer does at `t` s."""
        return next((what for start, end, what in self.activities if start <= t < end), Activity.STANDING)

    def elevation(self, t: Array | float) -> Array:
        """How much higher than at t = 0 the wearer is at instants `t`, (N), m: the mean of the floors or treads that
        both feet stand on, between which a foot in the air goes evenly."""
        t = np.atleast_1d(np.asarray(t, dtype=np.float64))
        total = np.zeros(len(t))
        for foot in Foot:
            when, climbed = [0.0], [0.0]
            for stride in self.plan.strides[foot]:
                when += [stride.toe_off, stride.heel_strike]
                climbed += [climbed[-1], climbed[-1] + stride.end.z - stride.start.z]
            total += 0.5 * np.interp(t, when, climbed)
        for car in self.plan.rides:
            total += car.at(t)[0][:, 2]
        return total


def foot_truth(foot: Foot, plan: WalkPlan, motion: FootMotion, mounting: Mounting) -> FootTruth:
    """The truth of one foot for a sensor mounted like this."""
    strides = plan.strides[foot]
    marks = np.array([0.0, *(stride.foot_flat for stride in strides)])
    places = motion.at(marks, mounting).position
    steps = []
    for k, stride in enumerate(strides):
        dx, dy, dz = (float(v) for v in places[k + 1] - places[k])
        turned = stride.end.heading - stride.start.heading
        steps.append(
            TrueStride(
                foot=foot,
                number=k + 1,
                t_start=float(marks[k]),
                t_end=float(marks[k + 1]),
                t_heel_off=stride.heel_off,
                t_toe_off=stride.toe_off,
                t_heel_strike=stride.heel_strike,
                displacement=(dx, dy, dz),
                length=hypot(dx, dy),
                heading_change=atan2(sin(turned), cos(turned)),
            )
        )
    x, y, z = (float(v) for v in places[0])
    return FootTruth(
        foot=foot,
        heel_strikes=tuple(s.heel_strike for s in strides),
        foot_flats=tuple(s.foot_flat for s in strides),
        heel_offs=tuple(s.heel_off for s in strides),
        toe_offs=tuple(s.toe_off for s in strides),
        steps=tuple(steps),
        origin=(x, y, z),
        motion=motion,
        mounting=mounting,
    )
