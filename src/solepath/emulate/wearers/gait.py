"""The wearer, and the planned strides of each foot with their four event times.

The timing is that of healthy adults who walk on the level. The cadence follows from the speed by a constant walk ratio:
step length over cadence is about 0.0064 m per step/min (Sekiya and Nagasaki 1998, Gait & Posture 7). At 1.3 m/s, as
shares of the gait cycle from heel-strike on, stance lasts about 60 %, each of the two double supports about 11 %,
foot-flat is at about 9 % and heel-off at about 38 % (Perry, Gait Analysis, 1992). The values for running and stairs are
in styles.py."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import Enum
from typing import Protocol

import numpy as np
from attrs import frozen

from ...calibration import Limbs
from ...types import Foot
from ..routes.elevator import CarRide
from ..routes.escalator import EscalatorRide
from ..routes.path import Flight, Pose
from ..routes.styles import StrideKind, Style
from .curves import Array, Rng
from .shoe import Shoe


class HeelPad(Protocol):
    """Pad under a heel, which lets the patch of pressure spread and move while the shoe is at rest."""

    def spread(self, heel_load: Array) -> Array:
        """Return the half-axes of the patch as a share of those of the zone, (N); the load is a share of the weight."""

    def shift(self, stance: Array, heel_share: Array, weight: float, speed: Array, t: Array) -> Array:
        """Return how far the patch is ahead of its place at foot-flat without shear, m, (N).

        `stance` has heel-strike, foot-flat, heel-off and toe-off, s, (N, 4). `heel_share` is the share of the heel in
        the foot's load, `weight` is in N, and `speed` is a ratio to 1.3 m/s."""


Wandering = Callable[[float, Rng], Callable[[Pose, float], Pose]]
"""Function of the length of a path, m, that returns a function that moves a pose on it, which is so many m along it."""
Swaying = Callable[[float, float, float, float, Rng], Iterator[tuple[float, float, list[Array]]]]
"""Function that yields the pieces of a foot that stands, of the start and the end of standing, and of swaying, s.

A piece has its start and end, s, and the curves of pitch, yaw and roll, rad. All are 0 at both ends of swaying, and yaw
is relative to the foot's own."""


class LoadLaw(Enum):
    """Law by which the load under both feet moves in a bend (load.py)."""

    OUTWARD = "outward"
    """Away from the centre of the bend under the whole foot."""
    HEEL_OUT_FOREFOOT_IN = "heel out, forefoot in"
    """Away from the centre under the heel, towards it under forefoot and toes (Turcato et al. 2015)."""


SETTLE_TIME = 0.45
"""Time in which the weight settles on both feet at a halt, and longest time in which it rolls along the sole, s."""


