"""Error that the tracks of both feet share, which no comparison of the feet can show.

A gyroscope whose scale or axes are off turns the heading by nearly the same angle in every stride, because the loop of
rotations of a swing does not close, and by a share of every turn. One whose bias was learnt badly turns it all the
time. The errors (truth minus track) are therefore

    x, y       position of the wearer, m, world frame
    heading    heading of both tracks, rad
    drift      turn of the heading in a usual stride, rad
    turning    turn of the heading for a turn of 1 rad, no unit
    bias       rate of the heading, rad/s

For a stride with the displacement d that lasts T, turns by theta and counts as n usual strides, with e = (x, y) and c,
a rotation by +90 degrees:

    a = w (n drift + theta turning + T bias),   heading' = heading + a,   e' = e + w (heading + a / 2) c d

where w is 1/2 for a stride of one of two feet, and 1 for a foot alone. Straight ways measure the drift with the bias
(straightness.py). A rest at which a foot learns its bias anew measures the bias so far. The equations are linear in the
errors; what a heading error of any size does to the position is in position_covariance.py."""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum, sqrt

from ...calibration import HeadingCalibration
from ...foot.navigate.bias import BIAS_WANDER, Bias
from ...types import Foot
from ...types.attrs import define, field, frozen

DRIFT = 0.0014
"""Standard deviation of the drift of one foot, rad a stride (4.4 degrees a minute), unless it was calibrated.

On recordings a foot drifts by 1 to 7 degrees a minute (3.5 rms) with its bias (drift of `solepath evaluate`);
calibration walks of 60 emulated wearers show 0.0016."""
TURNING = 0.007
"""Standard deviation of the relative error of a turn of one foot, no unit, unless it was calibrated.

Sheets of gyroscopes give tolerances of the scale of 1 to 3 %, which are two standard deviations."""
DRIFT_CHANGE = 3e-6
"""Random walk of the drift, rad a stride and sqrt(s): the manner of walking changes."""
HEADING_NOISE = 0.0012
"""Random walk of the heading, rad/sqrt(s): 0.5 degrees in a minute."""
GAP_RATE, MAX_GAP_ERROR = 0.3, 0.06
"""Error of the heading after a gap in the samples of a foot: rad per s of the gap, and at the most, rad."""
REST_GATE = 9.0
"""Largest squared difference of a bias that was learnt anew from the expected one, divided by its variance, that is
attributed to the time before it."""

Move = tuple[float, float, float]
"""Values to be added to x and y, m, and to the heading of both tracks, rad."""
NO_MOVE: Move = (0.0, 0.0, 0.0)
"""The correction of nothing: the tracks stay where they are."""


@frozen
class FootBias:
    """The knowledge that a foot has of its gyroscope bias at the end of a stride."""

    t: float
    """End of the stride, s."""
    variance: float
    """Variance of the bias about the vertical at `t`, (rad/s)^2."""
    learnt_at: float | None
    """End of the rest that has shown the bias, s; None before any and after times restart."""
    change: float
    """Sum of all changes of the bias about the vertical, rad/s."""


