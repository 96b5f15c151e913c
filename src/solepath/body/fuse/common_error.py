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
(straight_ways.py), and rests measure the bias: a foot that has learnt its bias at a rest, with a gain of 1 - q / p for
the variance p before and q now, has measured it with the variance p q / (p - q), and with it the rate by which its own
strides have turned the heading since the last rest. The drift in which both tracks differ is another matter:
error_filter.py finds it by comparing the feet. The equations are linear in the errors, except for what a heading error
of any size does to the position (`position_covariance`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import exp, fsum, sqrt

from ...calibration import HeadingCalibration
from ...foot.navigate.bias import BIAS_WANDER, FIRST_BIAS, Bias
from ...foot.navigate.corrector import LONGEST_FILLED_GAP
from ...foot.world import Covariance2
from ...types import OTHER, Foot, PerFoot
from ...types.attrs import define, evolve, field, frozen

DRIFT = 0.0014
"""Standard deviation of the drift of one foot, rad a stride (4.4 degrees a minute), unless it was calibrated.

On recordings a foot drifts by 1 to 7 degrees a minute (3.5 rms) with its bias (drift of `solepath-lab evaluate`);
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
REST_GATE = 9.0
"""Largest squared difference of a measured bias from the expected one, divided by its variance: above it, the bias has
changed since the last rest."""
POSITION_GATE = 11.8
"""Largest squared distance of a report, divided by its variance: 99.7 % of right ones (chi square, 2 axes)."""
LEAST_WAY = 10.0
"""Least way from a rejected position to one that confirms it, m: to repeat it on the spot does not."""
LENGTH_ERROR = 0.007
"""Standard deviation of the relative error that all strides have in common, no unit.

Emulated strides are up to 1.6 % too long or too short on average (rms 0.7 %)."""
X, Y, HEADING = 0, 1, 2
"""Rows of the position and of the heading."""
FEET = {Foot.LEFT: 3, Foot.RIGHT: 6}
"""First row of each foot: its drift."""
TURN, BIAS = 1, 2
"""Rows of the turning and of the bias, from that of the drift on."""
SIZE = 9
"""Number of these rows; those of a compass and of named places follow."""

Term = tuple[int, float]
"""A row, and the factor of its error in a sum of errors."""
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


def column(covariance: list[list[float]], terms: Sequence[Term]) -> list[float]:
    """Return the covariance of a sum of errors with all errors."""
    found: list[float] = []
    for row in covariance:
        total = 0.0
        for number, factor in terms:
            total += row[number] * factor
        found.append(total)
    return found


def _first_covariance() -> list[list[float]]:
    sigmas = (0.0, 0.0, 0.0, DRIFT, TURNING, FIRST_BIAS, DRIFT, TURNING, FIRST_BIAS)
    return [[sigma * sigma if j == k else 0.0 for j in range(SIZE)] for k, sigma in enumerate(sigmas)]


@define
class CommonError:
    """The covariance of the errors, and what was estimated and removed of those of each foot."""

    covariance: list[list[float]] = field(factory=_first_covariance)
    """Covariance of the errors, symmetric; the rows are named above."""
    estimates: list[float] = field(factory=lambda: [0.0] * SIZE)
    """Estimate of each row, 0 for position and heading. What is estimated of the feet is removed from both tracks."""
    shares: PerFoot[float] = field(factory=lambda: dict.fromkeys(Foot, 0.5))
    """Share of each foot in the wearer's heading: 1 and 0 if a foot is alone."""
    started: bool = False
    """Flag: a foot has taken a stride."""
    foot_biases: PerFoot[FootBias | None] = field(factory=lambda: dict.fromkeys(Foot))
    """Bias of each foot at its newest stride."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Use the standard deviations of a calibration, before any stride; the feet remove the drift themselves."""
        for foot, one in headings.items():
            for row, sigma in enumerate((one.drift_sigma, one.turning_sigma), FEET[foot]):
                self.covariance[row][row] = sigma * sigma

    def start_stride(self, foot: Foot, alone: bool) -> float:
        """Set the shares for a stride of a foot, which has all of the heading if it is `alone`.

        Returns the share of this foot, 0.5 or 1."""
        self.started = True
        share = 1.0 if alone else 0.5
        self.shares[foot], self.shares[OTHER[foot]] = share, 1.0 - share
        return share

    def aid(self, first: int) -> complex:
        """Return the estimates of two rows."""
        return complex(self.estimates[first], self.estimates[first + 1])

    def _drift(self, values: Sequence[float], stride_time: float) -> float:
        """Return the drift with the bias, rad a stride, as straight ways measure it, of values by row."""
        left, right = [
            self.shares[foot] * (values[row] + stride_time * values[row + BIAS]) for foot, row in FEET.items()
        ]
        return left + right

    def drift_with_bias(self, stride_time: float) -> float:
        """Return the estimated drift with the bias, rad a stride, with strides of this duration, s."""
        return self._drift(self.estimates, stride_time)

    def drift_variance(self, stride_time: float) -> float:
        """Return the variance of drift and bias together, (rad a stride)^2, with strides of this duration, s."""
        return max(0.0, self._drift([self._drift(row, stride_time) for row in self.covariance], stride_time))

    @property
    def heading_sigma(self) -> float:
        """Standard deviation of the heading, rad."""
        return sqrt(max(0.0, self.covariance[HEADING][HEADING]))  # below 0 only by rounding

    def position_covariance(self, displacement: complex, since: int | None = None) -> Covariance2:
        """Return the covariance of the position: xx, xy, yy, m^2.

        `displacement` is that from the first position, m; or from a place whose errors have the rows from `since` on,
        and then the covariance is that of the displacement. The heading error h moves the position by h b + z, with
        b = P_eh / P_hh and z independent of h. For a small h that is a turn of the arm a = -c b by h, and a large one
        turns it too, by (R(h) - 1) a. With h normal and v its variance, E (cos h - 1)^2 = 3/2 - 2 exp(-v/2) +
        exp(-2v)/2 and E sin^2 h = (1 - exp(-2v))/2."""
        p = self.covariance
        xx, xy, xh, yy, yh, v = p[X][X], p[X][Y], p[X][HEADING], p[Y][Y], p[Y][HEADING], p[HEADING][HEADING]
        if since is not None:
            k, j = since, since + 1
            xx, yy = xx - 2.0 * p[X][k] + p[k][k], yy - 2.0 * p[Y][j] + p[j][j]
            xy, xh, yh = xy - p[X][j] - p[Y][k] + p[k][j], xh - p[k][HEADING], yh - p[j][HEADING]
        if v > 1e-9:
            bx, by = xh / v, yh / v
            half, twice = exp(-0.5 * v), exp(-2.0 * v)
            # b b' v leaves, across b b' + along a a' enters, with a = (by, -bx)
            across, along = 0.5 * (1.0 - twice) - v, 1.5 - 2.0 * half + 0.5 * twice
            xx += across * bx * bx + along * by * by
            xy += (across - along) * bx * by
            yy += across * by * by + along * bx * bx
        px, py = LENGTH_ERROR * displacement.real, LENGTH_ERROR * displacement.imag
        xx, xy, yy = max(0.0, xx) + px * px, xy + px * py, max(0.0, yy) + py * py
        bound = (xx * yy) ** 0.5  # |xy| exceeds it only by rounding
        return (xx, min(max(xy, -bound), bound), yy)

    def propagate(
        self, foot: Foot, strides: float, turn: float, duration: float, displacement: complex,
        variance: Covariance2,
    ) -> None:  # fmt: skip
        """Propagate the covariance over a stride of a foot with this `displacement`, m.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s; `variance` is that of its
        displacement: xx, xy, yy, m^2."""
        p, row, w, rows = self.covariance, FEET[foot], self.shares[foot], range(HEADING + 1, len(self.covariance))
        n, k, t = w * strides, w * turn, w * duration
        # a: the turn of the heading in the stride; g: the heading in its middle; each with all errors
        a, g = list[float](), list[float]()
        for r, q, b, heading in zip(*p[row : row + 3], p[HEADING], strict=True):
            a.append(n * r + k * q + t * b)
            g.append(heading + 0.5 * a[-1])
        aa, ah, hh = n * a[row] + k * a[row + TURN] + t * a[row + BIAS], a[HEADING], p[HEADING][HEADING]
        gg, gh = hh + ah + 0.25 * aa, hh + 1.5 * ah + 0.5 * aa
        arms = (-w * displacement.imag, w * displacement.real)
        for i, arm in enumerate(arms):
            for j in range(i, HEADING):
                p[i][j] += arms[j] * g[i] + arm * g[j] + arm * arms[j] * gg + w * w * variance[i + j]
            p[i][HEADING] += a[i] + arm * gh
            for j in rows:
                p[i][j] += arm * g[j]
        p[HEADING][HEADING] += 2.0 * ah + aa + w * HEADING_NOISE * HEADING_NOISE * duration
        for j in rows:
            p[HEADING][j] += a[j]
        for i in (X, Y, HEADING):
            for j in range(i, len(p)):
                p[j][i] = p[i][j]
        p[row][row] += DRIFT_CHANGE * DRIFT_CHANGE * duration

    def add_gap(self, duration: float, unseen: bool) -> None:
        """Inflate the covariance by a gap in the samples of a foot, of this duration in s.

        If it is `unseen`, the other foot had no samples either, so the wearer may have turned. A stride of a usual walk
        fills a shorter gap; in a longer one the wearer may have walked anywhere."""
        one_foot = max(self.shares.values()) * min(GAP_RATE * duration, MAX_GAP_ERROR)
        distance = UNSEEN_SPEED * duration if unseen and duration > LONGEST_FILLED_GAP else 0.0
        self.inflate(distance * distance, min(UNSEEN_RATE * duration, UNSEEN_TURN) if unseen else one_foot)

    def turn_of(self, foot: Foot, strides: float, turn: float, duration: float) -> float:
        """Return the correction of the heading of a foot, rad, over a stride.

        It counts as `strides` usual ones, turns by `turn` rad and takes `duration` s."""
        drift, turning, bias = self.estimates[FEET[foot] : FEET[foot] + 3]
        return strides * drift + turn * turning + duration * bias

    def correct_drift(self, z: float, variance: float, weight: float, stride_time: float) -> Move:
        """Correct the errors by a measured drift that differs by `z` rad a stride from the estimate.

        `variance` is that of the measurement and `stride_time` the duration of a stride, s, in which the bias adds to
        the drift; `weight` is the probability that it measures them at all. Returns what is to be added to x and y, m,
        and to the heading, rad."""
        with_all = [self._drift(row, stride_time) for row in self.covariance]
        return self.correct(with_all, z, variance + max(0.0, self._drift(with_all, stride_time)), weight)

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
            if i > HEADING:
                self.estimates[i] += one * z
        return (gain[X] * z, gain[Y] * z, gain[HEADING] * z) if rows is None else NO_MOVE

    def correct_by(self, terms: Sequence[Term], z: float, variance: float, rows: range | None = None) -> Move:
        """Correct the errors by a measurement of a sum of them, with the innovation `z` and this `variance`."""
        with_all = column(self.covariance, terms)
        return self.correct(with_all, z, variance + _along(with_all, terms), 1.0, rows)

    def variance_of(self, terms: Sequence[Term]) -> float:
        """Return the variance of a sum of errors."""
        return _along(column(self.covariance, terms), terms)

    def add_aids(self, estimates: Sequence[float], variances: Sequence[float]) -> int:
        """Add the rows of the errors of these estimates, with these variances and independent of all others.

        Returns the first of them."""
        p = self.covariance
        self.estimates += estimates
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

    def renew_aid(self, first: int, values: complex, variance: float) -> None:
        """Give two rows new estimates with this variance."""
        for row, value in enumerate((values.real, values.imag), first):
            self.renew(row, variance)
            self.estimates[row] = value

    def replace(self, row: int, value: float, variance: float, moved: list[float]) -> Move:
        """Replace the drift or the turning of a foot, which has this row, by another one with its variance.

        `moved` is the derivative of x and y, m, and of the heading, rad, by this error over the whole walk. Returns
        what is to be added to them."""
        p, change = self.covariance, value - self.estimates[row]
        # slopes: what this error has done to the estimates of aids
        slopes = [one / max(p[row][row], 1e-18) for one in p[row][SIZE:]]
        self.renew(row, variance)
        all_moved = [*enumerate(moved), *enumerate(slopes, SIZE)]
        for i, one in all_moved:
            p[row][i] = p[i][row] = variance * one
            for j, other in all_moved:
                p[i][j] += variance * (one * other)
        for i, one in [(row, 1.0), *enumerate(slopes, SIZE)]:
            self.estimates[i] += change * one
        x, y, heading = moved
        return (change * x, change * y, change * heading)

    def inflate(self, variance: float, turn: float = 0.0) -> None:
        """Add `variance`, m^2, to that of x and of y, and the square of `turn`, rad, to that of the heading."""
        self.covariance[X][X] += variance
        self.covariance[Y][Y] += variance
        self.covariance[HEADING][HEADING] += turn * turn

    def has_rested(self, foot: Foot, bias: Bias) -> bool:
        """Return whether a foot has learnt its `bias` since its last stride."""
        newest = self.foot_biases[foot]
        return newest is None or (bias.spans, bias.device) != (newest.spans, newest.device)

    def add_rest(self, foot: Foot, t: float, bias: Bias) -> Move:
        """Take in the `bias` of a foot at the end of a stride at `t`, s.

        A bias far from the expected one has changed since the last rest, nobody knows when. Returns what is to be added
        to x and y, m, and to the heading of both tracks, rad."""
        newest, row, variance, p = self.foot_biases[foot], FEET[foot] + BIAS, bias.variances[0], self.covariance
        now = self.foot_biases[foot] = FootBias(t, variance, bias.spans, bias.change, bias.device)
        if newest is None or bias.device != newest.device:  # the first stride of this device
            self._replace_bias(row, variance)
            if bias.device:  # not the first device of this foot: the new one and the old one are both off by this
                for number, usual in enumerate((DRIFT, TURNING), FEET[foot]):
                    self.renew(number, 2.0 * usual * usual)
            return NO_MOVE
        wander = BIAS_WANDER * BIAS_WANDER * max(0.0, t - newest.t)
        before = newest.variance + wander
        p[row][row] += wander
        if bias.spans == newest.spans:
            self.foot_biases[foot] = evolve(now, variance=before)
            return NO_MOVE
        known, change, gain = self.estimates[row], bias.change - newest.change, 1.0 - variance / before
        if gain > 0.0:
            z, noise = -change / gain - known, variance / gain
            s = p[row][row] + noise
            if z * z > REST_GATE * s and not newest.spans and p[row][row] > 0.0:
                # the bias was not known at all, and is larger than usual
                self._add_to_bias(row, p[row][row] * (z * z / s - 1.0), len(p))
                s = p[row][row] + noise
            if z * z <= REST_GATE * s and abs(p[HEADING][row] * z) <= MAX_TURN_BACK * s:
                move = self.correct(list(p[row]), z, s, 1.0)
                self.estimates[row] += change  # which the foot has removed
                return move
        elif change * change <= REST_GATE * p[row][row]:  # the rest was too restless to show anything
            self.estimates[row] += change
            return NO_MOVE
        self._replace_bias(row, variance, change + known)
        return NO_MOVE

    def _replace_bias(self, row: int, variance: float, change: float = 0.0) -> None:
        """Replace the error of a foot's bias by a new one with its `variance`, (rad/s)^2.

        The old one has changed by `change`, rad/s, at some time since the last rest: a variance of change^2 / 3."""
        p = self.covariance
        if p[row][row] > 0.0:
            most = 2.0 * MAX_TURN_BACK * p[row][row] / (abs(p[HEADING][row]) + 1e-12)
            self._add_to_bias(row, min(change * change / 3.0, most * most), HEADING + 1)
        self.renew(row, variance)
        self.estimates[row] = 0.0

    def _add_to_bias(self, row: int, variance: float, count: int) -> None:
        """Add `variance`, (rad/s)^2, to that of a bias, and what it has moved so far to the first `count` errors."""
        p = self.covariance
        moved = [value / p[row][row] for value in p[row][:count]]
        for i, one in enumerate(moved):
            for j, other in enumerate(moved):
                p[i][j] += one * other * variance


def _along(with_all: list[float], terms: Sequence[Term]) -> float:
    """Return the variance of a sum of errors whose covariance with all errors is `with_all`."""
    return max(0.0, fsum([factor * with_all[row] for row, factor in terms]))
