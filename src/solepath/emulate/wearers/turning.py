"""Arrays of N rotations: matrices (N, 3, 3) and unit quaternions (N, 4), w x y z."""

from __future__ import annotations

import numpy as np

from .curves import Array


def unit(v: Array) -> Array:
    """Return each row scaled to length one."""
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def multiply_quaternions(p: Array, q: Array) -> Array:
    """Return the Hamilton products of two arrays of quaternions, (N, 4) each; one of them may be (1, 4)."""
    a, u = p[:, :1], p[:, 1:]
    b, v = q[:, :1], q[:, 1:]
    scalar = a * b - np.sum(u * v, axis=1, keepdims=True)
    return np.concatenate((scalar, a * v + b * u + np.cross(u, v)), axis=1)


def from_rotation_vectors(vectors: Array) -> Array:
    """Return the unit quaternions (N, 4) of rotation vectors (N, 3), rad."""
    angle = np.linalg.norm(vectors, axis=1, keepdims=True)
    # sin(angle / 2) / angle by the normalised sinc, which is 1 at 0
    return np.concatenate((np.cos(0.5 * angle), 0.5 * np.sinc(angle / (2.0 * np.pi)) * vectors), axis=1)


def matrices(q: Array) -> Array:
    """Return the rotation matrices (N, 3, 3) of unit quaternions (N, 4)."""
    w, x, y, z = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=1) for row in rows], axis=1)


def quaternions(turn: Array) -> Array:
    """Return the unit quaternions (N, 4) of rotation matrices, with signs that make them continuous.

    Candidate k is the quaternion multiplied by four times its component k. The candidate with the largest component is
    the most exact one; it is scaled to length one."""
    diagonal = np.diagonal(turn, axis1=1, axis2=2)
    trace = diagonal[:, 0] + diagonal[:, 1] + diagonal[:, 2]
    candidates = np.empty((len(turn), 4, 4))
    candidates[:, 0, 0] = 1.0 + trace
    candidates[:, 0, 1:] = candidates[:, 1:, 0] = twice_axis(turn)
    candidates[:, 1:, 1:] = turn + turn.swapaxes(1, 2)
    candidates[:, [1, 2, 3], [1, 2, 3]] = 1.0 + 2.0 * diagonal - trace[:, None]
    largest = np.argmax(np.diagonal(candidates, axis1=1, axis2=2), axis=1)
    q = unit(candidates[np.arange(len(candidates)), largest])
    flips = np.where(np.sum(q[1:] * q[:-1], axis=1) < 0.0, -1.0, 1.0)
    q[1:] *= np.cumprod(flips)[:, None]
    return np.asarray(q)


def twice_axis(turn: Array) -> Array:
    """Return the vectors (N, 3) whose cross products are matrices (N, 3, 3) less their transposes."""
    return np.stack([turn[:, j, i] - turn[:, i, j] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)


def rotation(yaw: Array, b: Array, roll: Array) -> Array:
    """Return Rz(yaw) Ry(b) Rx(roll) as matrices, (N, 3, 3)."""
    sy, cy, sb, cb, sr, cr = np.sin(yaw), np.cos(yaw), np.sin(b), np.cos(b), np.sin(roll), np.cos(roll)
    rows = [
        [cy * cb, cy * sb * sr - sy * cr, cy * sb * cr + sy * sr],
        [sy * cb, sy * sb * sr + cy * cr, sy * sb * cr - cy * sr],
        [-sb, cb * sr, cb * cr],
    ]
    return np.stack([np.stack(row, axis=1) for row in rows], axis=1)
