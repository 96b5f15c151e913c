"""The lower limbs as a chain of seven segments: where the ends of the feet are, seen from the pelvis.

After Gong et al. 2023 (Sensors 23, 5417), section 3.2.2 and fig. 8: O_0 at the hips, O_1 the knee, O_2 the ankle, O_3
the end of the foot, and P_R, P_L "from the last column" of the product (7) of the transforms between them.

A sensor is strapped on in any way, so what its attitude says of its segment is taken from the first time that all seven
are quiet together: the wearer stands upright, thighs and shanks vertical, feet level, everything facing the first
heading (N-pose). Attitudes come from the devices (`Sample.quat`), which share one world with z up, as sensors with a
magnetometer do; or from acceleration and angular velocity (inclination.py), each in a world of its own heading.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, cos, hypot, sin, sqrt
from typing import NamedTuple

from ....calibration import Limbs
from ....types import OTHER, Foot, Quat, Site, Vec3
from ....types.attrs import define, field
from ....types.vector import IDENTITY, ZERO, conjugate, from_yaw, multiply, normalise, rotate
from ..settings import ModesSettings
from .segment import LimbSegment

ABOVE = (Site.PELVIS, Site.LEFT_THIGH, Site.RIGHT_THIGH, Site.LEFT_SHANK, Site.RIGHT_SHANK)
"""The sites above the ankles."""
LEGS = {
    Foot.LEFT: (Site.LEFT_THIGH, Site.LEFT_SHANK, Site.LEFT_FOOT),
    Foot.RIGHT: (Site.RIGHT_THIGH, Site.RIGHT_SHANK, Site.RIGHT_FOOT),
}
SEGMENTS = (*ABOVE, Site.LEFT_FOOT, Site.RIGHT_FOOT)
STOOD = 0.5
"""For so long all seven must be quiet, s."""
STALE = 0.25
"""An attitude older than this is nobody's any more, s."""
FIRST_WAY = 0.15
"""A step that is longer tells the first heading, m (as foot/world.py has it)."""

LARGEST = 1e6
"""A quaternion with a part beyond this, or shorter than its inverse, is none."""


class Transform(NamedTuple):
    """A homogeneous transform: `rotation`, then `translation` (m). The last column of its matrix is `translation`."""

    rotation: Quat = IDENTITY
    translation: Vec3 = ZERO

    def then(self, other: Transform) -> Transform:
        """The product: `other` is seen from this one's end."""
        x, y, z = self.translation
        dx, dy, dz = rotate(self.rotation, other.translation)
        return Transform(multiply(self.rotation, other.rotation), (x + dx, y + dy, z + dz))


def foot_end(pelvis: Quat, thigh: Quat, shank: Quat, foot: Quat, hip: Vec3, limbs: Limbs) -> Vec3:
    """O_3 seen from the middle of the hips, in the frame that the segments' attitudes lead to, m: the last column of

        0_3R = 0_1R 1_2R 2_3R                                                                                   (7)

    hung on the pelvis. `hip`: the hip joint in the pelvis, m. In the N-pose all attitudes are the identity: thigh and
    shank point down, the foot forward from below the ankle."""
    chain = Transform(pelvis, ZERO).then(Transform(multiply(conjugate(pelvis), thigh), hip))
    chain = chain.then(Transform(multiply(conjugate(thigh), shank), (0.0, 0.0, -limbs.thigh)))
    chain = chain.then(Transform(multiply(conjugate(shank), foot), (0.0, 0.0, -limbs.shank)))
    return chain.then(Transform(IDENTITY, (limbs.foot, 0.0, -limbs.ankle_height))).translation


