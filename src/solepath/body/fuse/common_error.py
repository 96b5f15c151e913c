"""Error of the wearer's position and heading that both tracks share, which no comparison of the feet can show.

A gyroscope whose scale or axes are off turns the heading by nearly the same angle in every stride, because the loop of
rotations of a swing does not close, and by a share of every turn. One whose bias was learnt badly turns it all the
time. The errors (truth minus track) are therefore

    x, y       position of the wearer, m, world frame
    heading    heading of both tracks, rad

and, for the left foot and for the right foot,

    drift      turn of the heading in a usual stride, rad
    turning    turn of the heading for a turn of 1 rad, no unit
    bias       rate of the heading, rad/s

For a stride of a foot with the displacement d that lasts T, turns by theta and counts as n usual strides, with
e = (x, y) and c, a rotation by +90 degrees:

    a = w (n drift + theta turning + T bias),   heading' = heading + a,   e' = e + w (heading + a / 2) c d

where w is 1/2 for a stride of one of two feet, and 1 for a foot alone. Straight ways measure the drift with the bias
(straightness.py), rests measure the bias (learnt_bias.py). The drift in which both tracks differ is another matter:
error_filter.py finds it by comparing the feet. The equations are linear in the errors; what a heading error of any
size does to the position is in position_covariance.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import fsum, sqrt

from ...calibration import HeadingCalibration
from ...foot.gap import LONGEST_FILLED_GAP
from ...foot.navigate.bias import FIRST_BIAS
from ...types import Foot
from ...types.attrs import define, field, frozen

DRIFT = 0.0014
"""Standard deviation of the drift of one foot, rad a stride (4.4 degrees a minute), unless it was calibrated.

On recordings a foot drifts by 1 to 7 degrees a minute (3.5 rms) with its bias (drift of `solepath evaluate`);
calibration walks of 60 emulated wearers show 0.0016."""
TURNING = 0.007
"""Standard deviation of the relative error of a turn of one foot, no unit, unless it was calibrated.

Sheets of gyroscopes give tolerances of the scale of 1 to 3 %, which are two standard deviations."""
DRIFT_CHANGE = 4e-6
"""Random walk of the drift of one foot, rad a stride and sqrt(s): the manner of walking changes."""
HEADING_NOISE = 0.0006
"""Random walk of the heading, rad/sqrt(s): 0.3 degrees in a minute, of which the gyroscope's noise is 0.1 at most.

