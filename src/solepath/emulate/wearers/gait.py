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
from ..routes.stairs import Flight
from ..routes.styles import Manner
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
class FootStand:
    """Where a foot stands flat: the ground point under the ankle, m, and the yaw of the foot, rad (not wrapped)."""

    x: float
    y: float
    z: float
    yaw: float


@frozen
class PlannedStride:
    """One foot from one place to the next. Times in s: it leaves with `heel_off` and `toe_off`, and lands with
    `heel_strike` and `foot_flat`."""

    number: int
    heel_off: float
    toe_off: float
    heel_strike: float
    foot_flat: float
    start: FootStand
    end: FootStand
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
    manner: Manner = Manner.WALK
    flight: Flight | None = None
    """That it begins or ends on."""


@frozen
class Climb:
    """A flight that was walked, from when the first foot leaves the one floor until both are on the other, s."""

    begin: float
    end: float
    flight: Flight


@frozen
class WalkPlan:
    """Everything that is decided before a foot moves."""

    duration: float
    starts: dict[Foot, FootStand]
    strides: dict[Foot, tuple[PlannedStride, ...]]
    bouts: tuple[tuple[float, float], ...]
    """When walking begins and when the closing foot is down, for each stretch between stands, s."""
    climbs: tuple[Climb, ...] = ()
    rides: tuple[CarRide, ...] = ()


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
