"""Samples and devices of seven sites on the lower body: pelvis, thighs, shanks and feet.

Samples have the motion of the skin under the sensors (soft_tissue.py). The devices of `suit` have that of the bones."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter

import numpy as np

from ...calibration import Limbs
from ...types import Foot, Layout, Sample, Site
from ...types.vector import from_rotation_vector
from ..wearers.curves import Array, Rng
from ..wearers.limbs import INTERVAL, Body, body
from ..wearers.shoe import ON_INSTEP, Mounting
from ..wearers.turning import multiply_quaternions, quaternions
from ..wearers.walker import Walker
from .device import Device
from .dot import Dot
from .insole_device import Insole
from .insoles import LOAD_PER_COUNT
from .parts import CRE_CC02, MPU9250, WORN_RESISTIVE, AttitudeErrors, CellErrors, Imu
from .sensors import instants, measure_imu, read_attitudes, read_cells, samples_of, take_samples
from .soft_tissue import tissue_constants, with_soft_tissue

MISALIGNMENT = 0.15
"""Standard deviation, about each axis, of the misalignment of a sensor that is strapped on by hand, rad (assumed)."""


def limb_mounting(site: Site, limbs: Limbs, seed: int, turned: float = MISALIGNMENT) -> Mounting:
    """Return position, m, and attitude of a site's sensor in the frame of its segment, with a random misalignment.

    Sensors sit on the small of the back, half-way down the front of thighs and shanks, and on the insteps (offsets
    assumed). `turned` is the standard deviation of the misalignment about each axis, rad."""
    rng = np.random.default_rng([seed, 5, list(Site).index(site)])
    x, y, z = (turned * float(value) for value in rng.standard_normal(3))
    position = ON_INSTEP.position
    if site is Site.PELVIS:
        position = (-0.10, 0.0, 0.05)
    elif site.foot is None:
        thigh = site in (Site.LEFT_THIGH, Site.RIGHT_THIGH)
        position = (0.06, 0.0, -0.5 * (limbs.thigh if thigh else limbs.shank))
    return Mounting(position, from_rotation_vector((x, y, z)))


def limb_samples(
    walker: Walker,
    rate: float,
    limbs: Limbs | None = None,
    seed: int = 1,
    *,
    attitude: AttitudeErrors | None = CRE_CC02,
    errors: Imu | None = MPU9250,
    north: float = 0.0,
    turned: float = MISALIGNMENT,
    layouts: Mapping[Site, Layout] | None = None,
    cell_part: CellErrors | None = None,
    tissue: float = 1.0,
    limb_attitudes_only: bool = False,
) -> list[Sample]:
    """Return samples of all seven sites on the true clock at k / rate s, in the order of time and of Site.

    There are no packets and no radio. `quat` turns a vector of the sensor frame into a world frame that is yawed by
    `north` rad from the walk's. It has the errors `attitude`; specific force and angular rate have `errors`, and are
    neither saturated nor rounded. None: exact values. The default is MPU9250, because Gong et al. 2023 give only the
    attitude errors of their device. `limbs` are the wearer's own by default; `turned` is that of `limb_mounting`. With
    `layouts`, foot samples have the loads of the cells, N, exact or read by `cell_part` at the layout's scale. `tissue`
    is the motion of soft tissue under the sensors above the ankles, as a multiple of that of soft_tissue.py. With
    `limb_attitudes_only` these send nothing but `quat`, which takes a fifth of the time to emulate."""
    wearer = walker.wearer
    limbs = limbs or wearer.limbs
    if limbs == wearer.limbs:
        bones = walker.body
    else:
        bones = body(walker.plan, walker.motions, walker.loads, wearer.shoe, wearer.centre_height, limbs)
    body_motion = worn_body(walker, bones, seed, tissue)
    sampling = instants(0.0, 1.0 / rate, int(walker.duration * rate) + 1)
    samples: list[Sample] = []
    for order, site in enumerate(Site):
        rng = np.random.default_rng([seed, 6, order])
        mounting = limb_mounting(site, limbs, seed, turned)
        acc: Array | None
        gyro: Array | None
        if limb_attitudes_only and site.foot is None:
            skin = quaternions(body_motion.segment(site, sampling.times)[1])
            acc, gyro, turn = None, None, multiply_quaternions(skin, np.array([mounting.attitude]))
        elif errors is None:
            true = body_motion.at(site, sampling.times, mounting)
            acc, gyro, turn = true.force, true.rate, true.attitude
        else:
            true = body_motion.at(site, sampling.fine_times, mounting)
            acc, gyro = measure_imu(true, sampling, errors, rng, 0.5 * rate)
            turn = take_samples(true.attitude, sampling)
        if attitude is not None:
            turn = read_attitudes(turn, sampling.times, attitude, north, rng)
        cells = None
        if site.foot is not None and layouts is not None and site in layouts:
            cells = _cell_loads(walker, layouts[site], sampling.times, cell_part, rng)
        samples += samples_of(site, sampling.times, acc, gyro, cells, turn)
    return sorted(samples, key=attrgetter("t"))


def worn_body(walker: Walker, bones: Body, seed: int, tissue: float = 1.0) -> Body:
    """Return the body as sensors see it that are strapped on with this seed: the motion of the skin, not of the bones.

    `tissue` is the motion of soft tissue as a multiple of that of soft_tissue.py."""
    t = np.asarray(bones.t_start + INTERVAL * np.arange(len(bones.track)), dtype=np.float64)
    load_shares = {foot: walker.loads.share(foot, t) for foot in Foot}
    return with_soft_tissue(bones, load_shares, tissue_constants(walker.wearer.number, seed, tissue))


def suit(
    limbs: Limbs, seed: int, *, attitude: AttitudeErrors = CRE_CC02, north: float = 0.0, rate: float = 50.0
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
                cell_part=WORN_RESISTIVE,
            )
    return devices


def _cell_loads(walker: Walker, layout: Layout, t: Array, part: CellErrors | None, rng: Rng) -> Array:
    true = walker.cell_loads(layout, t)
    if part is None:
        return true
    scale = layout.scale or LOAD_PER_COUNT
    upward_force = walker.kinematics(layout.foot, t).force[:, 2]
    return np.asarray(read_cells(true, t, part, scale, rng, upward_force=upward_force).counts * scale)
