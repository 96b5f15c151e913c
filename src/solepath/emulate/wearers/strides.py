"""The curves of one foot: a smooth motion from the event times, positions and angles of its strides.

On the ground the motion follows from the pitch alone (shoe.py). In swing the ankle point follows a quintic. At its
start it has position, velocity and acceleration of the roll over the forefoot at toe-off; at its end it has those of
the roll over the heel at heel-strike. A bump is added that keeps the sole just above the ground.

At heel-strike the heel still moves by some decimetres per second relative to the ground, as in reality. Sole and heel
pad deform and stop the heel within the impact time; from then on the heel rolls without slip. Impact, slip at toe-off
and the place where the sole bends may vary between strides (contact.py). Numbers without a source were chosen by
hand for plausible rates and forces of a foot and not swept."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from attrs import evolve

from ...types import Foot, Phase
from ..routes.path import Pose
from ..routes.styles import StrideKind
from .contact import MAX_IMPACT_SHARE, TOE_SLIP, impact_displacement, slip_at_toe_off
from .curves import BUMP, LEVELLING, Array, EndState, Rng, constant, evaluate, join, subcurve
from .gait import PlannedStride, WalkPlan, Wearer
from .motion import PHASES, FootMotion
from .ramps import axes, leaning, ramp_height, steeper
from .shoe import Rocker
from .swing import pitch_at, reversal_share, running_swing_pitch, walking_swing_pitch

TOE_OFF_SLOPES = (2.1, -2.0)
"""First and second derivative of the pitch at toe-off, in units of that pitch and the push-off time."""
HEEL_STRIKE_SLOPES = (0.5, -4.0)
"""Derivatives at heel-strike like TOE_OFF_SLOPES, with time running backwards from foot-flat."""

LEVELLING_WEIGHT = 5.0
"""Weight of LEVELLING in swing: it lowers the peak speed of a foot from 1.9 to 1.7 times the mean speed."""
SHORTEST_STANDING = 1.0
"""Shortest time of standing in which a foot sways, s; a stance in walking is shorter."""
_FOREVER = 1e6
"""Time for which a foot stands before the first and after the last stride, s."""

_PointMotion = tuple[Array, Array, Array]
"""Position, m, velocity, m/s, and acceleration, m/s^2, of the ankle point in the world frame, (3,) each."""


def foot_motions(plan: WalkPlan, wearer: Wearer, rng: Rng, contact_rng: Rng) -> dict[Foot, FootMotion]:
    """Return the motion of both feet of a plan.

    `rng` draws the sway of a wearer who sways, `contact_rng` the contact of the sole in each stride."""
    return {
        foot: _MotionBuilder(wearer, plan, rng, contact_rng).build(plan.starts[foot], plan.strides[foot])
        for foot in Foot
    }


class _MotionBuilder:
    """Builds the motion of one foot from pieces, with the elevator rides."""

    def __init__(self, wearer: Wearer, plan: WalkPlan, rng: Rng, contact_rng: Rng) -> None:
        self.worn_shoe, self.sway, self.rng, self.contact_rng = wearer.shoe, wearer.sway, rng, contact_rng
        self.shoe = wearer.shoe
        self.contact = wearer.shoe.contact.draw(contact_rng)
        self.rides, self.moving_ground, self.duration = plan.rides, plan.moving_ground, plan.duration
        self.rows: list[tuple[float, float, list[Array], tuple[float, float], float, int]] = []

    def build(self, start: Pose, strides: tuple[PlannedStride, ...]) -> FootMotion:
        """Return the motion of a foot that stands at `start`, makes the strides, and stands again."""
        leave_times = [*(stride.heel_off for stride in strides), _FOREVER]
        self.stand(start, -_FOREVER, leave_times[0], 0.0)
        for stride, leave_time in zip(strides, leave_times[1:], strict=True):
            self.contact = self.worn_shoe.contact.draw(self.contact_rng)
            self.shoe = self.worn_shoe.walking(self.contact.pivot_shift)
            self.push_off(stride)
            self.swing(stride)
            self.land(stride)
            self.stand(stride.end, stride.foot_flat, leave_time, stride.rest_pitch if leave_time < _FOREVER else 0.0)
        t_start, duration, curves, reference, radius, phase = map(np.array, zip(*self.rows, strict=True))
        return FootMotion(t_start, duration, curves, reference, radius, phase.astype(np.intp), self.moving_ground)

    def stand(self, pose: Pose, t_start: float, end: float, rest_pitch: float) -> None:
        """Add a foot that stands at `pose` from `t_start` to `end`, s; an elevator ride in this time lifts it."""
        for car in self.rides:
            if t_start <= car.start and car.end <= end:
                # FootMotion adds the displacement of the car during the ride.
                self._roll(Phase.STATIONARY, self.shoe.heel, pose, t_start, car.end, 0.0 * BUMP)
                pose, t_start, rest_pitch = evolve(pose, z=pose.z + car.height), car.end, 0.0
        first, last = max(t_start, 0.0), min(end, self.duration)
        if not self.sway or last - first < SHORTEST_STANDING:
            self._roll(Phase.STATIONARY, self.shoe.heel, pose, t_start, end, rest_pitch * BUMP)
            return
        arc = self.shoe.heel
        centre = [constant(float(value)) for value in self._centre(arc, pose)]
        for start, stop, (pitch, yaw, roll) in self.sway(t_start, end, first, last, self.rng):
            curves = leaning([*centre, pitch, yaw + constant(pose.heading), roll], pose, arc.radius)
            self._add(start, stop, curves, (arc.x, arc.radius), arc.radius, Phase.STATIONARY)

    def push_off(self, stride: PlannedStride) -> None:
        """Add the roll over the forefoot from heel-off to toe-off; a raised heel makes the pitch negative."""
        pitch = -stride.toe_off_pitch * _from_rest(TOE_OFF_SLOPES)
        slip = [axis * TOE_SLIP for axis in self._toe_slip(stride.start)]
        self._roll(Phase.PUSH_OFF, self.shoe.forefoot, stride.start, stride.heel_off, stride.toe_off, pitch, slip)

    def _toe_slip(self, pose: Pose) -> Array:
        """Return the displacement of the forefoot by slip at toe-off, world frame, m."""
        return np.asarray(-self.contact.toe_slip * axes(pose)[0])

    def _impact_time(self, stride: PlannedStride) -> float:
        """Return the time from heel-strike until the heel rolls without slip, s."""
        return min(self.contact.impact_time, MAX_IMPACT_SHARE * (stride.foot_flat - stride.heel_strike))

    def land(self, stride: PlannedStride) -> None:
        """Add the motion from heel-strike to foot-flat: first the impact, then the roll without slip."""
        t_start, end = stride.heel_strike, stride.foot_flat
        pitch = _landing_pitch(stride)
        impact_time = self._impact_time(stride)
        cut = impact_time / (end - t_start)
        impact = [impact_displacement(speed, impact_time) for speed in _excess(stride)]
        arc = self._landing_arc(stride)
        self._roll(Phase.LOADING, arc, stride.end, t_start, t_start + impact_time, subcurve(pitch, 0.0, cut), impact)
        self._roll(Phase.LOADING, arc, stride.end, t_start + impact_time, end, subcurve(pitch, cut, 1.0))

    def _landing_arc(self, stride: PlannedStride) -> Rocker:
        """Return the arc that touches the ground first."""
        return self.shoe.forefoot if stride.strike_pitch < 0.0 else self.shoe.heel

    def swing(self, stride: PlannedStride) -> None:
        """Add the swing from toe-off to heel-strike."""
        shoe, duration = self.shoe, stride.heel_strike - stride.toe_off
        push_off_pitch, landing_pitch = -stride.toe_off_pitch * _from_rest(TOE_OFF_SLOPES), _landing_pitch(stride)
        pitch_start = _end_state(push_off_pitch, 1.0, stride.toe_off - stride.heel_off)
        pitch_end = _end_state(landing_pitch, 0.0, stride.foot_flat - stride.heel_strike)
        p0, v0, a0 = self._ankle(shoe.forefoot, stride.start, pitch_start)
        slip, slip_v, slip_a = slip_at_toe_off(self._toe_slip(stride.start), stride.toe_off - stride.heel_off)
        p0, v0, a0 = p0 + slip, v0 + slip_v, a0 + slip_a
        p1, v1, a1 = self._ankle(self._landing_arc(stride), stride.end, pitch_end)
        pitch_start, pitch_end = steeper(pitch_start, stride.start), steeper(pitch_end, stride.end)
        # The impact moves the heel by half of what its speed at contact would in the same time.
        excess = np.array(_excess(stride))
        p1, v1 = p1 - 0.5 * self._impact_time(stride) * excess, v1 + excess
        x, y, z = (join((p0[i], v0[i], a0[i]), (p1[i], v1[i], a1[i]), duration) for i in range(3))
        yaw = (
            join((stride.start.heading, 0.0, 0.0), (stride.end.heading, 0.0, 0.0), duration)
            + stride.deviation[1] * BUMP
        )
        roll = stride.deviation[0] * BUMP
        heading = 0.5 * (stride.start.heading + stride.end.heading)
        levelling = LEVELLING_WEIGHT if stride.flight is None else 0.0
        x += -sin(heading) * stride.deviation[2] * BUMP + levelling * (p1[0] - p0[0]) * LEVELLING
        y += cos(heading) * stride.deviation[2] * BUMP + levelling * (p1[1] - p0[1]) * LEVELLING
        if stride.start.grade or stride.end.grade:
            z += levelling * (stride.end.z - stride.start.z) * LEVELLING  # the foot rises where it goes ahead
        curves_of_pitch = running_swing_pitch if stride.kind is StrideKind.RUN else walking_swing_pitch
        pitches = curves_of_pitch(pitch_start, pitch_end, duration)
        if stride.flight is not None:
            style, displacement = stride.style, p1 - p0
            hold = style.mid_swing_shift * min(1.0, 2.0 * stride.flight.going / hypot(displacement[0], displacement[1]))
            x += hold * displacement[0] * BUMP
            y += hold * displacement[1] * BUMP
            z += style.early_rise * 2.0 * abs(stride.flight.rise) * LEVELLING
        z += self._bump(stride, [x, y, z, yaw, roll], pitches) * BUMP
        ankle = (shoe.ankle[0], shoe.ankle[2])
        reversal = stride.toe_off + reversal_share(stride) * duration
        for t_start, end, pitch in ((stride.toe_off, reversal, pitches[0]), (reversal, stride.heel_strike, pitches[1])):
            shares = [(t - stride.toe_off) / duration for t in (t_start, end)]
            x_part, y_part, z_part, *turns = [subcurve(curve, *shares) for curve in (x, y, z, yaw, roll)]
            self._add(t_start, end, [x_part, y_part, z_part, pitch, *turns], ankle, 0.0, Phase.SWING)

    def _bump(self, stride: PlannedStride, curves: list[Array], pitches: tuple[Array, Array]) -> float:
        """Return the factor of BUMP, m, that keeps the sole at least `clearance` times BUMP above what is below it.

        `curves` are x, y and z of the ankle, yaw and roll. The sole is taken as discs, on stairs as more of them, whose
        centre and radius are interpolated between its two arcs."""
        shoe, flight, arcs = self.shoe, stride.flight, (self.shoe.heel, self.shoe.forefoot)
        s, discs, height = np.linspace(0.1, 0.9, 41), [(arc.x, arc.radius) for arc in arcs], -np.inf
        if flight is not None:
            s, shares, height = np.linspace(0.04, 0.96, 93), np.linspace(0.0, 1.0, 7).tolist(), 0.0
            (x0, r0), (x1, r1) = discs
            discs = [(x0 + (x1 - x0) * share, r0 + (r1 - r0) * share) for share in shares]
        x, y, z, yaw, roll = (evaluate(curve, s) for curve in curves)
        angle, bump = pitch_at(pitches, s, reversal_share(stride)), evaluate(BUMP, s)
        edge = 0.5 * shoe.width * np.abs(np.sin(roll))
        ground = stride.start.z + (stride.end.z - stride.start.z) * s
        for arc_x, radius in discs:
            dx, dz = arc_x - shoe.ankle[0], radius - shoe.ankle[2]
            ahead, up = np.cos(angle) * dx - np.sin(angle) * dz, np.sin(angle) * dx + np.cos(angle) * dz
            if flight is not None:
                least = flight.clear_height(x + np.cos(yaw) * ahead, y + np.sin(yaw) * ahead, np.full(len(s), radius))
                need = (least - z - up) / bump
            else:
                if stride.start.grade or stride.end.grade:
                    ground = ramp_height(stride.start, stride.end, x, y, ahead)
                need = -(z + up - radius - edge - ground) / bump
            height = max(height, float(np.max(stride.clearance + need)))
        return height

    def _ankle(self, arc: Rocker, pose: Pose, pitch: EndState) -> _PointMotion:
        """Return the motion of the ankle point while the shoe rolls on `arc` with this pitch, rate and acceleration.

        The pitch is relative to the ground."""
        angle, rate, rate_change = pitch
        dx, dz = self.shoe.ankle[0] - arc.x, self.shoe.ankle[2] - arc.radius
        along = cos(angle) * dx - sin(angle) * dz  # distances from the arc's centre to the ankle
        up = sin(angle) * dx + cos(angle) * dz
        ahead, vertical = axes(pose)
        centre = self._centre(arc, pose)
        position = centre + ahead * (along - arc.radius * angle) + vertical * up
        velocity = ahead * (-up - arc.radius) * rate + vertical * along * rate
        acceleration = ahead * ((-up - arc.radius) * rate_change - along * rate**2) + vertical * (
            along * rate_change - up * rate**2
        )
        return position, velocity, acceleration

    def _centre(self, arc: Rocker, pose: Pose) -> Array:
        """Return the centre of an arc's circle while the foot stands flat, world frame, m."""
        ahead, up = axes(pose)
        return np.array([pose.x, pose.y, pose.z]) + ahead * (arc.x - self.shoe.ankle[0]) + up * arc.radius

    def _roll(
        self,
        phase: Phase,
        arc: Rocker,
        pose: Pose,
        t_start: float,
        end: float,
        pitch: Array,
        slide: list[Array] | None = None,
    ) -> None:
        """Add a roll on `arc`; `slide` is the displacement from a roll without slip, world frame, m."""
        centre = [constant(float(value)) for value in self._centre(arc, pose)]
        if slide is not None:
            centre = [a + b for a, b in zip(centre, slide, strict=True)]
        curves = leaning([*centre, pitch, constant(pose.heading), constant(0.0)], pose, arc.radius)
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


def _landing_pitch(stride: PlannedStride) -> Array:
    """Return the pitch from heel-strike to foot-flat, rad; it is a curve from rest, reversed in time."""
    return stride.strike_pitch * subcurve(_from_rest(HEEL_STRIKE_SLOPES), 1.0, 0.0)


def _end_state(curve: Array, s: float, duration: float) -> EndState:
    """Return value, velocity and acceleration of a curve at `s` when the curve lasts `duration` s."""
    value, slope, bend = (float(evaluate(curve, s, order)) for order in range(3))
    return value, slope / duration, bend / duration**2


def _excess(stride: PlannedStride) -> tuple[float, float, float]:
    """Return the velocity of the heel at contact, world frame, m/s; rolling without slip would make it 0."""
    slide, sink = stride.style.forward_speed, stride.style.sink_speed
    return (slide * cos(stride.end.heading), slide * sin(stride.end.heading), -sink)
