"""The body above the feet: motion of pelvis, thighs and shanks during a walk, at any instant.

The body's centre of mass x is a linear inverted pendulum over the feet (Kajita et al. 2001, IROS). With the centre of
pressure p of both feet and w = sqrt(g / h) for the height h of the centre of mass, x'' = w^2 (x - p). The only bounded
motion is x = (w / 2) integral of p(s) exp(-w |t - s|) ds; it contains sway, variation of speed and leaning into bends.
The pelvis is assumed above x, as high as both legs allow; the height is smoothed. It turns with the feet and with the
leg ahead, and sinks on the side of the leg in swing, each by 4 degrees (Perry, Gait Analysis, 1992).

Each leg has two links of constant length from the hip joint to the ankle. The knee bends forward, in a plane whose
direction is the mean of the forward directions of pelvis and foot.

The foot slides a little in its shoe (Gong et al. 2023, Sensors 23, 5417, fig. 9): the force between body and ground
moves it in x and y by up to MAX_SLIP, which is assumed because the paper has no figures. The sensor sits on the shoe,
but a kinematic chain of limbs ends at the foot; the two differ by the slip.

A segment is the pelvis, a thigh, a shank or a foot. When the wearer stands straight, the axes of every segment frame
are x ahead, y left, z up. The frame of the pelvis has its origin between the hip joints. That of a thigh has it at the
hip, with z from knee to hip, and that of a shank at the knee, with z from ankle to knee. A foot has the foot frame.
Numbers without a source were chosen by hand for plausible motion and not swept."""

from __future__ import annotations

from collections.abc import Callable
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
from .motion import BLOCK, FootMotion, Kinematics, join_blocks
from .shoe import Mounting, Shoe
from .turning import matrices, multiply_quaternions, quaternions, rotation, twice_axis, unit
from .zones import FOREFOOT, HEEL, MIDFOOT, TOES

INTERVAL = 0.01
"""Time between the instants at which the pelvis is computed, s; cubic B-splines interpolate between them."""
MAX_REACH = 0.998
"""Largest distance from hip to ankle, as a share of the leg's length; below 1 the knee is never quite straight."""
MAX_REACH_RUNNING = 0.97
"""MAX_REACH in running, which lands with the knee bent by some 20 degrees (Novacheck 1998, Gait & Posture 7)."""
FOLLOW_TIME = 0.2
"""Length of the window that smooths height, roll and yaw of the pelvis as they follow the legs, s."""
TURN_TIME = 1.1
"""Length of the window that smooths the heading of the feet for the pelvis, s: about a stride."""
YAW_PER_LEAD = 0.10
"""Yaw of the pelvis per distance of one foot ahead of the other, rad/m; it makes 4 degrees each way at 1.3 m/s."""
PELVIS_ROLL = 0.07
"""Roll by which the pelvis sinks on the side of the leg in swing, rad."""
MAX_SLIP = (0.006, 0.004)
"""Largest slip of a foot in its shoe, either way along x and along y of the foot frame, m (assumed)."""
SLIP_ACCELERATION = 2.0
"""Acceleration of the body at which the slip is three quarters of MAX_SLIP, m/s^2 (assumed)."""
_MARGIN_TIME = 4.0
"""Time before the start and after the end of the walk for which the pelvis is computed too, s."""
_DIFFERENCE_STEP = 1e-3
"""Step of the numerical differentiation, s."""
_NO_MOUNTING = Mounting((0.0, 0.0, 0.0))

SIDE_SIGNS = {Foot.LEFT: 1.0, Foot.RIGHT: -1.0}
FOOT_OF_SITE: dict[Site, Foot] = {site: Foot(site.value.partition("_")[0]) for site in Site if site is not Site.PELVIS}
"""Foot on whose side each site is, for every site except the pelvis."""
_THIGHS = (Site.LEFT_THIGH, Site.RIGHT_THIGH)


@frozen(eq=False)
class Leg:
    """Joints and segments of one leg at N instants, world frame."""

    hip: Array
    """Hip joint, m, (N, 3)."""
    knee: Array
    """Knee joint, m, (N, 3)."""
    ankle: Array
    """Ankle joint, m, (N, 3)."""
    thigh: Array
    """Attitude of the thigh as rotation matrices, segment to world, (N, 3, 3)."""
    shank: Array
    """Attitude of the shank as rotation matrices, segment to world, (N, 3, 3)."""

    def segment(self, site: Site) -> tuple[Array, Array]:
        """Return origin and attitude of the segment of a site on the thigh or the shank."""
        return (self.hip, self.thigh) if site in _THIGHS else (self.knee, self.shank)


