"""Error that the tracks of both feet share, which no comparison of the feet can show.

A gyroscope whose scale or axes are off turns the heading by nearly the same angle in every stride, because the loop of
rotations of a swing does not close, and by a share of every turn. The errors (truth minus track) are therefore

    x, y       position of the wearer, m, world frame
    heading    heading of both tracks, rad
    drift      turn of the heading in a usual stride, rad
    turning    turn of the heading for a turn of 1 rad, no unit

For a stride with the displacement d that turns by theta and counts as n usual strides, with e = (x, y) and c, a
rotation by +90 degrees:

    heading' = heading + w (n drift + theta turning),   e' = e + w (heading + (n drift + theta turning) / 2) c d

where w is 1/2 for a stride of one of two feet, and 1 for a foot alone. The equations are linear in the errors; what a
heading error of any size does to the position is in `position_covariance`."""

from __future__ import annotations

from collections.abc import Mapping
from math import exp, hypot, sqrt

from ...calibration import HeadingCalibration
from ...types import Foot
from ...types.attrs import define, field

DRIFT = 0.0014
"""Standard deviation of the drift of one foot, rad a stride (4 degrees a minute), unless it was calibrated.

On recordings a foot drifts by 1 to 8 degrees a minute (`solepath evaluate`, drift of the heading)."""
TURNING = 0.007
"""Standard deviation of the relative error of a turn of one foot, no unit, unless it was calibrated.

Sheets of gyroscopes give tolerances of the scale of 1 to 3 %, which are two standard deviations."""
DRIFT_CHANGE = 1.2e-5
"""Random walk of the drift, rad a stride and sqrt(s): the bias wanders, and the manner of walking changes."""
HEADING_NOISE = 0.0018
"""Random walk of the heading, rad/sqrt(s): 0.8 degrees in a minute, because the bias wanders and is learnt anew."""
GAP_RATE, MAX_GAP_ERROR = 0.3, 0.06
"""Error of the heading after a gap in the samples of a foot: rad per s of the gap, and at the most, rad."""
LENGTH_ERROR = 0.007
"""Standard deviation of the relative error that all strides have in common, no unit.

Emulated strides are up to 1.6 % too long or too short on average (rms 0.7 %)."""


