"""The curves of one foot: a smooth motion from the event times, positions and angles of its strides.

On the ground the pitch alone gives the motion (shoe.py). In the air the ankle point follows a quintic whose ends have
position, velocity and acceleration of the forefoot's roll at toe-off and of the heel's roll at heel-strike, plus a bump
that keeps the sole just above the ground.

At heel-strike the heel still moves by some decimetres per second relative to the ground, as in reality. Sole and heel
pad deform and stop it within IMPACT s; from then on the heel rolls without slip."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from attrs import evolve

from ...types import Foot, Phase
from ..routes.lift import CarRide
from ..routes.path import Flight, Pose
from ..routes.styles import StrideKind, style_of
from .curves import BUMP, EVEN_OUT, Array, End, constant, evaluate, join, part
from .gait import PlannedStride, WalkPlan
from .motion import PHASES, FootMotion
from .shoe import Rocker, Shoe

IMPACT = 0.014
"""Time that the sole and the heel pad take to stop the heel, s."""
SLIDE = 0.30
"""Forward speed of the heel just before contact, relative to the walking speed."""
SINK = 0.13
"""Downward speed of the heel just before contact, relative to the walking speed."""
PUSH = (2.1, -2.0)
"""Pitch rate and acceleration at toe-off in units of pitch per push-off time: the rate peaks just before toe-off."""
LAND = (0.5, -4.0)
"""Pitch rate and acceleration at heel-strike in units of pitch per loading time: slow at contact, then faster."""

CRUISE = 5.0
"""Weight of EVEN_OUT in swing: the peak speed of a foot is 1.7 times its mean, with a bare quintic it would be 1.9."""
REVERSAL = 0.22
"""Share of the swing in which the pitch rate changes from that of push-off to that of the swing forward."""
SWING_UP = 1.1
"""Pitch rate after the reversal, relative to the mean rate from there to heel-strike."""
KICK_PITCH, KICK_SHARE = -1.50, 0.34
"""Extreme pitch of a runner's foot in swing, rad (heel up), and the share of the swing at which it is reached."""
KICK_ACCELERATION = 4.0
"""Pitch acceleration at that extreme, in units of the remaining pitch change per square of the remaining time."""
_EVER = 1e6
"""Time for which a foot stands before the first and after the last stride, s."""

_Joint = tuple[Array, Array, Array]
"""Position, m, velocity, m/s, and acceleration, m/s^2, of the ankle point in the world frame, (3,) each."""


def foot_motions(plan: WalkPlan, shoe: Shoe) -> dict[Foot, FootMotion]:
    """Return the motion of both feet of a plan."""
    return {foot: _Pieces(shoe, plan.rides).joined(plan.starts[foot], plan.strides[foot]) for foot in Foot}


