"""Samples of seven sensors strapped on the lower body, which move with the skin under them and not with the bones.

The motion of the skin of pelvis, thighs and shanks follows the gait: as the knee bends, the skin of the thigh slides
and rolls over the muscle, and in stance the muscles are tense. So rotation and displacement are here two patterns times
constants of their own: the angle of the knee, and the share of the leg in the body's load, both relative to quiet
standing. The literature has such motion: it correlates with the knee's angle, mostly at the thigh (J Biomech 62, 2017,
21-26), has the frequencies of the bone's own motion, is smallest about the flexion axis, and differs between persons
(Leardini et al. 2005, Gait & Posture 21). By fluoroscopy a cluster on the thigh turns by about 10 degrees and slides by
18 mm at most, one on the shank by 7 degrees and 17 mm (PMC8631460, 2021); reviews have 5 to 30 mm. Wobbling after
impacts is not emulated.

The constants belong to the wearer, and a part of them is new each time the sensors are strapped on (assumed, see
NEW_SHARE). A foot has none: its sensor sits on the shoe, in which the foot slips (emulate/wearers/limbs.py)."""

from __future__ import annotations

from collections.abc import Mapping
from math import radians
from operator import attrgetter

import numpy as np
from attrs import fields, frozen

from solepath.emulate.sensors.insoles import LOAD_PER_COUNT
from solepath.emulate.sensors.parts import CRE_CC02, MPU9250, AttitudeErrors, CellErrors
from solepath.emulate.sensors.sensors import instants, measure_imu, read_attitudes, read_cells, samples_of, take_samples
from solepath.emulate.sensors.suit import limb_mounting
from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.limbs import FOOT_OF_SITE, INTERVAL, Body, Leg
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, multiply_quaternions, quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Layout, Sample, Site, Vec3

NEW_SHARE = 0.45
"""Standard deviation of the part of a constant that is new at each strapping, as a share of that of the wearer's part
(assumed)."""
_THIGH = ((2.0, 1.5, 4.0), (1.5, 1.0, 2.0), (8.0, 4.0, 8.0), (4.0, 3.0, 4.0))
_SHANK = ((1.0, 1.0, 2.5), (1.0, 0.7, 2.0), (6.0, 3.0, 6.0), (3.0, 2.0, 3.0))
SPREADS: dict[Site, tuple[Vec3, Vec3, Vec3, Vec3]] = {
    Site.PELVIS: ((0.0, 0.0, 0.0), (1.0, 0.7, 1.0), (0.0, 0.0, 0.0), (2.0, 2.0, 3.0)),
    Site.LEFT_THIGH: _THIGH,
    Site.RIGHT_THIGH: _THIGH,
    Site.LEFT_SHANK: _SHANK,
    Site.RIGHT_SHANK: _SHANK,
}
"""Standard deviations between wearers about and along x, y (the flexion axis) and z of the segment: rotation, degrees,
per rad of the knee and from half to the whole load on the leg, and displacement, mm, for the same two."""


def tissue_constants(number: int, seed: int, scale: float) -> dict[Site, Array]:
    """Return the constants of the wearer of this number for sensors strapped on with this seed; `scale` times SPREADS.

    They are rows as those of SPREADS, (4, 3), in rad and m."""
    found: dict[Site, Array] = {}
    for site, spreads in SPREADS.items():
        order = list(Site).index(site)
        own = np.random.default_rng([number, 8, order]).standard_normal((4, 3))
        new = np.random.default_rng([seed, 9, order]).standard_normal((4, 3))
        units = np.array((radians(1.0), radians(1.0), 1e-3, 1e-3))[:, None]
        found[site] = scale * units * np.array(spreads) * (own + NEW_SHARE * new)
    return found


