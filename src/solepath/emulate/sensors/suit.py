"""Samples and devices of seven sensors on the lower body: pelvis, thighs, shanks and feet."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter

import numpy as np

from ...calibration import Limbs
from ...types import Layout, Sample, Site
from ...types.vector import from_rotation_vector
from ..wearers.curves import Array, Rng
from ..wearers.limbs import body
from ..wearers.shoe import ON_INSTEP, Mounting
from ..wearers.walker import Walker
from .device import Device
from .dot import Dot
from .insole_device import Insole
from .insoles import SCALE
from .parts import CRE_CC02, MPU9250, WORN_RESISTIVE, AttitudePart, CellPart, Imu
from .sensors import instants, measure_imu, read_attitudes, read_cells, sample, samples_of

MISALIGNMENT = 0.15
"""Standard deviation of the misalignment of a sensor strapped on by hand, about each axis, rad (assumed)."""


def limb_mounting(site: Site, limbs: Limbs, seed: int, turned: float = MISALIGNMENT) -> Mounting:
    """Return position and attitude of a site's sensor in its segment's frame, with a constant random misalignment.

    The pelvis sensor sits on the small of the back, those of thigh and shank on the front half-way down, those of the
    feet on the instep."""
    rng = np.random.default_rng([seed, 5, list(Site).index(site)])
    x, y, z = (turned * float(value) for value in rng.standard_normal(3))
    place = ON_INSTEP.position
    if site is Site.PELVIS:
        place = (-0.10, 0.0, 0.05)
    elif site.foot is None:
        thigh = site in (Site.LEFT_THIGH, Site.RIGHT_THIGH)
        place = (0.06, 0.0, -0.5 * (limbs.thigh if thigh else limbs.shank))
    return Mounting(place, from_rotation_vector((x, y, z)))


def limb_samples(
    walker: Walker,
    rate: float,
    limbs: Limbs | None = None,
    seed: int = 1,
    *,
    attitude: AttitudePart | None = CRE_CC02,
    errors: Imu | None = MPU9250,
    north: float = 0.0,
    turned: float = MISALIGNMENT,
    layouts: Mapping[Site, Layout] | None = None,
    cell_part: CellPart | None = None,
) -> list[Sample]:
    """Return samples of all seven sites on the true clock at k / rate s, in the order of time and of Site.

    There are no packets and no radio. `quat` turns from the sensor to a world that is turned by `north` rad from the
    walk's world, with the errors of `attitude`. Acceleration and rate have the errors of `errors`, without saturation
    and rounding; the paper gives no figures for its unit, and another nine-axis part replaces it. None: exact values.
    `limbs` are the wearer's own by default. With `layouts` the samples of the feet have the loads of their cells, N,
    exact or read by `cell_part` at the scale of the layout. `seed` sets mountings and errors."""
    wearer = walker.wearer
    limbs = limbs or wearer.limbs
    if limbs == wearer.limbs:
        made = walker.body
    else:
        made = body(walker.plan, walker.motions, walker.loads, wearer.shoe, wearer.centre_height, limbs)
    when = instants(0.0, 1.0 / rate, int(walker.duration * rate) + 1)
    found: list[Sample] = []
    for order, site in enumerate(Site):
        rng = np.random.default_rng([seed, 6, order])
        mounting = limb_mounting(site, limbs, seed, turned)
        if errors is None:
            true = made.at(site, when.taken, mounting)
            acc, gyro, turn = true.force, true.rate, true.attitude
        else:
            true = made.at(site, when.fine, mounting)
            acc, gyro = measure_imu(true, when, errors, rng, 0.5 * rate)
            turn = sample(true.attitude, when)
        if attitude is not None:
            turn = read_attitudes(turn, when.taken, attitude, north, rng)
        cells = None
        if site.foot is not None and layouts is not None and site in layouts:
            cells = _pressed(walker, layouts[site], when.taken, cell_part, rng)
        found += samples_of(site, when.taken, acc, gyro, cells, turn)
    return sorted(found, key=attrgetter("t"))


def suit(
    limbs: Limbs, seed: int, *, attitude: AttitudePart = CRE_CC02, north: float = 0.0, rate: float = 50.0
) -> dict[Site, Device]:
    """Return seven devices for one session, mounted by `limb_mounting`.

    The feet wear insoles of 99 cells that send their attitude, at `rate` Hz; all other sites wear DOTs."""
    worn: dict[Site, Device] = {}
    for site in Site:
        mounting = limb_mounting(site, limbs, seed)
        if site.foot is None:
            worn[site] = Dot(mounting, attitude, north)
        else:
            worn[site] = Insole(
                cells=99,
                rate=rate,
                quaternion=True,
                attitude=attitude,
                north=north,
                mounting=mounting,
                part=MPU9250,
                cell_part=WORN_RESISTIVE,
            )
    return worn


def _pressed(walker: Walker, layout: Layout, t: Array, part: CellPart | None, rng: Rng) -> Array:
    true = walker.cell_loads(layout, t)
    if part is None:
        return true
    scale = layout.scale or SCALE
    lift = walker.kinematics(layout.foot, t).force[:, 2]
    return np.asarray(read_cells(true, t, part, scale, rng, lift=lift).counts * scale)