class _Pieces:
    """Collects the pieces of one foot's motion, rides in lifts included."""

    def __init__(self, shoe: Shoe, rides: tuple[CarRide, ...]) -> None:
        self.shoe = shoe
        self.rides = rides
        self.rows: list[tuple[float, float, list[Array], tuple[float, float], float, int]] = []

    def joined(self, start: Pose, strides: tuple[PlannedStride, ...]) -> FootMotion:
        """Return the motion of a foot that stands at `start`, makes the strides, and stands."""
        leaves = [*(stride.heel_off for stride in strides), _EVER]
        self.stand(start, -_EVER, leaves[0], 0.0)
        for stride, leave in zip(strides, leaves[1:], strict=True):
            self.push_off(stride)
            self.swing(stride)
            self.land(stride)
            self.stand(stride.end, stride.foot_flat, leave, stride.settle if leave < _EVER else 0.0)
        t_start, duration, curves, reference, radius, phase = map(np.array, zip(*self.rows, strict=True))
        return FootMotion(t_start, duration, curves, reference, radius, phase.astype(np.intp), self.rides)

    def stand(self, at: Pose, t_start: float, end: float, settle: float) -> None:
        """Add a stance with rides from `t_start` to `end`, s."""
        for car in self.rides:
            if t_start <= car.start and car.end <= end:
                # FootMotion adds the displacement of the car during the ride.
                self._roll(Phase.STATIONARY, self.shoe.heel, at, t_start, car.end, 0.0 * BUMP)
                at, t_start, settle = evolve(at, z=at.z + car.height), car.end, 0.0
        self._roll(Phase.STATIONARY, self.shoe.heel, at, t_start, end, settle * BUMP)

    def push_off(self, stride: PlannedStride) -> None:
        """Add the roll over the forefoot from heel-off to toe-off."""
        pitch = -stride.toe_off_pitch * _from_rest(PUSH)
        self._roll(Phase.PUSH_OFF, self.shoe.forefoot, stride.start, stride.heel_off, stride.toe_off, pitch)

    def land(self, stride: PlannedStride) -> None:
        """Add the motion from heel-strike to foot-flat: first the impact, then the pure roll."""
        t_start, end = stride.heel_strike, stride.foot_flat
        pitch = _landing(stride)
        cut = IMPACT / (end - t_start)
        give = [_give(speed) for speed in _residual(stride)]
        arc = self._lands_on(stride)
        self._roll(Phase.LOADING, arc, stride.end, t_start, t_start + IMPACT, part(pitch, 0.0, cut), give)
        self._roll(Phase.LOADING, arc, stride.end, t_start + IMPACT, end, part(pitch, cut, 1.0))

    def _lands_on(self, stride: PlannedStride) -> Rocker:
        """Return the arc that touches the ground first."""
        return self.shoe.forefoot if stride.strike_pitch < 0.0 else self.shoe.heel

    def swing(self, stride: PlannedStride) -> None:
        """Add the swing from toe-off to heel-strike."""
        shoe, duration = self.shoe, stride.heel_strike - stride.toe_off
        push, land = -stride.toe_off_pitch * _from_rest(PUSH), _landing(stride)
        off = _ends(push, 1.0, stride.toe_off - stride.heel_off)
        strike = _ends(land, 0.0, stride.foot_flat - stride.heel_strike)
        p0, v0, a0 = self._ankle(shoe.forefoot, stride.start, off)
        p1, v1, a1 = self._ankle(self._lands_on(stride), stride.end, strike)
        residual = np.array(_residual(stride))
        p1, v1 = p1 - 0.5 * IMPACT * residual, v1 + residual
        x, y, z = (join((p0[i], v0[i], a0[i]), (p1[i], v1[i], a1[i]), duration) for i in range(3))
        yaw = join((stride.start.heading, 0.0, 0.0), (stride.end.heading, 0.0, 0.0), duration) + stride.weave[1] * BUMP
        roll = stride.weave[0] * BUMP
        sideways = 0.5 * (stride.start.heading + stride.end.heading)
        cruise = CRUISE if stride.flight is None else 0.0
        x += -sin(sideways) * stride.weave[2] * BUMP + cruise * (p1[0] - p0[0]) * EVEN_OUT
        y += cos(sideways) * stride.weave[2] * BUMP + cruise * (p1[1] - p0[1]) * EVEN_OUT
        swung = _kicked_pitch if stride.kind is StrideKind.RUN else _swing_pitch
        pitches = swung(off, strike, duration)
        if stride.flight is not None:
            style = style_of(stride.kind, stride.speed)
            way = p1 - p0
            hold = style.hold * min(1.0, 2.0 * stride.flight.going / hypot(way[0], way[1]))
            x += hold * way[0] * BUMP
            y += hold * way[1] * BUMP
            z += style.soon * 2.0 * abs(stride.flight.rise) * EVEN_OUT
            z += self._over(stride, stride.flight, (x, y, z), pitches, yaw) * BUMP
        else:
            z += self._lift(stride, z, pitches, roll) * BUMP
        ankle = (shoe.ankle[0], shoe.ankle[2])
        turn = stride.toe_off + _reversal(stride) * duration
        for t_start, end, pitch in ((stride.toe_off, turn, pitches[0]), (turn, stride.heel_strike, pitches[1])):
            low, high = ((t - stride.toe_off) / duration for t in (t_start, end))
            curves = [part(curve, low, high) for curve in (x, y, z)]
            curves += [pitch, part(yaw, low, high), part(roll, low, high)]
            self._add(t_start, end, curves, ankle, 0.0, Phase.SWING)

    def _lift(self, stride: PlannedStride, z: Array, pitches: tuple[Array, Array], roll: Array) -> float:
        """Return the height of the bump, m, at which the sole's lowest point just has the clearance (itself a bump)."""
        shoe, s = self.shoe, np.linspace(0.1, 0.9, 41)
        ground = stride.start.z + (stride.end.z - stride.start.z) * s
        angle, bump = _pitch_at(pitches, s, _reversal(stride)), evaluate(BUMP, s)
        edge = 0.5 * shoe.width * np.abs(np.sin(evaluate(roll, s)))
        lift = -np.inf
        for arc in (shoe.heel, shoe.forefoot):
            centre = np.sin(angle) * (arc.x - shoe.ankle[0]) + np.cos(angle) * (arc.radius - shoe.ankle[2])
            low = evaluate(z, s) + centre - arc.radius - edge - ground
            lift = max(lift, float(np.max(stride.clearance - low / bump)))
        return lift

    def _over(
        self,
        stride: PlannedStride,
        flight: Flight,
        way: tuple[Array, Array, Array],
        pitches: tuple[Array, Array],
        yaw: Array,
    ) -> float:
        """Return the height of the bump, m, at which the sole just clears the treads and edges of a flight.

        The sole is the hull of its two arcs: discs with centre and radius interpolated from one arc to the other."""
        shoe, s = self.shoe, np.linspace(0.04, 0.96, 93)
        angle, bump = _pitch_at(pitches, s, _reversal(stride)), evaluate(BUMP, s)
        x, y, z, turned = (evaluate(curve, s) for curve in (*way, yaw))
        lift = 0.0
        for part_of in np.linspace(0.0, 1.0, 7):
            radius = shoe.heel.radius + (shoe.forefoot.radius - shoe.heel.radius) * part_of
            dx = shoe.heel.x + (shoe.forefoot.x - shoe.heel.x) * part_of - shoe.ankle[0]
            dz = radius - shoe.ankle[2]
            ahead, up = np.cos(angle) * dx - np.sin(angle) * dz, np.sin(angle) * dx + np.cos(angle) * dz
            least = flight.above(x + np.cos(turned) * ahead, y + np.sin(turned) * ahead, np.full(len(s), radius))
            lift = max(lift, float(np.max(stride.clearance + (least - z - up) / bump)))
        return lift

    def _ankle(self, arc: Rocker, at: Pose, pitch: End) -> _Joint:
        """Return the motion of the ankle point while the shoe rolls on `arc` with this pitch, rate and acceleration."""
        angle, rate, change = pitch
        dx, dz = self.shoe.ankle[0] - arc.x, self.shoe.ankle[2] - arc.radius
        along = cos(angle) * dx - sin(angle) * dz  # from the arc's centre to the ankle: ahead and up
        up = sin(angle) * dx + cos(angle) * dz
        ahead = np.array([cos(at.heading), sin(at.heading), 0.0])
        above = np.array([0.0, 0.0, 1.0])
        place = self._centre(arc, at)
        position = place + ahead * (along - arc.radius * angle) + above * up
        velocity = ahead * (-up - arc.radius) * rate + above * along * rate
        acceleration = ahead * ((-up - arc.radius) * change - along * rate**2) + above * (along * change - up * rate**2)
        return position, velocity, acceleration

    def _centre(self, arc: Rocker, at: Pose) -> Array:
        """Return the centre of an arc's circle while the foot stands flat, world frame, m."""
        forward = arc.x - self.shoe.ankle[0]
        return np.array([at.x + cos(at.heading) * forward, at.y + sin(at.heading) * forward, at.z + arc.radius])

    def _roll(
        self,
        phase: Phase,
        arc: Rocker,
        at: Pose,
        t_start: float,
        end: float,
        pitch: Array,
        give: list[Array] | None = None,
    ) -> None:
        place = [constant(float(value)) for value in self._centre(arc, at)]
        if give is not None:
            place = [a + b for a, b in zip(place, give, strict=True)]
        curves = [*place, pitch, constant(at.heading), constant(0.0)]
        self._add(t_start, end, curves, (arc.x, arc.radius), arc.radius, phase)

    def _add(
        self,
        t_start: float,
        end: float,
        curves: list[Array],
        reference: tuple[float, float],
        radius: float,
        phase: Phase,
    ) -> None:
        self.rows.append((t_start, end - t_start, curves, reference, radius, PHASES.index(phase)))


