"""KUPT: known velocity from heel-strike to toe-off, not only while the foot stands still.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C. While the shoe rolls over its forefoot or its heel, the velocity of the sensor
follows from its pitch (kinematics.py); only the swing is left to integration, and only there a drift is taken out.
"""

from __future__ import annotations

from math import inf

from ...calibration import Calibration, ShoeGeometry
from ...foot.cues.touch import Touch
from ...foot.stance.shoe import ShoeDetector
from ...foot.stance.stance import Detector, Load, Stance
from ...types import Foot, Layout, Phase, Quat, Vec3
from ...types.attrs import define, evolve, field, frozen
from ...types.vector import IDENTITY, ZERO
from .kinematics import Sagittal, shoe_for, velocity

LEAST_TURN = 0.5
"""A foot that turns faster than this does not lie flat, whatever its cells say, rad/s."""
TOE_DOWN = 0.1
"""A foot that lands with its toes lower than this does not roll over its heel, rad."""
STALE = 0.05
"""Loads that come more slowly than inertial samples hold for so long, s."""
LONGEST_STRIDE, QUIET = 3.0, 0.05
"""No stride lasts longer, s: the foot stood since, and does not go on to be integrated. After so long the inertial
detector need not be certain: its zero velocity may have this sigma, m/s."""


@frozen
class KnownVelocitySettings:
    """What `KnownVelocity` is set to."""

    on: float = 0.05
    """The foot is stationary once both areas carry more than this share of the full load."""
    off: float = 0.03
    """It is so no longer once one of them carries less than this share."""
    sigma: float = 0.01
    """Noise of a zero velocity, m/s."""
    rolling_sigma: float = 0.1
    """Noise of the velocity of a rolling shoe, m/s."""
    shoe: ShoeGeometry | None = None
    """The wearer's, measured. Without it the default shoe in the insole's size."""


