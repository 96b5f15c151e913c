"""Stance evidence from pressure cells; the same signature as the inertial detectors in shoe.py and classic.py.

Without cells, or while the wearer's full load is not known yet, both have nothing to say (sigma is infinite).
"""

from __future__ import annotations

from math import inf

from ...types import Phase, Quat, Vec3
from ...types.attrs import define
from ...types.vector import IDENTITY, ZERO
from .stance import Detector, Load, Stance

NO_EVIDENCE = Stance(ZERO, inf, 0.0, None)


@define
class TwoArea(Detector):
    """Heel area and forefoot area both loaded: the sole lies flat, so the sensor between them stands still.

    After "Smart insole-based indoor localization system for Internet of Things applications", stationary epoch
    detection: forces on both sides of the circuit board. The statistic is the smaller of the two loads as a share of
    the wearer's full load.
    """

    on: float = 0.05
    sigma: float = 0.01

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        if load is None or load.heel is None or load.forefoot is None:
            return NO_EVIDENCE
        statistic = min(load.heel, load.forefoot)
        if statistic >= self.on:
            return Stance(ZERO, self.sigma, statistic, Phase.STATIONARY)
        return Stance(ZERO, inf, statistic, Phase.SWING if load.airborne else None)


@define
class MaximumPressure(Detector):
    """The most loaded cell beyond a threshold: the foot is down (equation (6) of "Improving accuracy of real-time
    positioning and path tracking by using an error compensation algorithm against walking modes", method III).

    The statistic is that cell as a share of the most loaded one ever seen. A foot that is down still rolls, hence the
    larger noise.
    """

    threshold: float = 0.25
    sigma: float = 0.05

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        if load is None:
            return NO_EVIDENCE
        if load.highest > self.threshold and not load.airborne:
            return Stance(ZERO, self.sigma, load.highest, None)
        return Stance(ZERO, inf, load.highest, Phase.SWING if load.airborne else None)
