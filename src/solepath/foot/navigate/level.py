"""Whether a step was level, so that level walking stays level.

A foot comes down on the floor that it left, on a slope, or on another stair. What integration says of the height is off
by a few centimetres a step, and mostly always the same way: with nothing to hold it a level walk climbs by metres. So
what is no stair and no slope is taken off again ("vertical error elimination": Li, Liu, Liu, Chen, Ma, Sensors 16,
1809, 2016, section 3.4.2), softly, by how likely each of three is by Bayes' rule:

    level   height = 0          pitch = 0       the foot stands as high as before, and as flat as it does on the level
    slope   height = s way      pitch = s       it stands higher, and is pitched by the same angle; s is small
    stair   height = anything   pitch = 0       within half a metre: a kerb, a stair, two stairs at a time

with what the step before most likely was as the prior: a slope goes on, a stair is followed by another.

What level steps have in common is learnt and taken off every step. `rise_bias`: the height for each metre of way that the
errors of this sensor make (a bias of 25 mg makes 3.5 cm of a stride of 1.4 m). `scale`: by how much heights scatter,
as a share of what the filter expects. `upright`: how the sensor lies when the foot is flat. The pitch is measured
against that, in the direction of the step, so neither the mounting nor an error of integration has a part in it.

A slope of less than some 3 % cannot be told from a lean and is taken for one; so is any slope by a sensor whose heights
scatter by a decimetre, until the pitch of several steps has shown it.
"""

from __future__ import annotations

from math import exp, hypot, log, pi, sqrt

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, rotate_back

UP = (0.0, 0.0, 1.0)
FARTHEST = 1e3
"""No step is longer, m, nor is anything learnt of one."""
STARTS_ON_SLOPE = 0.05
"""How often a walk begins on a slope."""
LEAST_RUN, LONGEST_RUN = 4, 20
"""So many steps in a row show that there are two slopes, and more than these are no better proof."""
LEAST_LOG_ODDS = 2.0
"""Natural logarithm of the odds at which the other one is taken for level."""
LEAST_PITCH_VARIANCE = 2e-4
"""The pitch of a flat foot is not known better than by this variance, rad^2."""
UNEVEN = 0.01
"""What a level floor differs by from one foot-flat to the next: the sole, the moment that is taken for flat, m."""
STEEP = 0.08
"""Standard deviation of the slopes that are walked, rise for each metre."""
STAIR_HEIGHTS = 1.0
"""Between the highest stair up and down that a step may take, m."""
LEAVES_LEVEL = (0.01, 0.03)
"""How often a step that was on none is followed by one on a slope, and on a stair."""
STAYS = (0.8, 0.5)
"""How often a slope, and a stair, is followed by another."""
RISE_BIAS_SIGMA = 0.02
"""Standard deviation of the lean from sensor to sensor."""
PITCH_SIGMA = 0.06
"""How far one foot-flat tells the pitch of the others: those of a start and of a turn differ, rad."""
PITCH_OUTLIERS = 0.1
"""Share of foot-flats whose pitch says nothing."""
LEAST_WAY, CORNER = 0.3, 0.6
"""A shorter step tells nothing of lean and pitch, m, nor does one that turns by more, rad."""
MEMORY = 25.0
"""Level steps that count in what is learnt."""


