"""When and where each foot goes: a route becomes strides with their four event times.

Timing follows level walking of healthy adults: cadence from speed by a constant walk ratio (step length over cadence,
about 0.0064 m per step/min; Sekiya and Nagasaki 1998, Gait & Posture 7), stance about 60 % and double support twice
about 11 % of the stride at 1.3 m/s, foot-flat at about 9 % and heel-off at about 38 % of it (Perry, Gait Analysis,
1992). Running is the same scheme with a negative double support.
"""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from attrs import evolve, frozen

from ..calibration import Limbs
from ..types import Foot
from .route import Leg, Path, Pivot, Pose, Route, Stand, legs
from .shoe import Shoe

SETTLING = 0.45
"""How long the weight takes to come to rest on two feet, and to roll on in a foot that has stood, s."""


@frozen
class Wearer:
    """Who walks. SI units; angles in rad; the variabilities are standard deviations relative to the mean."""

    mass: float = 75.0
    shoe: Shoe = Shoe()
    step_width: float = 0.14
    """Between the ankles' tracks, m."""
    toe_out: float = 0.12
    """Outward turn of each foot from the path, rad (7 degrees)."""
    walk_ratio: float = 0.0064
    """Step length over cadence, m per step/min."""
    strike_pitch: float = 0.37
    """Toe-up pitch at heel-strike of a full stride at 1.3 m/s, rad."""
    toe_off_pitch: float = 1.02
    """Heel-up pitch at toe-off of a full stride at 1.3 m/s, rad."""
    clearance: float = 0.018
    """Least height of the sole in mid-swing, m."""
    pivot_step: float = 0.7
    """Largest turn of one step on the spot, rad."""
    first: Foot = Foot.LEFT
    length_variation: float = 0.025
    time_variation: float = 0.018
    width_variation: float = 0.012
    """m."""
    angle_variation: float = 0.035
    """Of pitch angles (relative); toe-out varies by half of this in rad."""
    load_variation: float = 0.0
    """How far the load's place across the foot differs from step to step, m."""
    aim: float = 0.01
    """How far along the path a foot misses the mark that it is to step on, m (assumed)."""
    centre_height: float = 0.97
    """Of the body's centre of mass, m: 0.555 of a stature of 1.75 m (Winter, Biomechanics and Motor Control of Human
    Movement, 2009)."""
    limbs: Limbs = Limbs()


@frozen
class Stance:
    """Where a foot stands flat: the ground point under the ankle, m, and the yaw of the foot, rad (not wrapped)."""

    x: float
    y: float
    z: float
    yaw: float


@frozen
class Stride:
    """One foot from one place to the next. Times in s: it leaves with `heel_off` and `toe_off`, and lands with
    `heel_strike` and `foot_flat`."""

    number: int
    heel_off: float
    toe_off: float
    heel_strike: float
    foot_flat: float
    start: Stance
    end: Stance
    toe_off_pitch: float
    """Heel-up, positive, rad."""
    strike_pitch: float
    """Toe-up, positive, rad."""
    speed: float
    """Of the body along the path, m/s."""
    clearance: float
    weave: tuple[float, float, float]
    """Of the swing: roll in rad, yaw in rad, and outward swing in m; the largest deviation of each."""
    settle: float
    """How much the foot rocks during the stance that follows, rad."""
    curvature: float
    """Of the path where the foot comes down, 1/m; positive to the left."""
    pace: float
    """Of the body over this step, m/s: half of the foot's way in the step's time."""


@frozen
class Plan:
    """Everything that is decided before a foot moves."""

    duration: float
    starts: dict[Foot, Stance]
    strides: dict[Foot, tuple[Stride, ...]]
    bouts: tuple[tuple[float, float], ...]
    """When walking begins and when the closing foot is down, for each stretch between stands, s."""


