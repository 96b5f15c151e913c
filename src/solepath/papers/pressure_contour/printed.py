"""Stance evidence of Bebek et al. 2010 as printed: equation (3) with the levels of figure 4 and nothing else.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). `ContourVelocity` differs from it by shares for levels, a threshold of the wearer's own, a higher threshold for a
stance that lasts, and the gyroscope where contours do not decide."""

from __future__ import annotations

from math import hypot, inf

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Layout, Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, ZERO
from .contour import PAPER_LEVELS, Contours, ContourSettings
from .contour_stance import GyroscopeMagnitude


def printed_contours() -> Contours:
    """Return contours of 20 to 70 kPa."""
    return Contours(ContourSettings(pascals=PAPER_LEVELS))


NO_CONTOUR = 100.0
"""Statistic without a contour, m/s: faster than any foot."""


@frozen
class PrintedContourSettings:
    """Settings of `PrintedContour`."""

    threshold: float = 0.004
    """Threshold v_thrsh of (3), m/s: the "velocity sensing bias" of 4 mm/s of figure 7 and table II."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s; the recipe's corrector sets the velocity to zero whatever it is."""


@define
class PrintedContour(Detector):
    """Detector: the shoe stands while the contours of 20 to 70 kPa are slower than 4 mm/s (3).

    The statistic is the speed of the contours, m/s; `NO_CONTOUR` without a contour. Latency: 50 ms, that of `Contours`.

    Levels in kPa need cells of known places and a known scale. Without them nothing of (3) can be computed, a
    Limitation says so, and the gyroscope decides. It also decides for samples with fewer cells than the layout, and
    before the first step, because cells are reported from then on (pressure/insole.py)."""

    settings: PrintedContourSettings = PrintedContourSettings()
    contours: Contours = field(factory=printed_contours)
    baseline: GyroscopeMagnitude = field(factory=GyroscopeMagnitude)
    lacking: str | None = field(default=None, init=False)
    """Sentence about missing data; None if nothing is missing."""

    def set_layout(self, layout: Layout) -> None:
        reason = self.contours.set_layout(layout)
        if reason is None and not self.contours.levels_in_pascals:
            reason = "pressure cells of unknown scale have no contours of 20 to 70 kPa"
        self.lacking = None if reason is None else f"{reason}; the gyroscope says when the foot stands"

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gyroscope_stance = self.baseline.update(t, dt, acc, gyro, load, attitude)
        if self.lacking is not None or not self.contours.points or load is None:
            return gyroscope_stance
        if not load.cells or max(self.contours.cells) >= len(load.cells):
            return gyroscope_stance
        velocity = self.contours.velocity(t, [load.cells[i] for i in self.contours.cells])
        speed = NO_CONTOUR if velocity is None else min(hypot(*velocity), NO_CONTOUR)
        if speed <= self.settings.threshold:
            return Stance(ZERO, self.settings.sigma, speed, Phase.STATIONARY)
        return Stance(ZERO, inf, speed, None)
