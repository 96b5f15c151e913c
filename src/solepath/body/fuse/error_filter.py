"""Error filter over the tracks of both feet, updated at every stride.

Skog, Nilsson, Zachariah and Handel, "Fusing the information from two navigation systems using an upper bound on their
maximum spatial separation", IPIN 2012, and Prateek, Girisha, Hari and Handel, "Data fusion of dual foot-mounted INS to
reduce the systematic heading drift", ISMS 2013, pull two feet together when they are further apart than a body is long.
This filter has nine errors (truth minus track) as states: x, y (m), heading (rad) and heading drift rate (rad/s) of
each foot, and the walking width (m). The scale and alignment errors of a gyroscope turn every stride by nearly the same
angle, which is why the rate is a state; it fades slowly (first-order Gauss-Markov). With a stride d of T s, and c the
quarter turn:

    e' = e + (psi + r (T_stance + T_swing / 2)) c d,   psi' = psi + r T,   r' = r exp(-T / DRIFT_MEMORY)

An error that both feet share cannot be observed from their relative position, and the filter must not claim to observe
it. Therefore x and y belong to a track that is turned with its heading about one point for both feet, the end of the
newest stride: e = xi + psi c (p - centre), the invariant error of Barrau and Bonnabel, "The invariant extended Kalman
filter as a stable observer", IEEE Trans. Automatic Control 62, 2017. The correction by a measured difference is shared
between the feet by their variances, so that it does not move both alike; for such a gain P follows Joseph's form."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, sqrt

from ...types.attrs import define, field

X, Y, HEADING, RATE = range(4)
STATES = 4
"""Number of states of each foot; the left foot's come first."""
WIDTH = 8
COUNT = 9
LARGEST_VARIANCE = 1e9
"""Variance above which nothing is known, and rounding spoils the numbers."""
FIRST_PLACE_ERROR, FIRST_HEADING_ERROR = 0.06, 0.04
"""First standard deviations of the relative place of the feet, m, and of their relative heading, rad."""
FIRST_WIDTH_ERROR = 0.05
"""First standard deviation of the walking width, m."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""Usual drift rate of a track's heading, rad/s (0.07 degrees), and for how long it lasts, s.

The rate changes with the manner of walking."""
HEADING_DRIFT = 0.0015
"""Random walk of the heading error that adds to the drift rate, rad/sqrt(s)."""
DEGRADED_ERROR = 0.06
"""Heading error that a degraded stride adds, rad."""

Term = tuple[int, float]
"""Index of a state, and the derivative of the measurement by that state."""


def _zeros() -> list[list[float]]:
    return [[0.0] * COUNT for _ in range(COUNT)]


