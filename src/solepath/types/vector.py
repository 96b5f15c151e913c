"""Vectors and quaternions as plain tuples, because at this size a numpy call costs more than the arithmetic."""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

from .records import Quat, Vec2, Vec3

GRAVITY = 9.80665
"""Standard gravity, m/s^2 (ISO 80000-3)."""

TIME_EPSILON = 1e-6
"""Tolerance with which durations are compared, s: one that is shorter by less than this counts as long enough.

Samples are often taken at round times. Rounding must not decide which sample ends a duration, otherwise the same walk
at another time of day would give other results."""

IDENTITY: Quat = (1.0, 0.0, 0.0, 0.0)
"""Quaternion of no rotation."""
ZERO: Vec3 = (0.0, 0.0, 0.0)
"""The zero vector."""
UP: Vec3 = (0.0, 0.0, 1.0)
"""Unit vector upwards, in a frame with z up."""


SPLIT = 2.0**29 + 1.0
"""Factor with which `to_float32` removes the lower 29 of a float's 53 bits."""


def to_float32(x: float) -> float:
    """Return `x` rounded to the 24 bits of a float32, whose other bits are zeros that a packed state compresses.

    Use it for values that are stored, not for values that are propagated (a covariance, a position). It takes 60 ns.
    `x` must be below 1e290 (T. J. Dekker, "A floating-point technique for extending
    the available precision", 1971)."""
    high = SPLIT * x
    return high - (high - x)


def sub(a: Vec3, b: Vec3) -> Vec3:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def add(a: Vec3, b: Vec3, k: float = 1.0) -> Vec3:
    """Return a + k b."""
    return (a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2])


def scaled(v: Vec3, k: float) -> Vec3:
    """Return k v."""
    return (v[0] * k, v[1] * k, v[2] * k)


def pair(z: complex) -> Vec2:
    """Return x and y of the vector x + iy."""
    return (z.real, z.imag)


def dot(a: Vec3, b: Vec3) -> float:
    """Return the scalar product a b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec3, b: Vec3) -> Vec3:
    """Return the vector product a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def across(v: Vec3, axis: Vec3) -> Vec3:
    """Return the part of `v` across `axis`, which has the length 1."""
    return add(v, axis, -dot(v, axis))


def add_quat(p: Quat, q: Quat, k: float = 1.0) -> Quat:
    """Return p + k q, which is not normalised."""
    return (p[0] + k * q[0], p[1] + k * q[1], p[2] + k * q[2], p[3] + k * q[3])


def multiply(p: Quat, q: Quat) -> Quat:
    """Return the Hamilton product p q: a rotation by q, then by p."""
    pw, px, py, pz = p
    qw, qx, qy, qz = q
    return (
        pw * qw - px * qx - py * qy - pz * qz,
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
    )


def conjugate(q: Quat) -> Quat:
    """Return the conjugate of q, which is the inverse rotation."""
    return (q[0], -q[1], -q[2], -q[3])


def normalise(q: Quat) -> Quat:
    """Return q scaled to length 1."""
    w, x, y, z = q
    k = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * k, x * k, y * k, z * k)


def unit(q: Quat) -> Quat | None:
    """Return a quaternion from a device, of any length, scaled to length 1; None for zero."""
    w, x, y, z = q
    length = sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length) if length > 0.0 else None


def rotate(q: Quat, v: Vec3) -> Vec3:
    """Return q v q*: sensor coordinates to world coordinates when q is sensor to world."""
    w, x, y, z = q
    vx, vy, vz = v
    tx = 2.0 * (y * vz - z * vy)
    ty = 2.0 * (z * vx - x * vz)
    tz = 2.0 * (x * vy - y * vx)
    return (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx)


def rotate_back(q: Quat, v: Vec3) -> Vec3:
    """Return q* v q: world coordinates to sensor coordinates when q is sensor to world."""
    return rotate(conjugate(q), v)


def turned(v: Vec3, yaw: float) -> Vec3:
    """Return v rotated about the vertical by `yaw` rad, counter-clockwise positive."""
    c, s = cos(yaw), sin(yaw)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])


def from_rotation_vector(r: Vec3) -> Quat:
    """Return the rotation by |r| rad about r."""
    x, y, z = r
    angle = sqrt(dot(r, r))
    if angle < 1e-9:
        return normalise((1.0, 0.5 * x, 0.5 * y, 0.5 * z))
    k = sin(0.5 * angle) / angle
    return (cos(0.5 * angle), k * x, k * y, k * z)


def from_yaw(yaw: float) -> Quat:
    """Return the rotation about the vertical by `yaw` rad, counter-clockwise positive."""
    return (cos(0.5 * yaw), 0.0, 0.0, sin(0.5 * yaw))


def tipped(q: Quat, tx: float, ty: float, tz: float = 0.0) -> Quat:
    """Return q after a small rotation by (2 tx, 2 ty, 2 tz) rad, about the axes of the world frame."""
    w, x, y, z = q
    return normalise(
        (w - tx * x - ty * y - tz * z, x + tx * w + ty * z - tz * y,
         y + ty * w + tz * x - tx * z, z + tz * w + tx * y - ty * x)
    )  # fmt: skip


def levelling(acc: Vec3) -> Quat:
    """Return the smallest rotation that takes the specific force `acc` at rest to straight up; heading stays."""
    x, y, z = acc
    length = sqrt(dot(acc, acc))
    if length == 0.0:
        return IDENTITY
    x, y, z = x / length, y / length, z / length
    if z < -0.999999:  # upside down: any horizontal axis works
        return (0.0, 1.0, 0.0, 0.0)
    # half-way quaternion of z-up and the measured up: (1 + cos, sensor_up x world_up)
    return normalise((1.0 + z, y, -x, 0.0))


def wrap_angle(angle: float) -> float:
    """Return the angle plus whole turns, from -pi to pi, rad."""
    return (angle + pi) % (2.0 * pi) - pi


def heading_turned(before: Quat, after: Quat) -> float:
    """Return the twist about the vertical from `before` to `after`, rad, counter-clockwise positive, in (-pi, pi]."""
    w, _, _, z = multiply(after, conjugate(before))
    turn = 2.0 * atan2(z, w)
    return turn - 2.0 * pi if turn > pi else turn + 2.0 * pi if turn <= -pi else turn
