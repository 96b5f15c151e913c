"""The wearer, and the planned strides of each foot with their four event times.

Timing follows level walking of healthy adults: cadence from speed by a constant walk ratio (step length over cadence,
about 0.0064 m per step/min; Sekiya and Nagasaki 1998, Gait & Posture 7), stance about 60 % and double support twice
about 11 % of the stride at 1.3 m/s, foot-flat at about 9 % and heel-off at about 38 % of it (Perry, Gait Analysis,
1992). The values for running and stairs are in styles.py."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...calibration import Limbs
from ...types import Foot
from ..routes.lift import CarRide
from ..routes.path import Flight, Pose
from ..routes.styles import StrideKind
from .curves import Rng
from .shoe import Rocker, Shoe

SETTLE_TIME = 0.45
"""Time in which the weight settles on both feet, and in which it moves on in a foot that has stood, s."""


@frozen
class Wearer:
    """The parameters of a wearer; variations are standard deviations between strides."""

    mass: float = 75.0
    """Body mass, kg."""
    shoe: Shoe = Shoe()
    """Shoe of either foot."""
    step_width: float = 0.14
    """Distance between the tracks of the ankles, m."""
    toe_out: float = 0.12
    """Outward rotation of each foot from the path, rad (7 degrees)."""
    walk_ratio: float = 0.0064
    """Step length divided by cadence, m per step/min."""
    strike_pitch: float = 0.37
    """Toe-up pitch at heel-strike of a full stride at 1.3 m/s, rad."""
    toe_off_pitch: float = 1.02
    """Heel-up pitch at toe-off of a full stride at 1.3 m/s, rad."""
    clearance: float = 0.018
    """Least height of the sole in mid-swing, m."""
    pivot_step: float = 0.7
    """Largest turn of one step on the spot, rad."""
    first: Foot = Foot.LEFT
    """Foot that makes the first step."""
    length_variation: float = 0.025
    """Variation of the step length, relative to the mean."""
    time_variation: float = 0.018
    """Variation of the step time, relative to the mean."""
    width_variation: float = 0.012
    """Variation of the foot's lateral position, m."""
    angle_variation: float = 0.035
    """Variation of pitch angles, relative to the mean; toe-out varies by half of this value in rad."""
    load_variation: float = 0.0
    """Variation of the load's lateral position under the foot, m."""
    aim: float = 0.01
    """Standard deviation along the path between a foot and the mark that it steps on, m (assumed)."""
    centre_height: float = 0.97
    """Height of the body's centre of mass, m: 0.555 of a stature of 1.75 m. Source: Winter, Biomechanics and Motor
    Control of Human Movement, 2009."""
    limbs: Limbs = Limbs()
    """Lengths of the limbs."""

    def cadence(self, speed: float) -> float:
        """Return the steps per minute at `speed` m/s.

        The walk ratio W = l / c and v = l c / 60 give c = sqrt(60 v / W)."""
        return float(np.sqrt(60.0 * speed / self.walk_ratio))


@frozen
class PlannedStride:
    """One planned stride of one foot, from one position at foot-flat to the next."""

    number: int
    """Number of the foot's stride, from 1."""
    heel_off: float
    """Time of heel-off, s."""
    toe_off: float
    """Time of toe-off, s."""
    heel_strike: float
    """Time of heel-strike, s."""
    foot_flat: float
    """Time of foot-flat, s."""
    start: Pose
    """Position on the ground under the ankle, and heading, before the stride."""
    end: Pose
    """Position on the ground under the ankle, and heading, after the stride."""
    toe_off_pitch: float
    """Pitch at toe-off, rad; positive when the heel is up."""
    strike_pitch: float
    """Pitch at heel-strike, rad; positive when the toe is up."""
    speed: float
    """Speed of the body along the path, m/s."""
    clearance: float
    """Least height of the sole in mid-swing, m."""
    weave: tuple[float, float, float]
    """Largest deviations in swing: roll, rad, yaw, rad, and outward displacement, m."""
    settle: float
    """Amplitude of the pitch during the next stance, rad."""
    curvature: float
    """Curvature of the path where the foot lands, 1/m; positive to the left."""
    pace: float
    """Speed of the body over this step, m/s: half of the foot's displacement divided by the step time."""
    kind: StrideKind = StrideKind.WALK
    """Kind of the stride."""
    flight: Flight | None = None
    """Flight of stairs that the stride starts or ends on."""