@define
class KnownVelocity(Detector):
    """Which velocity the sensor has, from the load on the two areas that its circuit board parts (section III.C.1).

    Both areas loaded: the foot is stationary, velocity zero. Then the forefoot alone: the shoe rolls over its forefoot
    and the velocity is that of (7). No load: swing. Then the heel: the velocity of (5). Rolling velocities are the mean
    since the sample before. They take a direction of the toes, which the first push-off teaches; before it, and when
    the forefoot lands first, there is no evidence. As long as the cells are not to be believed, or nobody has said
    where they are, an inertial detector speaks; and so it does in a motion longer than any stride, from then on until
    the foot is stationary beyond doubt: an area that feels nothing would leave it moving for ever. The statistic is the
    smaller of the two loads as a share of the wearer's full load.
    """

    settings: KnownVelocitySettings = KnownVelocitySettings()
    sagittal: Sagittal = field(factory=Sagittal)
    """What was learnt of the mounting."""
    default: ShoeGeometry = field(factory=ShoeGeometry, init=False)
    moving: float = field(default=0.0, init=False)
    """Time since the foot was last stationary beyond doubt, s."""
    touch: Touch = field(factory=Touch, init=False)
    inertial: ShoeDetector = field(factory=ShoeDetector, init=False)
    """Speaks as long as the cells are not to be believed (touch.py): standing before the first step."""
    phase: Phase | None = field(default=None, init=False)
    """As far as the load tells; None while it does not."""
    place: Vec3 | None = field(default=None, init=False)
    """Of the sensor in the last sample, from the heel's end or the toe, navigation frame, m."""
    held: Load | None = field(default=None, init=False)
    held_at: float = field(default=0.0, init=False)

    def calibrated(self, foot: Foot, calibration: Calibration) -> KnownVelocity:
        shoe = calibration.shoe
        return self if shoe is None else evolve(self, settings=evolve(self.settings, shoe=shoe))

    def set_layout(self, layout: Layout) -> None:
        self.touch.set_layout(layout)
        self.default = shoe_for(layout.length)

    @property
    def worn(self) -> ShoeGeometry:
        """The shoe that is reckoned with."""
        return self.settings.shoe or self.default

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        settings = self.settings
        inertial = self.inertial.update(t, dt, acc, gyro, None)
        still = inertial.hint is Phase.STATIONARY
        self.moving += dt
        overdue = self.moving > LONGEST_STRIDE and inertial.sigma <= QUIET
        if load is not None:
            self.held, self.held_at = load, t
        elif self.held is not None and t - self.held_at < STALE:
            load = self.held
        else:
            self.held = None
        airborne = self.touch.update(t, load, still)
        sagittal = self.sagittal
        if load is None or not self.touch.trusted:
            return self._by_inertia(dt, attitude, inertial, overdue)
        heel, forefoot = load.heel, load.forefoot
        if overdue and (airborne or heel is None or forefoot is None or min(heel, forefoot) < settings.on):
            self.phase = self.place = None
            return _ends(inertial)
        if heel is None or forefoot is None:
            if not airborne:
                return self._by_inertia(dt, attitude, inertial, overdue)
            self.phase = self.place = None
            return Stance(ZERO, inf, 0.0, Phase.SWING)
        statistic = min(heel, forefoot)
        was = self.phase
        sagittal.see(attitude)
        if airborne:
            if was is not Phase.SWING:
                sagittal.lifted()
            self.phase = Phase.SWING
            self.place = None
            return Stance(ZERO, inf, statistic, Phase.SWING)
        if statistic >= (settings.off if was is Phase.STATIONARY else settings.on):
            if was is not Phase.STATIONARY:
                sagittal.lifted()
            self.phase = Phase.STATIONARY
            self.moving = 0.0
            gx, gy, gz = gyro
            if gx * gx + gy * gy + gz * gz < LEAST_TURN * LEAST_TURN:
                sagittal.stands(dt, attitude)
            self.place = None if sagittal.toe is None else sagittal.forefoot_place(self.worn)
            return Stance(ZERO, settings.sigma, statistic, Phase.STATIONARY)
        if was is Phase.STATIONARY or was is Phase.PUSH_OFF:
            return self._push_off(dt, attitude, statistic, forefoot > heel)
        if was is Phase.SWING or was is Phase.LOADING:
            return self._loading(dt, statistic, heel > forefoot)
        return Stance(ZERO, inf, statistic, None)

    def _by_inertia(self, dt: float, attitude: Quat, inertial: Stance, overdue: bool) -> Stance:
        """The cells tell nothing."""
        self.phase = self.place = None
        if inertial.hint is Phase.STATIONARY:
            self.moving = 0.0
            self.sagittal.lifted()
            self.sagittal.stands(dt, attitude)
            return inertial
        if overdue:
            self.sagittal.lifted()
            return _ends(inertial)
        self.sagittal.lifts(attitude)
        return Stance(ZERO, inf, inertial.statistic, None)

    def _push_off(self, dt: float, attitude: Quat, statistic: float, on_forefoot: bool) -> Stance:
        sagittal = self.sagittal
        if not on_forefoot:
            # the weight went back to the heel: the shoe does not roll over its forefoot
            self.place = None
            return Stance(ZERO, inf, statistic, None)
        sagittal.lifts(attitude)
        place = None if sagittal.toe is None else sagittal.forefoot_place(self.worn)
        return self._rolling(Phase.PUSH_OFF, place, dt, statistic)

    def _loading(self, dt: float, statistic: float, on_heel: bool) -> Stance:
        sagittal = self.sagittal
        rolls = on_heel and sagittal.toe is not None and sagittal.pitch > -TOE_DOWN
        return self._rolling(Phase.LOADING, sagittal.heel_place(self.worn) if rolls else None, dt, statistic)

    def _rolling(self, phase: Phase, place: Vec3 | None, dt: float, statistic: float) -> Stance:
        """The velocity that takes the sensor to `place` from where it was in the last sample, if both are known."""
        before, self.place, self.phase = self.place, place, phase
        if before is None or place is None or dt <= 0.0:
            return Stance(ZERO, inf, statistic, phase)
        return Stance(velocity(before, place, dt), self.settings.rolling_sigma, statistic, phase)


def _ends(inertial: Stance) -> Stance:
    """The foot is as quiet as it gets: a motion that has lasted too long ends here."""
    return Stance(ZERO, inertial.sigma, inertial.statistic, Phase.STATIONARY)