@define
class LowerLimbs:
    """The chain of one wearer: attitudes in, the ends of both feet out."""

    settings: ModesSettings = ModesSettings()
    facing: float | None = field(init=False)
    """Where the wearer looks in the N-pose, or where the first step has gone, in the world that the devices share, rad.
    """
    turn: float = field(default=0.0, init=False)
    """From there to the x axis of the world, rad."""
    segments: dict[Site, LimbSegment] = field(init=False)
    aligned: bool = field(default=False, init=False)
    given_up: bool = field(default=False, init=False)
    """The wearer walked off before all seven were quiet."""

    def __attrs_post_init__(self) -> None:
        self.facing = self.settings.heading
        self.segments = {site: LimbSegment() for site in SEGMENTS}

    def told(self, site: Site, t: float, quat: Quat) -> None:
        """A new attitude of a sensor, of any length but 0."""
        if not all([-LARGEST < part < LARGEST for part in quat]):
            return
        length = sqrt(sum([part * part for part in quat]))
        if length < 1.0 / LARGEST:
            return
        k = 1.0 / length
        segment = self.segments[site]
        segment.told(t, (quat[0] * k, quat[1] * k, quat[2] * k, quat[3] * k))
        if segment.adrift and segment.quiet_for() >= STOOD:
            self._moor(segment)
        if not self.aligned and not self.given_up:
            self._align()

    def told_own(self, site: Site, t: float, quat: Quat, heading: float | None) -> None:
        """The same of a sensor with a world of its own, in which the wearer's first heading is `heading`, rad, once
        that is known. Nothing of it is used where the site has told an attitude in the shared world."""
        segment = self.segments[site]
        if segment.own or segment.t is None:
            segment.own, segment.heading = True, heading
            self.told(site, t, quat)

    def reset(self, site: Site) -> None:
        """The clock of a sensor begins anew. If it tells its attitude, its world may be another from now on."""
        segment = self.segments[site]
        segment.t = segment.earlier = segment.quiet_since = None
        segment.adrift = segment.standing is not None and not segment.own

    def _moor(self, segment: LimbSegment) -> None:
        """A segment whose sensor's world is new stands as it did in the N-pose, turned as the others are that are
        known: what its attitude is off by from there is the turn from its old world to its new one."""
        standing = segment.standing
        known = [s for s in self.segments.values() if s is not segment and s.standing is not None and not s.own]
        x = y = 0.0
        for other in known:
            if other.standing is not None and other.t is not None and not other.adrift:
                w, _, _, z = multiply(other.sensor, conjugate(other.standing))
                yaw = 2.0 * atan2(z, w)
                x, y = x + cos(yaw), y + sin(yaw)
        if standing is None or hypot(x, y) < 1e-6:
            return
        expected = multiply(from_yaw(atan2(y, x)), standing)
        w, _, _, z = multiply(normalise(segment.total), conjugate(expected))
        segment.world = from_yaw(-2.0 * atan2(z, w))
        segment.sensor = segment.before = multiply(segment.world, segment.sensor)
        segment.adrift = False

    def _align(self) -> None:
        if any([segment.quiet_for() < STOOD for segment in self.segments.values()]):
            return
        for segment in self.segments.values():
            segment.standing = normalise(segment.total)
        self.aligned = True

    def current(self, t: float) -> bool:
        """Whether the chain can be used for this instant, s."""
        if not self.aligned:
            return False
        for segment in self.segments.values():
            if segment.t is None or abs(t - segment.t) >= STALE or segment.adrift:
                return False
            if segment.own and segment.heading is None:
                return False
        return True

    def hopeful(self) -> bool:
        """It may yet be known, or known again."""
        return (self.aligned or not self.given_up) and not self.missing()

    def missing(self) -> tuple[Site, ...]:
        """The sites above the ankles that no attitude was heard of."""
        return tuple([site for site in ABOVE if self.segments[site].t is None])

    def why_not(self, t: float, heard: Iterable[Site]) -> str:
        """Why it cannot be used at `t` s; `heard`: the sites that samples came of."""
        missing = self.missing()
        if missing:
            silent = [site for site in missing if site not in heard]
            if silent:
                return f"no sensor heard at the {_words(silent)}"
            return f"no attitude, and no acceleration with angular velocity, of the {_words(missing)}"
        adrift = [site for site in SEGMENTS if self.segments[site].adrift]
        if adrift:
            return f"the sensor at the {_words(adrift)} began anew, and its world with it"
        if not self.aligned:
            return "the wearer did not stand still before the first step"
        old = [(site, t - s.t) for site, s in self.segments.items() if s.t is not None and abs(t - s.t) >= STALE]
        if old:
            most = max([age for _, age in old], key=abs)
            names = _words([site for site, _ in old])
            return f"the newest attitude of the {names} is {abs(most):.2g} s {'old' if most > 0.0 else 'ahead'}"
        names = _words([site for site, s in self.segments.items() if s.own and s.heading is None])
        return f"the sensor at the {names} does not know yet which way the wearer goes"

    def _attitude(self, site: Site, t: float) -> Quat:
        return self.segments[site].attitude(self.facing or 0.0, self.turn, t)

    def complete(self) -> float | None:
        """Up to when every segment's attitude is known, s."""
        times = [segment.t for segment in self.segments.values() if segment.t is not None]
        return min(times) if len(times) == len(SEGMENTS) else None

    def end(self, foot: Foot, t: float) -> Vec3:
        """P_L or P_R at `t` s: the end of the foot seen from the middle of the hips, world frame, m."""
        thigh, shank, end = [self._attitude(site, t) for site in LEGS[foot]]
        side = 0.5 if foot is Foot.LEFT else -0.5
        limbs = self.settings.limbs
        hip = (0.0, side * limbs.hip_width, 0.0)
        return foot_end(self._attitude(Site.PELVIS, t), thigh, shank, end, hip, limbs)

    def height(self, foot: Foot, t: float) -> float:
        """Of the sole below the ankle at `t` s, seen from the middle of the hips, m. Not that of the foot's end, P_Lz
        and P_Rz of (4): in a chain without toes it dips below the floor when the heel comes up, and the foot that
        pushes off would be the lower one."""
        segments, limbs = self.segments, self.settings.limbs
        thigh, shank, end = [segments[site].upright(t) for site in LEGS[foot]]
        side = 0.5 if foot is Foot.LEFT else -0.5
        _, _, hip = rotate(self._attitude(Site.PELVIS, t), (0.0, side * limbs.hip_width, 0.0))
        return hip - limbs.thigh * thigh - limbs.shank * shank - limbs.ankle_height * end

    def forward(self, foot: Foot, t: float) -> tuple[float, float]:
        """Which way a foot points: a horizontal vector of the world frame, of length 1; (1, 0) when it points up."""
        x, y, _ = rotate(self._attitude(LEGS[foot][2], t), (1.0, 0.0, 0.0))
        length = hypot(x, y)
        return (x / length, y / length) if length > 1e-6 else (1.0, 0.0)

    def stepped(self, foot: Foot, t: float, way: float = 0.0) -> None:
        """The foot has come down at `t` s: the first step tells where the wearer looked. Hips and feet are left out of
        it, so that this need not be known for it: legs that hang down do so whatever they face. `way`: where it went,
        rad from the x axis of the world, when the wearer has walked before the chain was known."""
        if self.facing is not None or not self.aligned:
            return
        limbs = self.settings.limbs
        x = y = 0.0
        for leg, sign in ((foot, 1.0), (OTHER[foot], -1.0)):
            for site, length in zip(LEGS[leg], (limbs.thigh, limbs.shank), strict=False):
                dx, dy, _ = rotate(self.segments[site].attitude(0.0, 0.0, t), (0.0, 0.0, -length))
                x += sign * dx
                y += sign * dy
        if hypot(x, y) > FIRST_WAY:
            self.facing = atan2(y, x)
            if not any([segment.own for segment in self.segments.values()]):  # those know the first heading themselves
                self.facing -= way


def _words(sites: Iterable[Site]) -> str:
    return ", ".join([site.words for site in sites])
