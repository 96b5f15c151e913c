"""The ground truth of a walk.

The position of a foot is always the position of the sensor that is mounted on it, relative to the position of that
sensor at t = 0, in the world frame (z up, x along the route's first heading, y left), m. `FootTruth.origin` is the
sensor's position at t = 0 relative to the point between the feet; with it both feet can be drawn on one floor."""

from __future__ import annotations

from itertools import groupby, pairwise
from math import atan2, cos, hypot, sin
from operator import itemgetter

import numpy as np
from attrs import evolve, frozen

from ...types import Activity, Foot, Phase, Vec3
from ..routes.elevator import CarRide
from ..routes.escalator import EscalatorRide
from ..routes.styles import StrideKind
from .curves import Array
from .gait import Climb, WalkPlan
from .motion import FootMotion, Kinematics
from .shoe import Mounting


def activities(plan: WalkPlan) -> tuple[tuple[float, float, Activity], ...]:
    """Return the activities (start, end, activity) from 0 to the plan's end, s, without a gap.

    A turn on the spot is walking. Who stands on an escalator stands, since there are neither strides nor an elevator,
    and who walks on one climbs stairs. A run lasts from the toe-off of its first stride to its last heel-strike."""
    overlapping = [(start, end, Activity.WALKING) for start, end in plan.bouts]
    overlapping += _running_spans(plan)
    for climb in plan.climbs:
        overlapping.append((climb.start, climb.end, Activity.STAIRS_UP if climb.up else Activity.STAIRS_DOWN))
    for car in plan.rides:
        overlapping.append((car.start, car.end, Activity.ELEVATOR_UP if car.height > 0.0 else Activity.ELEVATOR_DOWN))
    boundaries = sorted({0.0, plan.duration, *(t for start, end, _ in overlapping for t in (start, end))})

    def activity_in(span: tuple[float, float]) -> Activity:
        """Return the activity between two boundaries; later spans are more specific and replace earlier ones."""
        middle = 0.5 * (span[0] + span[1])
        return next((a for b, e, a in reversed(overlapping) if b <= middle < e), Activity.STANDING)

    found = [(activity, list(spans)) for activity, spans in groupby(pairwise(boundaries), activity_in)]
    return tuple([(spans[0][0], spans[-1][1], activity) for activity, spans in found])


def _running_spans(plan: WalkPlan) -> list[tuple[float, float, Activity]]:
    strides = sorted((s.heel_strike, s.toe_off, s.kind is StrideKind.RUN) for foot in Foot for s in plan.strides[foot])
    runs = [list(one) for is_running, one in groupby(strides, itemgetter(2)) if is_running]
    return [(run[0][1], run[-1][0], Activity.RUNNING) for run in runs]


@frozen
class TrueStride:
    """A true stride of one foot, from one foot-flat to its next; the first stride starts at t = 0."""

    foot: Foot
    """Foot that made the stride."""
    number: int
    """Number of this stride among those of the foot, from 1."""
    t_start: float
    """Foot-flat before the stride, s; 0 for the first stride."""
    t_end: float
    """Foot-flat after the stride, s."""
    t_heel_off: float
    """Time of heel-off, s."""
    t_toe_off: float
    """Time of toe-off, s."""
    t_heel_strike: float
    """Time of heel-strike, s."""
    displacement: Vec3
    """Displacement of the sensor over the stride in the world frame, m."""
    length: float
    """Horizontal length of the displacement, m."""
    heading_change: float
    """Change of the foot's heading over the stride, rad, in (-pi, pi]; positive to the left."""


@frozen(eq=False)
class FootTruth:
    """The ground truth of one foot; the time before the first stride has no events."""

    foot: Foot
    """Foot that the truth is about."""
    heel_strikes: tuple[float, ...]
    """True times of the heel-strikes, s."""
    foot_flats: tuple[float, ...]
    """True times of the foot-flats, s."""
    heel_offs: tuple[float, ...]
    """True times of the heel-offs, s."""
    toe_offs: tuple[float, ...]
    """True times of the toe-offs, s."""
    strides: tuple[TrueStride, ...]
    """True strides of the foot."""
    origin: Vec3
    """Position of the sensor at t = 0 relative to the point between the feet, world frame, m."""
    motion: FootMotion
    """Exact motion of the foot."""
    mounting: Mounting
    """Mounting of the sensor."""

    def pose(self, t: Array | float) -> Kinematics:
        """Return the motion of the sensor at `t`, s; the position is relative to that at t = 0, world frame, m."""
        kinematics = self.motion.at(np.atleast_1d(np.asarray(t, dtype=np.float64)), self.mounting)
        return evolve(kinematics, position=kinematics.position - np.array(self.origin))

    def phases(self, t: Array | float) -> list[Phase]:
        """Return the phase of the foot at times `t`, s."""
        return self.motion.phases(np.atleast_1d(np.asarray(t, dtype=np.float64)))


