"""Motion of one foot: exact pose, velocity, acceleration and angular rate at any instant.

A foot is a rigid shoe. Its motion in each of the four phases is a curve; second derivatives are continuous where two
curves meet. Specific force and angular rate are therefore analytical derivatives, not numerical differences:

    LOADING     the shoe rolls without slip over the heel arc; the pitch goes from its value at heel-strike to 0
    STATIONARY  the sole is flat; the pitch changes by a fraction of a milliradian
    PUSH_OFF    the shoe rolls without slip over the forefoot arc; the pitch goes from 0 to its value at toe-off
    SWING       the ankle point follows a curve on which the sole does not touch the ground

The velocity of a point p on the rolling shoe is omega x (p - contact). strides.py makes the curves; this module
evaluates them. The attitude is Rz(yaw) Ry(-pitch) Rx(roll), foot to world; pitch is positive when the toe is up."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from attrs import fields, frozen
from numpy.typing import NDArray

from ...types import Phase
from ...types.vector import GRAVITY
from ..routes.elevator import CarRide
from ..routes.escalator import EscalatorRide
from .curves import Array
from .shoe import Mounting
from .turning import matrices, rotation

RowIndices = NDArray[np.intp]

X, Y, Z, PITCH, YAW, ROLL = range(6)
"""Indices of the curves of a piece: x, y, z of the reference point (world, m), and pitch, yaw, roll (rad)."""

BLOCK = 65536
"""Number of instants computed at a time, because intermediate arrays need several times the memory of the result."""
PHASES = (Phase.STATIONARY, Phase.PUSH_OFF, Phase.SWING, Phase.LOADING)
"""Phases in the order of their numbers in `FootMotion.phase`."""


@frozen(eq=False)
class Kinematics:
    """The exact motion of one sensor at N instants."""

    t: Array
    """Times, s, (N)."""
    position: Array
    """Position in the world frame, m, (N, 3)."""
    velocity: Array
    """Velocity in the world frame, m/s, (N, 3)."""
    acceleration: Array
    """Acceleration in the world frame, m/s^2, (N, 3)."""
    attitude: Array
    """Unit quaternion that turns a vector of the sensor frame into the world frame, (N, 4)."""
    rate: Array
    """Angular rate in the sensor frame, rad/s, (N, 3)."""
    force: Array
    """Specific force in the sensor frame, m/s^2, (N, 3)."""


@frozen(eq=False)
class FootMotion:
    """The motion of one foot as a sequence of pieces in time; the foot stands before the first and after the last."""

    start: Array
    """Start of each piece, s, (rows)."""
    duration: Array
    """Duration of each piece, s, (rows)."""
    curves: Array
    """Coefficients of the curves x, y, z, m, and pitch, yaw, roll, rad, of each piece, (rows, 6, degree + 1)."""
    reference: Array
    """Coordinates x and z, in the foot frame, of the reference point that the curves move, m, (rows, 2)."""
    radius: Array
    """Radius of the arc on which the sole rolls, m, (rows); 0 in swing."""
    phase: Array
    """Index of the phase in PHASES, (rows)."""
    rides: tuple[CarRide | EscalatorRide, ...] = ()
    """Rides of the wearer. The curves contain neither the motion during a ride nor the displacement by an escalator."""

    def phases(self, t: Array) -> list[Phase]:
        """Return the phase of the foot at times `t`, s."""
        return [PHASES[int(k)] for k in self.phase[self._piece(t)]]

    def pitch(self, t: Array) -> Array:
        """Return the pitch of the sole, rad, (N); positive when the toe is up."""
        row = self._piece(t)
        return _evaluate(self._factors[0][:, PITCH], row, (t - self.start[row]) / self.duration[row])

    def at(self, t: Array, mounting: Mounting) -> Kinematics:
        """Return the motion of a sensor mounted on this foot at times `t`, s."""
        t = np.asarray(t, dtype=np.float64)
        return join_blocks([self._block(t[k : k + BLOCK], mounting) for k in range(0, max(len(t), 1), BLOCK)])

    def _block(self, t: Array, mounting: Mounting) -> Kinematics:
        row = self._piece(t)
        s = (t - self.start[row]) / self.duration[row]
        inverse_duration = 1.0 / self.duration[row]
        value, first, second = (_evaluate(self._factors[order], row, s) for order in range(3))
        first *= inverse_duration
        second *= inverse_duration**2
        pitch, yaw, roll = value[PITCH], value[YAW], value[ROLL]
        turn = rotation(yaw, -pitch, roll)
        rate, rate_change = _body_rates(value, first, second)

        # A rolling arc moves the reference point from its curve by radius * pitch against the heading.
        ahead = np.stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)], axis=1)
        radius = self.radius[row]
        centre, centre_v, centre_a = (
            np.ascontiguousarray(found[:3].T) - (radius * found[PITCH])[:, None] * ahead
            for found in (value, first, second)
        )

        # With the angular rate w and the arm r from the reference point c to the sensor, both in the foot frame:
        # v = v_c + w x r, a = a_c + w' x r + w x (w x r).
        x, y, z = mounting.position
        arm = np.stack([x - self.reference[row, 0], np.full_like(t, y), z - self.reference[row, 1]], axis=1)
        arm_velocity = np.cross(rate, arm)
        position = centre + _apply(turn, arm)
        velocity = centre_v + _apply(turn, arm_velocity)
        acceleration = centre_a + _apply(turn, np.cross(rate_change, arm) + np.cross(rate, arm_velocity))

        for ride in self.rides:
            moved = t >= ride.start
            if isinstance(ride, CarRide):
                moved &= t < ride.end
            rows = np.flatnonzero(moved)
            for total, added in zip((position, velocity, acceleration), ride.at(t[rows]), strict=True):
                total[rows] += added

        # Specific force is acceleration minus gravity, in the sensor frame.
        opposed_gravity = acceleration + np.array([0.0, 0.0, GRAVITY])
        force = np.einsum("nij,ni->nj", turn, opposed_gravity)
        mounting_turn = matrices(np.array([mounting.attitude]))[0]
        return Kinematics(
            t=t,
            position=position,
            velocity=velocity,
            acceleration=acceleration,
            attitude=_multiply(_quaternion(yaw, -pitch, roll), np.array(mounting.attitude)),
            rate=rate @ mounting_turn,
            force=force @ mounting_turn,
        )

    def _piece(self, t: Array) -> RowIndices:
        return np.clip(np.searchsorted(self.start, t, side="right") - 1, 0, len(self.start) - 1)

    @cached_property
    def _factors(self) -> list[Array]:
        """Coefficients of all curves and of their first and second derivatives by s, constant first, (k, 6, rows)."""
        derivatives = [np.polynomial.polynomial.polyder(self.curves, order, axis=2) for order in range(3)]
        return [np.ascontiguousarray(np.moveaxis(one, 2, 0).swapaxes(1, 2)) for one in derivatives]


def _evaluate(factors: Array, row: RowIndices, s: Array) -> Array:
    """Return the polynomials of these rows at `s`, (..., N), for factors (k, ..., rows)."""
    total: Array = factors[-1].take(row, axis=-1)
    for factor in factors[-2::-1]:
        total *= s
        total += factor.take(row, axis=-1)
    return total


def join_blocks(blocks: list[Kinematics]) -> Kinematics:
    """Return one record with the rows of all blocks in order."""
    if len(blocks) == 1:
        return blocks[0]
    return Kinematics(*(np.concatenate([getattr(b, field.name) for b in blocks]) for field in fields(Kinematics)))


def _body_rates(value: Array, first: Array, second: Array) -> tuple[Array, Array]:
    """Return angular rate and its derivative in the foot frame for Rz(yaw) Ry(b) Rx(roll), with b = -pitch."""
    b, b1, b2 = -value[PITCH], -first[PITCH], -second[PITCH]
    roll, r1, r2 = value[ROLL], first[ROLL], second[ROLL]
    y1, y2 = first[YAW], second[YAW]
    sb, cb, sr, cr = np.sin(b), np.cos(b), np.sin(roll), np.cos(roll)
    rate = np.stack([r1 - y1 * sb, b1 * cr + y1 * sr * cb, -b1 * sr + y1 * cr * cb], axis=1)
    change = np.stack(
        [
            r2 - y2 * sb - y1 * b1 * cb,
            b2 * cr - b1 * r1 * sr + y2 * sr * cb + y1 * r1 * cr * cb - y1 * b1 * sr * sb,
            -b2 * sr - b1 * r1 * cr + y2 * cr * cb - y1 * r1 * sr * cb - y1 * b1 * cr * sb,
        ],
        axis=1,
    )
    return rate, change


def _quaternion(yaw: Array, b: Array, roll: Array) -> Array:
    """Return Rz(yaw) Ry(b) Rx(roll) as quaternions, (N, 4), w x y z."""
    sy, cy, sb, cb = np.sin(yaw / 2), np.cos(yaw / 2), np.sin(b / 2), np.cos(b / 2)
    sr, cr = np.sin(roll / 2), np.cos(roll / 2)
    return np.stack(
        [
            cy * cb * cr + sy * sb * sr,
            cy * cb * sr - sy * sb * cr,
            cy * sb * cr + sy * cb * sr,
            sy * cb * cr - cy * sb * sr,
        ],
        axis=1,
    )


def _multiply(p: Array, q: Array) -> Array:
    """Return the Hamilton products of p (N, 4) with one q."""
    w, x, y, z = q
    return np.asarray(p @ np.array([[w, x, y, z], [-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]]))


def _apply(turn: Array, v: Array) -> Array:
    return np.asarray(np.einsum("nij,nj->ni", turn, v))
