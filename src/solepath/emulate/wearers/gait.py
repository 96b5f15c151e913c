"""Who walks, and when and where each foot goes: strides with their four event times.

Timing follows level walking of healthy adults: cadence from speed by a constant walk ratio (step length over cadence,
about 0.0064 m per step/min; Sekiya and Nagasaki 1998, Gait & Posture 7), stance about 60 % and double support twice
about 11 % of the stride at 1.3 m/s, foot-flat at about 9 % and heel-off at about 38 % of it (Perry, Gait Analysis,
1992). What differs in running and on stairs is in styles.py.
"""

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

    def cadence(self, speed: float) -> float:
        """Steps per minute at `speed` m/s: the walk ratio W = l / c and v = l c / 60 give c = sqrt(60 v / W)."""
        return float(np.sqrt(60.0 * speed / self.walk_ratio))


@frozen
class PlannedStride:
    """One foot from where it stands flat (the ground under its ankle) to the next such place. Times in s: it leaves
    with `heel_off` and `toe_off`, and lands with `heel_strike` and `foot_flat`."""

    number: int
    heel_off: float
    toe_off: float
    heel_strike: float
    foot_flat: float
    start: Pose
    end: Pose
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
    kind: StrideKind = StrideKind.WALK
    flight: Flight | None = None
    """That it begins or ends on."""


@frozen
class Climb:
    """A flight that was walked, from when the first foot leaves the one floor until both are on the other, s."""

    start: float
    end: float
    flight: Flight

    @property
    def up(self) -> bool:
        return self.flight.rise > 0.0

    @property
    def height(self) -> float:
        """m from floor to floor, negative when it leads down."""
        return self.flight.height


@frozen
class WalkPlan:
    """Everything that is decided before a foot moves."""

    duration: float
    starts: dict[Foot, Pose]
    strides: dict[Foot, tuple[PlannedStride, ...]]
    bouts: tuple[tuple[float, float], ...]
    """When walking begins and when the closing foot is down, for each stretch between stands, s."""
    climbs: tuple[Climb, ...] = ()
    rides: tuple[CarRide, ...] = ()


def double_support(speed: float) -> float:
    """Each of the two double supports as a share of the stride; shorter the faster."""
    return float(np.clip(0.115 - 0.04 * (speed - 1.3), 0.05, 0.20))


FOOT = 0.275
"""m: foot that the default shoe is for, a size 43."""
STATURE = 1.75
"""m: of the default wearer."""


def wearer(stature: float, mass: float, foot_length: float) -> Wearer:
    """A wearer of so many m and kg in shoes for a foot of `foot_length` m, the default ones made larger or smaller.

    Limbs by the proportions of `Limbs`; `foot` is what of the shoe is ahead of the ankle. The walk ratio goes with the
    stature to the power of 1.5: steps then are as long as legs at cadences that go with a pendulum's, as dynamic
    similarity has it (Alexander 1989, Physiol. Rev. 69).
    """
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
    """Somebody between 1.55 m and 1.92 m tall, neither thin nor fat, and the stature, m."""
    stature = float(rng.uniform(1.55, 1.92))
    return wearer(stature, float(rng.uniform(21.0, 28.0)) * stature**2, 0.153 * stature), stature


SUBJECTS = (wearer(1.72, 63.0, 0.245), wearer(1.68, 52.5, 0.255), wearer(1.60, 50.0, 0.235), wearer(1.83, 81.0, 0.270))
"""Of table 3: height, weight and shoe size (Sensors 23, 5417)."""
