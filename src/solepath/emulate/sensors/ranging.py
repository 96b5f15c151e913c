"""An emulated sensor of the distance between the feet: a transmitter on one shoe and a receiver on the other.

Idealised: both are where the inertial sensors are; they share the true clock; the noise is white and Gaussian, without
the long tail of a reflected signal; the bias is constant; a lost range is lost and never the length of a detour.
Signals fail in two ways. Sensors that look inwards lose each other when one foot is far in front (`cone`), and
something, such as the other shoe or clothes, is in the way for a while (`blocked`)."""

from __future__ import annotations

from math import inf, pi

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ...types import SITE_OF_FOOT, Foot, Sample
from ..wearers.curves import Array
from ..wearers.shoe import IN_SOLE, Mounting
from ..wearers.turning import matrices
from ..wearers.walker import Walker


@frozen
class RangeErrors:
    """The errors of a sensor of the distance between the feet."""

    name: str
    """Name of the kind of sensor."""
    noise: float
    """Standard deviation of a single range, m."""
    bias: float
    """Standard deviation between specimens of the constant error, m."""
    rate: float = 50.0
    """Number of ranges a second, Hz."""
    cone: float = 0.5 * pi
    """Largest horizontal angle between the line to the other sensor and the direction in which each looks, rad; a
    sensor looks to the inner side of its foot. With pi / 2 it sees everything on that side."""
    blocked: float = 0.1
    """Share of the time in which something is in the way."""
    blocked_time: float = 0.15
    """Mean duration for which something is in the way, s."""
    reach: float = inf
    """Largest distance that is measured, m."""


ULTRASOUND = RangeErrors("ultrasound", noise=0.005, bias=0.005, cone=1.2)
"""Ultrasound between the shoes, as in Weenk et al. 2015 (IEEE Trans. Neural Syst. Rehabil. Eng. 23); all its numbers
are assumed: half a centimetre, and sensors that see each other within 70 degrees."""
ULTRA_WIDEBAND = RangeErrors("ultra-wideband radio", noise=0.05, bias=0.05, blocked=0.2)
"""Ultra-wideband radio between the shoes; all numbers are assumed: data sheets claim 0.1 m, and a constant delay of the
antennas of some centimetres remains."""


def measure_ranges(
    walker: Walker, errors: RangeErrors, mountings: dict[Foot, Mounting] | None = None, foot: Foot = Foot.RIGHT
) -> list[Sample]:
    """Return the ranges of a walk as samples of `foot`, which has the receiver, on the true clock."""
    rng = np.random.default_rng([walker.seed, 11])
    bias = errors.bias * float(rng.standard_normal())
    t = (float(rng.uniform()) + np.arange(int(walker.duration * errors.rate), dtype=np.float64)) / errors.rate
    worn = {one: (mountings or {}).get(one, IN_SOLE) for one in Foot}
    moved = {one: walker.kinematics(one, t, mounting) for one, mounting in worn.items()}
    between = moved[Foot.RIGHT].position - moved[Foot.LEFT].position
    distance = np.linalg.norm(between, axis=1)
    seen = ~_blocked(len(t), errors, rng) & (distance < errors.reach)
    for one, line in ((Foot.LEFT, between), (Foot.RIGHT, -between)):
        inwards = _inwards(moved[one].attitude, worn[one], one)
        ahead = np.sum(inwards[:, :2] * line[:, :2], axis=1)
        aside = np.abs(inwards[:, 0] * line[:, 1] - inwards[:, 1] * line[:, 0])
        seen &= np.arctan2(aside, ahead) <= errors.cone
    measured = distance + bias + errors.noise * rng.standard_normal(len(t))
    site = SITE_OF_FOOT[foot]
    return [
        Sample(time, site, range=value)
        for time, value in zip(t[seen].tolist(), measured[seen].tolist(), strict=True)
        if value > 0.0
    ]


def _inwards(attitude: Array, mounting: Mounting, foot: Foot) -> Array:
    """Return the direction to the inner side of a foot whose sensor has these attitudes, world frame, (N, 3)."""
    side = -1.0 if foot is Foot.LEFT else 1.0
    in_sensor = matrices(np.array([mounting.attitude]))[0].T @ np.array([0.0, side, 0.0])
    return np.asarray(matrices(attitude) @ in_sensor)


def _blocked(count: int, errors: RangeErrors, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Return, for each of `count` instants, whether something is in the way: a chain of two states."""
    leave = min(1.0, 1.0 / (errors.rate * errors.blocked_time))
    enter = min(1.0, leave * errors.blocked / (1.0 - errors.blocked))
    blocked = np.zeros(count, dtype=np.bool_)
    state = bool(rng.uniform() < errors.blocked)
    for k, chance in enumerate(rng.uniform(size=count).tolist()):
        state = chance >= leave if state else chance < enter
        blocked[k] = state
    return blocked
