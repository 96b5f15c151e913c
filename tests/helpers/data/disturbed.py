"""Emulated walks on which something is wrong that is none of the wearer's doing: the ground moves, a sensor swings."""

from __future__ import annotations

import numpy as np
from attrs import evolve

from solepath.emulate.walk import SampledWalk
from solepath.emulate.wearers.curves import Array
from solepath.types import SITE_OF_FOOT, Foot, Sample


def _world_from_sensor(attitude: Array) -> Array:
    """Return the rotation matrices of attitudes w, x, y, z, (n,3,3)."""
    w, x, y, z = attitude.T
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)


def on_walkway(
    walk: SampledWalk, t_on: float, t_off: float, velocity: tuple[float, float]
) -> tuple[tuple[Sample, ...], tuple[float, float]]:
    """Return the samples of a walk on ground that moves from t_on to t_off, s, and the way that it adds, m.

    Each foot takes up the velocity, m/s, in the swing with which it steps onto the walkway, and loses it in that with
    which it steps off."""
    changed: list[Sample] = []
    way = np.zeros(2)
    for foot in Foot:
        own = [sample for sample in walk.samples if sample.site is SITE_OF_FOOT[foot]]
        t = np.array([sample.t for sample in own])
        strides = walk.truth.strides(foot)
        acc = np.zeros((len(t), 3))
        middles = []
        for at, sign in ((t_on, 1.0), (t_off, -1.0)):
            stride = next(one for one in strides if one.t_toe_off >= at)
            start, duration = stride.t_toe_off, stride.t_heel_strike - stride.t_toe_off
            phase = np.clip((t - start) / duration, 0.0, 1.0)
            acc[:, :2] += sign * (np.outer(1.0 - np.cos(2.0 * np.pi * phase), velocity) / duration)
            middles.append(start + 0.5 * duration)
        way += 0.5 * (middles[1] - middles[0]) * np.array(velocity)
        turns = _world_from_sensor(walk.truth.pose(foot, t).attitude)
        extra = np.einsum("nji,nj->ni", turns, acc)
        changed += [
            evolve(sample, acc=tuple((np.array(sample.acc) + more).tolist()))
            for sample, more in zip(own, extra, strict=True)
        ]
    return tuple(sorted(changed, key=lambda sample: sample.t)), (float(way[0]), float(way[1]))


ARM = 0.04
"""Distance of a loose sensor from what it still hangs on, m."""
STEP = 0.002
"""Time over which motions are differentiated, s."""


def loose(walk: SampledWalk, foot: Foot, t_start: float, angle: float, seed: int = 1) -> tuple[Sample, ...]:
    """Return the samples of a walk with a sensor of `foot` that swings on the shoe from t_start, s, on.

    It swings about one axis by `angle` rad (standard deviation), at random and below 3 Hz, at a distance of `ARM`."""
    own = [sample for sample in walk.samples if sample.site is SITE_OF_FOOT[foot] and sample.t >= t_start]
    rng = np.random.default_rng([seed, 41])
    axis = rng.standard_normal(3)
    axis /= np.linalg.norm(axis)
    arm = np.cross(axis, rng.standard_normal(3))
    arm *= ARM / np.linalg.norm(arm)
    frequency, phase = rng.uniform(0.3, 3.0, 12), rng.uniform(0.0, 2.0 * np.pi, 12)
    amplitude, turning = angle / np.sqrt(6.0), 2.0 * np.pi * frequency

    def swung(t: Array) -> Array:
        """Return the rotation matrices from the loose sensor to the fixed one: a sum of waves that starts at 0."""
        half = 0.5 * amplitude * (np.sin(np.outer(t - t_start, turning) + phase) - np.sin(phase)).sum(axis=1)
        return _world_from_sensor(np.column_stack([np.cos(half), np.outer(np.sin(half), axis)]))

    def moved(t: Array) -> Array:
        """Return how far the sensor is from where it was fixed, world frame, m."""
        off: Array = swung(t) @ arm - arm
        moves: Array = np.einsum("nij,nj->ni", _world_from_sensor(walk.truth.pose(foot, t).attitude), off)
        return moves

    t = np.array([sample.t for sample in own])
    rates = (turning * amplitude * np.cos(np.outer(t - t_start, turning) + phase)).sum(axis=1)
    extra = (moved(t + STEP) - 2.0 * moved(t) + moved(t - STEP)) / STEP**2
    extra = np.einsum("nji,nj->ni", _world_from_sensor(walk.truth.pose(foot, t).attitude), extra)
    new = {
        sample.t: evolve(
            sample,
            acc=tuple((turn.T @ (np.array(sample.acc) + more)).tolist()),
            gyro=tuple((turn.T @ np.array(sample.gyro) + rate * axis).tolist()),
        )
        for sample, turn, rate, more in zip(own, swung(t), rates, extra, strict=True)
    }
    return tuple(new.get(sample.t, sample) if sample.site is SITE_OF_FOOT[foot] else sample for sample in walk.samples)