@frozen(eq=False)
class SkinBody(Body):
    """A body whose segments above the ankles are those of the skin, not of the bones."""

    load_shares: dict[Foot, Array]
    """Share of each foot in the body's load less that of standing, times 2, in the rows of `track`, (n, 1)."""
    constants: dict[Site, Array]
    """Constants by site (`tissue_constants`)."""

    def segment(self, site: Site, t: Array) -> tuple[Array, Array]:
        """Return origin (N, 3), world, m, and attitude (N, 3, 3), skin to world, of the skin of a site at `t`, s."""
        if site.foot is not None:
            return super().segment(site, t)
        foot = FOOT_OF_SITE.get(site, Foot.LEFT)
        load = self._interpolate(self.load_shares[foot], t)
        if site is Site.PELVIS:
            (origin, turn), knee = self.pelvis(t), np.zeros((len(t), 1))
        else:
            # by how much more than at time 0 the knee is bent
            leg, first = self.leg(foot, t), self.leg(foot, np.zeros(1))
            (origin, turn), knee = leg.segment(site), _bend(leg)[:, None] - _bend(first)
        knee_turn, load_turn, knee_shift, load_shift = self.constants[site]
        angles = knee * knee_turn + load * load_turn
        shift = knee * knee_shift + load * load_shift
        return origin + np.einsum("nij,nj->ni", turn, shift), turn @ matrices(from_rotation_vectors(angles))


def _bend(leg: Leg) -> Array:
    """Return the angle by which the knee is bent, rad, (N)."""
    cosine = np.sum(leg.thigh[:, :, 2] * leg.shank[:, :, 2], axis=1)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def worn_body(walker: Walker, seed: int, tissue: float) -> Body:
    """Return the body as sensors see it that are strapped on with this seed.

    `tissue` is the motion of the skin as a multiple of that of SPREADS."""
    bones = walker.body
    if not tissue:
        return bones
    t = np.asarray(bones.t_start + INTERVAL * np.arange(len(bones.track)), dtype=np.float64)
    load_shares = {foot: 2.0 * walker.loads.share(foot, t)[:, None] - 1.0 for foot in Foot}
    bare = {field.name: getattr(bones, field.name) for field in fields(Body)}
    return SkinBody(**bare, load_shares=load_shares, constants=tissue_constants(walker.wearer.number, seed, tissue))


def limb_samples(
    walker: Walker,
    rate: float,
    seed: int = 1,
    *,
    attitude: AttitudeErrors | None = CRE_CC02,
    north: float = 0.0,
    layouts: Mapping[Site, Layout] | None = None,
    cell_part: CellErrors | None = None,
    tissue: float = 1.0,
    limb_attitudes_only: bool = False,
) -> list[Sample]:
    """Return samples of all seven sites on the true clock at k / rate s, in the order of time and of Site.

    There are no packets and no radio. `quat` turns a vector of the sensor frame into a world frame that is yawed by
    `north` rad from the walk's; it has the errors `attitude`, None: none. Specific force and angular rate have the
    errors of an MPU9250, because Gong et al. 2023 give only the attitude errors of their device, and are neither
    saturated nor rounded. With `layouts`, foot samples have the loads of the cells, N, exact or read by `cell_part` at
    the layout's scale. `tissue` is that of `worn_body`. With `limb_attitudes_only` sites above the ankles send nothing
    but `quat`, which takes a fifth of the time to emulate."""
    body = worn_body(walker, seed, tissue)
    sampling = instants(0.0, 1.0 / rate, int(walker.duration * rate) + 1)
    samples: list[Sample] = []
    for order, site in enumerate(Site):
        rng = np.random.default_rng([seed, 6, order])
        mounting = limb_mounting(site, walker.wearer.limbs, seed)
        acc: Array | None = None
        gyro: Array | None = None
        if limb_attitudes_only and site.foot is None:
            skin = quaternions(body.segment(site, sampling.times)[1])
            turn = multiply_quaternions(skin, np.array([mounting.attitude]))
        else:
            true = body.at(site, sampling.fine_times, mounting)
            acc, gyro = measure_imu(true, sampling, MPU9250, rng, 0.5 * rate)
            turn = take_samples(true.attitude, sampling)
        if attitude is not None:
            turn = read_attitudes(turn, sampling.times, attitude, north, rng)
        layout = (layouts or {}).get(site)
        cells = None if layout is None else _cell_loads(walker, layout, sampling.times, cell_part, rng)
        samples += samples_of(site, sampling.times, acc, gyro, cells, turn)
    return sorted(samples, key=attrgetter("t"))


def _cell_loads(walker: Walker, layout: Layout, t: Array, part: CellErrors | None, rng: Rng) -> Array:
    true = walker.cell_loads(layout, t)
    if part is None:
        return true
    scale = layout.scale or LOAD_PER_COUNT
    upward_force = walker.kinematics(layout.foot, t).force[:, 2]
    return np.asarray(read_cells(true, t, part, scale, rng, upward_force=upward_force).counts * scale)
