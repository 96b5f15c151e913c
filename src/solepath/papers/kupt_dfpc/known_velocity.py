"""KUPT detector (fig. 3, two areas): the velocity is known from heel-strike to toe-off, not only in a standing foot.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C. While the shoe rolls over its forefoot or its heel, the sensor's velocity
follows from its pitch (kinematics.py). Only in swing is the velocity integrated, and only there is a drift removed.
Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import hypot, inf

from ...calibration import Calibration, ShoeGeometry
from ...foot.cues.touch import Touch
from ...foot.stance.shoe import ShoeDetector
from ...foot.stance.stance import Detector, Load, Stance
from ...types import Foot, Layout, Phase, Quat, Vec3
from ...types.attrs import define, evolve, field, frozen
from ...types.vector import IDENTITY, ZERO
from .kinematics import Sagittal, mean_velocity, shoe_for

HIGHEST_FLAT_RATE = 0.5
"""Angular rate above which a foot does not lie flat, even if its cells show a load, rad/s."""
LARGEST_TOE_DOWN = 0.1
"""Toe-down pitch above which a landing foot does not roll over its heel, rad; ours, the paper has no such limit."""
LOAD_VALID_TIME = 0.05
"""Time for which a load is used for later samples, s, because cells are read less often than the IMU."""
LONGEST_STRIDE, UNCERTAIN_SIGMA = 3.0, 0.05
"""Longest stride, s, and largest sigma, m/s, of an inertial zero velocity that ends a longer motion.

