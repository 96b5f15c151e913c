"""Courses of a quantity over time, from which motions of feet are made that are not walks.

A course goes through key frames by quintics, so that its second derivative is continuous, as that of a limb is. A
landing is two key frames: the touch with the speed of the fall, and the rest some centiseconds later, by which sole and
floor have stopped the foot. A way is the integral of a speed along a heading. A vibration is a sum of sines with random
phases that has a given spectrum."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from attrs import frozen

from solepath.emulate.wearers.curves import Array, Rng, join
from solepath.emulate.wearers.turning import rotation
from solepath.types import Vec3

GRID = 0.02
"""Interval of the key frames of a way, s."""
SINES = 60
"""Number of sines of a vibration."""


Pose = tuple[Array, Array]
"""Positions of a body's origin, m, (N, 3), and its attitudes, body to the frame around it, (N, 3, 3)."""


Key = tuple[float, ...]
"""Time, s, value, and first and second derivative, which may be left out, of a course."""


@frozen(eq=False)
class Course:
    """A quantity over time; before its first key frame and after its last one it stays as it is there."""

    times: Array
    """Times of the key frames, s, (K)."""
    curves: Array
    """Coefficients of the curve between each two key frames, constant first, (8, K - 1)."""

    @classmethod
    def through(cls, *keys: Key) -> Course:
        """Return the course through key frames: time, s, value, and first and second derivative, 0 if left out.

        A key frame at the time of the one before it, or earlier, is left out."""
        kept: list[tuple[float, float, float, float]] = []
        for key in keys:
            t, value, speed, acceleration = (*key, 0.0, 0.0)[:4]
            if not kept or t > kept[-1][0]:
                kept.append((t, value, speed, acceleration))
        if len(kept) == 1:
            kept.append((kept[0][0] + 1.0, kept[0][1], 0.0, 0.0))
        curves = [join(a[1:], b[1:], b[0] - a[0]) for a, b in zip(kept, kept[1:], strict=False)]
        return cls(np.array([one[0] for one in kept]), np.array(curves).T)

    def at(self, t: Array, order: int = 0) -> Array:
        """Return the values at times `t`, s, or those of the derivative of this order, (N)."""
        row = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.times) - 2)
        duration = self.times[row + 1] - self.times[row]
        s = np.clip((t - self.times[row]) / duration, 0.0, 1.0)
        factors = self.curves
        for _ in range(order):
            factors = factors[1:] * np.arange(1.0, len(factors))[:, None]
        total = factors[-1][row]
        for factor in factors[-2::-1]:
            total = total * s + factor[row]
        return np.asarray(total / duration**order)


STILL = Course.through((0.0, 0.0))
"""Course of a quantity that is always 0."""


@frozen(eq=False)
class Way:
    """The way on level ground of something that moves at a speed, m/s, along a heading, rad."""

    speed: Course
    heading: Course
    x: Course
    y: Course

    @classmethod
    def along(cls, speed: Course, heading: Course, duration: float) -> Way:
        """Return the way over so many seconds. The speed is integrated by Simpson's rule."""
        t = np.arange(0.0, duration + 2.0 * GRID, GRID)
        middle = t[:-1] + 0.5 * GRID
        axes = []
        for direction in (np.cos, np.sin):
            rates, halves = (speed.at(at) * direction(heading.at(at)) for at in (t, middle))
            places = np.concatenate(([0.0], np.cumsum(GRID / 6.0 * (rates[:-1] + 4.0 * halves + rates[1:]))))
            change = speed.at(t, 1) * direction(heading.at(t))
            turned = heading.at(t, 1) * speed.at(t)
            change += turned * (-np.sin(heading.at(t)) if direction is np.cos else np.cos(heading.at(t)))
            axes.append(Course.through(*map(tuple, np.stack((t, places, rates, change), axis=1).tolist())))
        return cls(speed, heading, *axes)

    def place(self, t: Array) -> Array:
        """Return the position at times `t`, s, (N, 3), m."""
        return np.stack((self.x.at(t), self.y.at(t), np.zeros_like(t)), axis=1)

    def pull(self, t: Array) -> tuple[Array, Array]:
        """Return the acceleration along and to the left of the heading at times `t`, s, m/s^2, (N) each."""
        return self.speed.at(t, 1), self.speed.at(t) * self.heading.at(t, 1)


@frozen(eq=False)
class Motion:
    """The courses of a rigid body in a frame: x, y, z, m, and pitch, roll and yaw, rad.

    The attitude is Rz(yaw) Ry(-pitch) Rx(roll), as of a foot: pitch is positive when the toe is up."""

    x: Course = STILL
    y: Course = STILL
    z: Course = STILL
    pitch: Course = STILL
    roll: Course = STILL
    yaw: Course = STILL
    pivot: Vec3 = (0.0, 0.0, 0.0)
    """Point of the body, in its own frame, that x, y and z move and about which it turns, m."""

    def pose(self, t: Array) -> Pose:
        """Return the position of the body's origin (N, 3), m, and its attitude (N, 3, 3) at times `t`, s."""
        turn = rotation(self.yaw.at(t), -self.pitch.at(t), self.roll.at(t))
        place = np.stack((self.x.at(t), self.y.at(t), self.z.at(t)), axis=1)
        return place - turn @ np.array(self.pivot), turn


class Frames:
    """Key frames of a motion, which are added in the order of time."""

    def __init__(self, **start: float) -> None:
        """Start at time 0 s with these values of the courses of `Motion`."""
        self.keys: dict[str, list[Key]] = {name: [(0.0, value)] for name, value in start.items()}

    def add(self, t: float, **values: float | Key) -> None:
        """Add a key frame at `t`, s, of each of these courses: a value, or one with its derivatives."""
        for name, value in values.items():
            self.keys[name].append((t, *value) if isinstance(value, tuple) else (t, value))

    def motion(self, pivot: Vec3 = (0.0, 0.0, 0.0)) -> Motion:
        """Return the motion through all key frames."""
        return Motion(**{name: Course.through(*keys) for name, keys in self.keys.items()}, pivot=pivot)


def carried(carrier: Pose, inner: Pose) -> Pose:
    """Return the pose in the world of a body whose pose in a carrier is known, and that of the carrier."""
    (place, turn), (offset, attitude) = carrier, inner
    return place + np.einsum("nij,nj->ni", turn, offset), turn @ attitude


Spectrum = Callable[[Array], Array]
"""Function of frequencies, Hz, that returns the power spectral density, one-sided, in the square of a unit per Hz."""


@frozen(eq=False)
class Vibration:
    """A random vibration with a spectrum."""

    frequencies: Array
    amplitudes: Array
    phases: Array

    @classmethod
    def drawn(cls, spectrum: Spectrum, least: float, most: float, rng: Rng) -> Vibration:
        """Return a vibration with this spectrum from the frequency `least` to `most`, Hz."""
        edges = np.geomspace(least, most, SINES + 1)
        frequencies = np.asarray(rng.uniform(edges[:-1], edges[1:]))
        amplitudes = np.sqrt(2.0 * spectrum(frequencies) * np.diff(edges))
        return cls(frequencies, amplitudes, np.asarray(rng.uniform(0.0, 2.0 * np.pi, SINES)))

    def at(self, t: Array) -> Array:
        """Return the values at times `t`, s, (N)."""
        total = np.zeros_like(t)
        for frequency, amplitude, phase in zip(self.frequencies, self.amplitudes, self.phases, strict=True):
            total += amplitude * np.sin(2.0 * np.pi * frequency * t + phase)
        return total