@frozen(eq=False)
class Truth:
    """The ground truth of a whole walk."""

    duration: float
    """Duration of the walk, s."""
    feet: dict[Foot, FootTruth]
    """Ground truth of each foot."""
    activities: tuple[tuple[float, float, Activity], ...]
    """Start, s, end, s, and kind of each activity of the wearer, in order and without a gap."""
    flights: tuple[Climb, ...]
    """Flights of stairs that the wearer walked, in order."""
    rides: tuple[CarRide, ...]
    """Elevator rides of the wearer, in order."""
    escalators: tuple[EscalatorRide, ...]
    """Rides on escalators, in order; a flight that is walked on one is also among `flights`."""
    plan: WalkPlan
    """Plan of the walk."""

    def pose(self, foot: Foot, t: Array | float) -> Kinematics:
        """Return the motion of a foot's sensor at `t`, s; the position is relative to that at t = 0, world, m."""
        return self.feet[foot].pose(t)

    def strides(self, foot: Foot) -> tuple[TrueStride, ...]:
        """Return the true strides of a foot."""
        return self.feet[foot].strides

    def activity(self, t: float) -> Activity:
        """Return the activity of the wearer at `t` s."""
        return next((activity for start, end, activity in self.activities if start <= t < end), Activity.STANDING)

    def elevation(self, t: Array | float) -> Array:
        """Return the height of the wearer relative to t = 0 at times `t`, m, (N).

        It is the mean height of the floors or treads under both feet. For a foot in swing the height is interpolated
        linearly in time."""
        t = np.atleast_1d(np.asarray(t, dtype=np.float64))
        total = np.zeros(len(t))
        for foot in Foot:
            times, heights = [0.0], [0.0]
            for stride in self.plan.strides[foot]:
                times += [stride.toe_off, stride.heel_strike]
                heights += [heights[-1], heights[-1] + stride.end.z - stride.start.z]
            total += 0.5 * np.interp(t, times, heights)
        for car in self.plan.rides:
            total += car.at(t)[0][:, 2]
        return np.asarray(total + self.plan.ground_shift(t)[:, 2])


def foot_truth(foot: Foot, plan: WalkPlan, motion: FootMotion, mounting: Mounting) -> FootTruth:
    """Return the ground truth of one foot for a sensor with this mounting."""
    strides = plan.strides[foot]
    boundaries = np.array([0.0, *(stride.foot_flat for stride in strides)])
    positions = motion.at(boundaries, mounting).position
    true_strides = []
    for k, stride in enumerate(strides):
        dx, dy, dz = (float(v) for v in positions[k + 1] - positions[k])
        turn = stride.end.heading - stride.start.heading
        true_strides.append(
            TrueStride(
                foot=foot,
                number=k + 1,
                t_start=float(boundaries[k]),
                t_end=float(boundaries[k + 1]),
                t_heel_off=stride.heel_off,
                t_toe_off=stride.toe_off,
                t_heel_strike=stride.heel_strike,
                displacement=(dx, dy, dz),
                length=hypot(dx, dy),
                heading_change=atan2(sin(turn), cos(turn)),
            )
        )
    x, y, z = (float(v) for v in positions[0])
    return FootTruth(
        foot=foot,
        heel_strikes=tuple(s.heel_strike for s in strides),
        foot_flats=tuple(s.foot_flat for s in strides),
        heel_offs=tuple(s.heel_off for s in strides),
        toe_offs=tuple(s.toe_off for s in strides),
        strides=tuple(true_strides),
        origin=(x, y, z),
        motion=motion,
        mounting=mounting,
    )
