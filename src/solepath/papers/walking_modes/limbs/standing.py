"""Lengths of a wearer's limbs, and a check that seven sensors are worn and stood still, from a standing pose.

The lengths are shares of the stature (calibration.Limbs), replaced by those that were measured. A standing pose shows
no lengths, but it shows whether a walk can begin with it: the chain (limbs.py) takes how each sensor sits on its
segment from the first half second in which all seven are still. That is done again in every session, because a strap
never sits twice as before, so these rotations are not part of a calibration."""

from __future__ import annotations

from collections.abc import Iterable
from math import acos

from ....calibration import CalibrationError, Limbs
from ....types import Sample, Site
from ....types.attrs import frozen
from ....types.vector import rotate
from .inclination import Inclination
from .limb_sensors import LimbSensors
from .limbs import SEGMENTS, STANDING_TIME, LowerLimbs

STATURE = 1.75
"""Stature of a wearer with the default `Limbs`, m."""
JOINT_DISTANCE_SHARE = 0.72
"""Distance of the hip joints as a share of that of the anterior iliac spines: each joint lies inward by 14 % of it.

Bell, Brand and Pedersen 1989, Human Movement Science 8."""
_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@frozen
class StoodSensor:
    """A sensor while the wearer stood."""

    site: Site
    tilt: float
    """Angle from the vertical to the axis of the sensor that is nearest to it, rad."""
    own_world: bool
    """Flag: the sensor sends no attitude, so that its heading drifts with its gyroscope."""


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


def check_standing(samples: Iterable[Sample]) -> list[StoodSensor]:
    """Return how the seven sensors sat while the wearer stood.

    Raises CalibrationError, which names the sites, when one sent no attitude or when they were never still at once."""
    chain, sensors = LowerLimbs(), LimbSensors()
    feet = {site: Inclination() for site in SEGMENTS if site.foot is not None}
    for sample in samples:
        if sample.site.foot is None:
            sensors.add_sample(sample, chain)
        elif sample.quat is not None:
            chain.set_attitude(sample.site, sample.t, sample.quat)
        elif sample.acc is not None and sample.gyro is not None:
            attitude = feet[sample.site].update(sample.t, sample.acc, sample.gyro)
            if attitude is not None:
                chain.set_own_attitude(sample.site, sample.t, attitude, None)
    silent = [site.words for site in SEGMENTS if chain.segments[site].t is None]
    if silent:
        raise CalibrationError(f"no attitude of the {', '.join(silent)}: all seven sensors are needed")
    if not chain.aligned:
        restless = [site.words for site in SEGMENTS if chain.segments[site].still_time() < STANDING_TIME]
        names = f": the {', '.join(restless)} moved last" if restless else ""
        raise CalibrationError(f"the wearer never stood still for {STANDING_TIME:g} s with all seven sensors{names}")
    found = []
    for site in SEGMENTS:
        segment = chain.segments[site]
        axes = [abs(rotate(segment.standing, axis)[2]) for axis in _AXES] if segment.standing is not None else [1.0]
        found.append(StoodSensor(site, acos(min(1.0, max(axes))), segment.own_world))
    return found
