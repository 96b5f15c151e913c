"""Lengths of a wearer's limbs, and a check that seven sensors are worn and stood still, from a standing pose.

The lengths are shares of the stature (calibration.Limbs), replaced by those that were measured. A standing pose shows
no lengths, but it shows whether a walk can begin with it: the chain (limbs.py) takes how each sensor sits on its
segment from the first half second in which all seven are still. That is done again in every session, because a strap
never sits twice as before, so these rotations are not part of a calibration."""

from __future__ import annotations

from collections.abc import Iterable
from math import acos

from ....calibration import CalibrationError, Limbs
from ....foot.navigate.clipping import AXES
from ....types import Sample, Site
from ....types.vector import IDENTITY, rotate
from .limbs import SEGMENTS, STANDING_TIME, LowerLimbs, names

STATURE = 1.75
"""Stature of a wearer with the default `Limbs`, m."""
JOINT_DISTANCE_SHARE = 0.72
"""Distance of the hip joints as a share of that of the anterior iliac spines: each joint lies inward by 14 % of it.

Bell, Brand and Pedersen 1989, Human Movement Science 8."""


def limbs_of(
    stature: float, spines: float | None = None, thigh: float | None = None, shank: float | None = None
) -> Limbs:
    """Return the limbs of a wearer of this stature, m, with those lengths that were measured, m.

    `spines` is the distance between the anterior iliac spines, the bony points at the front of the hips. `thigh` goes
    from the hip joint to the knee, `shank` from there to the ankle."""
    usual, scale = Limbs(), stature / STATURE
    return Limbs(
        hip_width=scale * usual.hip_width if spines is None else JOINT_DISTANCE_SHARE * spines,
        thigh=scale * usual.thigh if thigh is None else thigh,
        shank=scale * usual.shank if shank is None else shank,
        foot=scale * usual.foot,
        ankle_height=scale * usual.ankle_height,
    )


def check_standing(samples: Iterable[Sample]) -> dict[Site, float]:
    """Return the tilt of each of the seven sensors while the wearer stood, rad.

    It is the angle from the vertical to the axis of the sensor that is nearest to it. Raises CalibrationError, which
    names the sites, when one sent no attitude or when they were never still at once."""
    chain = LowerLimbs()
    for sample in samples:
        if sample.site.foot is None:
            chain.add_limb(sample)
        else:
            chain.add_attitude(sample.site, sample.t, sample.quat)
    silent = [site for site in SEGMENTS if chain.segments[site].t is None]
    if silent:
        raise CalibrationError(f"no attitude of the {names(silent)}: all seven sensors are needed")
    if not chain.aligned:
        restless = chain.restless()
        moved = f": the {names(restless)} moved last" if restless else ""
        raise CalibrationError(f"the wearer never stood still for {STANDING_TIME:g} s with all seven sensors{moved}")
    tilts = {}
    for site, segment in chain.segments.items():
        axes = [abs(rotate(segment.standing or IDENTITY, axis)[2]) for axis in AXES]
        tilts[site] = acos(min(1.0, max(axes)))
    return tilts