@define
class CommonError:
    """Covariance of the errors x, y, heading (h), drift (r), turning (k) and bias (b) of the mean of both tracks."""

    xx: float = field(default=0.0, init=False)
    xy: float = field(default=0.0, init=False)
    xh: float = field(default=0.0, init=False)
    xr: float = field(default=0.0, init=False)
    xk: float = field(default=0.0, init=False)
    xb: float = field(default=0.0, init=False)
    yy: float = field(default=0.0, init=False)
    yh: float = field(default=0.0, init=False)
    yr: float = field(default=0.0, init=False)
    yk: float = field(default=0.0, init=False)
    yb: float = field(default=0.0, init=False)
    hh: float = field(default=0.0, init=False)
    hr: float = field(default=0.0, init=False)
    hk: float = field(default=0.0, init=False)
    hb: float = field(default=0.0, init=False)
    rr: float = field(default=0.5 * DRIFT * DRIFT, init=False)
    rk: float = field(default=0.0, init=False)
    rb: float = field(default=0.0, init=False)
    kk: float = field(default=0.5 * TURNING * TURNING, init=False)
    kb: float = field(default=0.0, init=False)
    bb: float = field(default=0.0, init=False)
    drift: float = field(default=0.0, init=False)
    """Estimated drift, which is removed from both tracks, rad a stride."""
    turning: float = field(default=0.0, init=False)
    """Estimated relative error of turns, which is removed from both tracks, no unit."""
    bias: float = field(default=0.0, init=False)
    """Estimated rate of the heading, which is removed from both tracks, rad/s."""
    started: bool = field(default=False, init=False)
    """Flag: a foot has taken a stride."""
    alone: bool = field(default=False, init=False)
    """Flag: the newest stride was that of a foot alone."""
    drift_variances: tuple[float, float] = field(default=(DRIFT * DRIFT, DRIFT * DRIFT), init=False)
    """Variance of the drift of the left and the right foot before any stride, (rad a stride)^2."""
    turning_variances: tuple[float, float] = field(default=(TURNING * TURNING, TURNING * TURNING), init=False)
    """Variance of the relative error of the turns of the left and the right foot before any stride, no unit."""
    foot_biases: list[FootBias | None] = field(factory=lambda: [None, None], init=False)
    """Bias of the left and the right foot at its newest stride."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Use the standard deviations of a calibration, before any stride; the feet remove the drift themselves."""
        known = [headings.get(foot) for foot in (Foot.LEFT, Foot.RIGHT)]
        left, right = [(DRIFT, TURNING) if one is None else (one.drift_sigma, one.turning_sigma) for one in known]
        self.drift_variances, self.turning_variances = (left[0] ** 2, right[0] ** 2), (left[1] ** 2, right[1] ** 2)
        self.rr, self.kk = 0.25 * fsum(self.drift_variances), 0.25 * fsum(self.turning_variances)

    def share(self, foot: int, alone: bool) -> float:
        """Return the share of the next stride of foot 0 (left) or 1 in the mean: all of it if it is `alone`."""
        if alone and not self.alone:  # its own drift was hidden in the mean
            self.rr += max(0.0, self.drift_variances[foot] - 0.25 * fsum(self.drift_variances))
            self.kk += max(0.0, self.turning_variances[foot] - 0.25 * fsum(self.turning_variances))
            self.bb *= 2.0
        self.started, self.alone = True, alone
        return 1.0 if alone else 0.5

    def drift_variance(self, stride_time: float) -> float:
        """Return the variance of drift and bias together, (rad a stride)^2, with strides of this duration, s."""
        return max(0.0, self.rr + stride_time * (2.0 * self.rb + stride_time * self.bb))

    @property
    def heading_sigma(self) -> float:
        """Standard deviation of the heading, rad."""
        return sqrt(max(0.0, self.hh))  # below 0 only by rounding

    def propagate(
        self, share: float, strides: float, turn: float, duration: float, displacement: tuple[float, float],
        variance: tuple[float, float, float],
    ) -> None:  # fmt: skip
        """Propagate the covariance over a stride that moves the mean by `share` of its `displacement`, m.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s; `variance` is that of its
        displacement: xx, xy, yy, m^2."""
        dx, dy = share * displacement[0], share * displacement[1]
        n, k, t = share * strides, share * turn, share * duration
        # a: the turn of the heading in the stride, n drift + k turning + t bias; g: the heading in its middle
        ax = n * self.xr + k * self.xk + t * self.xb
        ay = n * self.yr + k * self.yk + t * self.yb
        ah = n * self.hr + k * self.hk + t * self.hb
        ar = n * self.rr + k * self.rk + t * self.rb
        ak = n * self.rk + k * self.kk + t * self.kb
        ab = n * self.rb + k * self.kb + t * self.bb
        aa = n * ar + k * ak + t * ab
        gx, gy = self.xh + 0.5 * ax, self.yh + 0.5 * ay
        gr, gk, gb = self.hr + 0.5 * ar, self.hk + 0.5 * ak, self.hb + 0.5 * ab
        gg = self.hh + ah + 0.25 * aa
        gh = self.hh + 1.5 * ah + 0.5 * aa
        xx, xy, yy = variance
        square = share * share
        self.xx += -2.0 * dy * gx + dy * dy * gg + square * xx
        self.xy += dx * gx - dy * gy - dx * dy * gg + square * xy
        self.yy += 2.0 * dx * gy + dx * dx * gg + square * yy
        self.xh += ax - dy * gh
        self.yh += ay + dx * gh
        self.xr -= dy * gr
        self.yr += dx * gr
        self.xk -= dy * gk
        self.yk += dx * gk
        self.xb -= dy * gb
        self.yb += dx * gb
        self.hh += 2.0 * ah + aa + share * HEADING_NOISE * HEADING_NOISE * duration
        self.hr += ar
        self.hk += ak
        self.hb += ab
        self.rr += share * DRIFT_CHANGE * DRIFT_CHANGE * duration

    def add_gap(self, duration: float) -> None:
        """Inflate the variance of the heading by a gap in the samples of a foot, of this duration in s."""
        error = (1.0 if self.alone else 0.5) * min(GAP_RATE * duration, MAX_GAP_ERROR)
        self.hh += error * error

    def turn_of(self, strides: float, turn: float, duration: float) -> float:
        """Return the correction of the heading, rad, over a stride.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s."""
        return strides * self.drift + turn * self.turning + duration * self.bias

    def add_rest(self, foot: int, t: float, bias: Bias) -> Move:
        """Take in the `bias` of foot 0 (left) or 1 at the end of a stride at `t`, s.

        A foot that has learnt its bias anew, with a gain of 1 - q / p for the variance p before and q now, has measured
        by which rate its track turned wrongly until now. Returns what is to be added to x and y, m, and to the heading,
        rad."""
        newest, share, variance = self.foot_biases[foot], 1.0 if self.alone else 0.5, bias.variances[0]
        if newest is None:
            self.foot_biases[foot] = FootBias(t, variance, bias.t, bias.change)
            self.bb += share * share * variance
            return NO_MOVE
        wander = BIAS_WANDER * BIAS_WANDER * max(0.0, t - newest.t)
        self.bb += share * share * wander
        before = newest.variance + wander
        if bias.t == newest.learnt_at or variance >= before:
            self.foot_biases[foot] = FootBias(t, before, bias.t, newest.change)
            return NO_MOVE
        self.foot_biases[foot] = FootBias(t, variance, bias.t, bias.change)
        change, gain = bias.change - newest.change, 1.0 - variance / before
        # the error of the foot is `part` of that of the mean, and another one that has nothing to do with it
        other = None if self.alone else self.foot_biases[1 - foot]
        part = 1.0 if other is None else 2.0 * before / (before + other.variance)
        s, z = before / gain, -change / gain - part * self.bias
        move = NO_MOVE
        if z * z < REST_GATE * s:
            column = [part * value for value in (self.xb, self.yb, self.hb, self.rb, self.kb, self.bb)]
            move = self._correct(column, z, s, 1.0)
        else:  # it is another bias, and nobody knows since when
            self.bb += share * share * variance
        self.bias += share * change  # the foot has removed it
        return move

    def correct_drift(self, z: float, variance: float, weight: float, stride_time: float) -> Move:
        """Correct the errors by a measured drift that differs by `z` rad a stride from the estimate.

        `variance` is that of the measurement and `stride_time` the duration of a stride, s, in which the bias adds to
        the drift; `weight` is the probability that it measures them at all. Returns what is to be added to x and y, m,
        and to the heading, rad."""
        t = stride_time
        column = [
            self.xr + t * self.xb, self.yr + t * self.yb, self.hr + t * self.hb, self.rr + t * self.rb,
            self.rk + t * self.kb, self.rb + t * self.bb,
        ]  # fmt: skip
        return self._correct(column, z, variance + self.drift_variance(t), weight)

    def _correct(self, column: list[float], z: float, s: float, weight: float) -> Move:
        """Correct the errors by a measurement with the innovation `z`, its variance `s` and P H' in `column`.

        With the gain K, the errors move by weight K z, and their covariance becomes that of both possibilities
        together: that the measurement is one, with the probability `weight`, or none (Bar-Shalom et al. 2001, section
        11.6)."""
        a, b, c, d, e, g = [value / s for value in column]
        # P <- P - weight K S K' + weight (1 - weight) K z z K'
        f = weight * ((1.0 - weight) * z * z - s)
        fa, fb, fc, fd = f * a, f * b, f * c, f * d
        self.xx += fa * a
        self.xy += fa * b
        self.xh += fa * c
        self.xr += fa * d
        self.xk += fa * e
        self.xb += fa * g
        self.yy += fb * b
        self.yh += fb * c
        self.yr += fb * d
        self.yk += fb * e
        self.yb += fb * g
        self.hh += fc * c
        self.hr += fc * d
        self.hk += fc * e
        self.hb += fc * g
        self.rr += fd * d
        self.rk += fd * e
        self.rb += fd * g
        self.kk += f * e * e
        self.kb += f * e * g
        self.bb += f * g * g
        z *= weight
        self.drift += d * z
        self.turning += e * z
        self.bias += g * z
        return (a * z, b * z, c * z)

    def replace_drift(self, drift: float, variance: float, strides: float, moves: tuple[float, float]) -> Move:
        """Replace the drift by another one with its `variance`, rad a stride, because a calibration does not fit.

        The walk so far counts as `strides` usual ones, and `moves` is the derivative of the position by the drift, m
        for each rad a stride. Returns what is to be added to x and y, m, and to the heading, rad."""
        change, (x, y) = drift - self.drift, moves
        self.drift, self.rr, self.rk, self.rb = drift, variance, 0.0, 0.0
        self.xr, self.yr, self.hr = variance * x, variance * y, variance * strides
        self.xx += self.xr * x
        self.xy += self.xr * y
        self.xh += self.xr * strides
        self.yy += self.yr * y
        self.yh += self.yr * strides
        self.hh += self.hr * strides
        return (change * x, change * y, change * strides)

    def inflate(self, variance: float) -> None:
        """Add `variance`, m^2, to that of x and of y."""
        self.xx += variance
        self.yy += variance
