"""Check that the accelerometer reads 1 g at rest, which shows a wrong range or scale."""

from __future__ import annotations

from math import sqrt

from ..events import ScaleSuspect
from ..types import Sample, Vec3
from ..types.attrs import define
from ..types.vector import GRAVITY

STILL_FOR = 1.5
"""Time without motion that counts as rest, s."""
STILL_RANGE = 0.06
"""Range of each axis in a still window at most, as a fraction of the reading's magnitude."""
TOLERANCE = 0.15
"""Deviation from 1 g above which the scale is suspect, as a fraction (ranges differ by factors of two)."""
RANGES = (2, 4, 8, 16)
"""Usual full scales of accelerometers, g."""


@define
class RestCheck:
    """Finds one still window, compares its mean with 1 g, and is done."""

    grain: float
    """Size of one count, m/s^2."""
    done: bool = False
    """True if a still window was found; then no more samples are needed."""
    started: float = 0.0
    """Start of the present window, s."""
    count: int = 0
    """Number of samples in the present window."""
    acc_min: Vec3 = (0.0, 0.0, 0.0)
    """Smallest value of each axis in the window, m/s^2."""
    acc_max: Vec3 = (0.0, 0.0, 0.0)
    """Largest value of each axis in the window, m/s^2."""
    acc_sum: Vec3 = (0.0, 0.0, 0.0)
    """Sum of the samples in the window, m/s^2."""

    def check(self, sample: Sample, assumed: float) -> list[ScaleSuspect]:
        """Return a ScaleSuspect event when this sample, which has `acc`, shows that the scale is wrong.

        `assumed`: full scale that the sample was computed with, g. Call it with every such sample until `done`."""
        magnitude = None if sample.acc is None else self.add_acc(sample.t, sample.acc)
        if magnitude is None:
            return []
        t, known_at, words = sample.t, sample.known_at, suggest_range(magnitude, assumed)
        return [ScaleSuspect(t=t, known_at=known_at, site=sample.site, magnitude=magnitude, suggestion=words)]

    def add_acc(self, t: float, acc: Vec3) -> float | None:
        """Return the mean |acc| of the still window in m/s^2 when it shows a wrong scale, else None."""
        x, y, z = acc
        if self.count == 0:
            self._restart_window(t, acc)
            return None
        (lx, ly, lz), (hx, hy, hz), (sx, sy, sz) = self.acc_min, self.acc_max, self.acc_sum
        self.acc_min = lx, ly, lz = (min(lx, x), min(ly, y), min(lz, z))
        self.acc_max = hx, hy, hz = (max(hx, x), max(hy, y), max(hz, z))
        self.acc_sum = sx, sy, sz = (sx + x, sy + y, sz + z)
        self.count += 1
        magnitude = sqrt(sx * sx + sy * sy + sz * sz) / self.count
        if max(hx - lx, hy - ly, hz - lz) > STILL_RANGE * magnitude + 2.5 * self.grain:
            self._restart_window(t, acc)
            return None
        if t - self.started < STILL_FOR or self.count < 8:
            return None
        self.done = True
        return magnitude if abs(magnitude - GRAVITY) > TOLERANCE * GRAVITY else None

    def _restart_window(self, t: float, acc: Vec3) -> None:
        self.started, self.count = t, 1
        self.acc_min = self.acc_max = self.acc_sum = acc


def suggest_range(magnitude: float, assumed: float) -> str:
    """Return a sentence on a reading of `magnitude` m/s^2 at rest with an assumed full scale of `assumed` g."""
    if magnitude < 0.05 * GRAVITY:
        return "reads nothing at rest: is the accelerometer switched on?"
    ratio = magnitude / GRAVITY
    for full in RANGES:
        if abs(ratio * full / assumed - 1.0) <= TOLERANCE:
            return f"reads {ratio:.2f} g at rest with {assumed:g} g full scale assumed; {full} g would fit"
    return f"reads {ratio:.2f} g at rest with {assumed:g} g full scale assumed; no usual range fits"
