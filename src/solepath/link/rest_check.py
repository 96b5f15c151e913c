"""Check that the accelerometer reads 1 g at rest; another value shows a wrong range or scale."""

from __future__ import annotations

from math import sqrt

from ..events import ScaleSuspect
from ..types import Sample, Vec3
from ..types.attrs import define
from ..types.vector import GRAVITY

FULL_SCALE_COUNTS = 32768
"""Counts that are the full scale of a sensor with 16 bits."""
STILL_DURATION, MIN_STILL_SAMPLES = 1.5, 8
"""Duration (s), and number of samples, of a window without motion that counts as rest."""
MAX_STILL_RANGE, MAX_STILL_COUNTS = 0.06, 2.5
"""Largest range of an axis in a window without motion: this fraction of the mean |acc|, plus these counts."""
SCALE_TOLERANCE = 0.15
"""Relative deviation from 1 g above which the scale is suspect; usual ranges differ by factors of two."""
USUAL_RANGES = (2, 4, 8, 16)
"""Usual full scales of accelerometers, g."""


@define
class RestCheck:
    """Compares the mean |acc| of the first window without motion with 1 g."""

    count_size: float
    """Acceleration of one count, m/s^2."""
    is_finished: bool = False
    """True after the first window without motion; then no more samples are needed."""
    window_start: float = 0.0
    """Start of the window, s."""
    count: int = 0
    """Number of samples in the window."""
    acc_min: Vec3 = (0.0, 0.0, 0.0)
    """Smallest value of each axis in the window, m/s^2."""
    acc_max: Vec3 = (0.0, 0.0, 0.0)
    """Largest value of each axis in the window, m/s^2."""
    acc_sum: Vec3 = (0.0, 0.0, 0.0)
    """Sum of the samples in the window, m/s^2."""

    def check(self, sample: Sample, assumed: float) -> list[ScaleSuspect]:
        """Return a ScaleSuspect event when this sample shows that the scale is wrong.

        `assumed`: full scale that `acc` was computed with, g. Call it with every sample that has `acc`, until
        `is_finished`."""
        magnitude = None if sample.acc is None else self.add_acc(sample.t, sample.acc)
        if magnitude is None:
            return []
        t, known_at, suggestion = sample.t, sample.known_at, suggest_range(magnitude, assumed)
        return [ScaleSuspect(t=t, known_at=known_at, site=sample.site, magnitude=magnitude, suggestion=suggestion)]

    def add_acc(self, t: float, acc: Vec3) -> float | None:
        """Add a specific force (m/s^2) at `t` (s); return the mean |acc| at rest if its scale is wrong, else None."""
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
        if max(hx - lx, hy - ly, hz - lz) > MAX_STILL_RANGE * magnitude + MAX_STILL_COUNTS * self.count_size:
            self._restart_window(t, acc)
            return None
        if t - self.window_start < STILL_DURATION or self.count < MIN_STILL_SAMPLES:
            return None
        self.is_finished = True
        return magnitude if abs(magnitude - GRAVITY) > SCALE_TOLERANCE * GRAVITY else None

    def _restart_window(self, t: float, acc: Vec3) -> None:
        self.window_start, self.count = t, 1
        self.acc_min = self.acc_max = self.acc_sum = acc


def suggest_range(magnitude: float, assumed: float) -> str:
    """Return a text on a mean |acc| of `magnitude` m/s^2 at rest, where a full scale of `assumed` g was assumed."""
    if magnitude < 0.05 * GRAVITY:
        return "reads nothing at rest: is the accelerometer switched on?"
    ratio = magnitude / GRAVITY
    for full_scale in USUAL_RANGES:
        if abs(ratio * full_scale / assumed - 1.0) <= SCALE_TOLERANCE:
            return f"reads {ratio:.2f} g at rest with {assumed:g} g full scale assumed; {full_scale} g would fit"
    return f"reads {ratio:.2f} g at rest with {assumed:g} g full scale assumed; no usual range fits"
