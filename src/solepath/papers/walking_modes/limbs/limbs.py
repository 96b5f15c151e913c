"""Lower limbs as a chain of seven segments, which gives the ends of the feet relative to the pelvis.

After Gong et al. 2023 (Sensors 23, 5417), section 3.2.2 and fig. 8: O_0 is at the hips, O_1 the knee, O_2 the ankle,
O_3 the end of the foot. P_R and P_L are "from the last column" of the product (7) of the transforms between them.

Sensors may have any mounting. So the rotation between a sensor and its segment is computed at the first time at which
all seven segments are still. The wearer is then taken to be in the N-pose: upright, thighs and shanks vertical, feet
level, all segments facing the first heading. Attitudes come from the devices (`Sample.quat`), which share one world
with z up, as sensors with a magnetometer do. How the wearer's first heading lies in that world is given, or the
first steps show it. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, hypot
from typing import NamedTuple

from ....calibration import Limbs
from ....events import Rejection
from ....foot.rejection import RejectionReason, rejection_reason
from ....types import OTHER, Foot, Quat, Sample, Site, Vec2, Vec3
from ....types.attrs import field, state, stateful
from ....types.vector import IDENTITY, ZERO, add, conjugate, from_yaw, multiply, normalise, rotate, unit
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
"""Limit of the components of a valid quaternion, which may have any length but 0."""
FARTHEST_AHEAD = 60.0
"""Largest time ahead of all earlier samples, s. Later ones are rejected, unless the site's last one was, too."""


class Transform(NamedTuple):
    """A homogeneous transform: a rotation followed by a translation, m, which is the last column of its matrix."""

    rotation: Quat = IDENTITY
    translation: Vec3 = ZERO

    def then(self, other: Transform) -> Transform:
        """Return the product with `other`, which is given in the frame at the end of this transform."""
        translation = add(self.translation, rotate(self.rotation, other.translation))
        return Transform(multiply(self.rotation, other.rotation), translation)


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


Legs = tuple[tuple[Vec3, ...], tuple[Vec3, ...]]
"""Rods of the left and of the right leg, m."""


