"""A gauge that presses one cell of an uncalibrated insole, for `solepath calibrate newton`, and what that insole says.

As Gong et al. 2023 (Sensors 23, 5417), section 3.1: a gauge of 500 N and 1 % presses 0 to 200 N, the insole answers
with a converter's counts, and from counts to newtons leads a cubic. Its curve is in fig. 6 b alone; the one here is
assumed: a resistive cell whose counts rise ever more slowly.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from attrs import evolve, frozen

from ...types import Sample
from ..wearers.curves import Array

MOST = 200.0
"""N."""


@frozen
class ForceCurve:
    """`coefficients`: N = a + b c + c2 c^2 + c3 c^3 of counts c, constant first; `full`: the largest count."""

    coefficients: tuple[float, float, float, float]
    full: int

    def newtons(self, counts: Array) -> Array:
        return np.asarray(np.polynomial.polynomial.polyval(counts, self.coefficients))

    def counts(self, newtons: Array) -> Array:
        """Whole counts of forces, 0 for those below the cubic's beginning and `full` at the most: its inverse."""
        table = np.arange(self.full + 1, dtype=np.float64)
        return np.rint(np.interp(newtons, self.newtons(table), table))


RPPS_99 = ForceCurve((0.0, 6.0e-3, -4.0e-7, 4.7e-11), full=16383)
"""14 bits, as the paper's insole; 0 to 197 N. The coefficients are assumed."""
TWELVE_BIT = ForceCurve((0.0, 2.4e-2, -6.4e-6, 3.008e-9), full=4095)
"""The same curve for a converter of 12 bits, as the insoles of protocol/insole.md have."""


@frozen
class Pressing:
    """What the insole said, `counts`, while the gauge read `newtons`."""

    counts: float
    newtons: float


def gauge(
    characteristic: ForceCurve = RPPS_99,
    seed: int = 1,
    *,
    forces: Iterable[float] = tuple(np.arange(5.0, 196.0, 5.0).tolist()),
    accuracy: float = 0.01,
    noise: float = 2.0,
) -> tuple[Pressing, ...]:
    """A cell pressed with these forces, N, one after the other.

    `accuracy`: of the gauge, relative to its reading; as for other tolerances two standard deviations, half of it in
    its scale, the rest from reading to reading (that the paper's 1 % is of the reading is assumed). `noise`: of the
    counts, rms (assumed).
    """
    rng = np.random.default_rng([seed, 9])
    true = np.array(list(forces), dtype=np.float64)
    spread = 0.5 * accuracy / np.sqrt(2.0)
    read = true * (1.0 + spread * float(rng.standard_normal()) + spread * rng.standard_normal(true.shape))
    said = np.rint(characteristic.counts(true) + noise * rng.standard_normal(true.shape))
    said = np.clip(said, 0, characteristic.full)
    return tuple(Pressing(c, float(np.clip(n, 0.0, MOST))) for c, n in zip(said.tolist(), read.tolist(), strict=True))


def write_gauge(path: Path | str, pressed: Iterable[Pressing]) -> None:
    """As `solepath calibrate newton` reads it."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("counts", "newtons"))
        rows.writerows((f"{one.counts:.0f}", f"{one.newtons:.2f}") for one in pressed)


def uncalibrated(samples: Iterable[Sample], characteristic: ForceCurve = RPPS_99) -> list[Sample]:
    """The same samples with counts where they had newtons."""
    found = []
    for sample in samples:
        if sample.pressure is not None:
            counts = characteristic.counts(np.array(sample.pressure)).tolist()
            sample = evolve(sample, pressure=tuple(counts))
        found.append(sample)
    return found