@define
class TrackErrorFilter:
    """The covariance of the errors of both tracks, and the drift rates.

    Errors that are found are taken out of the tracks at once, so the filter holds no estimate of them except the rates.
    """

    covariance: list[list[float]] = field(factory=_zeros, init=False)
    """Covariance of the errors, `COUNT` rows; units of m, rad and rad/s."""
    centre: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Point about which the tracks turn, m."""
    rates: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Corrections that are added to the turn rate of the left and the right track, rad/s."""

    def start(self) -> None:
        """Start with both feet side by side; their mean has no error, since the world frame starts there."""
        p = self.covariance = _zeros()
        self.rates = [0.0, 0.0]
        for one, sigma in ((X, FIRST_PLACE_ERROR), (Y, FIRST_PLACE_ERROR), (HEADING, FIRST_HEADING_ERROR)):
            p[one][one] = p[one + STATES][one + STATES] = 0.25 * sigma * sigma
            p[one][one + STATES] = p[one + STATES][one] = -0.25 * sigma * sigma
        p[RATE][RATE] = p[RATE + STATES][RATE + STATES] = DRIFT_RATE * DRIFT_RATE
        p[WIDTH][WIDTH] = FIRST_WIDTH_ERROR * FIRST_WIDTH_ERROR

    @property
    def diverged(self) -> bool:
        """Flag: a variance is so large that nothing is known."""
        return any([not row[k] < LARGEST_VARIANCE for k, row in enumerate(self.covariance)])

    def align(self, foot: int, place: float, heading: float) -> None:
        """Set foot 0 or 1 beside the other one, to `place` m and `heading` rad.

        Apart from these deviations both then have the same errors; the foot keeps its own rate."""
        p = self.covariance
        for one, sigma in ((X, place), (Y, place), (HEADING, heading)):
            here, there = foot * STATES + one, (1 - foot) * STATES + one
            p[here] = [*p[there]]
            for row in p:
                row[here] = row[there]
            p[here][here] += sigma * sigma

    def propagate(
        self,
        foot: int,
        stance: float,
        swing: float,
        end: tuple[float, float],
        displacement: tuple[float, float],
        variance: tuple[float, float, float],
        degraded: bool,
    ) -> None:
        """Propagate the covariance over a stride of foot 0 or 1 with its stance and swing time, s.

        The stride is `displacement` m long and leads to `end`, m; its covariance is xx, xy, yy (m^2)."""
        p = self.covariance
        cx, cy = end[0] - self.centre[0], end[1] - self.centre[1]
        self.centre = end
        dx, dy = displacement
        x = foot * STATES
        y, heading, rate = x + Y, x + HEADING, x + RATE
        time, middle = stance + swing, stance + 0.5 * swing
        keep = exp(-time / DRIFT_MEMORY)
        noise = DEGRADED_ERROR * DEGRADED_ERROR if degraded else 0.0
        p[heading][heading] += noise + HEADING_DRIFT * HEADING_DRIFT * time
        # P <- F P F': the rows of F P, then the columns. Both tracks turn about the new centre, then the foot goes
        for k in (0, STATES):
            px, py, ph = p[k], p[k + 1], p[k + 2]
            for j in range(COUNT):
                px[j] -= cy * ph[j]
                py[j] += cx * ph[j]
        px, py, ph, pr = p[x], p[y], p[heading], p[rate]
        for j in range(COUNT):
            r = pr[j]
            px[j] -= middle * dy * r
            py[j] += middle * dx * r
            ph[j] += time * r
            pr[j] = keep * r
        for row in p:
            for k in (0, STATES):
                row[k] -= cy * row[k + 2]
                row[k + 1] += cx * row[k + 2]
            r = row[rate]
            row[x] -= middle * dy * r
            row[y] += middle * dx * r
            row[heading] += time * r
            row[rate] = keep * r
        xx, xy, yy = variance
        px[x] += xx
        px[y] += xy
        py[x] += xy
        py[y] += yy
        pr[rate] += DRIFT_RATE * DRIFT_RATE * (1.0 - keep * keep)
        self.rates[foot] *= keep

    def inflate(self, foot: int, by: float) -> None:
        """Inflate the covariance of the place of foot 0 or 1 by `by` m."""
        p, x = self.covariance, foot * STATES
        p[x][x] += by * by
        p[x + Y][x + Y] += by * by

    def correct(self, terms: Sequence[Term], z: float, variance: float, limit: float) -> list[float] | None:
        """Correct the filter with an innovation `z` of this variance, which is the sum of the terms.

        Returns the value to add to every state, or None when z^2 is more than `limit` times its predicted variance."""
        p = self.covariance
        ph, gains, errors = [0.0] * COUNT, [0.0] * COUNT, [0.0] * COUNT
        for j, row in enumerate(p):
            total = 0.0
            for one, k in terms:
                total += row[one] * k
            ph[j] = total
        total = 0.0
        for one, k in terms:
            total += ph[one] * k
        s = variance + total
        if not z * z <= limit * s:
            return None
        for j, one_of in enumerate(ph):
            gains[j] = one_of / s
        for left in range(STATES):
            right = left + STATES
            own, others = p[left][left] - p[left][right], p[right][right] - p[left][right]
            if own + others > 0.0:
                between = gains[left] - gains[right]
                share = min(1.0, max(0.0, own / (own + others)))
                gains[left], gains[right] = share * between, (share - 1.0) * between
        self._joseph(gains, ph, s)
        for j, gain in enumerate(gains):
            errors[j] = gain * z
        self.rates[0] += errors[RATE]
        self.rates[1] += errors[RATE + STATES]
        return errors

    def correct_mean_rate(self, rate: float, variance: float) -> None:
        """Add `rate` rad/s to the rates of both feet; the variance is that of their mean, (rad/s)^2."""
        p = self.covariance
        ph = [0.5 * (row[RATE] + row[RATE + STATES]) for row in p]
        s = variance + 0.5 * (ph[RATE] + ph[RATE + STATES])
        if s > 0.0:
            self._joseph([one / s for one in ph], ph, s)
        self.rates[0] += rate
        self.rates[1] += rate

    def mean_covariance(self) -> tuple[float, float, float]:
        """Return the covariance of the mean place of both feet: xx, xy, yy in m^2."""
        p, r = self.covariance, STATES
        xx = p[X][X] + p[X + r][X + r] + 2.0 * p[X][X + r]
        yy = p[Y][Y] + p[Y + r][Y + r] + 2.0 * p[Y][Y + r]
        xy = p[X][Y] + p[X + r][Y + r] + p[X][Y + r] + p[X + r][Y]
        xx, yy = max(0.0, xx), max(0.0, yy)
        most = sqrt(xx * yy)  # only rounding can make it more
        return (0.25 * xx, 0.25 * min(max(xy, -most), most), 0.25 * yy)

    def _joseph(self, gains: list[float], ph: list[float], s: float) -> None:
        """Update the covariance: P <- (1 - K H) P (1 - K H)' + K R K', with P H' and S = H P H' + R."""
        for row, gain, a in zip(self.covariance, gains, ph, strict=True):
            for j in range(COUNT):
                row[j] += gain * gains[j] * s - gain * ph[j] - a * gains[j]