In a longer motion the foot must have stood without being detected, and integration must end. So less certain evidence
suffices."""


@frozen
class KnownVelocitySettings:
    """Settings of `KnownVelocity`."""

    area_on: float = 0.05
    """Load on both areas above which the foot becomes stationary, as a share of the full load."""
    area_off: float = 0.03
    """Load on either area below which the foot is no longer stationary, as a share of the full load."""
    sigma: float = 0.01
    """Noise of a zero velocity, m/s."""
    rolling_sigma: float = 0.1
    """Noise of the velocity of a rolling shoe, m/s."""
    shoe: ShoeGeometry | None = None
    """Measured geometry of the wearer's shoe; None for the default shoe in the insole's size."""


@define
class KnownVelocity(Detector):
    """Detector of the sensor's velocity from the loads of heel and forefoot, the areas on either side of the board.

    The circuit board divides the insole in two (III.C.1). Both areas loaded: the foot is stationary and its velocity
    is zero. Forefoot alone after that: the shoe rolls over its forefoot with the velocity of (7). No load: swing. Heel
    alone after swing: the shoe rolls over its heel with the velocity of (5). A rolling velocity is the mean since the
    previous sample. It needs the direction of the toes, which is known after the first push-off. Before that, and when
    the forefoot lands first, there is no evidence.

    An inertial detector is used while the cells are not reliable or have no layout. It is also used when a motion lasts
    longer than any stride, until the foot is certainly stationary; otherwise the motion would never end if an area did
    not measure. The statistic is the smaller of the two loads as a share of the full load."""

    settings: KnownVelocitySettings = KnownVelocitySettings()
    sagittal: Sagittal = field(factory=Sagittal)
    """Learnt mounting of the sensor, with pitch and direction of the foot."""
    touch: Touch = field(factory=Touch)
    """Detector of a foot in the air, from the load."""
    default_shoe: ShoeGeometry = field(factory=ShoeGeometry, init=False)
    """Geometry of the default shoe in the insole's size."""
    moving_time: float = field(default=0.0, init=False)
    """Time since the foot was last certainly stationary, s."""
    inertial: ShoeDetector = field(factory=ShoeDetector, init=False)
    """Detector for the time in which the cells are not reliable (touch.py), such as standing before the first step."""
    phase: Phase | None = field(default=None, init=False)
    """Phase by the load; None while the load does not show it."""
    position: Vec3 | None = field(default=None, init=False)
    """Last position of the sensor, relative to the toe or, in loading, to the heel's end, navigation frame, m."""
    last_load: Load | None = field(default=None, init=False)
    """Last load; None when it is too old."""
    last_load_t: float = field(default=0.0, init=False)
    """Time of the last load, s."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> KnownVelocity:
        shoe = calibration.shoe
        return self if shoe is None else evolve(self, settings=evolve(self.settings, shoe=shoe))

    def set_layout(self, layout: Layout) -> None:
        self.touch.set_layout(layout)
        self.default_shoe = shoe_for(layout.length)

    @property
    def shoe_in_use(self) -> ShoeGeometry:
        """Geometry of the shoe from which velocities are computed."""
        return self.settings.shoe or self.default_shoe

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        settings = self.settings
        inertial = self.inertial.update(t, dt, acc, gyro, None)
        still = inertial.hint is Phase.STATIONARY
        self.moving_time += dt
        overdue = self.moving_time > LONGEST_STRIDE and inertial.sigma <= UNCERTAIN_SIGMA
        if load is not None:
            self.last_load, self.last_load_t = load, t
        elif self.last_load is not None and t - self.last_load_t < LOAD_VALID_TIME:
            load = self.last_load
        else:
            self.last_load = None
        airborne = self.touch.update(t, load, still)
        sagittal, last_phase, last_position = self.sagittal, self.phase, self.position
        self.position = None
        if load is None or not self.touch.trusted:
            return self._from_inertial(dt, attitude, inertial, overdue)
        heel, forefoot = load.heel, load.forefoot
        if heel is None or forefoot is None:
            if overdue or not airborne:
                return self._from_inertial(dt, attitude, inertial, overdue)
            self.phase = None
            return Stance(ZERO, inf, 0.0, Phase.SWING)
        statistic = min(heel, forefoot)
        if overdue and (airborne or statistic < settings.area_on):
            self.phase = None
            return _end_motion(inertial)
        sagittal.update(attitude)
        stands = statistic >= (settings.area_off if last_phase is Phase.STATIONARY else settings.area_on)
        if airborne or stands:
            self.phase = Phase.SWING if airborne else Phase.STATIONARY
            if last_phase is not self.phase:
                sagittal.end_lift()
            if airborne:
                return Stance(ZERO, inf, statistic, Phase.SWING)
            self.moving_time = 0.0
            if hypot(*gyro) < HIGHEST_FLAT_RATE:
                sagittal.add_flat_sample(dt, attitude)
            self.position = None if sagittal.toe is None else sagittal.forefoot_position(self.shoe_in_use)
            return Stance(ZERO, settings.sigma, statistic, Phase.STATIONARY)
        if last_phase is Phase.STATIONARY or last_phase is Phase.PUSH_OFF:
            if forefoot <= heel:  # the weight is on the heel again: the shoe does not roll over its forefoot
                return Stance(ZERO, inf, statistic, None)
            sagittal.add_lift_sample(attitude)
            self.phase, position = Phase.PUSH_OFF, sagittal.forefoot_position
            rolls = True
        elif last_phase is Phase.SWING or last_phase is Phase.LOADING:
            self.phase, position = Phase.LOADING, sagittal.heel_position
            rolls = heel > forefoot and sagittal.pitch > -LARGEST_TOE_DOWN
        else:
            return Stance(ZERO, inf, statistic, None)
        self.position = new = position(self.shoe_in_use) if rolls and sagittal.toe is not None else None
        if last_position is None or new is None or dt <= 0.0:
            return Stance(ZERO, inf, statistic, self.phase)
        return Stance(mean_velocity(last_position, new, dt), settings.rolling_sigma, statistic, self.phase)

    def _from_inertial(self, dt: float, attitude: Quat, inertial: Stance, overdue: bool) -> Stance:
        self.phase = None
        if inertial.hint is Phase.STATIONARY:
            self.moving_time = 0.0
            self.sagittal.end_lift()
            self.sagittal.add_flat_sample(dt, attitude)
            return inertial
        if overdue:
            self.sagittal.end_lift()
            return _end_motion(inertial)
        self.sagittal.add_lift_sample(attitude)
        return Stance(ZERO, inf, inertial.statistic, None)


def _end_motion(inertial: Stance) -> Stance:
    """Return stationary evidence that ends a motion that has lasted too long."""
    return Stance(ZERO, inertial.sigma, inertial.statistic, Phase.STATIONARY)
