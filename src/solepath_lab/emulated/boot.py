"""The boot of Bebek et al. 2010, IEEE Trans. Instrum. Meas. 59, and the pad of the heel in it.

The pressure under a heel moves and spreads although the shoe does not move, because of that pad."""

from __future__ import annotations

from math import radians

import numpy as np
from attrs import evolve, frozen

from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import FULL_COUNT
from solepath.emulate.sensors.parts import AttitudeErrors, CellErrors
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.shoe import ON_HEEL
from solepath.types import Cell, Foot, Layout

CAPACITIVE = CellErrors("capacitive", gain=0.025, preload=0.3, noise=0.06, lag=0.002)
"""Calibrated capacitive insoles (novel pedar), accuracy +-5 %; noise, lag and preload are assumed."""

WORN_CAPACITIVE = evolve(CAPACITIVE, name="capacitive in a laced shoe", relief_per_g=0.3, contact_noise=0.12)
"""Errors of capacitive cells with the contact of the foot in swing, which is that of WORN_RESISTIVE."""

HEEL_ARRAY = evolve(WORN_CAPACITIVE, name="DigiTacts II under a heel")
"""Errors of the DigiTacts II of Pressure Profile Systems, assumed as for other capacitive cells.

The array is capacitive and calibrated before shipment; Bebek et al. 2010, section IV, give only its range."""

INERTIACUBE3 = AttitudeErrors("InertiaCube3", tilt=radians(0.25), heading=radians(1.0))
"""InterSense InertiaCube3 (*): accuracy 1 degree in yaw, 0.25 degrees in pitch and roll at 25 degrees C."""

TILTED_INERTIACUBE3 = evolve(INERTIACUBE3, steady_tilt=radians(0.25))
"""Errors of INERTIACUBE3, and a tilt as large as its accuracy that stays (assumed).

The users of Bebek et al. 2010 found "drifts toward a fixed direction" and suspected the device's gravity compensation
(section V-B)."""

HEEL_LENGTH, HEEL_WIDTH = 0.0823, 0.0451
"""Sensing area of a DigiTacts II array, m (Bebek et al. 2010, section IV); its 24 cells lie 6 by 4 (assumed)."""
MAX_HEEL_PRESSURE = 140e3
"""Largest pressure that a DigiTacts II array detects, Pa (Bebek et al. 2010, section IV)."""


def heel_array(foot: Foot, length: float = 0.285, rear: float = 0.008) -> Layout:
    """Return the layout of a DigiTacts II array under the heel of a shoe of `length` m.

    Its 24 cells are ordered row by row from the back to the front, and in a row from right to left. The first row
    starts `rear` m in front of the heel's rear end (assumed). The layout of 24 cells over the whole sole has the same
    id, 24; INFO distinguishes the two."""
    step, across = HEEL_LENGTH / 6, HEEL_WIDTH / 4
    cells = [
        Cell(rear + (row + 0.5) * step, -0.5 * HEEL_WIDTH + (column + 0.5) * across, step * across)
        for row in range(6)
        for column in range(4)
    ]
    max_load = MAX_HEEL_PRESSURE * step * across
    return Layout(24, foot, tuple(cells), length, max_load / FULL_COUNT, max_load)


def boot(foot: Foot, rate: float = 100.0) -> Insole:
    """Return the sensors of Bebek et al. 2010, IEEE Trans. Instrum. Meas. 59: 24 cells and an attitude sensor.

    The cells are under the heel, the sensor on the back of the heel. Specific force and angular rate have the errors of
    the other insoles, and `rate`, Hz, is assumed, because the paper gives neither errors nor a sampling rate."""
    return Insole(
        cells=heel_array(foot),
        rate=rate,
        quaternion=True,
        attitude=INERTIACUBE3,
        mounting=ON_HEEL,
        cell_part=HEEL_ARRAY,
        reports_saturation=False,
    )


@frozen
class HeelPad:
    """The pad of fat under the heel bone, which lets the patch of pressure spread and move while the shoe is at rest.

    The patch grows with the load. A paraboloid on a bed of equal springs has the pressure 1 - r^2, and its half-axes
    grow with the fourth root of the load (Johnson, Contact Mechanics, 1985, section 4.3).

    The bone moves against the sole. The sole pushes the foot back in the first half of stance and forward in the second
    half, and the pad yields in shear. The bone also rolls forward over the sole between foot-flat and heel-off, because
    the arch gives way. Both are elastic: a pad that creeps is not emulated. (*) marks figures that have not been
    compared with their source."""

    full_load: float = 1.0
    """Load of the heel, as a share of the weight, at which the patch is as large as the zone (assumed).

    A larger load does not widen it, because the shoe encloses the heel."""
    smallest: float = 0.35
    """Smallest half-axes, as a share of those of the zone (assumed)."""
    shear_stiffness: float = 40e3
    """Force by which the pad resists a shift of one m in shear, N/m.

    It is a third of the stiffness in compression, as in all incompressible material, and that is 32 N/mm for a small
    load and 212 N/mm for the whole one in walking (Wearing et al. 2014, Med Sci Sports Exerc 46 (*))."""
    fore_aft_share: float = 0.18
    """Largest force along the foot at 1.3 m/s, as a share of the weight.

    It is 0.13 backwards and 0.23 forwards on force plates (Perry, Gait Analysis, 1992 (*)); it grows with the speed."""
    roll: float = 0.09
    """Angle by which the bone turns against the sole from foot-flat to heel-off, rad: 5 degrees (assumed)."""
    radius: float = 0.035
    """Radius of the bone and its pad in side view, m (assumed)."""

    def spread(self, heel_load: Array) -> Array:
        """Return the half-axes of the patch as a share of those of the zone, (N); the load is a share of the weight."""
        return np.clip((np.maximum(heel_load, 0.0) / self.full_load) ** 0.25, self.smallest, 1.0)

    def shift(self, stance: Array, heel_share: Array, weight: float, speed: Array, t: Array) -> Array:
        """Return how far the patch is ahead of its place at foot-flat without shear, m, (N).

        `stance` has heel-strike, foot-flat, heel-off and toe-off, s, (N, 4). `heel_share` is the share of the heel in
        the foot's load, `weight` is in N, and `speed` is a ratio to 1.3 m/s."""
        heel_strike, foot_flat, heel_off, toe_off = stance.T
        in_stance = np.clip((t - heel_strike) / (toe_off - heel_strike), 0.0, 1.0)
        force = -self.fore_aft_share * weight * speed * np.sin(2.0 * np.pi * in_stance) * heel_share
        flat = np.clip((t - foot_flat) / (heel_off - foot_flat), 0.0, 1.0)
        rolled = self.radius * self.roll * flat * flat * (3.0 - 2.0 * flat)
        return np.asarray(rolled - force / self.shear_stiffness)
