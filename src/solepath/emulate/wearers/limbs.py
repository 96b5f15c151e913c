"""The body above the feet: motion of pelvis, thighs and shanks during a walk, at any instant.

The body's centre of mass is a linear inverted pendulum over the feet (Kajita et al. 2001, IROS): with the load at p and
w = sqrt(g / h), x'' = w^2 (x - p). The only bounded motion is x = (w / 2) integral of p(s) exp(-w |t - s|) ds. Sway,
variation of the speed and lean into a bend follow from the positions of the load. The pelvis is assumed at that point.
Its height is what both legs can reach, smoothed. It turns with the feet; it also turns with the leg ahead and sinks
with the leg in the air, as gait laboratories measure (Perry, Gait Analysis, 1992: 4 degrees each).

Each leg has two links of constant length from the hip joint to the ankle and one solution: the knee bends forward, in a
plane whose direction is the mean of the pelvis' and the foot's forward directions.

The foot slides a little in its shoe (Gong et al. 2023, Sensors 23, 5417, fig. 9): the force between body and ground
moves it forward and back, left and right, by up to SLACK. The paper has no figures; SLACK is assumed. The sensor sits
on the shoe, so a kinematic chain of limbs that ends at the foot differs from the shoe's position by that.

Frames of segments, when standing straight: x ahead, y left, z up. Pelvis: origin between the hip joints. Thigh: at the
hip, z from knee to hip. Shank: at the knee, z from ankle to knee. Foot: that of types.Cell."""

from __future__ import annotations

from math import sqrt

import numpy as np
from attrs import frozen

from ...calibration import Limbs
from ...types import Foot, Site, Vec3
from ...types.vector import GRAVITY
from ..routes.styles import StrideKind
from .curves import Array
from .gait import WalkPlan
from .load import Loads
from .motion import BLOCK, FootMotion, Kinematics, joined
from .shoe import Mounting, Shoe
from .turning import matrices, multiplied, quaternions, turned, unit
from .zones import FOREFOOT, HEEL, MIDFOOT, TOES

STEP = 0.01
"""Time between the instants at which the pelvis is computed, s; cubic B-splines join them."""
MAX_REACH = 0.998
"""Largest distance from hip to ankle, as a share of the leg's length: the knee is never quite straight."""
MAX_REACH_RUNNING = 0.97
"""Largest reach of a runner, who lands with the knee bent by some 20 degrees (Novacheck 1998, Gait & Posture 7)."""
FOLLOW_TIME = 0.2
"""Time over which the pelvis follows the legs' reach, and turns and sinks with them, s."""
TURN_TIME = 1.1
"""Time over which the pelvis turns with the feet, s: about a stride."""
ROTATION = 0.10
"""Yaw of the pelvis per distance of one foot ahead of the other, rad/m: 4 degrees to each side at 1.3 m/s."""
DROP = 0.07
"""Roll by which the pelvis sinks on the side of the leg in the air, rad."""
SLACK = (0.006, 0.004)
"""Largest slip of a foot in its shoe forward and back, left and right, m (assumed)."""
SLACK_ACCELERATION = 2.0
"""Acceleration of the body at which the slip is three quarters of SLACK, m/s^2."""
_MARGIN = 4.0
"""Time before the first and after the last instant for which the pelvis is computed too, s."""
_DIFFERENCE_STEP = 1e-3
"""Step of the numerical differentiation, s."""
_NO_MOUNTING = Mounting((0.0, 0.0, 0.0))

SIDES = {Foot.LEFT: 1.0, Foot.RIGHT: -1.0}
SEGMENTS = {
    Site.LEFT_FOOT: Foot.LEFT,
    Site.RIGHT_FOOT: Foot.RIGHT,
    Site.LEFT_THIGH: Foot.LEFT,
    Site.RIGHT_THIGH: Foot.RIGHT,
    Site.LEFT_SHANK: Foot.LEFT,
    Site.RIGHT_SHANK: Foot.RIGHT,
}
"""Side of every site except the pelvis."""
_THIGHS = (Site.LEFT_THIGH, Site.RIGHT_THIGH)