def _from_rest(end: tuple[float, float]) -> Array:
    """Return a curve from 0 at rest to 1 with the given slope and curvature."""
    return join((0.0, 0.0, 0.0), (1.0, end[0], end[1]), 1.0)


def _landing(stride: PlannedStride) -> Array:
    """Return the pitch from heel-strike to foot-flat: a start from rest, reversed in time."""
    return stride.strike_pitch * part(_from_rest(LAND), 1.0, 0.0)


def _swing_pitch(off: End, strike: End, duration: float) -> tuple[Array, Array]:
    """Return the pitch in swing: the reversal after toe-off, then a nearly constant rate until the foot is braked.

    The reversal lasts a, the rest of the swing b. With the rate r after the reversal, the pitch there is off + a
    (rate_off + r) / 2, and r is SWING_UP times the mean rate over b; this is solved for r."""
    a, b = REVERSAL * duration, (1.0 - REVERSAL) * duration
    rate = SWING_UP * (strike[0] - off[0] - 0.5 * a * off[1]) / (b + 0.5 * SWING_UP * a)
    middle = (off[0] + 0.5 * a * (off[1] + rate), rate, 0.0)
    return join(off, middle, a), join(middle, strike, b)


def _kicked_pitch(off: End, strike: End, duration: float) -> tuple[Array, Array]:
    """Return the pitch in a runner's swing: the heel rises to KICK_PITCH, then the foot swings forward."""
    a, b = KICK_SHARE * duration, (1.0 - KICK_SHARE) * duration
    top = (KICK_PITCH, 0.0, KICK_ACCELERATION * (strike[0] - KICK_PITCH) / b**2)
    return join(off, top, a), join(top, strike, b)


