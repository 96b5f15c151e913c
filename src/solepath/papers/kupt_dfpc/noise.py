"""Noise of pressure cells while the foot swings: equation (1) of Chen et al. 2019 (IEEE Internet of Things Journal 6).

The wearer walks for about 20 s. Swing takes 38 % of a gait cycle, so the 15 % of the samples with the least total
pressure, which the paper uses, are in swing. A cell's noise is the mean of its values in these samples plus three
standard deviations."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...calibration import Calibration, CalibrationError, InsoleCalibration
from ...types import Floats, Foot, Sample

SWING_SHARE = 0.15
"""Share of the samples that are taken for swing, because they have the least total pressure."""
FEWEST_SAMPLES = 20
"""Least number of swing samples for a standard deviation; 5 s of walking at 30 Hz have 22."""


def pressure_noise(samples: Iterable[Sample], share: float = SWING_SHARE) -> Calibration:
    """Return a calibration that contains only the noise of every cell of every insole in `samples`.

    `share` is the share of the samples that are taken for swing (`SWING_SHARE`). The noise is in the unit of the
    samples. All pressures are kept in memory. Raises CalibrationError when there are no cells, too few samples, or a
    number of cells that changes, and ValueError when the share is outside 0 to 1."""
    if not 0.0 < share <= 1.0:
        raise ValueError(f"share is {share}")
    rows: dict[Foot, list[Floats]] = {}
    for sample in samples:
        foot = sample.site.foot
        if foot is None or not sample.pressure:
            continue
        cells = sample.pressure
        foot_rows = rows.setdefault(foot, [])
        if foot_rows and len(foot_rows[0]) != len(cells):
            raise CalibrationError(f"the {foot.value} insole has {len(foot_rows[0])} cells and then {len(cells)}")
        foot_rows.append(cells)
    if not rows:
        raise CalibrationError("no pressure cells in this recording: nothing to learn of their noise")
    return Calibration(insoles={foot: _insole_noise(foot, rows[foot], share) for foot in Foot if foot in rows})


def _insole_noise(foot: Foot, rows: list[Floats], share: float) -> InsoleCalibration:
    pressure = np.array(rows, dtype=np.float64)
    count = round(share * len(pressure))
    if count < FEWEST_SAMPLES:
        reason = (
            f"{len(pressure)} samples of the {foot.value} insole, {count} of them in swing; {FEWEST_SAMPLES} are needed"
        )
        raise CalibrationError(f"too short a walk: {reason}")
    # by P_total; a stable sort keeps ties in the order of time, so that every platform gives the same noise
    swing = pressure[np.argsort(pressure.sum(axis=1), kind="stable")[:count]]
    noise = swing.mean(axis=0) + 3.0 * swing.std(axis=0)
    return InsoleCalibration(noise=tuple(noise.tolist()))