@stateful
class LowerLimbs:
    """Computes the ends of one wearer's feet from the attitudes of seven segments."""

    settings: ModesSettings = field(default=ModesSettings())
    facing: float | None = None
    """Heading of the wearer in the N-pose by the first steps, in the world that the devices share, rad; None before."""
    segments: dict[Site, LimbSegment] = state(factory=lambda: {site: LimbSegment() for site in SEGMENTS})
    """Segment by the site of its sensor."""
    aligned: bool = False
    """Flag: the N-pose of all segments is known."""
    given_up: bool = False
    """Flag: the wearer started to walk before all seven segments were still."""
    restarted: list[Site] = state(factory=list)
    """Sites whose sensor came back after the N-pose with another world."""
    times: dict[Site, float] = state(factory=dict)
    """Time of the newest used sample by site, s, for the sites above the ankles."""
    newest: float | None = None
    """Time of the newest sample of any site, s."""
    ahead_t: dict[Site, float] = state(factory=dict)
    """Time of a site's last sample, s, if it was rejected for being too far ahead."""

    @property
    def heading(self) -> float | None:
        """Heading of the wearer in the N-pose, in the world that the devices share, rad; None while unknown."""
        return self.facing if self.settings.heading is None else self.settings.heading

    def add_first_step(self, foot: Foot, t: float) -> None:
        """Take the direction of the step that `foot` ends at `t` s for the wearer's heading, if that is not known.

        It is that of thighs and shanks alone. They hang down in the N-pose, so their vectors need no heading."""
        limbs, step = self.settings.limbs, ZERO
        for leg, sign in ((foot, 1.0), (OTHER[foot], -1.0)):
            for site, length in zip(LEG_SITES[leg], (limbs.thigh, limbs.shank), strict=False):
                step = add(step, rotate(self.segments[site].rotation(t), (0.0, 0.0, -length)), sign)
        x, y, _ = step
        if self.heading is None and hypot(x, y) > LEAST_FIRST_STEP:
            self.facing = atan2(y, x)

    def add_limb(self, sample: Sample) -> RejectionReason | None:
        """Add a sample of a site above the ankles; return the reason for its rejection, or None if it is used."""
        site, t = sample.site, sample.t
        reason = rejection_reason(sample, self.times.get(site))
        if reason is None and self.newest is not None and t - self.newest > FARTHEST_AHEAD:
            last, self.ahead_t[site] = self.ahead_t.get(site), t
            if last is None or not last < t <= last + FARTHEST_AHEAD:
                reason = RejectionReason(Rejection.ABSURD, f"{t - self.newest:.4g} s ahead of everything before")
        if reason is None:
            self.ahead_t.pop(site, None)
            self.times[site] = t
            self.add_attitude(site, t, sample.quat)
        return reason

    def add_attitude(self, site: Site, t: float, quat: Quat | None) -> None:
        """Add the time of a sample, and the attitude that it has, a quaternion of any length except 0."""
        self.newest = t if self.newest is None else max(self.newest, t)
        if quat is None or not all([abs(part) < LARGEST_COMPONENT for part in quat]):
            return
        attitude = unit(quat)
        if attitude is None:
            return
        if self.segments[site].set_attitude(t, attitude) and site not in self.restarted:
            self.restarted.append(site)
        if not (self.aligned or self.given_up or self.restless()):
            for segment in self.segments.values():
                segment.standing = normalise(segment.attitude_sum)
            self.aligned = True

    def restless(self) -> list[Site]:
        """Return the sites that have not been still for `STANDING_TIME`."""
        return [site for site, segment in self.segments.items() if segment.still_time() < STANDING_TIME]

    def reset(self, site: Site) -> None:
        """Discard the times of a sensor whose clock restarts."""
        segment = self.segments[site]
        segment.t = segment.earlier_t = segment.still_since = None
        self.times.pop(site, None)
        self.ahead_t.pop(site, None)
        self.newest = max(self.times.values(), default=None)

    def is_current(self, t: float) -> bool:
        """Return whether the chain can be used at `t` s."""
        return self.aligned and not self.restarted and not self._ages(t)

    def _ages(self, t: float) -> dict[Site, float]:
        """Return the ages of the newest attitudes that are too old, or too far ahead, at `t` s."""
        ages = {site: t - segment.t for site, segment in self.segments.items() if segment.t is not None}
        return {site: age for site, age in ages.items() if abs(age) >= ATTITUDE_VALID_TIME}

    def missing(self) -> list[Site]:
        """Return the sites above the ankles without an attitude."""
        return [site for site in LIMB_SITES if self.segments[site].t is None]

    def why_unusable(self, t: float) -> str:
        """Return the reason why the chain cannot be used at `t` s."""
        missing = self.missing()
        if missing:
            silent = [site for site in missing if site not in self.times]
            return f"no sensor heard at the {names(silent)}" if silent else f"no attitude of the {names(missing)}"
        if self.restarted:
            return f"the sensor at the {names(self.restarted)} restarted, and its world with it"
        if not self.aligned:
            return "the wearer did not stand still before the first step"
        ages = self._ages(t)
        oldest = max(ages.values(), key=abs, default=0.0)
        return f"the newest attitude of the {names(ages)} is {abs(oldest):.2g} s {'old' if oldest > 0.0 else 'ahead'}"

    def complete(self) -> float | None:
        """Return the time up to which the attitudes of all segments are known, s; None if one has none."""
        times = [segment.t for segment in self.segments.values() if segment.t is not None]
        return min(times) if len(times) == len(SEGMENTS) else None

    def _attitude(self, site: Site, t: float) -> Quat:
        """Return the attitude at `t` s, from the segment to the world frame."""
        facing = self.heading or 0.0
        return multiply(multiply(from_yaw(-facing), self.segments[site].rotation(t)), from_yaw(facing))

    def end(self, foot: Foot, t: float) -> Vec3:
        """Return P_L or P_R at `t` s: the end of the foot relative to the middle of the hips, world frame, m."""
        return self.rods(foot, t)[3]

    def rods(self, foot: Foot, t: float) -> tuple[Vec3, Vec3, Vec3, Vec3]:
        """Return hip, knee, ankle and end of the foot at `t` s, relative to the middle of the hips, world frame, m."""
        pelvis, thigh, shank, ankle = (self._attitude(site, t) for site in (Site.PELVIS, *LEG_SITES[foot]))
        return joints(pelvis, thigh, shank, ankle, self._hip(foot), self.settings.limbs)

    def _hip(self, foot: Foot) -> Vec3:
        return (0.0, (0.5 if foot is Foot.LEFT else -0.5) * self.settings.limbs.hip_width, 0.0)

    def legs(self, t: float) -> Legs | None:
        """Return the rods of both legs at `t` s; None if an attitude is not known then."""
        return (self.rods(Foot.LEFT, t), self.rods(Foot.RIGHT, t)) if self.is_current(t) else None

    def height(self, foot: Foot, t: float) -> float:
        """Return the height of the sole below the ankle at `t` s, relative to the middle of the hips, upwards, m.

        The height of the foot's end, P_Lz and P_Rz of (4), is not used: the chain has no toe joint, so when the heel
        rises, the end goes below the floor, and the foot that pushes off would be the lower one."""
        limbs = self.settings.limbs
        height = rotate(self._attitude(Site.PELVIS, t), self._hip(foot))[2]
        for site, length in zip(LEG_SITES[foot], (limbs.thigh, limbs.shank, limbs.ankle_height), strict=True):
            _, x, y, _ = self.segments[site].rotation(t)
            height -= length * (1.0 - 2.0 * (x * x + y * y))  # times the cosine of the angle from the vertical
        return height

    def forward(self, foot: Foot, t: float) -> Vec2:
        """Return the horizontal unit vector in the direction of a foot, world frame; (1, 0) if it points up or down."""
        x, y, _ = rotate(self._attitude(LEG_SITES[foot][2], t), (1.0, 0.0, 0.0))
        length = hypot(x, y)
        return (x / length, y / length) if length > 1e-6 else (1.0, 0.0)


def names(sites: Iterable[Site]) -> str:
    """Return the names of sites, for messages."""
    return ", ".join([site.words for site in sites])