def _reversal(stride: PlannedStride) -> float:
    return KICK_SHARE if stride.kind is StrideKind.RUN else REVERSAL


def _pitch_at(pitches: tuple[Array, Array], s: Array, turn: float) -> Array:
    """Return the pitch at shares `s` of the swing; the first curve ends at share `turn`."""
    early, late = evaluate(pitches[0], s / turn), evaluate(pitches[1], (s - turn) / (1.0 - turn))
    return np.where(s < turn, early, late)


def _ends(curve: Array, s: float, duration: float) -> End:
    """Return value, velocity and acceleration of a curve at s, per second."""
    value, slope, bend = (float(evaluate(curve, s, order)) for order in range(3))
    return value, slope / duration, bend / duration**2


def _residual(stride: PlannedStride) -> tuple[float, float, float]:
    """Return the velocity of the heel beyond its roll when it touches the ground, world frame, m/s."""
    slide, sink = SLIDE * stride.speed, SINK * stride.speed
    if stride.kind is not StrideKind.WALK:
        style = style_of(stride.kind, stride.speed)
        slide, sink = style.slide, style.sink
    return (slide * cos(stride.end.heading), slide * sin(stride.end.heading), -sink)


def _give(speed: float) -> Array:
    """Return the displacement of the heel from pure rolling over the impact, m; its `speed` decays by a smooth step.

    It is v (1 - (10 s^3 - 15 s^4 + 6 s^5)), integrated so that it ends at 0; the deceleration is the pulse 30 s^2 (1 -
    s)^2."""
    return -speed * IMPACT * np.array([0.5, -1.0, 0.0, 0.0, 2.5, -3.0, 1.0, 0.0])