@frozen(eq=False)
class Body:
    """Motion of the pelvis and the legs over time; rows of `track` and `slips` are INTERVAL s apart."""

    limbs: Limbs
    """Lengths of the limbs."""
    shoe: Shoe
    """Shoe of either foot."""
    motions: dict[Foot, FootMotion]
    """Motion of each foot."""
    t_start: float
    """Time of the first row of `track` and `slips`, s."""
    track: Array
    """Position x, y, z, m, yaw and roll, rad, of the pelvis in the world frame, (n, 5)."""
    slips: dict[Foot, Array]
    """Slip of each foot in its shoe along x and y of the foot frame, m, (n, 2)."""

    def pelvis(self, t: Array) -> tuple[Array, Array]:
        """Return the point between the hips (N, 3), world, m, and the attitude (N, 3, 3) of the pelvis at `t`, s."""
        values = self._interpolate(self.track, t)
        return values[:, :3], rotation(values[:, 3], np.zeros(len(t)), values[:, 4])

    def slip(self, foot: Foot, t: Array) -> Array:
        """Return the slip of the foot in its shoe along x and y of the foot frame at times `t`, s, m, (N, 2)."""
        return self._interpolate(self.slips[foot], t)

    def leg(self, foot: Foot, t: Array) -> Leg:
        """Return the joints and segments of a leg at times `t`, s."""
        position, turn = self.pelvis(t)
        hip = position + turn[:, :, 1] * (0.5 * SIDE_SIGNS[foot] * self.limbs.hip_width)
        shoe = self.motions[foot].at(t, Mounting(ankle_place(self.shoe, self.limbs)))
        sole = matrices(shoe.attitude)
        ankle = np.asarray(shoe.position + _slip_vector(sole, self.slip(foot, t)))
        forward = _horizontal(turn[:, :, 0]) + _forward(sole)
        thigh, shank = self.limbs.thigh, self.limbs.shank
        down = ankle - hip
        reach = np.linalg.norm(down, axis=1, keepdims=True)
        up = -down / reach
        left = unit(np.cross(up, forward))
        # The law of cosines gives the knee's position along the line from hip to ankle, Pythagoras the distance to it.
        knee_distance = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
        knee_offset = np.sqrt(np.maximum(thigh**2 - knee_distance**2, 0.0))
        knee = hip - up * knee_distance + np.cross(left, up) * knee_offset
        return Leg(hip, knee, ankle, _frame(hip - knee, left), _frame(knee - ankle, left))

    def segment(self, site: Site, t: Array) -> tuple[Array, Array]:
        """Return origin (N, 3), world, m, and attitude (N, 3, 3), segment to world, of a site's segment at `t`, s."""
        if site is Site.PELVIS:
            return self.pelvis(t)
        foot = FOOT_OF_SITE[site]
        if site.foot is not None:
            kinematics = self.motions[foot].at(t, _NO_MOUNTING)
            return kinematics.position, matrices(kinematics.attitude)
        return self.leg(foot, t).segment(site)

    def at(self, site: Site, t: Array, mounting: Mounting) -> Kinematics:
        """Return the motion of a sensor at times `t`, s: exact on a foot, elsewhere from differences over 2 ms."""
        t = np.asarray(t, dtype=np.float64)
        if site.foot is not None:
            return self.motions[site.foot].at(t, mounting)
        return motion_of(lambda times: self.segment(site, times), t, mounting)

    def _interpolate(self, track: Array, t: Array) -> Array:
        """Return the values at `t`, s, of a table whose rows are the coefficients of uniform cubic B-splines."""
        row_number = np.clip((t - self.t_start) / INTERVAL, 1.0, len(track) - 3.0)
        k = row_number.astype(np.intp)
        u = (row_number - k)[:, None]
        return np.asarray(
            (1.0 - u) ** 3 / 6.0 * track[k - 1]
            + (3.0 * u**3 - 6.0 * u**2 + 4.0) / 6.0 * track[k]
            + (-3.0 * u**3 + 3.0 * u**2 + 3.0 * u + 1.0) / 6.0 * track[k + 1]
            + u**3 / 6.0 * track[k + 2]
        )


