"""The body above the feet: pelvis, thighs and shanks that go with a walk, at any instant.

The body's centre of mass is a linear inverted pendulum over the feet (Kajita et al. 2001, IROS): with the load at p and
w = sqrt(g / h), x'' = w^2 (x - p), and the one motion that falls neither way is x = (w / 2) integral of p(s)
exp(-w |t - s|) ds. Sway, the speed's ripple and the lean into a bend follow from where the feet press. The pelvis is
taken to be at that point. It is as high as both legs reach, smoothed; it turns with the feet, turns and sinks with
the leg that is ahead and in the air by what gait laboratories find (Perry, Gait Analysis, 1992: 4 degrees each).

Each leg has two links of constant length from the hip joint to the ankle and one solution: the knee bends forward, in
the plane of the leg that looks half where the pelvis and half where the foot does.

The foot is a little loose in its shoe (Gong et al. 2023, Sensors 23, 5417, fig. 9): the force between body and ground
pushes it forward and back, left and right, by up to SLACK. The paper has no figures; SLACK is assumed. The sensor sits
on the shoe, so that a chain of limbs that ends at the foot misses where the shoe is by that.

Frames of segments, as one stands straight: x ahead, y left, z up. Pelvis: origin between the hip joints. Thigh: at the
hip, z from knee to hip. Shank: at the knee, z from ankle to knee. Foot: that of types.Cell.
"""

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
"""s between the instants at which the pelvis is worked out; cubic B-splines join them."""
MAX_REACH = 0.998
"""Of a leg, at the most: nobody walks on a straight knee."""
MAX_REACH_RUNNING = 0.97
"""The same of a runner, who lands with the knee bent by some 20 degrees (Novacheck 1998, Gait & Posture 7)."""
FOLLOW_TIME = 0.2
"""s over which the pelvis follows the legs' reach, and turns and sinks with them."""
TURN_TIME = 1.1
"""s over which it turns with the feet: about a stride."""
ROTATION = 0.10
"""rad that the pelvis turns for every metre that one foot is ahead of the other: 4 degrees each way at 1.3 m/s."""
DROP = 0.07
"""rad that it sinks on the side of the leg in the air."""
SLACK = (0.006, 0.004)
"""m by which a foot slides in its shoe forward and back, left and right, at the most (assumed)."""
SLACK_ACCELERATION = 2.0
"""m/s^2 of the body's acceleration at which it has slid three quarters of that."""
_MARGIN = 4.0
"""s before the first and after the last instant for which the pelvis is worked out, too."""
_DIFFERENCE_STEP = 1e-3
"""s."""
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
"""The side of every site but the pelvis."""
_THIGHS = (Site.LEFT_THIGH, Site.RIGHT_THIGH)


@frozen(eq=False)
class Leg:
    """Joints of one leg, world frame, m, (N, 3), and the attitudes (N, 3, 3) of its thigh and shank."""

    hip: Array
    knee: Array
    ankle: Array
    thigh: Array
    shank: Array


