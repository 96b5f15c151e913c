"""KUPT: known velocity from heel-strike to toe-off, not only while the foot stands still.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C. While the shoe rolls over its forefoot or its heel, the velocity of the sensor
follows from its pitch (kinematics.py); only the swing is left to integration, and only there a drift is taken out.
"""

from __future__ import annotations

from math import inf

from attrs import define, evolve, field

from ..calibration import Calibration, ShoeGeometry
from ..types import Foot, Layout, Phase, Quat, Vec3
from ..vector import IDENTITY, ZERO
from .kinematics import Sagittal, velocity
from .stance import Load, Shoe, Stance
from .touch import Touch

LEAST_TURN = 0.5
"""A foot that turns faster than this does not lie flat, whatever its cells say, rad/s."""


@define
class KnownVelocity:
    """Which velocity the sensor has, from the load on the two areas that its circuit board parts (section III.C.1).

    Both areas loaded: the foot is stationary, velocity zero. Then the forefoot alone: the shoe rolls over its forefoot
    and the velocity is that of (7). No load: swing. Then the heel: the velocity of (5). Rolling velocities are the mean
    since the sample before. They take a direction of the toes, which the first push-off teaches; before it, and when
    the forefoot lands first, there is no evidence. As long as the cells are not to be believed an inertial detector
    speaks. The statistic is the smaller of the two loads as a share of the wearer's full load.
    """

    on: float = 0.05
    """Both areas above this share of the full load: stationary begins,"""
    off: float = 0.03
    """and ends when one of them is below this."""
    sigma: float = 0.01
    """Of a zero velocity, m/s."""
    rolling_sigma: float = 0.1
    """Of a rolling shoe's, m/s."""
    toe_down: float = 0.1
    """A foot that lands with its toes lower than this does not roll over its heel, rad."""
    stale: float = 0.05
    """Loads that come more slowly than inertial samples hold for so long, s."""
    shoe: ShoeGeometry = field(factory=ShoeGeometry)
    sagittal: Sagittal = field(factory=Sagittal)
    """What was learnt of the mounting."""
    # state
    touch: Touch = field(factory=Touch, init=False)
    inertial: Shoe = field(factory=Shoe, init=False)
    """Speaks as long as the cells are not to be believed (touch.py): standing before the first step."""
    phase: Phase | None = field(default=None, init=False)
    """As far as the load tells; None while it does not."""
    place: Vec3 | None = field(default=None, init=False)
    """Of the sensor in the last sample, from the heel's end or the toe, navigation frame, m."""
    held: Load | None = field(default=None, init=False)
    held_at: float = field(default=0.0, init=False)

    def calibrated(self, foot: Foot, calibration: Calibration) -> KnownVelocity:
        """The same for the wearer's own shoe."""
        return self if calibration.shoe is None else evolve(self, shoe=calibration.shoe)

    def wear(self, layout: Layout) -> None:
        """The device said where its cells are."""
        self.touch.wear(layout)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        """As in `Detector`."""
        inertial = self.inertial.update(t, dt, acc, gyro, None)
        still = inertial.hint is Phase.STATIONARY
        if load is not None:
            self.held, self.held_at = load, t
        elif self.held is not None and t - self.held_at < self.stale:
            load = self.held
        else:
            self.held = None
        airborne = self.touch.update(t, load, still)
        sagittal = self.sagittal
        if load is None or not self.touch.known:
            self.phase = self.place = None
            if still:
                sagittal.lifted()
                sagittal.stands(dt, attitude)
                return inertial
            sagittal.lifts(attitude)
            return Stance(ZERO, inf, inertial.statistic, None)
        heel, forefoot = load.heel, load.forefoot
        if heel is None or forefoot is None:
            self.phase = self.place = None
            return Stance(ZERO, inf, 0.0, Phase.SWING if airborne else None)
        statistic = min(heel, forefoot)
        was = self.phase
        sagittal.see(attitude)
        if airborne:
            if was is not Phase.SWING:
                sagittal.lifted()
            self.phase = Phase.SWING
            self.place = None
            return Stance(ZERO, inf, statistic, Phase.SWING)
        if statistic >= (self.off if was is Phase.STATIONARY else self.on):
            if was is not Phase.STATIONARY:
                sagittal.lifted()
            self.phase = Phase.STATIONARY
            gx, gy, gz = gyro
            if gx * gx + gy * gy + gz * gz < LEAST_TURN * LEAST_TURN:
                sagittal.stands(dt, attitude)
            self.place = None if sagittal.toe is None else sagittal.forefoot_place(self.shoe)
            return Stance(ZERO, self.sigma, statistic, Phase.STATIONARY)
        if was is Phase.STATIONARY or was is Phase.PUSH_OFF:
            return self._push_off(dt, attitude, statistic, forefoot > heel)
        if was is Phase.SWING or was is Phase.LOADING:
            return self._loading(dt, statistic, heel > forefoot)
        return Stance(ZERO, inf, statistic, None)

    def _push_off(self, dt: float, attitude: Quat, statistic: float, on_forefoot: bool) -> Stance:
        sagittal, before = self.sagittal, self.place
        if not on_forefoot:
            # the weight went back to the heel: the shoe does not roll over its forefoot
            self.place = None
            return Stance(ZERO, inf, statistic, None)
        self.phase = Phase.PUSH_OFF
        sagittal.lifts(attitude)
        self.place = None if sagittal.toe is None else sagittal.forefoot_place(self.shoe)
        if before is None or self.place is None or dt <= 0.0:
            return Stance(ZERO, inf, statistic, Phase.PUSH_OFF)
        return Stance(velocity(before, self.place, dt), self.rolling_sigma, statistic, Phase.PUSH_OFF)

    def _loading(self, dt: float, statistic: float, on_heel: bool) -> Stance:
        sagittal, before = self.sagittal, self.place
        self.phase = Phase.LOADING
        rolls = on_heel and sagittal.toe is not None and sagittal.pitch > -self.toe_down
        self.place = sagittal.heel_place(self.shoe) if rolls else None
        if before is None or self.place is None or dt <= 0.0:
            return Stance(ZERO, inf, statistic, Phase.LOADING)
        return Stance(velocity(before, self.place, dt), self.rolling_sigma, statistic, Phase.LOADING)
