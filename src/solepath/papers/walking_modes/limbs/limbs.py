"""Lower limbs as a chain of seven segments, which gives the ends of the feet relative to the pelvis.

After Gong et al. 2023 (Sensors 23, 5417), section 3.2.2 and fig. 8: O_0 is at the hips, O_1 the knee, O_2 the ankle,
O_3 the end of the foot. P_R and P_L are "from the last column" of the product (7) of the transforms between them.

Sensors may have any mounting. So the rotation between a sensor and its segment is computed at the first time at which
all seven segments are still. The wearer is then taken to be in the N-pose: upright, thighs and shanks vertical, feet
level, all segments facing the first heading. Attitudes come from the devices (`Sample.quat`), which share one world
with z up, as sensors with a magnetometer do. Or they are computed from acceleration and angular velocity
(inclination.py), each in a world with its own heading. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, cos, fsum, hypot, sin, sqrt
from typing import NamedTuple

from ....calibration import Limbs
from ....types import OTHER, Foot, Quat, Site, Vec3
from ....types.attrs import define, field
from ....types.vector import IDENTITY, ZERO, conjugate, from_yaw, multiply, normalise, rotate
from ..settings import ModesSettings
from .segment import LimbSegment

LIMB_SITES = (Site.PELVIS, Site.LEFT_THIGH, Site.RIGHT_THIGH, Site.LEFT_SHANK, Site.RIGHT_SHANK)
"""The sites above the ankles."""
LEG_SITES = {
    Foot.LEFT: (Site.LEFT_THIGH, Site.LEFT_SHANK, Site.LEFT_FOOT),
    Foot.RIGHT: (Site.RIGHT_THIGH, Site.RIGHT_SHANK, Site.RIGHT_FOOT),
}
"""Sites of thigh, shank and foot, by foot."""
SEGMENTS = (*LIMB_SITES, Site.LEFT_FOOT, Site.RIGHT_FOOT)
"""Sites of all seven segments."""
STANDING_TIME = 0.5
"""Time for which all seven segments must be still in the N-pose, s."""
ATTITUDE_VALID_TIME = 0.25
"""Time for which an attitude is used, s."""
LEAST_FIRST_STEP = 0.15
"""Length of a step, m, from which it shows the first heading (as in foot/world.py)."""

LARGEST_COMPONENT = 1e6
"""Limit of the components of a valid quaternion; its length is at least 1 / LARGEST_COMPONENT."""


class Transform(NamedTuple):
    """A homogeneous transform: a rotation followed by a translation, m, which is the last column of its matrix."""

    rotation: Quat = IDENTITY
    translation: Vec3 = ZERO

    def then(self, other: Transform) -> Transform:
        """Return the product with `other`, which is given in the frame at the end of this transform."""
        x, y, z = self.translation
        dx, dy, dz = rotate(self.rotation, other.translation)
        return Transform(multiply(self.rotation, other.rotation), (x + dx, y + dy, z + dz))


def joints(
    pelvis: Quat, thigh: Quat, shank: Quat, foot: Quat, hip: Vec3, limbs: Limbs
) -> tuple[Vec3, Vec3, Vec3, Vec3]:
    """Return hip, knee, ankle and O_3 relative to the middle of the hips, m: the rods of fig. 8.

    They are in the frame into which the attitudes turn the segments. O_3 is the last column of

        0_3R = 0_1R 1_2R 2_3R                                                                                   (7)

    from the pelvis on. `hip` is the position of the hip joint in the pelvis, m. In the N-pose all attitudes are the
    identity: thigh and shank point down, and the foot points forward from below the ankle."""
    to_hip = Transform(pelvis, ZERO).then(Transform(multiply(conjugate(pelvis), thigh), hip))
    to_knee = to_hip.then(Transform(multiply(conjugate(thigh), shank), (0.0, 0.0, -limbs.thigh)))
    to_ankle = to_knee.then(Transform(multiply(conjugate(shank), foot), (0.0, 0.0, -limbs.shank)))
    to_end = to_ankle.then(Transform(IDENTITY, (limbs.foot, 0.0, -limbs.ankle_height)))
    return to_hip.translation, to_knee.translation, to_ankle.translation, to_end.translation


@define
class LowerLimbs:
    """Computes the ends of one wearer's feet from the attitudes of seven segments."""

    settings: ModesSettings = ModesSettings()
    facing: float | None = field(init=False)
    """Heading of the wearer in the N-pose, or of the first step, in the world that the devices share, rad; None while
    unknown."""
    turn: float = field(default=0.0, init=False)
    """Angle from `facing` to the x axis of the world frame, rad, left positive."""
    segments: dict[Site, LimbSegment] = field(init=False)
    """Segment by the site of its sensor."""
    aligned: bool = field(default=False, init=False)
    """Flag: the N-pose of all segments is known."""
    given_up: bool = field(default=False, init=False)
    """Flag: the wearer started to walk before all seven segments were still."""

    def __attrs_post_init__(self) -> None:
        self.facing = self.settings.heading
        self.segments = {site: LimbSegment() for site in SEGMENTS}

    def set_attitude(self, site: Site, t: float, quat: Quat) -> None:
        """Set a new attitude of a sensor; the quaternion may have any length except 0."""
        if not all([-LARGEST_COMPONENT < part < LARGEST_COMPONENT for part in quat]):
            return
        length = sqrt(fsum([part * part for part in quat]))
        if length < 1.0 / LARGEST_COMPONENT:
            return
        k = 1.0 / length
        segment = self.segments[site]
        segment.set_attitude(t, (quat[0] * k, quat[1] * k, quat[2] * k, quat[3] * k))
        if segment.world_changed and segment.still_time() >= STANDING_TIME:
            self._realign(segment)
        if not self.aligned and not self.given_up:
            self._align()

    def set_own_attitude(self, site: Site, t: float, quat: Quat, heading: float | None) -> None:
        """Set a new attitude of a sensor with a world of its own.

        `heading` is the wearer's first heading in that world, rad; None while unknown. The attitude is not used if the
        site has sent an attitude in the shared world."""
        segment = self.segments[site]
        if segment.own_world or segment.t is None:
            segment.own_world, segment.heading = True, heading
            self.set_attitude(site, t, quat)

    def reset(self, site: Site) -> None:
        """Discard the times of a sensor whose clock restarts; its attitudes may be in another world from now on."""
        segment = self.segments[site]
        segment.t = segment.earlier_t = segment.still_since = None
        segment.world_changed = segment.standing is not None and not segment.own_world

    def _realign(self, segment: LimbSegment) -> None:
        """Compute the rotation from a sensor's new world to its old one while its segment stands as in the N-pose.

        The heading of the segment is taken to have changed since the N-pose as those of the other segments have."""
        standing = segment.standing
        references = [
            s for s in self.segments.values() if s is not segment and s.standing is not None and not s.own_world
        ]
        x = y = 0.0
        for other in references:
            if other.standing is not None and other.t is not None and not other.world_changed:
                w, _, _, z = multiply(other.sensor, conjugate(other.standing))
                yaw = 2.0 * atan2(z, w)
                x, y = x + cos(yaw), y + sin(yaw)
        if standing is None or hypot(x, y) < 1e-6:
            return
        expected = multiply(from_yaw(atan2(y, x)), standing)
        w, _, _, z = multiply(normalise(segment.attitude_sum), conjugate(expected))
        segment.world = from_yaw(-2.0 * atan2(z, w))
        segment.sensor = segment.earlier_attitude = multiply(segment.world, segment.sensor)
        segment.world_changed = False

    def _align(self) -> None:
        """Take the present attitudes for those of the N-pose if all segments have been still for long enough."""
        if any([segment.still_time() < STANDING_TIME for segment in self.segments.values()]):
            return
        for segment in self.segments.values():
            segment.standing = normalise(segment.attitude_sum)
        self.aligned = True

    def is_current(self, t: float) -> bool:
        """Return whether the chain can be used at `t` s."""
        if not self.aligned:
            return False
        for segment in self.segments.values():
            if segment.t is None or abs(t - segment.t) >= ATTITUDE_VALID_TIME or segment.world_changed:
                return False
            if segment.own_world and segment.heading is None:
                return False
        return True

    def may_recover(self) -> bool:
        """Return whether the chain may become usable later."""
        return (self.aligned or not self.given_up) and not self.missing()

    def missing(self) -> tuple[Site, ...]:
        """Return the sites above the ankles without an attitude."""
        return tuple([site for site in LIMB_SITES if self.segments[site].t is None])

    def why_unusable(self, t: float, sampled_sites: Iterable[Site]) -> str:
        """Return the reason why the chain cannot be used at `t` s; `sampled_sites` are those that have sent samples."""
        missing = self.missing()
        if missing:
            silent = [site for site in missing if site not in sampled_sites]
            if silent:
                return f"no sensor heard at the {_names(silent)}"
            return f"no attitude, and no acceleration with angular velocity, of the {_names(missing)}"
        world_changed = [site for site in SEGMENTS if self.segments[site].world_changed]
        if world_changed:
            return f"the sensor at the {_names(world_changed)} restarted, and its world with it"
        if not self.aligned:
            return "the wearer did not stand still before the first step"
        ages = [
            (site, t - s.t)
            for site, s in self.segments.items()
            if s.t is not None and abs(t - s.t) >= ATTITUDE_VALID_TIME
        ]
        if ages:
            oldest = max([age for _, age in ages], key=abs)
            names = _names([site for site, _ in ages])
            return f"the newest attitude of the {names} is {abs(oldest):.2g} s {'old' if oldest > 0.0 else 'ahead'}"
        names = _names([site for site, s in self.segments.items() if s.own_world and s.heading is None])
        return f"the sensor at the {names} does not know yet which way the wearer goes"

    def _attitude(self, site: Site, t: float) -> Quat:
        return self.segments[site].attitude(self.facing or 0.0, self.turn, t)

    def complete(self) -> float | None:
        """Return the time up to which the attitudes of all segments are known, s; None if one has none."""
        times = [segment.t for segment in self.segments.values() if segment.t is not None]
        return min(times) if len(times) == len(SEGMENTS) else None

    def end(self, foot: Foot, t: float) -> Vec3:
        """Return P_L or P_R at `t` s: the end of the foot relative to the middle of the hips, world frame, m."""
        return self.rods(foot, t)[3]

    def rods(self, foot: Foot, t: float) -> tuple[Vec3, Vec3, Vec3, Vec3]:
        """Return hip, knee, ankle and end of the foot at `t` s, relative to the middle of the hips, world frame, m."""
        thigh, shank, foot_attitude = [self._attitude(site, t) for site in LEG_SITES[foot]]
        side = 0.5 if foot is Foot.LEFT else -0.5
        limbs = self.settings.limbs
        hip = (0.0, side * limbs.hip_width, 0.0)
        return joints(self._attitude(Site.PELVIS, t), thigh, shank, foot_attitude, hip, limbs)

    def legs(self, t: float) -> tuple[tuple[Vec3, ...], tuple[Vec3, ...]] | None:
        """Return the rods of both legs, left and right, at `t` s; None if an attitude is not known then."""
        return (self.rods(Foot.LEFT, t), self.rods(Foot.RIGHT, t)) if self.is_current(t) else None

    def newest_legs(self) -> tuple[float, tuple[tuple[Vec3, ...], tuple[Vec3, ...]]] | None:
        """Return the newest instant at which all attitudes are known, s, and the rods then; None if one is missing."""
        t = self.complete()
        rods = None if t is None else self.legs(t)
        return None if t is None or rods is None else (t, rods)

    def height(self, foot: Foot, t: float) -> float:
        """Return the height of the sole below the ankle at `t` s, relative to the middle of the hips, upwards, m.

        The height of the foot's end, P_Lz and P_Rz of (4), is not used: the chain has no toe joint, so when the heel
        rises, the end goes below the floor, and the foot that pushes off would be the lower one."""
        segments, limbs = self.segments, self.settings.limbs
        thigh_upright, shank_upright, foot_upright = [segments[site].upright(t) for site in LEG_SITES[foot]]
        side = 0.5 if foot is Foot.LEFT else -0.5
        _, _, hip_height = rotate(self._attitude(Site.PELVIS, t), (0.0, side * limbs.hip_width, 0.0))
        return (
            hip_height - limbs.thigh * thigh_upright - limbs.shank * shank_upright - limbs.ankle_height * foot_upright
        )

    def forward(self, foot: Foot, t: float) -> tuple[float, float]:
        """Return the horizontal unit vector in the direction of a foot, world frame; (1, 0) if it points up or down."""
        x, y, _ = rotate(self._attitude(LEG_SITES[foot][2], t), (1.0, 0.0, 0.0))
        length = hypot(x, y)
        return (x / length, y / length) if length > 1e-6 else (1.0, 0.0)

    def add_touchdown(self, foot: Foot, t: float, direction: float = 0.0) -> None:
        """Add a touchdown of the foot at `t` s; the first step gives the wearer's first heading.

        It is computed from thighs and shanks alone. They hang down in the N-pose, so their vectors need no heading.
        `direction` is the angle from the world's x axis to the step, rad, left positive; it is not 0 if the wearer has
        walked before the chain was known."""
        if self.facing is not None or not self.aligned:
            return
        limbs = self.settings.limbs
        x = y = 0.0
        for leg, sign in ((foot, 1.0), (OTHER[foot], -1.0)):
            for site, length in zip(LEG_SITES[leg], (limbs.thigh, limbs.shank), strict=False):
                dx, dy, _ = rotate(self.segments[site].attitude(0.0, 0.0, t), (0.0, 0.0, -length))
                x += sign * dx
                y += sign * dy
        if hypot(x, y) > LEAST_FIRST_STEP:
            self.facing = atan2(y, x)
            if not any([segment.own_world for segment in self.segments.values()]):  # own worlds have the first heading
                self.facing -= direction


def _names(sites: Iterable[Site]) -> str:
    return ", ".join([site.words for site in sites])
