"""Noise of pressure cells while the foot swings: equation (1) of Chen et al. 2019 (IEEE Internet of Things Journal 6).

The wearer walks for about 20 s. The samples with the least total pressure are those of the swing, which takes 38 % of a
gait cycle; the paper uses the least 15 %. A cell's noise is their mean plus three standard deviations."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...calibration import Calibration, CalibrationError, InsoleCalibration
from ...foot.pressure.insole import in_newtons
from ...types import Foot, Sample

SWING_SHARE = 0.15
"""Share of the samples, those with the least total pressure, that are taken for swing."""
FEWEST_SAMPLES = 20
"""Fewest samples in swing that show a spread (5 s of walking at 30 Hz have 22)."""


def pressure_noise(
    samples: Iterable[Sample], share: float = SWING_SHARE, known: Calibration | None = None
) -> Calibration:
    """Return the noise of every cell of every insole in `samples`, and nothing else.

    `share`: share of the samples, those with the least total pressure, that are taken for swing. `known`: where it
    turns an insole's values into newtons, noise is in N too. Takes the samples one by one and keeps their pressures.
    CalibrationError when there are no cells, too few samples, or a number of cells that changes; ValueError for a share
    outside 0 to 1."""
    if not 0.0 < share <= 1.0:
        raise ValueError(f"share is {share}")
    rows: dict[Foot, list[tuple[float, ...]]] = {}
    for sample in samples:
        foot = sample.site.foot
        if foot is None or not sample.pressure:
            continue
        cells = sample.pressure
        newtons = None if known is None else known.insole(foot).newtons
        before = rows.setdefault(foot, [])
        if before and len(before[0]) != len(cells):
            raise CalibrationError(f"the {foot.value} insole has {len(before[0])} cells and then {len(cells)}")
        before.append(cells if newtons is None else in_newtons(newtons, cells))
    if not rows:
        raise CalibrationError("no pressure cells in this recording: nothing to learn of their noise")
    return Calibration(insoles={foot: _insole_noise(foot, rows[foot], share) for foot in Foot if foot in rows})


def _insole_noise(foot: Foot, rows: list[tuple[float, ...]], share: float) -> InsoleCalibration:
    pressure = np.array(rows, dtype=np.float64)
    count = round(share * len(pressure))
    if count < FEWEST_SAMPLES:
        what = (
            f"{len(pressure)} samples of the {foot.value} insole, {count} of them in swing; {FEWEST_SAMPLES} are wanted"
        )
        raise CalibrationError(f"too short a walk: {what}")
    # P_total; ties in the order of time, so that the same walk gives the same noise everywhere
    least = pressure[np.argsort(pressure.sum(axis=1), kind="stable")[:count]]
    noise = least.mean(axis=0) + 3.0 * least.std(axis=0)
    return InsoleCalibration(noise=tuple(noise.tolist()))