def plan(route: Route, wearer: Wearer, rng: np.random.Generator) -> Plan:
    """Lay out the footfalls of `route` and time them; all randomness of the gait is drawn here."""
    return _Planner(wearer, rng).run(legs(route))


@frozen
class _Footfall:
    """One step to come: the place on the path, the speed, how far the path advances in it, how long it usually takes
    (s), and how the path bends there (1/m)."""

    pose: Pose
    speed: float
    advance: float
    duration: float
    curvature: float = 0.0


class _Planner:
    def __init__(self, wearer: Wearer, rng: np.random.Generator) -> None:
        self.wearer = wearer
        self.rng = rng
        self.t = 0.0
        self.moving = wearer.first  # the foot that goes next
        self.struck: float | None = None  # the last heel-strike while walking goes on; None while standing
        self.began = 0.0
        self.bouts: list[tuple[float, float]] = []
        origin = Pose(0.0, 0.0, 0.0, 0.0)
        self.at = {foot: self._stance(origin, foot, 0.0, 0.0) for foot in Foot}
        self.starts = dict(self.at)
        self.strides: dict[Foot, list[Stride]] = {foot: [] for foot in Foot}

    def run(self, todo: list[Leg]) -> Plan:
        for leg in todo:
            match leg:
                case Stand(duration=duration):
                    self._halt()
                    self.t += duration
                case Path():
                    self._walk(self._along(leg))
                case Pivot():
                    self._walk(self._on_the_spot(leg))
        self._halt()
        strides = {foot: tuple(found) for foot, found in self.strides.items()}
        return Plan(self.t, self.starts, strides, tuple(self.bouts))

    def _halt(self) -> None:
        if self.struck is not None:
            self.t = self.struck + SETTLING
            self.bouts.append((self.began, self.t))
            self.struck = None

    # --- where ------------------------------------------------------------------------------------------------------

    def _along(self, path: Path) -> list[_Footfall]:
        """Steps of natural length with a few per cent of variation, stretched to end exactly at the path's end; or one
        step for every mark."""
        if path.spacing is not None:
            return self._on_marks(path, path.spacing)
        ends: list[float] = []
        s = 0.0
        while not ends or ends[-1] < path.length:
            _, speed = path.at(min(s, path.length))
            s += step_length(speed, self.wearer) * self._vary(self.wearer.length_variation)
            ends.append(s)
        if len(ends) > 1 and ends[-1] - path.length > path.length - ends[-2]:
            ends.pop()
        fit = path.length / ends[-1]
        falls = []
        before = 0.0
        for end in (fit * end for end in ends):
            pose, speed = path.at(end)
            falls.append(_Footfall(pose, speed, end - before, step_time(speed, self.wearer), path.curvature(end)))
            before = end
        return [*falls, _closing(falls[-1])]

    def _on_marks(self, path: Path, spacing: float) -> list[_Footfall]:
        count = max(1, round(path.length / spacing))
        each = path.length / count
        falls = []
        for k in range(1, count + 1):
            _, speed = path.at(each * k)
            hit = each * k + self.wearer.aim * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))
            falls.append(_Footfall(path.at(hit)[0], speed, each, each / speed, path.curvature(each * k)))
        return [*falls, _closing(falls[-1])]

    def _on_the_spot(self, pivot: Pivot) -> list[_Footfall]:
        count = max(1, int(np.ceil(abs(pivot.angle) / self.wearer.pivot_step)))
        turned = [pivot.angle * k / count for k in range(1, count + 1)]
        duration = step_time(pivot.speed, self.wearer)
        falls = [
            _Footfall(evolve(pivot.start, heading=pivot.start.heading + a), pivot.speed, 0.0, duration) for a in turned
        ]
        return [*falls, falls[-1]]

    def _stance(self, pose: Pose, foot: Foot, width: float, turned: float) -> Stance:
        side = 1.0 if foot is Foot.LEFT else -1.0
        out = side * (0.5 * self.wearer.step_width + width)
        yaw = pose.heading + side * (self.wearer.toe_out + turned)
        return Stance(pose.x - out * sin(pose.heading), pose.y + out * cos(pose.heading), pose.z, yaw)

    # --- when -------------------------------------------------------------------------------------------------------

    def _walk(self, falls: list[_Footfall]) -> None:
        for fall in falls:
            step = fall.duration * self._vary(self.wearer.time_variation)
            if self.struck is None:
                self.began = self.t
                # As if the other foot had just landed: the weight needs that long to leave the foot that goes first.
                self.struck = self.t + 0.32 * step
            foot = self.moving
            self.moving = Foot.RIGHT if foot is Foot.LEFT else Foot.LEFT
            self._stride(foot, fall, self.struck, step)
            self.struck += step
            self.t = self.struck

    def _stride(self, foot: Foot, fall: _Footfall, struck: float, step: float) -> None:
        wearer, before = self.wearer, self.strides[foot]
        toe_off = struck + double_support(fall.speed) * 2.0 * step
        earliest = before[-1].foot_flat + 0.04 if before else 0.0
        heel_off = max(struck - 0.12 * 2.0 * step * self._vary(0.08), earliest)
        heel_strike = struck + step
        foot_flat = heel_strike + 0.095 * 2.0 * step * self._vary(0.06)
        start = self.at[foot]
        width, out = (float(value) for value in self.rng.standard_normal(2))
        end = self._stance(fall.pose, foot, wearer.width_variation * width, 0.5 * wearer.angle_variation * out)
        # Short steps roll the foot less; the exponents keep half steps and steps in place looking like steps.
        moved = hypot(end.x - start.x, end.y - start.y)
        reach = min(moved / 1.42, 1.4)
        roll, yaw, outward = (float(value) for value in self.rng.standard_normal(3))
        side = 1.0 if foot is Foot.LEFT else -1.0
        weave = (side * (0.16 + 0.03 * roll), -side * (0.10 + 0.02 * yaw), side * (0.012 + 0.004 * outward))
        before.append(
            Stride(
                number=len(before) + 1,
                heel_off=heel_off,
                toe_off=toe_off,
                heel_strike=heel_strike,
                foot_flat=foot_flat,
                start=start,
                end=end,
                toe_off_pitch=wearer.toe_off_pitch * max(reach, 0.08) ** 0.55 * self._vary(wearer.angle_variation),
                strike_pitch=wearer.strike_pitch * max(reach, 0.05) ** 0.9 * self._vary(wearer.angle_variation),
                speed=fall.speed * min(reach, 1.0),
                clearance=wearer.clearance * self._vary(0.08),
                weave=weave,
                settle=4e-4 * float(np.clip(self.rng.standard_normal(), -1.0, 1.0)),
                curvature=fall.curvature,
                pace=0.5 * moved / step,
            )
        )
        self.at[foot] = end

    def _vary(self, sigma: float) -> float:
        """A factor about 1, never further away than three sigma."""
        return 1.0 + sigma * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))


def _closing(last: _Footfall) -> _Footfall:
    """The closing half step: beside the foot that arrived."""
    return evolve(last, advance=0.0)


def cadence(speed: float, wearer: Wearer) -> float:
    """Steps per minute at `speed` m/s: the walk ratio W = l / c and v = l c / 60 give c = sqrt(60 v / W)."""
    return float(np.sqrt(60.0 * speed / wearer.walk_ratio))


def step_length(speed: float, wearer: Wearer) -> float:
    """m."""
    return wearer.walk_ratio * cadence(speed, wearer)


def step_time(speed: float, wearer: Wearer) -> float:
    """s."""
    return 60.0 / cadence(speed, wearer)


def double_support(speed: float) -> float:
    """Each of the two double supports as a share of the stride; shorter the faster."""
    return float(np.clip(0.115 - 0.04 * (speed - 1.3), 0.05, 0.20))
