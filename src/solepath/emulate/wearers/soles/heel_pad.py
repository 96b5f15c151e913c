"""Pad of the heel, by which the pressure under a heel moves and spreads although the shoe does not move."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ..curves import Array


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
