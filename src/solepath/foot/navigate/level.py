"""Height correction by the detection of level strides, so that level walking stays level.

A foot comes down on the floor that it left, on a slope, or on another stair. The height from integration errs by some
centimetres a stride, mostly in the same direction, so an uncorrected level walk climbs by metres. Height that is
neither stair nor slope is removed ("vertical error elimination": Li, Liu, Liu, Chen, Ma, Sensors 16, 1809, 2016,
section 3.4.2), weighted with the probability of three cases by Bayes' rule:

    level   height = 0          pitch = 0       the foot stands as high as before, and as flat as on level ground
    slope   height = s length   pitch = s       the foot stands higher (s > 0) or lower, and is pitched by s
    stair   height = anything   pitch = 0       within half a metre: a kerb, a stair, two stairs at a time

Height is positive upwards, pitch is positive with the toe up. The most likely case of the stride before gives the
prior: a slope goes on, a stair is followed by another.

The errors that all level strides share are learnt and removed from every stride. `rise_bias` is the height for each
metre of path that the errors of this sensor cause (a bias of 25 mg gives 3.5 cm in a stride of 1.4 m). `scale` is the
square of the scatter of heights as a share of the filter's variance. `upright` is up in the sensor frame when the foot
is flat on level ground. The pitch is measured relative to `upright`, in the direction of the stride, so it contains
neither the mounting nor an error of integration.

A slope of less than some 3 % looks like a rise bias and counts as one. The same holds for any slope with a sensor whose
heights scatter by a decimetre, until the pitch of several strides has shown it. The numbers were chosen by hand and not
swept."""

from __future__ import annotations

from math import exp, hypot, log, pi, sqrt

from ...types import Quat, Vec3
from ...types.attrs import define
from ...types.vector import UP, ZERO, add, dot, rotate_back, sub

LONGEST_STRIDE = 1e3
"""Longest stride, m; nothing is learnt from a longer one."""
STARTS_ON_SLOPE = 0.05
"""Probability that a walk starts on a slope."""
LEAST_SLOPE_STRIDES, MOST_SLOPE_STRIDES = 4, 20
"""Smallest and largest number of strides in a row on one slope that are evidence for another slope being level."""
LEAST_LOG_ODDS = 2.0
"""Natural logarithm of the odds from which on the current slope counts as level."""
LEAST_PITCH_VARIANCE = 2e-4
"""Smallest variance of the pitch of a flat foot, rad^2."""
FLOOR_SIGMA = 0.01
"""Standard deviation of a level floor between two foot-flats, from the sole and the time of foot-flat, m."""
SLOPE_SIGMA = 0.08
"""Standard deviation of the slopes that people walk, rise for each metre of path."""
STAIR_HEIGHT_RANGE = 1.0
"""Width of the range of heights of a stride on stairs, m: half a metre up to half a metre down."""
LEVEL_EXIT_PROBABILITIES = (0.01, 0.03)
"""Probabilities that a level stride is followed by a slope, and by a stair."""
STAY_PROBABILITIES = (0.8, 0.5)
"""Probabilities that a slope is followed by a slope, and a stair by a stair."""
RISE_BIAS_SIGMA = 0.02
"""Standard deviation of the rise bias between sensors, rise for each metre of path."""
PITCH_SIGMA = 0.06
"""Standard deviation of the mean pitch if it is estimated from one foot-flat, rad.

Foot-flats of a start or a turn differ from those of walking."""
PITCH_OUTLIER_SHARE = 0.1
"""Share of foot-flats whose pitch has no meaning, 0 to 1."""
LEAST_WALKED_LENGTH, LARGEST_WALKED_TURN = 0.3, 0.6
"""Shortest length, m, and largest turn, rad, of a stride from which rise bias and pitch are learnt."""
MOST_AVERAGED_STRIDES = 25.0
"""Number of level strides that are averaged."""