@define
class CommonError:
    """Covariance of the errors x, y, heading (h), drift (r) and turning (k) of the mean of both tracks."""

    xx: float = field(default=0.0, init=False)
    xy: float = field(default=0.0, init=False)
    xh: float = field(default=0.0, init=False)
    xr: float = field(default=0.0, init=False)
    xk: float = field(default=0.0, init=False)
    yy: float = field(default=0.0, init=False)
    yh: float = field(default=0.0, init=False)
    yr: float = field(default=0.0, init=False)
    yk: float = field(default=0.0, init=False)
    hh: float = field(default=0.0, init=False)
    hr: float = field(default=0.0, init=False)
    hk: float = field(default=0.0, init=False)
    rr: float = field(default=0.5 * DRIFT * DRIFT, init=False)
    rk: float = field(default=0.0, init=False)
    kk: float = field(default=0.5 * TURNING * TURNING, init=False)
    drift: float = field(default=0.0, init=False)
    """Estimated drift, which is removed from both tracks, rad a stride."""
    turning: float = field(default=0.0, init=False)
    """Estimated relative error of turns, which is removed from both tracks, no unit."""
    started: bool = field(default=False, init=False)
    """Flag: a foot has taken a stride."""
    alone: bool = field(default=False, init=False)
    """Flag: the newest stride was that of a foot alone."""

    foot_drift_sigma: float = field(default=DRIFT, init=False)
    """Standard deviation of the drift of one foot, rad a stride."""
    foot_turning_sigma: float = field(default=TURNING, init=False)
    """Standard deviation of the relative error of the turns of one foot, no unit."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Use the standard deviations of a calibration, before any stride; the feet remove the drift themselves."""
        drifts = [headings[foot].drift_sigma if foot in headings else DRIFT for foot in Foot]
        turnings = [headings[foot].turning_sigma if foot in headings else TURNING for foot in Foot]
        if len(headings) == 1:  # the other foot may never come
            drifts, turnings = (
                [one.drift_sigma for one in headings.values()],
                [one.turning_sigma for one in headings.values()],
            )
        self.foot_drift_sigma, self.foot_turning_sigma = (
            hypot(*drifts) / sqrt(len(drifts)),
            hypot(*turnings) / sqrt(len(turnings)),
        )
        self.rr, self.kk = 0.5 * self.foot_drift_sigma**2, 0.5 * self.foot_turning_sigma**2

    @property
    def drift_sigma(self) -> float:
        """Standard deviation of `drift`, rad a stride."""
        return sqrt(self.rr)

    def share(self, alone: bool) -> float:
        """Return the share of the next stride of a foot in the mean: all of it if the foot is `alone`, or one half."""
        if alone and not self.alone:  # its own drift was hidden in the mean
            self.rr += 0.5 * self.foot_drift_sigma * self.foot_drift_sigma
            self.kk += 0.5 * self.foot_turning_sigma * self.foot_turning_sigma
        self.started, self.alone = True, alone
        return 1.0 if alone else 0.5

    def propagate(
        self, share: float, strides: float, turn: float, duration: float, displacement: tuple[float, float],
        variance: tuple[float, float, float],
    ) -> None:  # fmt: skip
        """Propagate the covariance over a stride that moves the mean by `share` of its `displacement`, m.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s; `variance` is that of its
        displacement: xx, xy, yy, m^2."""
        dx, dy = share * displacement[0], share * displacement[1]
        n, k = share * strides, share * turn
        # d: the turn of the heading in the stride, n drift + k turning; g: the heading in its middle
        dx_, dy_ = n * self.xr + k * self.xk, n * self.yr + k * self.yk
        dh, dr, dk = n * self.hr + k * self.hk, n * self.rr + k * self.rk, n * self.rk + k * self.kk
        dd = n * dr + k * dk
        gx, gy = self.xh + 0.5 * dx_, self.yh + 0.5 * dy_
        gr, gk = self.hr + 0.5 * dr, self.hk + 0.5 * dk
        gg = self.hh + dh + 0.25 * dd
        gh = self.hh + 1.5 * dh + 0.5 * dd
        xx, xy, yy = variance
        square = share * share
        self.xx += -2.0 * dy * gx + dy * dy * gg + square * xx
        self.xy += dx * gx - dy * gy - dx * dy * gg + square * xy
        self.yy += 2.0 * dx * gy + dx * dx * gg + square * yy
        self.xh += dx_ - dy * gh
        self.yh += dy_ + dx * gh
        self.xr -= dy * gr
        self.yr += dx * gr
        self.xk -= dy * gk
        self.yk += dx * gk
        self.hh += 2.0 * dh + dd + share * HEADING_NOISE * HEADING_NOISE * duration
        self.hr += dr
        self.hk += dk
        self.rr += share * DRIFT_CHANGE * DRIFT_CHANGE * duration

    def add_gap(self, duration: float) -> None:
        """Inflate the variance of the heading by a gap in the samples of a foot, of this duration in s."""
        error = (1.0 if self.alone else 0.5) * min(GAP_RATE * duration, MAX_GAP_ERROR)
        self.hh += error * error

    def turn_of(self, strides: float, turn: float) -> float:
        """Return the correction of the heading, rad, over a stride that counts as `strides` and turns by `turn` rad."""
        return strides * self.drift + turn * self.turning

    def correct_drift(self, z: float, variance: float, weight: float) -> tuple[float, float, float]:
        """Correct the errors by a measured drift that differs by `z` rad a stride from the estimate.

        `variance` is that of the measurement; `weight` is the probability that it measures the drift at all. With the
        gain K, the error moves by weight K z, and its covariance to that of both possibilities together (the filter of
        Bar-Shalom for uncertain measurements). Returns what is to be added to x and y, m, and to the heading, rad."""
        s = self.rr + variance
        column = (self.xr, self.yr, self.hr, self.rr, self.rk)
        a, b, c, d, e = [value / s for value in column]
        # P <- P - weight K S K' + weight (1 - weight) K z z K'
        f = weight * ((1.0 - weight) * z * z - s)
        self.xx += f * a * a
        self.xy += f * a * b
        self.xh += f * a * c
        self.xr += f * a * d
        self.xk += f * a * e
        self.yy += f * b * b
        self.yh += f * b * c
        self.yr += f * b * d
        self.yk += f * b * e
        self.hh += f * c * c
        self.hr += f * c * d
        self.hk += f * c * e
        self.rr += f * d * d
        self.rk += f * d * e
        self.kk += f * e * e
        z *= weight
        self.drift += d * z
        self.turning += e * z
        return (a * z, b * z, c * z)

    def inflate(self, variance: float) -> None:
        """Add `variance`, m^2, to that of x and of y."""
        self.xx += variance
        self.yy += variance

    def position_covariance(self, from_start: tuple[float, float]) -> tuple[float, float, float]:
        """Return the covariance of the position: xx, xy, yy, m^2; `from_start`, m, is the way from the first position.

        The heading error h moves the position by h b + z, with b = P_eh / P_hh and z independent of h. For a small h
        that is a turn of the arm a = -c b by h, and a large one turns it too, by (R(h) - 1) a. With h normal and v its
        variance, E (cos h - 1)^2 = 3/2 - 2 exp(-v/2) + exp(-2v)/2 and E sin^2 h = (1 - exp(-2v))/2."""
        xx, xy, yy, v = self.xx, self.xy, self.yy, self.hh
        if v > 1e-9:
            bx, by = self.xh / v, self.yh / v
            half, twice = exp(-0.5 * v), exp(-2.0 * v)
            across, along = 0.5 * (1.0 - twice), 1.5 - 2.0 * half + 0.5 * twice
            # b b' v leaves, across b b' + along a a' enters, with a = (by, -bx)
            across -= v
            xx += across * bx * bx + along * by * by
            xy += (across - along) * bx * by
            yy += across * by * by + along * bx * bx
        px, py = LENGTH_ERROR * from_start[0], LENGTH_ERROR * from_start[1]
        xx, xy, yy = max(0.0, xx) + px * px, xy + px * py, max(0.0, yy) + py * py
        bound = (xx * yy) ** 0.5  # |xy| exceeds it only by rounding
        return (xx, min(max(xy, -bound), bound), yy)
