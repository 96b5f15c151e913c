"""Devices of seven sites on the lower body: pelvis, thighs, shanks and feet. They have the motion of the bones."""

from __future__ import annotations

import numpy as np

from ...calibration import Limbs
from ...types import Site
from ...types.vector import from_rotation_vector
from ..wearers.shoe import ON_INSTEP, Mounting
from .device import Device
from .dot import Dot
from .insole_device import Insole
from .parts import CRE_CC02, MPU9250, WORN_RESISTIVE, AttitudeErrors, CellErrors

MISALIGNMENT = 0.15
"""Standard deviation, about each axis, of the misalignment of a sensor that is strapped on by hand, rad (assumed)."""


def limb_mounting(site: Site, limbs: Limbs, seed: int) -> Mounting:
    """Return position, m, and attitude of a site's sensor in the frame of its segment, with a random misalignment.

    Sensors sit on the small of the back, half-way down the front of thighs and shanks, and on the insteps (offsets
    assumed)."""
    rng = np.random.default_rng([seed, 5, list(Site).index(site)])
    x, y, z = (MISALIGNMENT * float(value) for value in rng.standard_normal(3))
    position = ON_INSTEP.position
    if site is Site.PELVIS:
        position = (-0.10, 0.0, 0.05)
    elif site.foot is None:
        thigh = site in (Site.LEFT_THIGH, Site.RIGHT_THIGH)
        position = (0.06, 0.0, -0.5 * (limbs.thigh if thigh else limbs.shank))
    return Mounting(position, from_rotation_vector((x, y, z)))


def suit(
    limbs: Limbs,
    seed: int,
    *,
    attitude: AttitudeErrors = CRE_CC02,
    north: float = 0.0,
    rate: float = 50.0,
    cell_part: CellErrors = WORN_RESISTIVE,
) -> dict[Site, Device]:
    """Return seven devices for one session, mounted by `limb_mounting`.

    The feet wear insoles of 99 cells at `rate` Hz that send their attitude; other sites wear DOTs."""
    devices: dict[Site, Device] = {}
    for site in Site:
        mounting = limb_mounting(site, limbs, seed)
        if site.foot is None:
            devices[site] = Dot(mounting, attitude, north)
        else:
            devices[site] = Insole(
                cells=99,
                rate=rate,
                quaternion=True,
                attitude=attitude,
                north=north,
                mounting=mounting,
                chip=MPU9250,
                cell_part=cell_part,
            )
    return devices
