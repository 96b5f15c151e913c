"""Says in words what a calibration by hand leaves open: rests and turns that are missing."""

from __future__ import annotations

from itertools import product
from math import degrees, radians

import numpy as np

from ....types.vector import GRAVITY
from .fit import ACC, ACC_BIAS, BASIS, COLUMNS, GYRO, ROWS, Fit
from .pauses import Floats

LARGEST_SCALE_SIGMA, LARGEST_AXIS_SIGMA, LARGEST_BIAS_SIGMA = 0.005, radians(0.5), 0.1
"""Largest standard deviation of a scale, no unit, of an axis, rad, and of the accelerometer's bias, m/s^2.

Sheets of usual chips allow a scale error of 1 % and more, 1 degree across the axes and 0.2 m/s^2: what is known no
better than this is no calibration."""
AXES = "xyz"
"""Names of the axes of a sensor."""


def sigmas(fit: Fit) -> tuple[Floats, Floats, Floats]:
    """Return standard deviations of A, (3, 3), of a, m/s^2, (3), and of G, (3, 3)."""
    sigma = np.sqrt(np.diag(fit.covariance))
    return np.tensordot(sigma[ACC], BASIS, 1), sigma[ACC_BIAS], sigma[GYRO].reshape(3, 3)


def open_questions(fit: Fit) -> list[str]:
    """Return a sentence for each sensor of which something is not known well enough, with what would help."""
    acc, acc_bias, gyro = sigmas(fit)
    apart = ~np.eye(3, dtype=np.bool_)
    sentences = []
    acc_scale, acc_axis = float(np.diag(acc).max()), float(acc[apart].max())
    poor = [
        text
        for text, value, limit in (
            (f"its scale to {100.0 * acc_scale:.2g} %", acc_scale, LARGEST_SCALE_SIGMA),
            (f"its axes to {degrees(acc_axis):.2g} degrees", acc_axis, LARGEST_AXIS_SIGMA),
            (f"its bias to {acc_bias.max():.2g} m/s^2", acc_bias.max(), LARGEST_BIAS_SIGMA),
        )
        if value > limit
    ]
    if poor:
        sentences.append(f"the accelerometer is not known well enough: {', '.join(poor)}; {missing_orientation(fit)}")
    scale, axis = np.diag(gyro), np.where(apart, gyro, 0.0)
    if scale.max() > LARGEST_SCALE_SIGMA:
        name = AXES[int(np.argmax(scale))]
        sentences.append(
            f"the gyroscope's scale about {name} is known to {100.0 * scale.max():.2g} % only: hold the sensor's "
            f"{name} axis level and turn it five times about it, from one rest to another"
        )
    if axis.max() > LARGEST_AXIS_SIGMA:
        i, j = divmod(int(np.argmax(axis)), 3)
        sentences.append(
            f"how far the gyroscope's {AXES[i]} reads turns about {AXES[j]} is known to {degrees(axis.max()):.2g} "
            f"degrees only: add rests, each half a turn about the sensor's level {AXES[j]} axis from the one before"
        )
    return sentences


def missing_orientation(fit: Fit) -> str:
    """Return in words the rest that would help the accelerometer most, one of 26 orientations.

    It is the one after which the variances, each divided by the square of the largest standard deviation that is good
    enough, have the least sum."""
    limits = np.array([LARGEST_SCALE_SIGMA] * 3 + [LARGEST_AXIS_SIGMA] * 3 + [LARGEST_BIAS_SIGMA] * 3)
    signs = np.array([one for one in product((0, 1, -1), repeat=3) if any(one)])
    up = signs / np.linalg.norm(signs, axis=1, keepdims=True)
    rows = np.hstack((GRAVITY * up[:, ROWS] * up[:, COLUMNS] * [1, 1, 1, 2, 2, 2], -up))
    seen = rows @ fit.covariance[:9, :9]
    gain = np.sum((seen / limits) ** 2, axis=1) / (fit.noise[0] ** 2 + np.sum(rows * seen, axis=1))
    best = signs[np.argmax(gain >= gain.max() * (1.0 - 1e-9))]  # the first of those that are as good
    parts = [f"{AXES[k]} axis {'up' if sign > 0 else 'down'}" for k, sign in enumerate(best) if sign]
    return f"a rest with the sensor's {' and '.join(parts)} is missing"
