"""Stance detectors that use pressure cells, with the same signature as the inertial detectors.

Without cells, or while the wearer's full load is unknown, both detectors give no evidence (sigma is infinite). The full
load is that of all cells when they bear the wearer (pressure/insole.py). The origin of the numbers is not recorded."""

from __future__ import annotations

from math import inf

from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, ZERO
from ..pressure.insole import HIGHEST_DECAY
from .stance import Detector, Load, Stance

NO_EVIDENCE = Stance(ZERO, inf, 0.0, None)
"""Value for a sample whose load is unknown."""


@define
class TwoArea(Detector):
    """Detects a flat sole: if heel area and forefoot area are both loaded, the sensor between them stands still.

    Source: "Smart insole-based indoor localization system for Internet of Things applications", section on stationary
    epochs, which uses the forces on both sides of the circuit board. The statistic is the smaller of the two loads as a
    share of the full load; here more is more still."""

    area_load: float = 0.05
    """Smallest load of an area that counts as loaded, as a share of the full load."""
    sigma: float = 0.01
    """Standard deviation of the zero velocity, m/s."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        if load is None or load.heel is None or load.forefoot is None:
            return NO_EVIDENCE
        statistic = min(load.heel, load.forefoot)
        if statistic >= self.area_load:
            return Stance(ZERO, self.sigma, statistic, Phase.STATIONARY)
        return Stance(ZERO, inf, statistic, Phase.SWING if load.airborne else None)


@frozen
class MaximumPressureSettings:
    """Settings of `MaximumPressure`."""

    threshold: float = 0.25
    """Statistic above which the foot is on the ground."""
    sigma: float = 0.05
    """Standard deviation of the zero velocity, m/s."""


@define
class MaximumPressure(Detector):
    """Detects a foot on the ground: the most loaded cell is above a threshold.

    Source: equation (6) of "Improving accuracy of real-time positioning and path tracking by using an error
    compensation algorithm against walking modes", method III. The statistic is the value of this cell as a share of the
    highest cell value so far. A foot on the ground may still roll, so the noise is larger than that of `TwoArea`."""

    settings: MaximumPressureSettings = MaximumPressureSettings()
    highest: float = field(default=0.0, init=False)
    """Highest recent value of any cell, unit of the cells; it decays slowly."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        if load is None:
            return NO_EVIDENCE
        largest = max(load.cells, default=0.0)
        self.highest = max(self.highest * HIGHEST_DECAY, largest)
        statistic = largest / self.highest if self.highest > 0.0 else 0.0
        if statistic > self.settings.threshold and not load.airborne:
            return Stance(ZERO, self.settings.sigma, statistic, None)
        return Stance(ZERO, inf, statistic, Phase.SWING if load.airborne else None)