Chosen on tuning walks: with twice as much the ellipses are a tenth wider."""
GAP_RATE, MAX_GAP_ERROR = 0.3, 0.06
"""Error of the heading after a gap in the samples of a foot: rad per s of the gap, and at the most, rad."""
UNSEEN_RATE, UNSEEN_TURN, UNSEEN_SPEED = 0.5, 1.5, 1.4
"""Standard deviations of what a wearer does in a gap of all samples: rate of turning, rad/s (1.6, as in a bend of a
corridor, for a tenth of the time), turn at the most, rad, and speed, m/s."""
MAX_TURN_BACK = 1.0
"""Largest turn of both tracks by a rest or a dropped calibration, rad, because the equations are linear."""
X, Y, HEADING = 0, 1, 2
"""Rows of the position and of the heading."""
FEET = (3, 6)
"""First row of the left foot and of the right foot: drift, turning and bias."""
SIZE = 9

Move = tuple[float, float, float]
"""Values to be added to x and y, m, and to the heading of both tracks, rad."""
NO_MOVE: Move = (0.0, 0.0, 0.0)
"""The correction of nothing: the tracks stay where they are."""


@frozen
class FootBias:
    """The bias that a foot has learnt itself, at the end of a stride."""

    t: float
    """End of the stride, s."""
    variance: float
    """Variance of the bias about the vertical by the rests alone, (rad/s)^2."""
    spans: int
    """Number of spans of rest so far."""
    change: float
    """Sum of all changes of the bias about the vertical, rad/s."""
    device: int
    """Number of times that another device may have been connected."""


def _first_covariance() -> list[list[float]]:
    sigmas = (0.0, 0.0, 0.0, DRIFT, TURNING, FIRST_BIAS, DRIFT, TURNING, FIRST_BIAS)
    return [[sigma * sigma if j == k else 0.0 for j in range(SIZE)] for k, sigma in enumerate(sigmas)]


@define
class CommonError:
    """The covariance of the errors, and what was estimated and removed of those of each foot."""

    covariance: list[list[float]] = field(factory=_first_covariance, init=False)
    """Covariance of the errors, symmetric; the rows are named above."""
    drift: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Estimated drift of the left and the right foot, which is removed from both tracks, rad a stride."""
    turning: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Estimated relative error of turns of the left and the right foot, which is removed, no unit."""
    bias: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Estimated rate of the heading of the left and the right foot, which is removed, rad/s."""
    shares: tuple[float, float] = field(default=(0.5, 0.5), init=False)
    """Shares of the left and the right foot in the wearer's heading: 1 and 0 if the left foot is alone."""
    aids: list[float] = field(factory=list, init=False)
    """Estimates of a compass and of named places (body/aiding), whose errors have the rows from `SIZE` on."""
    started: bool = field(default=False, init=False)
    """Flag: a foot has taken a stride."""
    foot_biases: list[FootBias | None] = field(factory=lambda: [None, None], init=False)
    """Bias of the left and the right foot at its newest stride."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Use the standard deviations of a calibration, before any stride; the feet remove the drift themselves."""
        for row, foot in zip(FEET, Foot, strict=True):
            if foot in headings:
                drift, turning = headings[foot].drift_sigma, headings[foot].turning_sigma
                self.covariance[row][row], self.covariance[row + 1][row + 1] = drift * drift, turning * turning

    def renew_foot(self, foot: int) -> None:
        """Give drift and turning of foot 0 (left) or 1 the variance of another device, which may be the same."""
        for row, usual in ((FEET[foot], DRIFT), (FEET[foot] + 1, TURNING)):
            self.renew(row, 2.0 * usual * usual)  # the new one and the old one are both off by it

    def start_stride(self, foot: int, alone: bool) -> float:
        """Set the shares for a stride of foot 0 (left) or 1, which has all of the heading if it is `alone`.

        Returns the share of this foot, 0.5 or 1."""
        self.started = True
        self.shares = ((1.0, 0.0), (0.0, 1.0))[foot] if alone else (0.5, 0.5)
        return self.shares[foot]

    def drift_variance(self, stride_time: float) -> float:
        """Return the variance of drift and bias together, (rad a stride)^2, with strides of this duration, s."""
        return max(0.0, self._measured(self._drift_column(stride_time), stride_time))

    def bias_variance(self) -> float:
        """Return the variance of the rate at which the biases of the feet turn the heading, (rad/s)^2."""
        (left, right), p, (a, b) = self.shares, self.covariance, (FEET[0] + 2, FEET[1] + 2)
        return max(0.0, left * left * p[a][a] + 2.0 * left * right * p[a][b] + right * right * p[b][b])

    def drift_with_bias(self, stride_time: float) -> float:
        """Return the estimated drift with the bias, rad a stride, with strides of this duration, s."""
        left, right = [drift + stride_time * bias for drift, bias in zip(self.drift, self.bias, strict=True)]
        return self.shares[0] * left + self.shares[1] * right

    @property
    def heading_sigma(self) -> float:
        """Standard deviation of the heading, rad."""
        return sqrt(max(0.0, self.covariance[HEADING][HEADING]))  # below 0 only by rounding

    def propagate(
        self, foot: int, strides: float, turn: float, duration: float, displacement: tuple[float, float],
        variance: tuple[float, float, float],
    ) -> None:  # fmt: skip
        """Propagate the covariance over a stride of foot 0 (left) or 1 with this `displacement`, m.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s; `variance` is that of its
        displacement: xx, xy, yy, m^2."""
        p, row, w = self.covariance, FEET[foot], self.shares[foot]
        dx, dy = w * displacement[0], w * displacement[1]
        n, k, t = w * strides, w * turn, w * duration
        px, py, ph = p[X], p[Y], p[HEADING]
        # a: the turn of the heading in the stride; g: the heading in its middle; each with all errors
        a = [n * r + k * q + t * b for r, q, b in zip(p[row], p[row + 1], p[row + 2], strict=True)]
        g = [heading + 0.5 * half for heading, half in zip(ph, a, strict=True)]
        aa = n * a[row] + k * a[row + 1] + t * a[row + 2]
        ah, gx, gy = a[HEADING], g[X], g[Y]
        gg, gh = ph[HEADING] + ah + 0.25 * aa, ph[HEADING] + 1.5 * ah + 0.5 * aa
        xx, xy, yy = variance
        px[X] += -2.0 * dy * gx + dy * dy * gg + w * w * xx
        px[Y] += dx * gx - dy * gy - dx * dy * gg + w * w * xy
        py[Y] += 2.0 * dx * gy + dx * dx * gg + w * w * yy
        px[HEADING] += a[X] - dy * gh
        py[HEADING] += a[Y] + dx * gh
        ph[HEADING] += 2.0 * ah + aa + w * HEADING_NOISE * HEADING_NOISE * duration
        py[X], ph[X], ph[Y] = px[Y], px[HEADING], py[HEADING]
        for j in range(HEADING + 1, len(p)):
            px[j] -= dy * g[j]
            py[j] += dx * g[j]
            ph[j] += a[j]
            p[j][X], p[j][Y], p[j][HEADING] = px[j], py[j], ph[j]
        p[row][row] += DRIFT_CHANGE * DRIFT_CHANGE * duration

    def add_gap(self, duration: float, unseen: bool) -> None:
        """Inflate the covariance by a gap in the samples of a foot, of this duration in s.

        If it is `unseen`, the other foot had no samples either, so the wearer may have turned. A stride of a usual walk
        fills a shorter gap; in a longer one the wearer may have walked anywhere."""
        one_foot = max(self.shares) * min(GAP_RATE * duration, MAX_GAP_ERROR)
        distance = UNSEEN_SPEED * duration if unseen and duration > LONGEST_FILLED_GAP else 0.0
        self.inflate(distance * distance, min(UNSEEN_RATE * duration, UNSEEN_TURN) if unseen else one_foot)

    def turn_of(self, foot: int, strides: float, turn: float, duration: float) -> float:
        """Return the correction of the heading of foot 0 (left) or 1, rad, over a stride.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s."""
        return strides * self.drift[foot] + turn * self.turning[foot] + duration * self.bias[foot]

    def correct_drift(self, z: float, variance: float, weight: float, stride_time: float) -> Move:
        """Correct the errors by a measured drift that differs by `z` rad a stride from the estimate.

        `variance` is that of the measurement and `stride_time` the duration of a stride, s, in which the bias adds to
        the drift; `weight` is the probability that it measures them at all. Returns what is to be added to x and y, m,
        and to the heading, rad."""
        column = self._drift_column(stride_time)
        return self.correct(column, z, variance + max(0.0, self._measured(column, stride_time)), weight)

    def _drift_column(self, stride_time: float) -> list[float]:
        """Return the covariance of the drift with the bias, as straight ways measure it, with all errors."""
        (left, right), (a, b), p, t = self.shares, FEET, self.covariance, stride_time
        return [left * (p[a][j] + t * p[a + 2][j]) + right * (p[b][j] + t * p[b + 2][j]) for j in range(len(p))]

    def _measured(self, column: list[float], stride_time: float) -> float:
        (left, right), (a, b), t = self.shares, FEET, stride_time
        return left * (column[a] + t * column[a + 2]) + right * (column[b] + t * column[b + 2])

    def correct(self, column: list[float], z: float, s: float, weight: float, rows: range | None = None) -> Move:
        """Correct the errors by a measurement with the innovation `z`, its variance `s` and P H' in `column`.

        With the gain K, the errors move by weight K z, and their covariance becomes that of both possibilities
        together: that the measurement is one, with the probability `weight`, or none (Bar-Shalom et al. 2001, section
        11.6). If `rows` are given, the others keep their errors and covariance, which these take into account (Schmidt
        1966)."""
        # P <- P - weight K S K' + weight (1 - weight) K z z K'
        f, p = weight * ((1.0 - weight) * z * z - s), self.covariance
        gain, chosen = [value / s for value in column], range(len(p)) if rows is None else rows
        others = [j for j in range(len(p)) if j not in chosen]
        z *= weight
        for i in chosen:
            one = gain[i]
            for j in (*range(chosen.start, i + 1), *others):
                p[i][j] += f * one * gain[j]
                p[j][i] = p[i][j]
            if i >= SIZE:
                self.aids[i - SIZE] += one * z
        if rows is not None:
            return NO_MOVE
        for foot, row_of_foot in enumerate(FEET):
            self.drift[foot] += gain[row_of_foot] * z
            self.turning[foot] += gain[row_of_foot + 1] * z
            self.bias[foot] += gain[row_of_foot + 2] * z
        return (gain[X] * z, gain[Y] * z, gain[HEADING] * z)

    def column(self, terms: Sequence[tuple[int, float]]) -> list[float]:
        """Return the covariance of a sum of errors with all errors; each term has the row and the factor of one."""
        p = self.covariance
        first, *others = [(p[row], factor) for row, factor in terms]
        column = [first[1] * value for value in first[0]]
        for row, factor in others:
            column = [value + factor * more for value, more in zip(column, row, strict=True)]
        return column

    def along(self, column: list[float], terms: Sequence[tuple[int, float]]) -> float:
        """Return the variance of the sum of errors of which `column` is the covariance with all."""
        return max(0.0, fsum([factor * column[row] for row, factor in terms]))

    def add_aids(self, estimates: Sequence[float], variances: Sequence[float]) -> int:
        """Add the rows of the errors of these estimates, with these variances and independent of all others.

        Returns the first of them."""
        self.aids, p = [*self.aids, *estimates], self.covariance
        for variance in variances:
            for row in p:
                row.append(0.0)
            p.append([*[0.0] * len(p), variance])
        return len(p) - len(variances)

    def renew(self, row: int, variance: float) -> None:
        """Give the error of a row this variance, independent of all others."""
        for j, other in enumerate(self.covariance):
            self.covariance[row][j] = other[row] = 0.0
        self.covariance[row][row] = variance

    def replace(self, foot: int, error: int, value: float, variance: float, moved: list[float]) -> Move:
        """Replace the drift (`error` 0) or the turning (1) of foot 0 (left) or 1 by another one with its variance.

        `moved` is the derivative of x and y, m, and of the heading, rad, by this error over the whole walk. Returns
        what is to be added to them."""
        estimate, p, row = (self.drift, self.turning)[error], self.covariance, FEET[foot] + error
        change, estimate[foot] = value - estimate[foot], value
        # slopes: what this error has done to the estimates of aids
        slopes = [one / max(p[row][row], 1e-18) for one in p[row][SIZE:]]
        self.aids = [aid + change * slope for aid, slope in zip(self.aids, slopes, strict=True)]
        self.renew(row, variance)
        for i, one in [*enumerate(moved), *enumerate(slopes, SIZE)]:
            p[row][i] = p[i][row] = variance * one
            for j, other in [*enumerate(moved), *enumerate(slopes, SIZE)]:
                p[i][j] += variance * (one * other)
        x, y, heading = moved
        return (change * x, change * y, change * heading)

    def inflate(self, variance: float, turn: float = 0.0) -> None:
        """Add `variance`, m^2, to that of x and of y, and the square of `turn`, rad, to that of the heading."""
        self.covariance[X][X] += variance
        self.covariance[Y][Y] += variance
        self.covariance[HEADING][HEADING] += turn * turn