@frozen
class Climb:
    """A flight of stairs that the wearer walked."""

    start: float
    """Time at which the first foot leaves the one floor, s."""
    end: float
    """Time at which both feet are on the other floor, s."""
    flight: Flight
    """The flight of stairs."""

    @property
    def up(self) -> bool:
        """True when the wearer walked up."""
        return self.flight.rise > 0.0

    @property
    def height(self) -> float:
        """Height from floor to floor, m; negative downwards."""
        return self.flight.height


@frozen
class WalkPlan:
    """The plan of a walk: positions and times of all strides."""

    duration: float
    """Duration of the walk, s."""
    starts: dict[Foot, Pose]
    """Position of each foot at t = 0."""
    strides: dict[Foot, tuple[PlannedStride, ...]]
    """Strides of each foot."""
    bouts: tuple[tuple[float, float], ...]
    """Start of walking and time at which the closing foot has settled, for each bout between two stands, s."""
    climbs: tuple[Climb, ...] = ()
    """Flights of stairs that the wearer walks."""
    rides: tuple[CarRide, ...] = ()
    """Lifts that the wearer takes."""


def double_support(speed: float) -> float:
    """Return the duration of each of the two double supports as a share of the stride; it falls with the speed, m/s."""
    return float(np.clip(0.115 - 0.04 * (speed - 1.3), 0.05, 0.20))


FOOT = 0.275
"""Foot length that the default shoe (size 43) is for, m."""
STATURE = 1.75
"""Stature of the default wearer, m."""


def wearer(stature: float, mass: float, foot_length: float) -> Wearer:
    """Return a wearer of this stature, m, and mass, kg, in the default shoe scaled to a foot of `foot_length` m.

    Limbs have the proportions of `Limbs`; `foot` is the part of the shoe ahead of the ankle. The walk ratio is
    proportional to the stature to the power of 1.5: by dynamic similarity, step lengths scale with the leg length and
    cadences with the frequency of a pendulum of that length (Alexander 1989, Physiol. Rev. 69)."""
    plain, k = Wearer(), foot_length / FOOT
    old = plain.shoe
    shoe = Shoe(
        length=k * old.length,
        width=k * old.width,
        heel=Rocker(k * old.heel.x, k * old.heel.radius),
        forefoot=Rocker(k * old.forefoot.x, k * old.forefoot.radius),
        ankle=(k * old.ankle[0], k * old.ankle[1], k * old.ankle[2]),
    )
    limbs = Limbs(
        hip_width=0.191 * stature,
        thigh=0.245 * stature,
        shank=0.246 * stature,
        foot=shoe.length - shoe.ankle[0],
        ankle_height=0.039 * stature,
    )
    return Wearer(
        mass=mass,
        shoe=shoe,
        limbs=limbs,
        centre_height=plain.centre_height * stature / STATURE,
        walk_ratio=plain.walk_ratio * (stature / STATURE) ** 1.5,
    )


def random_wearer(rng: Rng) -> tuple[Wearer, float]:
    """Return a random wearer with a stature from 1.55 m to 1.92 m and a body mass index from 21 to 28, and the stature.

    The stature is in m."""
    stature = float(rng.uniform(1.55, 1.92))
    return wearer(stature, float(rng.uniform(21.0, 28.0)) * stature**2, 0.153 * stature), stature


SUBJECTS = (wearer(1.72, 63.0, 0.245), wearer(1.68, 52.5, 0.255), wearer(1.60, 50.0, 0.235), wearer(1.83, 81.0, 0.270))
"""Subjects of Gong et al. 2023 (Sensors 23, 5417), table 3: height, weight and shoe size."""