@define
class LevelGround:
    """Estimates the height of every stride (`judge`) at the foot-flat that ends it. Units: m and rad."""

    rise_bias: float = 0.0
    """Height for each metre of path that the errors of this sensor cause."""
    rise_bias_information: float = 0.0
    """Inverse of the variance of the rise bias, without its prior."""
    scale: float = 0.25
    """Square of the scatter of heights, as a share of the filter's variance of the height."""
    scale_weight: float = 4.0
    """Number of level strides in `scale`; four stand for the prior."""
    upright: Vec3 = ZERO
    """Mean of up at the foot-flats of level strides, sensor frame."""
    upright_weight: float = 0.0
    """Number of level strides in `upright`."""
    pitch_variance: float = 5e-4
    """Variance of the pitch of a flat foot from stride to stride, rad^2."""
    slope_strides: int = 0
    """Number of strides in a row on a slope, up to now."""
    grade: float = 0.0
    """Mean rise for each metre of path of the `slope_strides`."""
    slope_upright: Vec3 = ZERO
    """Mean of up at the foot-flats of the `slope_strides`, sensor frame."""
    slope: float = 0.02
    """Probability that the last stride was on a slope."""
    stair: float = 0.02
    """Probability that the last stride was on a stair."""

    def judge(self, displacement: Vec3, turn: float, variance: float, attitude: Quat) -> tuple[float, float]:
        """Return the most likely height of a stride, m, and the probability that it was level.

        `displacement` is measured from foot-flat to foot-flat, m (z up, any heading), `turn` is in rad. `variance` is
        that of the height in the filter, m^2. `attitude` is sensor to a frame with z up."""
        x, y, z = displacement
        length = hypot(x, y)
        if not (length < LONGEST_STRIDE and abs(z) < LONGEST_STRIDE and 0.0 < variance < LONGEST_STRIDE):
            return z, 0.0
        height = z - self.rise_bias * length
        noise = FLOOR_SIGMA * FLOOR_SIGMA + self.scale * variance
        # the error of the rise bias adds to the noise
        level_variance = noise + length * length / (
            1.0 / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA) + self.rise_bias_information
        )
        slope_variance = SLOPE_SIGMA * SLOPE_SIGMA
        rise_variance = length * length * slope_variance
        gain = rise_variance / (level_variance + rise_variance)
        # the prior probabilities, from the last stride
        to_slope, to_stair = LEVEL_EXIT_PROBABILITIES
        slope = (1.0 - self.slope) * to_slope + self.slope * STAY_PROBABILITIES[0]
        stair = (1.0 - self.stair) * to_stair + self.stair * STAY_PROBABILITIES[1]
        level = 1.0 - slope - stair
        level *= _normal_density(height, level_variance)
        slope *= _normal_density(height, level_variance + rise_variance)
        stair /= STAIR_HEIGHT_RANGE
        up = rotate_back(attitude, UP)
        informative = length > LEAST_WALKED_LENGTH and abs(turn) < LARGEST_WALKED_TURN
        pitch = 0.0
        if informative and self.upright_weight > 0.5:
            # relative to the mean, toe up positive: the change of up along the direction of the stride
            pitch = dot(sub(up, self.upright), rotate_back(attitude, (x / length, y / length, 0.0)))
            mean_pitch_sigma = PITCH_SIGMA / self.upright_weight
            pitch_variance = max(self.pitch_variance, LEAST_PITCH_VARIANCE) + mean_pitch_sigma * mean_pitch_sigma
            pitch_density = self._pitch_likelihood(pitch, pitch_variance)
            level *= pitch_density
            stair *= pitch_density
            # given the height, s has the mean gain height / length and (1 - gain) times the variance of slopes
            slope *= self._pitch_likelihood(
                pitch - gain * height / length, pitch_variance + (1.0 - gain) * slope_variance
            )
        total = level + slope + stair
        if total > 0.0:
            level, slope, stair = level / total, slope / total, stair / total
        else:
            level, slope, stair = 0.0, 0.0, 1.0
        if length > 0.5 * LEAST_WALKED_LENGTH:  # in a shorter one the foot was put down on the same ground
            self.slope, self.stair = slope, stair
        if informative:
            self._learn(level, height, length, variance, noise, up, pitch)
            self._follow_slope(slope, height / length, up)
        return (slope + stair) * height, level

    @staticmethod
    def _pitch_likelihood(difference: float, variance: float) -> float:
        """Return the likelihood of a pitch that differs by `difference` rad; outliers are uniform within a radian."""
        return (1.0 - PITCH_OUTLIER_SHARE) * _normal_density(difference, variance) + PITCH_OUTLIER_SHARE

    def _learn(
        self, level: float, height: float, length: float, variance: float, noise: float, up: Vec3, pitch: float
    ) -> None:
        """Learn from a stride that was level with the probability `level`."""
        # least squares of height = rise_bias ground, with a prior of 0
        weight = level * length * length / noise
        information = 1.0 / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA) + self.rise_bias_information
        self.rise_bias += weight / (information + weight) * height / length
        self.rise_bias_information = min(
            self.rise_bias_information + weight, MOST_AVERAGED_STRIDES * length * length / noise
        )
        self.scale_weight = min(self.scale_weight + level, MOST_AVERAGED_STRIDES)
        self.scale += level / self.scale_weight * (min(height * height / max(variance, 1e-6), 2.0) - self.scale)
        if self.upright_weight > 0.5:
            self.pitch_variance += (
                level / (self.upright_weight + 4.0) * (min(pitch * pitch, 0.01) - self.pitch_variance)
            )
        self.upright_weight = min(self.upright_weight + level, MOST_AVERAGED_STRIDES)
        if self.upright_weight > 0.0:
            self.upright = add(self.upright, sub(up, self.upright), level / self.upright_weight)

    def _follow_slope(self, slope: float, grade: float, up: Vec3) -> None:
        """Add a stride of `grade`, rise for each metre, that was on a slope with the probability `slope`.

        In a walk that starts on a slope, the slope is taken for level, and level ground for a slope. This shows when
        the slope ends: if the current ground counted as level, there would be hardly any rise bias."""
        if slope < 0.5:
            self.slope_strides = 0
            return
        self.slope_strides = min(self.slope_strides + 1, MOST_SLOPE_STRIDES)
        k = 1.0 / self.slope_strides
        self.grade += k * (grade - self.grade)
        self.slope_upright = add(self.slope_upright, sub(up, self.slope_upright), k)
        rise_bias, other_rise_bias = self.rise_bias, self.rise_bias + self.grade
        odds = 0.5 * (rise_bias * rise_bias - other_rise_bias * other_rise_bias) / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA)
        # a start on a slope has a probability, and each further stride on it the probability that the slope goes on
        odds += log(STARTS_ON_SLOPE / LEVEL_EXIT_PROBABILITIES[0]) + log(STAY_PROBABILITIES[0]) * (
            self.upright_weight - self.slope_strides
        )
        if self.slope_strides >= LEAST_SLOPE_STRIDES and odds > LEAST_LOG_ODDS:
            self.rise_bias, self.upright, self.upright_weight = (
                other_rise_bias,
                self.slope_upright,
                float(self.slope_strides),
            )
            self.rise_bias_information *= 0.5
            self.slope, self.stair, self.slope_strides = 0.02, 0.02, 0


def _normal_density(difference: float, variance: float) -> float:
    """Return the density at `difference` of a normal distribution about 0."""
    return exp(-0.5 * min(difference * difference / variance, 1400.0)) / sqrt(2.0 * pi * variance)