@frozen(eq=False)
class Leg:
    """Joints and segments of one leg in the world frame."""

    hip: Array
    """Hip joint, m, (N, 3)."""
    knee: Array
    """Knee joint, m, (N, 3)."""
    ankle: Array
    """Ankle joint, m, (N, 3)."""
    thigh: Array
    """Attitude of the thigh, (N, 3, 3)."""
    shank: Array
    """Attitude of the shank, (N, 3, 3)."""


@frozen(eq=False)
class Body:
    """Motion of the pelvis and the legs over time; rows of `track` and `slips` are STEP s apart."""

    limbs: Limbs
    """Lengths of the limbs."""
    shoe: Shoe
    """Shoe of either foot."""
    motions: dict[Foot, FootMotion]
    """Motion of each foot."""
    t_start: float
    """Time of the first row, s."""
    track: Array
    """Position x, y, z, m, yaw and roll, rad, of the pelvis, (n, 5)."""
    slips: dict[Foot, Array]
    """Slip of each foot in its shoe, ahead and to the left, m, (n, 2)."""

    def pelvis(self, t: Array) -> tuple[Array, Array]:
        """Return the point between the hip joints (N, 3), m, and the attitude (N, 3, 3) of the pelvis."""
        found = self._joined(self.track, t)
        return found[:, :3], turned(found[:, 3], found[:, 4])

    def slip(self, foot: Foot, t: Array) -> Array:
        """Return the slip of the foot in its shoe, ahead and to the left, m, (N, 2)."""
        return self._joined(self.slips[foot], t)

    def ankle(self, foot: Foot, t: Array) -> Array:
        """Return the ankle joint of the foot in its shoe, (N, 3), world frame, m."""
        shoe = self.motions[foot].at(t, Mounting(ankle_place(self.shoe, self.limbs)))
        return np.asarray(shoe.position + _slid(matrices(shoe.attitude), self.slip(foot, t)))

    def leg(self, foot: Foot, t: Array) -> Leg:
        """Return the joints and segments of a leg at times `t`, s."""
        at, turn = self.pelvis(t)
        hip = at + turn[:, :, 1] * (0.5 * SIDES[foot] * self.limbs.hip_width)
        ankle = self.ankle(foot, t)
        look = _level(turn[:, :, 0]) + _ahead(matrices(self.motions[foot].at(t, _NO_MOUNTING).attitude))
        thigh, shank = self.limbs.thigh, self.limbs.shank
        down = ankle - hip
        reach = np.linalg.norm(down, axis=1, keepdims=True)
        up = -down / reach
        left = unit(np.cross(up, look))
        # The law of cosines gives the knee's position along the line from hip to ankle, Pythagoras the distance to it.
        along = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
        out = np.sqrt(np.maximum(thigh**2 - along**2, 0.0))
        knee = hip - up * along + np.cross(left, up) * out
        return Leg(hip, knee, ankle, _frame(hip - knee, left), _frame(knee - ankle, left))

    def segment(self, site: Site, t: Array) -> tuple[Array, Array]:
        """Return origin (N, 3), m, and attitude (N, 3, 3), segment to world, of the segment of a site."""
        if site is Site.PELVIS:
            return self.pelvis(t)
        foot = SEGMENTS[site]
        if site.foot is not None:
            found = self.motions[foot].at(t, _NO_MOUNTING)
            return found.position, matrices(found.attitude)
        leg = self.leg(foot, t)
        return (leg.hip, leg.thigh) if site in _THIGHS else (leg.knee, leg.shank)

    def at(self, site: Site, t: Array, mounting: Mounting) -> Kinematics:
        """Return the motion of a sensor at a site: exact on a foot, by differences over 2 ms elsewhere."""
        t = np.asarray(t, dtype=np.float64)
        if site.foot is not None:
            return self.motions[site.foot].at(t, mounting)
        return joined([self._at(site, t[k : k + BLOCK], mounting) for k in range(0, max(len(t), 1), BLOCK)])

    def _at(self, site: Site, t: Array, mounting: Mounting) -> Kinematics:
        (p0, r0), (p1, r1), (p2, r2) = (self.segment(site, t + k * _DIFFERENCE_STEP) for k in (-1, 0, 1))
        arm = np.array(mounting.position)
        before, position, after = p0 + r0 @ arm, p1 + r1 @ arm, p2 + r2 @ arm
        acceleration = (before - 2.0 * position + after) / _DIFFERENCE_STEP**2
        turn = np.einsum("nji,njk->nik", r0, r2) / (4.0 * _DIFFERENCE_STEP)
        rate = np.stack([turn[:, j, i] - turn[:, i, j] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)
        force = np.einsum("nji,nj->ni", r1, acceleration + (0.0, 0.0, GRAVITY))
        mount = matrices(np.array([mounting.attitude]))[0]
        return Kinematics(
            t=t,
            position=position,
            velocity=(after - before) / (2.0 * _DIFFERENCE_STEP),
            acceleration=acceleration,
            attitude=multiplied(quaternions(r1), np.array([mounting.attitude])),
            rate=rate @ mount,
            force=force @ mount,
        )

    def _joined(self, track: Array, t: Array) -> Array:
        """Return values of a track at any instants; its rows are the coefficients of uniform cubic B-splines."""
        place = np.clip((t - self.t_start) / STEP, 1.0, len(track) - 3.0)
        k = place.astype(np.intp)
        u = (place - k)[:, None]
        return np.asarray(
            (1.0 - u) ** 3 / 6.0 * track[k - 1]
            + (3.0 * u**3 - 6.0 * u**2 + 4.0) / 6.0 * track[k]
            + (-3.0 * u**3 + 3.0 * u**2 + 3.0 * u + 1.0) / 6.0 * track[k + 1]
            + u**3 / 6.0 * track[k + 2]
        )


def ankle_place(shoe: Shoe, limbs: Limbs) -> Vec3:
    """Return the ankle joint in the foot frame, m, without slip of the foot in its shoe."""
    return (shoe.ankle[0], 0.0, limbs.ankle_height)


def body(
    plan: WalkPlan, motions: dict[Foot, FootMotion], loads: Loads, shoe: Shoe, height: float, limbs: Limbs
) -> Body:
    """Return the body that walks by a plan; its centre of mass is `height` m above the ground when it stands."""
    t = np.arange(-_MARGIN, plan.duration + _MARGIN, STEP)
    pressed = _pressure_point(plan, loads, shoe, t)
    w = sqrt(GRAVITY / height)
    centre = _weighted(pressed, np.exp(-w * STEP * np.abs(np.arange(-round(3.0 / STEP), round(3.0 / STEP) + 1))))
    pull = w * w * (centre - pressed)

    feet = {foot: motions[foot].at(t, Mounting(ankle_place(shoe, limbs))) for foot in Foot}
    turns = {foot: matrices(feet[foot].attitude) for foot in Foot}
    share = {foot: loads.share(foot, t) for foot in Foot}
    slips = {foot: _smoothed(_slips(turns[foot], pull, share[foot]), 0.5 * FOLLOW_TIME) for foot in Foot}
    ankles = {foot: feet[foot].position + _slid(turns[foot], slips[foot]) for foot in Foot}

    looks = [_ahead(turn) for turn in turns.values()]
    yaws = [np.unwrap(np.arctan2(look[:, 1], look[:, 0])) for look in looks]
    yaw = _smoothed(0.5 * (yaws[0] + yaws[1])[:, None], TURN_TIME)[:, 0]
    apart = ankles[Foot.LEFT] - ankles[Foot.RIGHT]
    lead = apart[:, 0] * np.cos(yaw) + apart[:, 1] * np.sin(yaw)
    swing = np.stack((-ROTATION * lead, DROP * (share[Foot.LEFT] - share[Foot.RIGHT])), axis=1)
    swing = _smoothed(swing, FOLLOW_TIME)
    yaw, roll = yaw + swing[:, 0], swing[:, 1]

    reach = _reach_limit(plan, t) * (limbs.thigh + limbs.shank)
    half = 0.5 * limbs.hip_width * turned(yaw, roll)[:, :, 1]
    highest = np.full(len(t), np.inf)
    for foot in Foot:
        away = ankles[foot][:, :2] - centre - SIDES[foot] * half[:, :2]
        rise = np.sqrt(np.maximum(reach**2 - np.sum(away**2, axis=1), 0.0))
        highest = np.minimum(highest, ankles[foot][:, 2] + rise - SIDES[foot] * half[:, 2])
    z = _smoothed(_running_minimum(highest, round(0.5 * FOLLOW_TIME / STEP) + 2)[:, None], FOLLOW_TIME)
    track = np.concatenate((centre, z, yaw[:, None], roll[:, None]), axis=1)
    return Body(limbs, shoe, motions, float(t[0]), track, slips)


def _reach_limit(plan: WalkPlan, t: Array) -> Array:
    """Return the largest distance from hip to ankle over time, as a share of the leg's length, (N)."""
    least = np.full(len(t), MAX_REACH)
    runs = [s for foot in Foot for s in plan.strides[foot] if s.kind is StrideKind.RUN]
    if not runs:
        return least
    for stride in runs:
        least[(t > stride.toe_off - FOLLOW_TIME) & (t < stride.foot_flat + FOLLOW_TIME)] = MAX_REACH_RUNNING
    return np.asarray(np.minimum(_smoothed(least[:, None], 2.0 * FOLLOW_TIME)[:, 0], least))


def _pressure_point(plan: WalkPlan, loads: Loads, shoe: Shoe, t: Array) -> Array:
    """Return the centre of pressure of both feet together on the ground, (N, 2), m."""
    total = np.zeros((len(t), 2))
    for foot in Foot:
        places = [plan.starts[foot], *(stride.end for stride in plan.strides[foot])]
        table = np.array([(at.x, at.y, at.heading) for at in places])
        x, y, yaw = table[np.maximum(np.searchsorted(loads.stances[foot][:, 0], t, side="right") - 1, 0)].T
        zones = np.array([zone.x for zone in (HEEL, MIDFOOT, FOREFOOT, TOES)]) * shoe.length
        ahead, left = zones @ loads.shares(foot, t) - shoe.ankle[0], loads.lean(foot, t)
        place = np.stack((x + ahead * np.cos(yaw) - left * np.sin(yaw), y + ahead * np.sin(yaw) + left * np.cos(yaw)))
        total += loads.share(foot, t)[:, None] * place.T
    return total


def _slips(turn: Array, pull: Array, share: Array) -> Array:
    ahead, left = _ahead(turn)[:, :2], _level(turn[:, :, 1])[:, :2]
    local_pull = np.stack((np.sum(ahead * pull, axis=1), np.sum(left * pull, axis=1)), axis=1)
    return np.asarray(-share[:, None] * np.tanh(local_pull / SLACK_ACCELERATION) * SLACK)


def _slid(turn: Array, slip: Array) -> Array:
    """Return a slip ahead and to the left in the foot frame as a displacement in the world frame, m, (N, 3)."""
    return np.asarray(slip[:, :1] * turn[:, :, 0] + slip[:, 1:] * turn[:, :, 1])


def _weighted(track: Array, kernel: Array) -> Array:
    """Return the weighted mean of each column around every row; the end values are repeated beyond the ends."""
    half = len(kernel) // 2
    padded = np.pad(track, ((half, half), (0, 0)), mode="edge")
    return np.stack([np.convolve(column, kernel / kernel.sum(), mode="valid") for column in padded.T], axis=1)


def _smoothed(track: Array, over: float) -> Array:
    """Return a track smoothed by a Hann window of `over` s."""
    return _weighted(track, np.hanning(2 * round(0.5 * over / STEP) + 3)[1:-1])


def _running_minimum(values: Array, half: int) -> Array:
    """Return the minimum of each value and its `half` neighbours on either side."""
    padded = np.pad(values, half, mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1).min(axis=1))


def _level(v: Array) -> Array:
    """Return the horizontal unit directions of vectors."""
    return unit(v * (1.0, 1.0, 0.0))


def _ahead(turn: Array) -> Array:
    """Return the horizontal forward directions of feet, also where a runner's sole points backwards and up."""
    return np.asarray(_level(turn[:, :, 0]) * np.where(turn[:, 2, 2] < 0.0, -1.0, 1.0)[:, None])


def _frame(up: Array, left: Array) -> Array:
    """Return attitudes with z along `up` and y along `left`, which is perpendicular to it."""
    z = unit(up)
    return np.stack((np.cross(left, z), left, z), axis=2)