@frozen(eq=False)
class Body:
    """The pelvis over time and what hangs on it.

    Every STEP s from `begin`: `track` (n, 5), x, y, z (m), yaw and roll (rad) of the pelvis, and `slips` (n, 2) of each
    foot in its shoe, ahead and to the left, m.
    """

    limbs: Limbs
    shoe: Shoe
    motions: dict[Foot, FootMotion]
    t_start: float
    track: Array
    slips: dict[Foot, Array]

    def pelvis(self, t: Array) -> tuple[Array, Array]:
        """Point between the hip joints (N, 3), m, and attitude (N, 3, 3)."""
        found = self._joined(self.track, t)
        return found[:, :3], turned(found[:, 3], found[:, 4])

    def slip(self, foot: Foot, t: Array) -> Array:
        """How far the foot has slid in its shoe, ahead and to the left, m, (N, 2)."""
        return self._joined(self.slips[foot], t)

    def ankle(self, foot: Foot, t: Array) -> Array:
        """The ankle joint of the foot in its shoe, (N, 3), world frame, m."""
        shoe = self.motions[foot].at(t, Mounting(ankle_place(self.shoe, self.limbs)))
        return np.asarray(shoe.position + _slid(matrices(shoe.attitude), self.slip(foot, t)))

    def leg(self, foot: Foot, t: Array) -> Leg:
        """The whole leg at instants `t`."""
        at, turn = self.pelvis(t)
        hip = at + turn[:, :, 1] * (0.5 * SIDES[foot] * self.limbs.hip_width)
        ankle = self.ankle(foot, t)
        look = _level(turn[:, :, 0]) + _ahead(matrices(self.motions[foot].at(t, _NO_MOUNTING).attitude))
        thigh, shank = self.limbs.thigh, self.limbs.shank
        down = ankle - hip
        reach = np.linalg.norm(down, axis=1, keepdims=True)
        up = -down / reach
        left = unit(np.cross(up, look))
        # The knee divides hip to ankle by the law of cosines, and stands out forward by what is left of the thigh.
        along = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
        out = np.sqrt(np.maximum(thigh**2 - along**2, 0.0))
        knee = hip - up * along + np.cross(left, up) * out
        return Leg(hip, knee, ankle, _frame(hip - knee, left), _frame(knee - ankle, left))

    def segment(self, site: Site, t: Array) -> tuple[Array, Array]:
        """Origin (N, 3), m, and attitude (N, 3, 3), segment to world, of what wears the sensor of a site."""
        if site is Site.PELVIS:
            return self.pelvis(t)
        foot = SEGMENTS[site]
        if site.foot is not None:
            found = self.motions[foot].at(t, _NO_MOUNTING)
            return found.position, matrices(found.attitude)
        leg = self.leg(foot, t)
        return (leg.hip, leg.thigh) if site in _THIGHS else (leg.knee, leg.shank)

    def at(self, site: Site, t: Array, mounting: Mounting) -> Kinematics:
        """Everything about a sensor on the segment of a site: exact on a foot, by differences over 2 ms above."""
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
        """Values of a track at any instants: its rows as the coefficients of uniform cubic B-splines."""
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
    """The ankle joint in the foot frame, m, while the foot has not slid in its shoe."""
    return (shoe.ankle[0], 0.0, limbs.ankle_height)


def body(
    plan: WalkPlan, motions: dict[Foot, FootMotion], loads: Loads, shoe: Shoe, height: float, limbs: Limbs
) -> Body:
    """The body that goes with a plan; its centre of mass stands `height` m high."""
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
    """How much of a leg's length hip and ankle are apart, at the most."""
    least = np.full(len(t), MAX_REACH)
    runs = [s for foot in Foot for s in plan.strides[foot] if s.kind is StrideKind.RUN]
    if not runs:
        return least
    for stride in runs:
        least[(t > stride.toe_off - FOLLOW_TIME) & (t < stride.foot_flat + FOLLOW_TIME)] = MAX_REACH_RUNNING
    return np.asarray(np.minimum(_smoothed(least[:, None], 2.0 * FOLLOW_TIME)[:, 0], least))


def _pressure_point(plan: WalkPlan, loads: Loads, shoe: Shoe, t: Array) -> Array:
    """Where the load of both feet together presses on the ground, (N, 2), m."""
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
    """A slip ahead and to the left in the foot's own axes, as a way in the world, (N, 3)."""
    return np.asarray(slip[:, :1] * turn[:, :, 0] + slip[:, 1:] * turn[:, :, 1])


def _weighted(track: Array, kernel: Array) -> Array:
    """Weighted means of each column around every row; ends go on as they are."""
    half = len(kernel) // 2
    padded = np.pad(track, ((half, half), (0, 0)), mode="edge")
    return np.stack([np.convolve(column, kernel / kernel.sum(), mode="valid") for column in padded.T], axis=1)


def _smoothed(track: Array, over: float) -> Array:
    """Smoothed over so many s."""
    return _weighted(track, np.hanning(2 * round(0.5 * over / STEP) + 3)[1:-1])


def _running_minimum(values: Array, half: int) -> Array:
    """The least of each value and `half` neighbours on either side."""
    padded = np.pad(values, half, mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1).min(axis=1))


def _level(v: Array) -> Array:
    """The horizontal direction of vectors."""
    return unit(v * (1.0, 1.0, 0.0))


def _ahead(turn: Array) -> Array:
    """Where feet of these attitudes look, level; a runner's heel is kicked up until the sole looks backwards and up."""
    return np.asarray(_level(turn[:, :, 0]) * np.where(turn[:, 2, 2] < 0.0, -1.0, 1.0)[:, None])


def _frame(up: Array, left: Array) -> Array:
    """Attitudes with z along `up`, y along `left`, which is across it."""
    z = unit(up)
    return np.stack((np.cross(left, z), left, z), axis=2)
