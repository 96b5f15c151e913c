"""The air of a building: changes of its pressure that have nothing to do with height.

They are the same for every barometer of a walk. Weather: the Met Office's marine forecasts call a pressure falling
slowly that falls by 0.1 to 1.5 hPa in three hours (0.001 to 0.014 Pa/s), and falling very rapidly from 6 hPa on (0.06
Pa/s). The cold air of a thunderstorm raises it by 3.2 to 4.5 hPa on average (Engerer, Stensrud and Coniglio, Mon. Wea.
Rev. 136, 2008: 39 storms): a PressureStep of a long duration, some minutes, which is assumed. Gusts: the pressure
of the wind is 0.5 rho v^2, 38 Pa at 8 m/s; with an intensity of turbulence of 0.3 it varies by 0.6 of that, and about
a quarter gets inside (coefficients of internal pressure of 0.2 and -0.3: EN 1991-1-4, 7.2.9), which makes 6 Pa.

Doors and ventilation: a door that opens or closes is seen by barometers anywhere in a closed building (Wu, Pathak and
Tague, UbiComp 2015). Clean rooms differ from their neighbours by 10 Pa or more (EU GMP, annex 1; FDA, Sterile Drug
Products Produced by Aseptic Processing, 2004, IV.C: at least 10 to 15 Pa), and a stairwell that is kept free of smoke
by 50 Pa behind closed doors (EN 12101-6), or by 25 to 87 Pa (International Building Code, 909.20.5). How long a step
takes is assumed.

What is idealised: a step is everywhere in the building at once, although a pressurised stairwell ends at its door, and
its time is part of the record, not of the route. The stack effect, by which warm air in a building rises and changes
the pressure per metre by some percent, is left out."""

from __future__ import annotations

from functools import cached_property
from math import inf, isfinite, pi, sqrt

import numpy as np
from attrs import frozen

from ..wearers.curves import Array

GUST_TIME = 5.0
"""Time of correlation of gusts in a building, s: eddies of some 40 m that pass at 8 m/s (assumed)."""
FASTEST_GUST = 0.5
"""Highest frequency of a gust, Hz (assumed): cracks and doors let faster changes in damped."""
GUST_WAVES = 48
"""Number of sines of which gusts are made."""


@frozen
class PressureStep:
    """A change of the air pressure in the whole building: a door, a ventilation, a front."""

    t: float
    """Time at which the pressure starts to change, s."""
    change: float
    """Change of the pressure, Pa."""
    duration: float = 0.5
    """Time that the change takes, s: that of a door that swings."""
    lasting: float = inf
    """Time after `t` at which the pressure starts to change back, s: that of the door that closes; inf: it stays."""

    def __attrs_post_init__(self) -> None:
        if not (isfinite(self.t) and isfinite(self.change) and 0.0 < self.duration <= self.lasting):
            raise ValueError(f"a pressure step has finite numbers and lasts longer than it takes, unlike {self}")

    def at(self, t: Array) -> Array:
        """Return the change of pressure that has been reached at times `t`, s, (N), Pa."""
        return np.asarray(
            self.change * (_risen(t - self.t, self.duration) - _risen(t - self.t - self.lasting, self.duration))
        )


@frozen(eq=False)
class Air:
    """The changes of the air pressure in a building; without parameters there are none."""

    trend: float = 0.0
    """Rate at which the weather changes the pressure, Pa/s."""
    gusts: float = 0.0
    """Root mean square of the gusts in the building, Pa; what they have at t = 0 is subtracted."""
    steps: tuple[PressureStep, ...] = ()
    """Steps of doors, ventilation and fronts."""
    seed: int = 0
    """Seed of the gusts."""

    def __attrs_post_init__(self) -> None:
        if not (isfinite(self.trend) and 0.0 <= self.gusts < inf):
            raise ValueError(f"trend and gusts are finite, gusts not negative, unlike {self.trend}, {self.gusts}")

    def at(self, t: Array) -> Array:
        """Return what the air adds to the pressure of the height at times `t`, s, (N), Pa; without steps 0 at t = 0."""
        t = np.asarray(t, dtype=np.float64)
        change = self.trend * t
        for step in self.steps:
            change = change + step.at(t)
        if self.gusts:
            change = change + self._gusts_at(t) - self._gusts_at(np.zeros(1))
        return np.asarray(change)

    def _gusts_at(self, t: Array) -> Array:
        frequencies, phases = self._waves
        return np.asarray(
            self.gusts * sqrt(2.0 / GUST_WAVES) * np.cos(np.outer(t, 2.0 * pi * frequencies) + phases).sum(axis=1)
        )

    @cached_property
    def _waves(self) -> tuple[Array, Array]:
        """Frequencies, Hz, whose distribution gives the correlation exp(-t / GUST_TIME), and phases, rad."""
        rng = np.random.default_rng([self.seed, 33])
        frequencies = np.tan(0.5 * pi * rng.uniform(0.0, 1.0, GUST_WAVES)) / (2.0 * pi * GUST_TIME)
        return np.minimum(frequencies, FASTEST_GUST), rng.uniform(0.0, 2.0 * pi, GUST_WAVES)


def _risen(elapsed: Array, duration: float) -> Array:
    """Return a share that rises smoothly from 0 to 1 within `duration` s."""
    s = np.clip(elapsed / duration, 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


STILL_AIR = Air()
"""Air whose pressure depends on the height alone."""
