"""The planner: it turns a route into the positions and times of strides.

All random numbers of the gait are drawn here, in the order of the steps."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from attrs import evolve

from ...types import Foot
from ..wearers.curves import Rng
from ..wearers.gait import SETTLE_TIME, Climb, PlannedStride, WalkPlan, Wearer
from .elevator import CarRide, Elevator, ride
from .escalator import PAUSE, Escalator, EscalatorRide, ride_escalator, ride_time
from .footfalls import Footfall, FootfallPlan
from .path import LEFT, RIGHT, Flight, Pose, Stand, Turn, WalkPath, stages
from .route import Route
from .styles import StrideKind, Style, style_of

HEIGHT_TOLERANCE = 1e-6
"""Difference in height below which two floors are the same, m."""
_MIN_FLAT_TIME, _MIN_PUSH_OFF_TIME = 0.04, 0.06
"""Least time from foot-flat to heel-off, and least time from heel-off to toe-off before a flight, s."""
FULL_STRIDE = 1.42
"""Length of a stride at 1.3 m/s, m. In shorter ones the foot pitches less; the exponents keep some pitch in half steps
and steps in place."""
SLIDE_SPEED_RATIO = 0.30
"""Forward speed of the heel over the ground just before contact, as a ratio to the walking speed."""
SINK_SPEED_RATIO = 0.13
"""Downward speed of the heel just before contact, as a ratio to the walking speed."""


def walking_style(wearer: Wearer, speed: float, reach: float) -> Style:
    """Return the parameters of a stride of walking at `speed` m/s whose length is `reach` of FULL_STRIDE.

    The share of double support is assumed."""
    shoe_speed = speed * min(reach, 1.0)
    return Style(
        double_support_share=float(np.clip(0.115 - 0.04 * (speed - 1.3), 0.05, 0.20)),
        heel_off_share=0.12,
        foot_flat_share=0.095,
        toe_off_pitch=wearer.toe_off_pitch * max(reach, 0.08) ** 0.55,
        strike_pitch=wearer.strike_pitch * max(reach, 0.05) ** 0.9,
        forward_speed=SLIDE_SPEED_RATIO * shoe_speed,
        sink_speed=SINK_SPEED_RATIO * shoe_speed,
        clearance=wearer.clearance,
    )


def plan(route: Route, wearer: Wearer, rng: Rng) -> WalkPlan:
    """Return the positions and times of the strides on `route`; `rng` draws all variations of the gait."""
    return _Planner(wearer, rng).run(route)


class _Planner:
    def __init__(self, wearer: Wearer, rng: Rng) -> None:
        self.wearer = wearer
        self.rng = rng
        self.footfalls = FootfallPlan(wearer, rng)
        self.t = 0.0
        self.next_foot = wearer.first_foot
        self.last_heel_strike: float | None = None  # None while standing
        self.bout_start = 0.0
        self.last_run: Style | None = None  # style of the last step if it was a running step
        self.flight: Flight | None = None  # flight of stairs that a foot is on
        self.climb_start: float | None = None  # time at which the climb started
        self.bouts: list[tuple[float, float]] = []
        self.climbs: list[Climb] = []
        self.rides: list[CarRide] = []
        self.escalators: list[EscalatorRide] = []
        origin = Pose(0.0, 0.0, 0.0, 0.0)
        self.feet = {foot: self._stance(origin, foot, 0.0, 0.0) for foot in Foot}
        self.starts = dict(self.feet)
        self.strides: dict[Foot, list[PlannedStride]] = {foot: [] for foot in Foot}

    def run(self, route: Route) -> WalkPlan:
        """Return the plan of all stages of a route."""
        for pose, stage in stages(route.actions):
            match stage:
                case WalkPath(pieces=(first, *_)):
                    if first.move.direction in (LEFT, RIGHT):
                        self._lead(Foot.LEFT if first.move.direction == LEFT else Foot.RIGHT)
                    self._walk(self.footfalls.on_path(stage))
                    continue
                case Turn():
                    self._walk(self.footfalls.in_turn(pose, stage))
                    continue
            self._halt()
            match stage:
                case Stand(duration=duration):
                    self.t += duration
                case Elevator(doors=doors):
                    car = ride(stage, self.t + doors, self.rng)
                    self.rides.append(car)
                    self.t = car.end + doors
                    self.feet = {foot: evolve(one, z=one.z + car.height) for foot, one in self.feet.items()}
                case Escalator():
                    start, end = self.t + PAUSE, self.t + PAUSE + ride_time(stage)
                    self.escalators.append(ride_escalator(stage, pose.heading, start, end, self.rng))
                    self.t = end + PAUSE
        self._halt()
        return WalkPlan(
            duration=self.t,
            starts=self.starts,
            strides={foot: tuple(made) for foot, made in self.strides.items()},
            bouts=tuple(self.bouts),
            climbs=tuple(self.climbs),
            rides=tuple(self.rides),
            escalators=tuple(self.escalators),
        )

    def _halt(self) -> None:
        if self.last_heel_strike is not None:
            self.t = self.last_heel_strike + SETTLE_TIME
            self.bouts.append((self.bout_start, self.t))
            self.last_heel_strike = None
            self.last_run = None

    def _lead(self, foot: Foot) -> None:
        """Let this foot make the next step; after a step of the same foot the wearer halts."""
        if foot is not self.next_foot:
            self._halt()
            self.next_foot = foot

    def _stance(self, pose: Pose, foot: Foot, width: float, turn: float) -> Pose:
        """Return the pose of a foot that stands beside `pose`; `width`, m, and `turn`, rad, move it outwards.

        On a ramp both feet are as high as `pose`, and toes that point outwards change nothing in the foot's slope."""
        side = 1.0 if foot is Foot.LEFT else -1.0
        offset = side * (0.5 * self.wearer.step_width + width)
        heading = pose.heading + side * (self.wearer.toe_out + turn)
        return Pose(
            pose.x - offset * sin(pose.heading), pose.y + offset * cos(pose.heading), pose.z, heading, pose.grade
        )

    def _walk(self, footfalls: list[Footfall]) -> None:
        for footfall in footfalls:
            step_time = footfall.duration * self.footfalls.vary(self.wearer.time_variation)
            if self.last_heel_strike is None:
                self.bout_start = self.t
                # The weight needs this time to leave the foot that moves first, as if the other foot had just landed.
                self.last_heel_strike = self.t + 0.32 * step_time
            foot = self.next_foot
            self.next_foot = Foot.RIGHT if foot is Foot.LEFT else Foot.LEFT
            self._stride(foot, footfall, self.last_heel_strike, step_time)
            self.last_heel_strike += step_time
            self.t = self.last_heel_strike

    def _stride(self, foot: Foot, footfall: Footfall, last_heel_strike: float, step_time: float) -> None:
        wearer, strides, vary = self.wearer, self.strides[foot], self.footfalls.vary
        start, kind = self.feet[foot], footfall.kind
        if footfall.flight is not None and footfall.flight is not self.flight:
            self.flight, self.climb_start = footfall.flight, None
        if self.flight is not None and abs(footfall.pose.z - start.z) > HEIGHT_TOLERANCE:
            kind = StrideKind.UP if footfall.pose.z > start.z else StrideKind.DOWN
        heel_off_factor, foot_flat_factor = vary(0.08), vary(0.06)
        lateral, toe_out, roll, yaw, outward = (float(value) for value in self.rng.standard_normal(5))
        end = self._stance(
            footfall.pose, foot, wearer.width_variation * lateral, 0.5 * wearer.angle_variation * toe_out
        )
        displacement = hypot(end.x - start.x, end.y - start.y)
        reach = min(displacement / FULL_STRIDE, 1.4)
        walking = walking_style(wearer, footfall.speed, reach)
        style = walking if kind is StrideKind.WALK else style_of(kind, footfall.speed)
        # A runner is in flight before the other foot lands; the first step of a run leaves the ground as in walking.
        leaving = self.last_run or (walking if kind is StrideKind.RUN else style)
        toe_off = last_heel_strike + leaving.double_support_share * 2.0 * step_time
        earliest = strides[-1].foot_flat + _MIN_FLAT_TIME if strides else 0.0
        heel_off = max(last_heel_strike - leaving.heel_off_share * 2.0 * step_time * heel_off_factor, earliest)
        if self.last_run is not None:
            toe_off = max(toe_off, heel_off + _MIN_PUSH_OFF_TIME)
        heel_strike = last_heel_strike + step_time
        side = 1.0 if foot is Foot.LEFT else -1.0
        swerve = side * wearer.swerve[0 if foot is Foot.LEFT else 1] * style.deviation_factor
        strides.append(
            PlannedStride(
                number=len(strides) + 1,
                heel_off=heel_off,
                toe_off=toe_off,
                heel_strike=heel_strike,
                foot_flat=heel_strike + style.foot_flat_share * 2.0 * step_time * foot_flat_factor,
                start=start,
                end=end,
                toe_off_pitch=style.toe_off_pitch * vary(wearer.angle_variation),
                strike_pitch=style.strike_pitch * vary(wearer.angle_variation),
                speed=footfall.speed * (min(reach, 1.0) if kind is StrideKind.WALK else 1.0),
                clearance=style.clearance * vary(0.08),
                deviation=(
                    swerve * (0.16 + 0.03 * roll),
                    -swerve * (0.10 + 0.02 * yaw),
                    side * (0.012 + 0.004 * outward),
                ),
                rest_pitch=wearer.rest_pitch * float(np.clip(self.rng.standard_normal(), -1.0, 1.0)),
                curvature=footfall.curvature,
                step_speed=0.5 * displacement / step_time,
                kind=kind,
                style=style,
                flight=self.flight if kind in (StrideKind.UP, StrideKind.DOWN) else None,
            )
        )
        self.feet[foot] = end
        self.last_run = style if kind is StrideKind.RUN else None
        self._end_climb(strides[-1])

    def _end_climb(self, stride: PlannedStride) -> None:
        """End the climb when both feet are on the floor after the flight."""
        flight = self.flight
        if flight is None:
            return
        if self.climb_start is None:
            self.climb_start = stride.toe_off
        if all(abs(pose.z - flight.z - flight.height) < HEIGHT_TOLERANCE for pose in self.feet.values()):
            climb = Climb(self.climb_start, stride.heel_strike, flight)
            self.climbs.append(climb)
            if flight.escalator is not None:
                moved = ride_escalator(flight.escalator, flight.heading, climb.start, climb.end, self.rng)
                self.escalators.append(moved)
            self.flight = None
