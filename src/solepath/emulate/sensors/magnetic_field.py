"""The magnetic field around a wearer: that of the earth, the same everywhere.

Steel of a building would disturb it; experiments add that. The iron of a shoe is fixed to the sensor, so it is among
the errors of a magnetometer (parts.py): magnetised steel adds a constant field (hard iron: `bias`), steel that the
field magnetises scales and turns it (soft iron: `scale`, `cross`)."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Vec3
from ..wearers.curves import Array

EARTH: Vec3 = (16e-6, 12e-6, -43e-6)
"""Magnetic flux density of the earth's field in the world frame, T: 20 uT horizontal, 43 uT down, as in Central
Europe."""


@frozen(eq=False)
class MagneticField:
    """The magnetic field at the floor of a building."""

    earth: Vec3 = EARTH
    """Magnetic flux density of the earth's field, world frame, T."""

    def along(self, t: Array, places: Array) -> Array:
        """Return the flux density at the places (N, 3), m, of a way at fine instants `t`, s: (N, 3), T."""
        return np.broadcast_to(np.array(self.earth), (len(places), 3))


UNDISTURBED = MagneticField()
"""The field of the earth alone."""
