"""Motion of the skin under a strapped sensor relative to the bone, at pelvis, thighs and shanks.

The motion follows the gait: as the knee bends, the skin of the thigh slides and rolls over the muscle, and in stance
the muscles are tense. So rotation and displacement are here two patterns times constants of their own: the angle of the
knee, and the share of the leg in the body's load, both relative to quiet standing. The literature has such motion: it
correlates with the knee's angle, mostly at the thigh (J Biomech 62, 2017, 21-26), has the frequencies of the
bone's own motion, is smallest about the flexion axis, and differs between persons (Leardini et al. 2005, Gait & Posture
21). By fluoroscopy a cluster on the thigh turns by about 10 degrees and slides by 18 mm at most, one on the shank by 7
degrees and 17 mm (PMC8631460, 2021); reviews have 5 to 30 mm. Wobbling after impacts is not emulated.

The constants belong to the wearer, and a part of them is new each time the sensors are strapped on (assumed, see
NEW_SHARE). A foot has none: its sensor sits on the shoe, in which the foot slips (wearers/limbs.py)."""

from __future__ import annotations

from math import radians

import numpy as np
from attrs import fields, frozen

from ...types import Foot, Site, Vec3
from ..wearers.curves import Array
from ..wearers.limbs import FOOT_OF_SITE, Body, Leg
from ..wearers.turning import from_rotation_vectors, matrices

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


@frozen
class TissueConstants:
    """The constants of one sensor's soft tissue, in the frame of the segment."""

    knee_turn: Vec3
    """Rotation per rad by which the knee is bent, rad."""
    load_turn: Vec3
    """Rotation when the leg takes the whole load instead of half of it, rad."""
    knee_shift: Vec3
    """Displacement per rad by which the knee is bent, m."""
    load_shift: Vec3
    """Displacement when the leg takes the whole load instead of half of it, m."""


def tissue_constants(number: int, seed: int, scale: float = 1.0) -> dict[Site, TissueConstants]:
    """Return the constants of the wearer of this number for sensors strapped on with this seed; `scale` times SPREADS.

    They are empty when `scale` is 0."""
    found: dict[Site, TissueConstants] = {}
    if not scale:
        return found
    for site, spreads in SPREADS.items():
        order = list(Site).index(site)
        own = np.random.default_rng([number, 8, order]).standard_normal((4, 3))
        new = np.random.default_rng([seed, 9, order]).standard_normal((4, 3))
        units = np.array((radians(1.0), radians(1.0), 1e-3, 1e-3))[:, None]
        knee_turn, load_turn, knee_shift, load_shift = (
            (float(x), float(y), float(z)) for x, y, z in scale * units * np.array(spreads) * (own + NEW_SHARE * new)
        )
        found[site] = TissueConstants(knee_turn, load_turn, knee_shift, load_shift)
    return found


@frozen(eq=False)
class SkinBody(Body):
    """A body whose segments above the ankles are those of the skin, not of the bones."""

    load_shares: dict[Foot, Array]
    """Share of each foot in the body's load less that of standing, times 2, in the rows of `track`, (n, 1)."""
    constants: dict[Site, TissueConstants]
    """Constants by site."""

    def segment(self, site: Site, t: Array) -> tuple[Array, Array]:
        """Return origin (N, 3), world, m, and attitude (N, 3, 3), skin to world, of the skin of a site at `t`, s."""
        constants = self.constants.get(site)
        if constants is None:
            return super().segment(site, t)
        foot = FOOT_OF_SITE.get(site, Foot.LEFT)
        load = self._interpolate(self.load_shares[foot], t)
        if site is Site.PELVIS:
            (origin, turn), knee = self.pelvis(t), np.zeros((len(t), 1))
        else:
            # by how much more than at time 0 the knee is bent
            leg, first = self.leg(foot, t), self.leg(foot, np.zeros(1))
            (origin, turn), knee = leg.segment(site), _bend(leg)[:, None] - _bend(first)
        angles = knee * constants.knee_turn + load * constants.load_turn
        shift = knee * constants.knee_shift + load * constants.load_shift
        return origin + np.einsum("nij,nj->ni", turn, shift), turn @ matrices(from_rotation_vectors(angles))


def _bend(leg: Leg) -> Array:
    """Return the angle by which the knee is bent, rad, (N)."""
    cosine = np.sum(leg.thigh[:, :, 2] * leg.shank[:, :, 2], axis=1)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def with_soft_tissue(body: Body, load_shares: dict[Foot, Array], constants: dict[Site, TissueConstants]) -> Body:
    """Return the body with soft tissue of these constants; `load_shares` of each foot in the rows of `body.track`."""
    if not constants:
        return body
    relative = {foot: 2.0 * share[:, None] - 1.0 for foot, share in load_shares.items()}
    bare = {field.name: getattr(body, field.name) for field in fields(Body)}
    return SkinBody(**bare, load_shares=relative, constants=constants)