@define
class LevelGround:
    """Say of every step how high it led (`judge`). Known at its foot-flat; m and rad."""

    rise_bias: float = field(default=0.0, init=False)
    """Height for each metre of way."""
    rise_bias_information: float = field(default=0.0, init=False)
    """How well that is known: the inverse of its variance, without what was supposed at first."""
    scale: float = field(default=0.25, init=False)
    """Square of the scatter of heights as a share of what the filter expects."""
    scale_weight: float = field(default=4.0, init=False)
    """Level steps that it is known from; four stand for what was supposed."""
    upright: Vec3 = field(default=ZERO, init=False)
    """Up in the sensor's axes, mean over the foot-flats of level steps."""
    upright_weight: float = field(default=0.0, init=False)
    """Level steps that it is known from."""
    pitch_variance: float = field(default=5e-4, init=False)
    """Variance of the pitch of a flat foot from step to step, rad^2."""
    slope_strides: int = field(default=0, init=False)
    """Steps on a slope up to now, and their mean"""
    grade: float = field(default=0.0, init=False)
    """rise for each metre, and"""
    slope_upright: Vec3 = field(default=ZERO, init=False)
    """up in the sensor's axes."""
    slope: float = field(default=0.02, init=False)
    stair: float = field(default=0.02, init=False)
    """How likely the last step was on a slope, and on a stair."""

    def judge(self, displacement: Vec3, turn: float, variance: float, attitude: Quat) -> tuple[float, float]:
        """A foot has come down flat, `displacement` m (z up, any heading) from where it last was, turned by `turn` rad.

        `variance`: of the height as the filter has it, m^2. `attitude`: sensor to a frame with z up. Returns the height
        that it has most likely gained, m, and how likely the step was level.
        """
        x, y, z = displacement
        ground = hypot(x, y)
        if not (ground < FARTHEST and abs(z) < FARTHEST and 0.0 < variance < FARTHEST):
            return z, 0.0
        height = z - self.rise_bias * ground
        noise = UNEVEN * UNEVEN + self.scale * variance
        # neither is the lean known exactly
        spread = noise + ground * ground / (1.0 / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA) + self.rise_bias_information)
        rises = STEEP * STEEP
        slopes = ground * ground * rises
        gain = slopes / (spread + slopes)
        level, slope, stair = self._priors()
        level *= _normal_density(height, spread)
        slope *= _normal_density(height, spread + slopes)
        stair /= STAIR_HEIGHTS
        up = rotate_back(attitude, UP)
        walked = ground > LEAST_WAY and abs(turn) < CORNER
        pitch = 0.0
        if walked and self.upright_weight > 0.5:
            pitch = self._pitch(x / ground, y / ground, attitude, up)
            known = PITCH_SIGMA / self.upright_weight
            pitch_variance = max(self.pitch_variance, LEAST_PITCH_VARIANCE) + known * known
            flat = self._pitch_likelihood(pitch, pitch_variance)
            level *= flat
            stair *= flat
            # given the height, s is gain height / way and varies by (1 - gain) of what slopes do
            slope *= self._pitch_likelihood(pitch - gain * height / ground, pitch_variance + (1.0 - gain) * rises)
        total = level + slope + stair
        if total > 0.0:
            level, slope, stair = level / total, slope / total, stair / total
        else:
            level, slope, stair = 0.0, 0.0, 1.0
        if ground > 0.5 * LEAST_WAY:  # else the foot was lifted and put down again: still on what it was on
            self.slope, self.stair = slope, stair
        if walked:
            self._learn(level, height, ground, variance, noise, up, pitch)
            self._follow_slope(slope, height / ground, up)
        return (slope + stair) * height, level

    def _priors(self) -> tuple[float, float, float]:
        """How likely each of the three is by the step before."""
        to_slope, to_stair = LEAVES_LEVEL
        slope = (1.0 - self.slope) * to_slope + self.slope * STAYS[0]
        stair = (1.0 - self.stair) * to_stair + self.stair * STAYS[1]
        return 1.0 - slope - stair, slope, stair

    def _pitch(self, x: float, y: float, attitude: Quat, up: Vec3) -> float:
        """Toe up against the mean, in the direction (x, y) of the step: the change of up along it, rad."""
        fx, fy, fz = rotate_back(attitude, (x, y, 0.0))
        ux, uy, uz = up
        rx, ry, rz = self.upright
        return (ux - rx) * fx + (uy - ry) * fy + (uz - rz) * fz

    def _pitch_likelihood(self, off: float, variance: float) -> float:
        """Of a pitch; that which says nothing is as likely whatever it is, within a radian."""
        return (1.0 - PITCH_OUTLIERS) * _normal_density(off, variance) + PITCH_OUTLIERS

    def _learn(
        self, level: float, height: float, ground: float, variance: float, noise: float, up: Vec3, pitch: float
    ) -> None:
        """From a step that was level with that probability."""
        # least squares of height = lean ground, beside a lean that is about 0
        weight = level * ground * ground / noise
        before = 1.0 / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA) + self.rise_bias_information
        self.rise_bias += weight / (before + weight) * height / ground
        self.rise_bias_information = min(self.rise_bias_information + weight, MEMORY * ground * ground / noise)
        self.scale_weight = min(self.scale_weight + level, MEMORY)
        self.scale += level / self.scale_weight * (min(height * height / max(variance, 1e-6), 2.0) - self.scale)
        if self.upright_weight > 0.5:
            self.pitch_variance += (
                level / (self.upright_weight + 4.0) * (min(pitch * pitch, 0.01) - self.pitch_variance)
            )
        self.upright_weight = min(self.upright_weight + level, MEMORY)
        if self.upright_weight > 0.0:
            k = level / self.upright_weight
            x, y, z = self.upright
            ux, uy, uz = up
            self.upright = (x + k * (ux - x), y + k * (uy - y), z + k * (uz - z))

    def _follow_slope(self, slope: float, grade: float, up: Vec3) -> None:
        """A step of `grade`, rise for each metre, that was on a slope with that probability.

        Who sets out on a slope has what is level and what is not the wrong way round. It shows when the slope is left:
        with the other one for level there would be hardly any lean."""
        if slope < 0.5:
            self.slope_strides = 0
            return
        self.slope_strides = min(self.slope_strides + 1, LONGEST_RUN)
        k = 1.0 / self.slope_strides
        self.grade += k * (grade - self.grade)
        x, y, z = self.slope_upright
        ux, uy, uz = up
        self.slope_upright = (x + k * (ux - x), y + k * (uy - y), z + k * (uz - z))
        rise_bias, other = self.rise_bias, self.rise_bias + self.grade
        odds = 0.5 * (rise_bias * rise_bias - other * other) / (RISE_BIAS_SIGMA * RISE_BIAS_SIGMA)
        # each step more on a slope costs the chance that it goes on; the first one, to be on it from the start or later
        odds += log(STARTS_ON_SLOPE / LEAVES_LEVEL[0]) + log(STAYS[0]) * (self.upright_weight - self.slope_strides)
        if self.slope_strides >= LEAST_RUN and odds > LEAST_LOG_ODDS:
            self.rise_bias, self.upright, self.upright_weight = other, self.slope_upright, float(self.slope_strides)
            self.rise_bias_information *= 0.5
            self.slope, self.stair, self.slope_strides = 0.02, 0.02, 0


def _normal_density(off: float, variance: float) -> float:
    """Of a normal distribution about 0."""
    return exp(-0.5 * min(off * off / variance, 1400.0)) / sqrt(2.0 * pi * variance)
