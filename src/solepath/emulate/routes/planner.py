"""The planner: it turns a route into the positions and times of strides.

All random numbers of the gait are drawn here, in the order of the steps."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from attrs import evolve, frozen

from ...types import Foot
from ..wearers.curves import Rng
from ..wearers.gait import SETTLE_TIME, Climb, PlannedStride, WalkPlan, Wearer, double_support
from .lift import CarRide, ride
from .path import Flight, Lifted, Piece, Pivot, Pose, WalkPath
from .route import Leg, Route, Stand, legs
from .styles import StrideKind, running_cadence, style_of

SAME_LEVEL = 1e-6
"""Difference in height below which two floors are the same, m."""


def plan(route: Route, wearer: Wearer, rng: Rng) -> WalkPlan:
    """Plan the positions and times of the strides on `route`; `rng` draws all variations of the gait."""
    return _Planner(wearer, rng).run(legs(route))


@frozen
class _Footfall:
    """One planned step before its timing."""

    pose: Pose
    """Pose on the path."""
    speed: float
    """Speed along the path, m/s."""
    duration: float
    """Mean duration of the step, s."""
    curvature: float = 0.0
    """Curvature of the path there, 1/m; positive to the left."""
    kind: StrideKind = StrideKind.WALK
    flight: Flight | None = None


class _Planner:
    def __init__(self, wearer: Wearer, rng: Rng) -> None:
        self.wearer = wearer
        self.rng = rng
        self.t = 0.0
        self.moving = wearer.first_foot  # the foot that moves next
        self.struck: float | None = None  # time of the last heel-strike; None while standing
        self.bout_start = 0.0
        self.running: float | None = None  # speed of the last step if it was a running step
        self.flight: Flight | None = None  # flight of stairs that a foot is on
        self.climbing: float | None = None  # time at which the climb started
        self.bouts: list[tuple[float, float]] = []
        self.climbs: list[Climb] = []
        self.rides: list[CarRide] = []
        origin = Pose(0.0, 0.0, 0.0, 0.0)
        self.at = {foot: self._stance(origin, foot, 0.0, 0.0) for foot in Foot}
        self.starts = dict(self.at)
        self.strides: dict[Foot, list[PlannedStride]] = {foot: [] for foot in Foot}

    def run(self, todo: list[Leg]) -> WalkPlan:
        """Return the plan of all legs of a route."""
        for leg in todo:
            match leg:
                case Stand(duration=duration):
                    self._halt()
                    self.t += duration
                case WalkPath():
                    self._walk(self._along(leg))
                case Pivot():
                    self._walk(self._on_the_spot(leg))
                case Lifted():
                    self._halt()
                    self._ride(leg)
        self._halt()
        strides = {foot: tuple(found) for foot, found in self.strides.items()}
        return WalkPlan(self.t, self.starts, strides, tuple(self.bouts), tuple(self.climbs), tuple(self.rides))

    def _ride(self, leg: Lifted) -> None:
        """Add a ride: the doors close, the car moves, the doors open."""
        car = ride(leg.lift, self.t + leg.lift.doors, self.rng)
        self.rides.append(car)
        self.t = car.end + leg.lift.doors
        self.at = {foot: evolve(at, z=at.z + car.height) for foot, at in self.at.items()}

    def _halt(self) -> None:
        if self.struck is not None:
            self.t = self.struck + SETTLE_TIME
            self.bouts.append((self.bout_start, self.t))
            self.struck = None
            self.running = None

    def _along(self, path: WalkPath) -> list[_Footfall]:
        """Return the steps of a path, section by section, and a closing half step."""
        falls: list[_Footfall] = []
        for section in path.sections:
            piece = section.pieces[0]
            if piece.flight is not None:
                falls += self._on_stairs(piece, piece.flight)
            elif section.spacing is not None:
                falls += self._on_marks(section, section.spacing)
            else:
                falls += self._naturally(section)
        # The closing half step: beside the foot that arrived.
        return [*falls, evolve(falls[-1], kind=StrideKind.WALK)]

    def _naturally(self, path: WalkPath) -> list[_Footfall]:
        """Return steps of natural length with random variation, scaled to end exactly at the path's end."""
        ends: list[float] = []
        s = 0.0
        while not ends or ends[-1] < path.length:
            speed, running = path.pace(min(s, path.length))
            usual = (
                speed * 60.0 / running_cadence(speed)
                if running
                else self.wearer.walk_ratio * self.wearer.cadence(speed)
            )
            s += usual * self._vary(self.wearer.length_variation)
            ends.append(s)
        if len(ends) > 1 and ends[-1] - path.length > path.length - ends[-2]:
            ends.pop()
        fit = path.length / ends[-1]
        falls = []
        for end in (fit * end for end in ends):
            pose = path.at(end)[0]
            speed, running = path.pace(end)
            usual = 60.0 / running_cadence(speed) if running else 60.0 / self.wearer.cadence(speed)
            kind = StrideKind.RUN if running else StrideKind.WALK
            falls.append(_Footfall(pose, speed, usual, path.curvature(end), kind))
        return falls

    def _on_marks(self, path: WalkPath, spacing: float) -> list[_Footfall]:
        count = max(1, round(path.length / spacing))
        each = path.length / count
        falls = []
        for k in range(1, count + 1):
            _, speed = path.at(each * k)
            hit = each * k + self.wearer.mark_error * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))
            falls.append(_Footfall(path.at(hit)[0], speed, each / speed, path.curvature(each * k)))
        return falls

    def _on_stairs(self, piece: Piece, flight: Flight) -> list[_Footfall]:
        """Return one step for every riser."""
        kind = StrideKind.UP if flight.rise > 0.0 else StrideKind.DOWN
        falls = []
        for k in range(1, flight.steps + 1):
            hit = flight.going * k + self.wearer.mark_error * float(np.clip(self.rng.standard_normal(), -2.0, 2.0))
            pose = evolve(piece.start.ahead(hit, 0.0), z=flight.z + flight.rise * k)
            duration = flight.going / piece.speed
            falls.append(_Footfall(pose, piece.speed, duration, 0.0, kind, flight))
        return falls

    def _on_the_spot(self, pivot: Pivot) -> list[_Footfall]:
        count = max(1, int(np.ceil(abs(pivot.angle) / self.wearer.max_pivot_turn)))
        turned = [pivot.angle * k / count for k in range(1, count + 1)]
        duration = 60.0 / self.wearer.cadence(pivot.speed)
        falls = [_Footfall(evolve(pivot.start, heading=pivot.start.heading + a), pivot.speed, duration) for a in turned]
        return [*falls, falls[-1]]

    def _stance(self, pose: Pose, foot: Foot, width: float, turned: float) -> Pose:
        side = 1.0 if foot is Foot.LEFT else -1.0
        out = side * (0.5 * self.wearer.step_width + width)
        heading = pose.heading + side * (self.wearer.toe_out + turned)
        return Pose(pose.x - out * sin(pose.heading), pose.y + out * cos(pose.heading), pose.z, heading)

    def _walk(self, falls: list[_Footfall]) -> None:
        for fall in falls:
            step = fall.duration * self._vary(self.wearer.time_variation)
            if self.struck is None:
                self.bout_start = self.t
                # As if the other foot had just landed: the weight needs this time to leave the foot that moves first.
                self.struck = self.t + 0.32 * step
            foot = self.moving
            self.moving = Foot.RIGHT if foot is Foot.LEFT else Foot.LEFT
            self._stride(foot, fall, self.struck, step)
            self.struck += step
            self.t = self.struck

    def _stride(self, foot: Foot, fall: _Footfall, struck: float, step: float) -> None:
        wearer, before = self.wearer, self.strides[foot]
        start = self.at[foot]
        kind = fall.kind
        if fall.flight is not None and fall.flight is not self.flight:
            self.flight, self.climbing = fall.flight, None
        if abs(fall.pose.z - start.z) > SAME_LEVEL:
            kind = StrideKind.UP if fall.pose.z > start.z else StrideKind.DOWN
        style = None if kind is StrideKind.WALK else style_of(kind, fall.speed)
        double, early, flat = double_support(fall.speed), 0.12, 0.095
        if style is not None:
            flat = style.flat
            if kind is not StrideKind.RUN:
                double, early = style.double, style.early
        if self.running is not None:
            # A runner is in flight before the other foot lands.
            run = style_of(StrideKind.RUN, self.running)
            double, early = run.double, run.early
        toe_off = struck + double * 2.0 * step
        earliest = before[-1].foot_flat + 0.04 if before else 0.0
        heel_off = max(struck - early * 2.0 * step * self._vary(0.08), earliest)
        if self.running is not None:
            toe_off = max(toe_off, heel_off + 0.06)
        heel_strike = struck + step
        foot_flat = heel_strike + flat * 2.0 * step * self._vary(0.06)
        width, out = (float(value) for value in self.rng.standard_normal(2))
        end = self._stance(fall.pose, foot, wearer.width_variation * width, 0.5 * wearer.angle_variation * out)
        # In short steps the foot rolls less; the exponents keep enough roll in half steps and steps in place.
        moved = hypot(end.x - start.x, end.y - start.y)
        reach = min(moved / 1.42, 1.4)
        roll, yaw, outward = (float(value) for value in self.rng.standard_normal(3))
        side = 1.0 if foot is Foot.LEFT else -1.0
        deviation = (side * (0.16 + 0.03 * roll), -side * (0.10 + 0.02 * yaw), side * (0.012 + 0.004 * outward))
        if style is not None:
            deviation = (style.deviation_factor * deviation[0], style.deviation_factor * deviation[1], deviation[2])
        leave = wearer.toe_off_pitch * max(reach, 0.08) ** 0.55 if style is None else style.toe_off_pitch
        strike = wearer.strike_pitch * max(reach, 0.05) ** 0.9 if style is None else style.strike_pitch
        before.append(
            PlannedStride(
                number=len(before) + 1,
                heel_off=heel_off,
                toe_off=toe_off,
                heel_strike=heel_strike,
                foot_flat=foot_flat,
                start=start,
                end=end,
                toe_off_pitch=leave * self._vary(wearer.angle_variation),
                strike_pitch=strike * self._vary(wearer.angle_variation),
                speed=fall.speed * min(reach, 1.0) if style is None else fall.speed,
                clearance=(wearer.clearance if style is None else style.clearance) * self._vary(0.08),
                deviation=deviation,
                rest_pitch=4e-4 * float(np.clip(self.rng.standard_normal(), -1.0, 1.0)),
                curvature=fall.curvature,
                step_speed=0.5 * moved / step,
                kind=kind,
                flight=self.flight if kind in (StrideKind.UP, StrideKind.DOWN) else None,
            )
        )
        self.at[foot] = end
        self.running = fall.speed if kind is StrideKind.RUN else None
        self._step_off(before[-1])

    def _step_off(self, stride: PlannedStride) -> None:
        """End the climb when both feet are beyond the flight."""
        flight = self.flight
        if flight is None:
            return
        if self.climbing is None:
            self.climbing = stride.toe_off
        if all(abs(at.z - flight.z - flight.height) < SAME_LEVEL for at in self.at.values()):
            self.climbs.append(Climb(self.climbing, stride.heel_strike, flight))
            self.flight = None

    def _vary(self, sigma: float) -> float:
        """Return a random factor about 1, limited to three sigma."""
        return 1.0 + sigma * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))