def motion_of(pose: Callable[[Array], tuple[Array, Array]], t: Array, mounting: Mounting) -> Kinematics:
    """Return the motion at times `t`, s, of a sensor on a rigid body, from differences of its pose over 2 ms.

    `pose` returns the origin (N, 3), world, m, and the attitude (N, 3, 3), body to world, at increasing times."""
    t = np.asarray(t, dtype=np.float64)
    return join_blocks([_motion_of(pose, t[k : k + BLOCK], mounting) for k in range(0, max(len(t), 1), BLOCK)])


def _motion_of(pose: Callable[[Array], tuple[Array, Array]], t: Array, mounting: Mounting) -> Kinematics:
    (p0, r0), (p1, r1), (p2, r2) = (pose(t + k * _DIFFERENCE_STEP) for k in (-1, 0, 1))
    arm = np.array(mounting.position)
    before, position, after = p0 + r0 @ arm, p1 + r1 @ arm, p2 + r2 @ arm
    acceleration = (before - 2.0 * position + after) / _DIFFERENCE_STEP**2
    # r0^T r2 minus its transpose is 4 steps times the matrix of the cross product with the rate.
    rate = twice_axis(np.einsum("nji,njk->nik", r0, r2) / (4.0 * _DIFFERENCE_STEP))
    force = np.einsum("nji,nj->ni", r1, acceleration + (0.0, 0.0, GRAVITY))
    mounting_turn = matrices(np.array([mounting.attitude]))[0]
    return Kinematics(
        t=t,
        position=position,
        velocity=(after - before) / (2.0 * _DIFFERENCE_STEP),
        acceleration=acceleration,
        attitude=multiply_quaternions(quaternions(r1), np.array([mounting.attitude])),
        rate=rate @ mounting_turn,
        force=force @ mounting_turn,
    )


def ankle_place(shoe: Shoe, limbs: Limbs) -> Vec3:
    """Return the position of the ankle joint in the foot frame, m, for a foot that has not slipped in its shoe."""
    return (shoe.ankle[0], 0.0, limbs.ankle_height)


def body(
    plan: WalkPlan, motions: dict[Foot, FootMotion], loads: Loads, shoe: Shoe, height: float, limbs: Limbs
) -> Body:
    """Return the body of a wearer whose centre of mass is `height`, m, above the ground when the wearer stands."""
    t = np.arange(-_MARGIN_TIME, plan.duration + _MARGIN_TIME, INTERVAL)
    cop = _centre_of_pressure(plan, loads, shoe, t)
    w = sqrt(GRAVITY / height)
    centre = _filter(cop, np.exp(-w * INTERVAL * np.abs(np.arange(-round(3.0 / INTERVAL), round(3.0 / INTERVAL) + 1))))
    acceleration = w * w * (centre - cop)

    feet = {foot: motions[foot].at(t, Mounting(ankle_place(shoe, limbs))) for foot in Foot}
    turns = {foot: matrices(feet[foot].attitude) for foot in Foot}
    load_shares = {foot: loads.share(foot, t) for foot in Foot}
    slips = {foot: _smooth(_slip(turns[foot], acceleration, load_shares[foot]), 0.5 * FOLLOW_TIME) for foot in Foot}
    ankles = {foot: feet[foot].position + _slip_vector(turns[foot], slips[foot]) for foot in Foot}

    forwards = [_forward(turn) for turn in turns.values()]
    yaws = [np.unwrap(np.arctan2(forward[:, 1], forward[:, 0])) for forward in forwards]
    yaw = _smooth(0.5 * (yaws[0] + yaws[1])[:, None], TURN_TIME)[:, 0]
    separation = ankles[Foot.LEFT] - ankles[Foot.RIGHT]
    lead = separation[:, 0] * np.cos(yaw) + separation[:, 1] * np.sin(yaw)
    # A left foot ahead turns the pelvis to the right; a loaded left foot lets its right side sink.
    sway = np.stack((-YAW_PER_LEAD * lead, PELVIS_ROLL * (load_shares[Foot.LEFT] - load_shares[Foot.RIGHT])), axis=1)
    sway = _smooth(sway, FOLLOW_TIME)
    yaw, roll = yaw + sway[:, 0], sway[:, 1]

    reach = _reach_limit(plan, t) * (limbs.thigh + limbs.shank)
    half_hip = 0.5 * limbs.hip_width * rotation(yaw, np.zeros(len(t)), roll)[:, :, 1]
    highest = np.full(len(t), np.inf)
    for foot in Foot:
        horizontal_offset = ankles[foot][:, :2] - centre - SIDE_SIGNS[foot] * half_hip[:, :2]
        rise = np.sqrt(np.maximum(reach**2 - np.sum(horizontal_offset**2, axis=1), 0.0))
        highest = np.minimum(highest, ankles[foot][:, 2] + rise - SIDE_SIGNS[foot] * half_hip[:, 2])
    z = _smooth(_running_minimum(highest, round(0.5 * FOLLOW_TIME / INTERVAL) + 2)[:, None], FOLLOW_TIME)
    track = np.concatenate((centre, z, yaw[:, None], roll[:, None]), axis=1)
    return Body(limbs, shoe, motions, float(t[0]), track, slips)