@frozen
class Wearer:
    """The parameters of a wearer; every variation is a standard deviation between strides."""

    mass: float = 75.0
    """Body mass, kg."""
    shoe: Shoe = Shoe()
    """Shoe of either foot."""
    step_width: float = 0.14
    """Lateral distance between the tracks of the left and the right ankle, m."""
    toe_out: float = 0.12
    """Outward rotation of each foot from the path, rad (7 degrees)."""
    walk_ratio: float = 0.0064
    """Step length divided by cadence, m per step/min."""
    strike_pitch: float = 0.37
    """Pitch at heel-strike of a full stride at 1.3 m/s, rad; positive when the toe is up."""
    toe_off_pitch: float = 1.02
    """Pitch at toe-off of a full stride at 1.3 m/s, rad; positive when the heel is up."""
    clearance: float = 0.018
    """Least height of the sole above the ground in mid-swing, m."""
    max_pivot_turn: float = 0.7
    """Largest angle by which one step turns when the wearer turns on the spot, rad."""
    first_foot: Foot = Foot.LEFT
    """Foot that makes the first step."""
    length_variation: float = 0.025
    """Variation of the step length, as a ratio to the mean."""
    time_variation: float = 0.018
    """Variation of the step time, as a ratio to the mean."""
    width_variation: float = 0.012
    """Variation of the foot's lateral position, m."""
    angle_variation: float = 0.035
    """Variation of pitch angles, relative to their mean; the variation of toe-out is half of this number in rad."""
    load_variation: float = 0.0
    """Variation of the load's lateral position under the foot, m."""
    load_law: LoadLaw = LoadLaw.OUTWARD
    """Law by which the load moves in a bend."""
    mark_error: float = 0.01
    """Standard deviation of the distance along the path from a mark to the foot that steps on it, m (assumed)."""
    swerve: tuple[float, float] = (1.0, 1.0)
    """Roll and yaw of the left and the right foot in mid-swing, as a ratio to 9 and 6 degrees."""
    wander: Wandering | None = None
    """Lateral displacement of the body from the path; None: the body keeps to the path."""
    sway: Swaying | None = None
    """Sway of a foot while the wearer stands; None: a standing foot is still."""
    rest_pitch: float = 4e-4
    """Standard deviation of the largest pitch of a foot that stands between two strides, rad, cut off at one of them.

    The angular rate in the stillest 30 ms of a stance is 0.03 to 0.2 rad/s in tied shoes (papers/pressure_contour), as
    with 0.01 rad; the default is a foot that hardly turns (assumed)."""
    pad: HeelPad | None = None
    """Pad under the heels; None: the patch of pressure under a heel has a fixed size and moves with the pitch only."""
    centre_height: float = 0.97
    """Height of the body's centre of mass, m.

    It is 0.555 of a stature of 1.75 m (Winter, Biomechanics and Motor Control of Human Movement, 2009)."""
    limbs: Limbs = Limbs()
    """Lengths of the limbs."""
    number: int = 0
    """Number from which experiments draw what is this wearer's own."""

    def cadence(self, speed: float) -> float:
        """Return the cadence at `speed` m/s, steps per minute.

        With the step length l, the walk ratio W = l / c and the speed v = l c / 60 give c = sqrt(60 v / W)."""
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
    """Point on the ground under the ankle, and heading of the foot, before the stride, world frame."""
    end: Pose
    """Point on the ground under the ankle, and heading of the foot, after the stride, world frame."""
    toe_off_pitch: float
    """Pitch at toe-off, rad; positive when the heel is up."""
    strike_pitch: float
    """Pitch at heel-strike, rad; positive when the toe is up."""
    speed: float
    """Speed of the body along the path, m/s; reduced in a short stride of walking."""
    clearance: float
    """Least height of the sole above the ground in mid-swing, m."""
    deviation: tuple[float, float, float]
    """Roll, rad, yaw, rad, and displacement to the left, m, in mid-swing; they are 0 at both ends of the swing."""
    rest_pitch: float
    """Largest pitch while the foot stands after the stride, rad; positive when the toe is up. It is 0 at both ends."""
    curvature: float
    """Curvature of the path where the foot lands, 1/m; positive to the left."""
    step_speed: float
    """Speed of the body in the step that ends this stride, m/s: half of the foot's displacement over the step time."""
    kind: StrideKind
    """Kind of the stride."""
    style: Style
    """Parameters of the stride."""
    flight: Flight | None = None
    """Flight of stairs that the stride starts or ends on."""


@frozen
class Climb:
    """A flight of stairs that the wearer walked."""

    start: float
    """Time at which the first foot leaves the floor before the flight, s."""
    end: float
    """Time at which both feet are on the floor after the flight, s."""
    flight: Flight
    """Position and measures of the flight of stairs."""

    @property
    def up(self) -> bool:
        """True when the wearer walked up."""
        return self.flight.rise > 0.0

    @property
    def height(self) -> float:
        """Height from floor to floor, m, negative downwards; on an escalator that of the steps that were climbed."""
        return self.flight.height


@frozen
class WalkPlan:
    """The plan of a walk: positions and times of all strides."""

    duration: float
    """Duration of the walk, s."""
    starts: dict[Foot, Pose]
    """Point on the ground under each ankle, and heading of the foot, at t = 0, world frame."""
    strides: dict[Foot, tuple[PlannedStride, ...]]
    """Strides of each foot."""
    bouts: tuple[tuple[float, float], ...]
    """Start and end of each bout of walking, s; a bout ends SETTLE_TIME s after its last heel-strike."""
    climbs: tuple[Climb, ...] = ()
    """Flights of stairs that the wearer walks."""
    rides: tuple[CarRide, ...] = ()
    """Elevator rides of the wearer."""
    escalators: tuple[EscalatorRide, ...] = ()
    """Rides on escalators, standing or walking; the poses of strides do not contain their displacement."""

    @property
    def moving_ground(self) -> tuple[CarRide | EscalatorRide, ...]:
        """Rides of all kinds."""
        return (*self.rides, *self.escalators)

    def ground_shift(self, t: Array) -> Array:
        """Return how far escalators have moved the ground under the feet at times `t`, s, world frame, (N, 3), m."""
        total = np.zeros((len(t), 3))
        for ride in self.escalators:
            total += ride.at(t)[0]
        return total
