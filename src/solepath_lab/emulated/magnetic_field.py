"""The magnetic field over the floor of a building whose steel disturbs the field of the earth.

No source was found for how much it turns a compass near a floor, so the disturbance is an assumption, with its figures
as parameters: the gradient of a potential that decays upwards, as that of sources below the floor does, with two
lengths of correlation, those of furniture and reinforcement and those of girders and machines. Its size varies from
place to place, which gives it heavy tails. What is idealised: with that variation the field is no longer quite a
gradient, and it is taken at the floor, although a foot in swing is some centimetres above it."""

from __future__ import annotations

from functools import cached_property
from math import pi, sqrt

import numpy as np
from attrs import frozen

from solepath.emulate.sensors.magnetic_field import EARTH, MagneticField
from solepath.emulate.wearers.curves import Array, Rng
from solepath.types import Vec3

WAVES = 64
"""Number of plane waves of which the disturbance of each length is made."""
PROBES, PROBED_AREA = 2000, 300.0
"""Number of random places by which the amplitude of the disturbance is set, and half the side of their square, m."""
FIELD_STEP = 0.01
"""Time between the instants at which the field along a way is computed, s; a foot in swing moves by 5 cm in it."""


@frozen(eq=False)
class Waves:
    """Plane waves over the floor whose sum is a random function of the place."""

    vectors: Array
    """Wave vectors, (WAVES, 2), rad/m."""
    phases: Array
    """Phases, (WAVES), rad."""

    @staticmethod
    def drawn(length: float, rng: Rng) -> Waves:
        """Return random waves whose sum has the correlation exp(-d^2 / (2 length^2)) at the distance d, m."""
        return Waves(rng.standard_normal((WAVES, 2)) / length, rng.uniform(0.0, 2.0 * pi, WAVES))

    def at(self, places: Array) -> Array:
        """Return the arguments of all waves at places (N, 2 or more), m, as (N, WAVES), rad."""
        return np.asarray(places[:, :2] @ self.vectors.T + self.phases)

    def value(self, places: Array) -> Array:
        """Return the sum at places (N, 2 or more), m: (N), with a mean of 0 and a variance of 1."""
        return np.asarray(np.cos(self.at(places)).sum(axis=1) * sqrt(2.0 / WAVES))

    def gradient(self, places: Array) -> Array:
        """Return the gradient at the floor of a potential that these waves make, (N, 3), of a variance of about 1.

        Each wave of the potential decays with the height as exp(-k z), by its own wave number k."""
        argument = self.at(places)
        k = np.linalg.norm(self.vectors, axis=1)
        size = sqrt(2.0 / float(np.sum(k * k)))
        horizontal = np.sin(argument) @ self.vectors
        return np.asarray(size * np.column_stack((horizontal, np.cos(argument) @ k)) * sqrt(2.0))


@frozen(eq=False)
class DisturbedField(MagneticField):
    """The magnetic field at the floor of a building with steel."""

    disturbance: float
    """Root mean square by which the disturbance turns the horizontal field, rad."""
    seed: int = 0
    """Seed of the building."""
    earth: Vec3 = EARTH
    """Magnetic flux density of the earth's field, world frame, T."""
    lengths: tuple[float, float] = (1.5, 15.0)
    """Lengths of correlation, m, of both parts of the disturbance, which are equally large (assumed)."""
    variation: float = 0.6
    """Standard deviation of the logarithm of the size of the disturbance from place to place, no unit (assumed).

    With 0.6 the disturbance is 1.9 times as large as its root mean square in a twentieth of all places, or more."""

    @cached_property
    def _waves(self) -> tuple[Waves, ...]:
        """Waves of both parts of the disturbance, and of the logarithm of its size."""
        rng = np.random.default_rng([self.seed, 31])
        return tuple([Waves.drawn(length, rng) for length in (*self.lengths, self.lengths[1])])

    def at(self, places: Array) -> Array:
        """Return the magnetic flux density at places (N, 2 or more) in the world frame, m: (N, 3), T."""
        return np.asarray(np.array(self.earth) + self._amplitude * self._relative(places))

    def along(self, t: Array, places: Array) -> Array:
        """Return the flux density at the places (N, 3), m, of a way at fine instants `t`, s: (N, 3), T."""
        coarse = np.arange(t[0], t[-1] + FIELD_STEP, FIELD_STEP)
        rows = np.minimum(np.searchsorted(t, coarse), len(t) - 1)
        values = self.at(places[rows])
        return np.column_stack([np.interp(t, t[rows], axis) for axis in values.T])

    def _relative(self, places: Array) -> Array:
        *parts, size = self._waves
        both = sum((one.gradient(places) for one in parts), start=np.zeros((len(places), 3))) * sqrt(0.5)
        return np.asarray(both * np.exp(self.variation * size.value(places) - self.variation**2)[:, None])

    @cached_property
    def _amplitude(self) -> float:
        """Amplitude at which the horizontal field is turned by `disturbance` on average, T."""
        rng = np.random.default_rng([self.seed, 32])
        relative = self._relative(rng.uniform(-PROBED_AREA, PROBED_AREA, (PROBES, 2)))
        x, y, _ = self.earth
        low, high = 0.0, 10.0 * float(np.hypot(x, y))
        for _ in range(40):
            amplitude = 0.5 * (low + high)
            hx, hy = x + amplitude * relative[:, 0], y + amplitude * relative[:, 1]
            turn = np.arctan2(x * hy - y * hx, x * hx + y * hy)
            if float(np.sqrt(np.mean(turn * turn))) < self.disturbance:
                low = amplitude
            else:
                high = amplitude
        return low