def _reach_limit(plan: WalkPlan, t: Array) -> Array:
    """Return the largest distance from hip to ankle at times `t`, s, as a share of the leg's length, (N)."""
    reach_limit = np.full(len(t), MAX_REACH)
    runs = [s for foot in Foot for s in plan.strides[foot] if s.kind is StrideKind.RUN]
    if not runs:
        return reach_limit
    for stride in runs:
        reach_limit[(t > stride.toe_off - FOLLOW_TIME) & (t < stride.foot_flat + FOLLOW_TIME)] = MAX_REACH_RUNNING
    return np.asarray(np.minimum(_smooth(reach_limit[:, None], 2.0 * FOLLOW_TIME)[:, 0], reach_limit))


def _centre_of_pressure(plan: WalkPlan, loads: Loads, shoe: Shoe, t: Array) -> Array:
    """Return the centre of pressure of both feet together at times `t`, s, as x and y, world frame, m, (N, 2)."""
    total = plan.ground_shift(t)[:, :2]
    for foot in Foot:
        poses = [plan.starts[foot], *(stride.end for stride in plan.strides[foot])]
        table = np.array([(pose.x, pose.y, pose.heading) for pose in poses])
        x, y, yaw = table[loads.stance_rows(foot, t)].T
        zones = np.array([zone.x for zone in (HEEL, MIDFOOT, FOREFOOT, TOES)]) * shoe.length
        ahead, left = zones @ loads.zone_shares(foot, t) - shoe.ankle[0], loads.lateral_shift(foot, t)
        point = np.stack((x + ahead * np.cos(yaw) - left * np.sin(yaw), y + ahead * np.sin(yaw) + left * np.cos(yaw)))
        total += loads.share(foot, t)[:, None] * point.T
    return total


def _slip(turn: Array, acceleration: Array, share: Array) -> Array:
    """Return the slip of a foot, (N, 2), foot frame, m; it is against the acceleration of the body."""
    ahead, left = _forward(turn)[:, :2], _horizontal(turn[:, :, 1])[:, :2]
    local_pull = np.stack((np.sum(ahead * acceleration, axis=1), np.sum(left * acceleration, axis=1)), axis=1)
    return np.asarray(-share[:, None] * np.tanh(local_pull / SLIP_ACCELERATION) * MAX_SLIP)


def _slip_vector(turn: Array, slip: Array) -> Array:
    """Return a slip ahead and to the left in the foot frame as a displacement in the world frame, m, (N, 3)."""
    return np.asarray(slip[:, :1] * turn[:, :, 0] + slip[:, 1:] * turn[:, :, 1])


def _filter(track: Array, kernel: Array) -> Array:
    """Return each column filtered by `kernel` scaled to sum 1; the end values are repeated beyond the ends."""
    half = len(kernel) // 2
    padded = np.pad(track, ((half, half), (0, 0)), mode="edge")
    return np.stack([np.convolve(column, kernel / kernel.sum(), mode="valid") for column in padded.T], axis=1)


def _smooth(track: Array, window: float) -> Array:
    return _filter(track, np.hanning(2 * round(0.5 * window / INTERVAL) + 3)[1:-1])


def _running_minimum(values: Array, half: int) -> Array:
    padded = np.pad(values, half, mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1).min(axis=1))


def _horizontal(v: Array) -> Array:
    return unit(v * (1.0, 1.0, 0.0))


def _forward(turn: Array) -> Array:
    """Return the horizontal forward direction of a foot, also when a runner's foot is pitched beyond the vertical."""
    return np.asarray(_horizontal(turn[:, :, 0]) * np.where(turn[:, 2, 2] < 0.0, -1.0, 1.0)[:, None])


def _frame(up: Array, left: Array) -> Array:
    """Return attitudes with z along `up` and y along `left`, which are perpendicular."""
    z = unit(up)
    return np.stack((np.cross(left, z), left, z), axis=2)
