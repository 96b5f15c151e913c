"""What two feet of one body know of each other's errors: one filter over both tracks, at the rate of steps.

Skog, Nilsson, Zachariah and Handel, "Fusing the information from two navigation systems using an upper bound on their
maximum spatial separation", IPIN 2012, and Prateek, Girisha, Hari and Handel, "Data fusion of dual foot-mounted INS to
reduce the systematic heading drift", ISMS 2013, pull two feet together when they are further apart than a body is long.
Nine errors (the truth less what the tracks say): x, y (m), heading (rad) and the rate at which it drifts (rad/s) of
each foot, and the walking width (m). A gyroscope's scale and alignment make much the same of every stride, which is why
the rate is a state; it is forgotten slowly (first-order Gauss-Markov). With a stride d of T s, and c the quarter turn:

    e' = e + (psi + r (T_stood + T_swing / 2)) c d,   psi' = psi + r T,   r' = r exp(-T / DRIFT_MEMORY)

Which way both go wrong alike cannot be seen from how they stand to each other, and a filter must not think so. Hence x
and y are of a track that is turned with its heading about one point for both feet, the end of the newest stride: e =
xi + psi c (p - centre), the invariant error of Barrau and Bonnabel, "The invariant extended Kalman filter as a stable
observer", IEEE Trans. Automatic Control 62, 2017. What a measurement of a difference corrects is shared by how unsure
each foot is, so that nothing comes of it for both alike; for such a gain P follows Joseph's form.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, sqrt

from ...types.attrs import define, field

X, Y, HEADING, RATE = range(4)
STATES = 4
"""Of each foot, the left one's first."""
WIDTH = 8
COUNT = 9
LARGEST = 1e9
"""Beyond this variance nothing is known, and numbers lose their last digits."""
FIRST_APART, FIRST_ASIDE = 0.06, 0.04
"""How unsure it is at first how the feet stand to each other, m, and how their first headings do, rad."""
FIRST_WIDTH = 0.05
"""How unsure the walking width is at first, m."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""How fast the heading of a track drifts as a rule, rad/s (0.07 degrees), and for how long it does so, s: it changes
with the way of walking."""
HEADING_DRIFT = 0.0015
"""Growth of the heading error besides, rad/sqrt(s)."""
SPOILT = 0.06
"""What a degraded stride adds to that, rad."""

Term = tuple[int, float]
"""A state, and by how much what is measured grows with it."""


def _nothing() -> list[list[float]]:
    return [[0.0] * COUNT for _ in range(COUNT)]


@define
class Agreement:
    """The covariance of the errors. What is found of them is taken out of the tracks at once, so that the filter holds
    no estimate of them; but it keeps the rates."""

    covariance: list[list[float]] = field(factory=_nothing, init=False)
    centre: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """The point that the tracks turn about, m."""
    rates: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """What is to be added to the turn of the left and the right track, rad/s."""

    def begin(self) -> None:
        """Both feet stand side by side. Of their mean nothing is unknown: the world frame is where they begin."""
        p = self.covariance = _nothing()
        self.rates = [0.0, 0.0]
        for one, sigma in ((X, FIRST_APART), (Y, FIRST_APART), (HEADING, FIRST_ASIDE)):
            p[one][one] = p[one + STATES][one + STATES] = 0.25 * sigma * sigma
            p[one][one + STATES] = p[one + STATES][one] = -0.25 * sigma * sigma
        p[RATE][RATE] = p[RATE + STATES][RATE + STATES] = DRIFT_RATE * DRIFT_RATE
        p[WIDTH][WIDTH] = FIRST_WIDTH * FIRST_WIDTH

    @property
    def lost(self) -> bool:
        """The feet have gone so far that nothing is known."""
        return any([not row[k] < LARGEST for k, row in enumerate(self.covariance)])

    def beside(self, foot: int, place: float, heading: float) -> None:
        """Foot 0 or 1 was set beside the other, to `place` m and `heading` rad: but for that their errors are the same.
        Its rate is its own."""
        p = self.covariance
        for one, sigma in ((X, place), (Y, place), (HEADING, heading)):
            here, there = foot * STATES + one, (1 - foot) * STATES + one
            p[here] = [*p[there]]
            for row in p:
                row[here] = row[there]
            p[here][here] += sigma * sigma

    def advance(
        self,
        foot: int,
        stood: float,
        swung: float,
        end: tuple[float, float],
        way: tuple[float, float],
        variance: tuple[float, float, float],
        degraded: bool,
    ) -> None:
        """Foot 0 or 1 stood for `stood` s, swung for `swung` s, and has gone `way` m to `end`, with the covariance xx,
        xy, yy (m^2)."""
        p = self.covariance
        cx, cy = end[0] - self.centre[0], end[1] - self.centre[1]
        self.centre = end
        dx, dy = way
        x = foot * STATES
        y, heading, rate = x + Y, x + HEADING, x + RATE
        time, middle = stood + swung, stood + 0.5 * swung
        keep = exp(-time / DRIFT_MEMORY)
        noise = SPOILT * SPOILT if degraded else 0.0
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

    def doubt(self, foot: int, by: float) -> None:
        """Where foot 0 or 1 is may be wrong by another `by` m."""
        p, x = self.covariance, foot * STATES
        p[x][x] += by * by
        p[x + Y][x + Y] += by * by

    def measure(self, terms: Sequence[Term], z: float, variance: float, limit: float) -> list[float] | None:
        """How the feet stand to each other: `z`, of this variance, is the sum of the terms. Returns what to add to
        every state; None when the square of z is more than `limit` times what is likely."""
        p = self.covariance
        ph, gains, found = [0.0] * COUNT, [0.0] * COUNT, [0.0] * COUNT
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
            found[j] = gain * z
        self.rates[0] += found[RATE]
        self.rates[1] += found[RATE + STATES]
        return found

    def turned_alike(self, rate: float, variance: float) -> None:
        """The rates of both are `rate` rad/s higher than thought; the variance is that of their mean, (rad/s)^2."""
        p = self.covariance
        ph = [0.5 * (row[RATE] + row[RATE + STATES]) for row in p]
        s = variance + 0.5 * (ph[RATE] + ph[RATE + STATES])
        if s > 0.0:
            self._joseph([one / s for one in ph], ph, s)
        self.rates[0] += rate
        self.rates[1] += rate

    def mean(self) -> tuple[float, float, float]:
        """Covariance of the mean of both feet's places: xx, xy, yy in m^2."""
        p, r = self.covariance, STATES
        xx = p[X][X] + p[X + r][X + r] + 2.0 * p[X][X + r]
        yy = p[Y][Y] + p[Y + r][Y + r] + 2.0 * p[Y][Y + r]
        xy = p[X][Y] + p[X + r][Y + r] + p[X][Y + r] + p[X + r][Y]
        xx, yy = max(0.0, xx), max(0.0, yy)
        most = sqrt(xx * yy)  # but for rounding it is less
        return (0.25 * xx, 0.25 * min(max(xy, -most), most), 0.25 * yy)

    def _joseph(self, gains: list[float], ph: list[float], s: float) -> None:
        """P <- (1 - K H) P (1 - K H)' + K R K', with P H' and S = H P H' + R."""
        for row, gain, a in zip(self.covariance, gains, ph, strict=True):
            for j in range(COUNT):
                row[j] += gain * gains[j] * s - gain * ph[j] - a * gains[j]
