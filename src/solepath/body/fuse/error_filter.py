"""Kalman filter of the errors of both feet's tracks, updated at every stride.

Skog, Nilsson, Zachariah and Handel, "Fusing the information from two navigation systems using an upper bound on their
maximum spatial separation", IPIN 2012, and Prateek, Girisha, Hari and Handel, "Data fusion of dual foot-mounted INS to
reduce the systematic heading drift", ISMS 2013, pull two feet together when their distance exceeds a limit. This filter
has nine errors (truth minus track) as states: x, y (m), heading (rad) and heading drift rate (rad/s) of each foot, and
the walking width (m). The drift rate is a state because scale and alignment errors of a gyroscope turn every stride by
nearly the same angle. It fades slowly (first-order Gauss-Markov process). For a stride with displacement d that takes
T s, with e = (x, y), psi the heading, r the rate, and c a rotation by +90 degrees:

    e' = e + (psi + r (T_stance + T_swing / 2)) c d,   psi' = psi + r T,   r' = r exp(-T / DRIFT_MEMORY)

An error that both feet share cannot be observed from their relative position; no measurement may reduce its variance.
Therefore the states x and y are errors of a track that is rotated by its heading error about one point, which is the
same for both feet: the end of the newest stride. With xi for these states and p for a position, e = xi + psi c (p -
centre). It is the invariant error of Barrau and Bonnabel, "The invariant extended Kalman filter as a stable observer",
IEEE Trans. Automatic Control 62, 2017. A measured difference is divided between the feet by their variances, so that it
does not move their weighted mean. Such a gain is not optimal, so P is updated in Joseph's form."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, hypot

from ...events import StrideTaken
from ...types import Vec3
from ...types.attrs import define, field, frozen

X, Y, HEADING, RATE = range(4)
"""Indices of the states of one foot."""
STATES_PER_FOOT = 4
"""Number of states of each foot; the left foot's states come first."""
WIDTH = 8
"""Index of the walking width."""
STATE_COUNT = 9
MAX_VARIANCE = 1e9
"""Largest variance of a usable filter; above it, rounding errors dominate."""
FIRST_POSITION_ERROR, FIRST_HEADING_ERROR = 0.06, 0.04
"""Initial standard deviations of the relative position of the feet, m (each axis), and relative heading, rad."""
FIRST_WIDTH_ERROR = 0.05
"""Initial standard deviation of the walking width, m."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""Standard deviation of a track's heading drift rate, rad/s (0.07 degrees/s), and correlation time, s.

The rate changes with the manner of walking."""
MAX_PHASE_TIME = 1.0
"""Longest stance or swing time over which a drift rate is integrated, s; a foot that rests longer learns its bias."""
HEADING_DRIFT = 0.0015
"""Random walk of the heading error that adds to the drift rate, rad/sqrt(s)."""
DEGRADED_ERROR = 0.06
"""Standard deviation of the heading error that a degraded stride adds, rad."""
USUALLY_DEGRADED, DEGRADED_MEMORY = 0.5, 10.0
"""Share of a foot's strides above which a degraded one is usual, and strides over which it is averaged (by hand)."""
LATERAL_ERROR, LONGITUDINAL_ERROR = 0.045, 0.15
"""Standard deviations of the standing foot's position relative to the middle of the other foot's stride, m."""
TURN_ERROR = 0.12
"""Additional standard deviation of both in a turn, m per m of stride length and rad of turn."""

Pair = tuple[float, float]
Term = tuple[int, float]
"""Index of a state, and the derivative of the measurement with respect to it."""


def _zeros() -> list[list[float]]:
    return [[0.0] * STATE_COUNT for _ in range(STATE_COUNT)]


@define
class TrackErrorFilter:
    """The covariance of the errors of both tracks, and the estimated drift rates.

    Estimated errors are removed from the tracks at once, so only the rates are stored as estimates."""

    covariance: list[list[float]] = field(factory=_zeros, init=False)
    """Covariance of the states, `STATE_COUNT` rows, in units of m, rad and rad/s."""
    centre: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Point about which heading errors rotate the tracks, m, common frame."""
    rates: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Corrections of the heading rate of the left and the right track, rad/s, positive to the left."""
    degraded_shares: list[float] = field(factory=lambda: [0.0, 0.0], init=False)
    """Share of the recent strides of the left and the right foot that were degraded."""

    def start(self) -> None:
        """Start with both feet side by side; their mean has no error, because it defines the world frame."""
        p = self.covariance = _zeros()
        self.rates = [0.0, 0.0]
        for state, sigma in ((X, FIRST_POSITION_ERROR), (Y, FIRST_POSITION_ERROR), (HEADING, FIRST_HEADING_ERROR)):
            p[state][state] = p[state + STATES_PER_FOOT][state + STATES_PER_FOOT] = 0.25 * sigma * sigma
            p[state][state + STATES_PER_FOOT] = p[state + STATES_PER_FOOT][state] = -0.25 * sigma * sigma
        p[RATE][RATE] = p[RATE + STATES_PER_FOOT][RATE + STATES_PER_FOOT] = DRIFT_RATE * DRIFT_RATE
        p[WIDTH][WIDTH] = FIRST_WIDTH_ERROR * FIRST_WIDTH_ERROR

    @property
    def diverged(self) -> bool:
        """Flag: a variance exceeds `MAX_VARIANCE` or is not a number."""
        return any([not row[k] < MAX_VARIANCE for k, row in enumerate(self.covariance)])

    def align(self, foot: int, place: float, heading: float) -> None:
        """Give foot 0 or 1 the errors of the other foot, because its track was aligned with the other foot's.

        `place`, m, and `heading`, rad, are the standard deviations of the alignment. The foot keeps its own rate."""
        p = self.covariance
        for state, sigma in ((X, place), (Y, place), (HEADING, heading)):
            moved, fixed = foot * STATES_PER_FOOT + state, (1 - foot) * STATES_PER_FOOT + state
            p[moved] = [*p[fixed]]
            for row in p:
                row[moved] = row[fixed]
            p[moved][moved] += sigma * sigma

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
        """Propagate the covariance over a stride of foot 0 or 1, with its stance and swing time, s.

        `displacement` of the stride and its `end` are in m, common frame; `variance` is xx, xy, yy, m^2."""
        p = self.covariance
        cx, cy = end[0] - self.centre[0], end[1] - self.centre[1]
        self.centre = end
        dx, dy = displacement
        x = foot * STATES_PER_FOOT
        y, heading, rate = x + Y, x + HEADING, x + RATE
        duration, time_to_mid_swing = stance + swing, stance + 0.5 * swing
        decay = exp(-duration / DRIFT_MEMORY)
        noise = DEGRADED_ERROR * DEGRADED_ERROR if degraded else 0.0
        p[heading][heading] += noise + HEADING_DRIFT * HEADING_DRIFT * duration
        # P <- F P F': first the rows, then the columns. F moves the centre for both feet, then adds the stride
        for k in (0, STATES_PER_FOOT):
            px, py, ph = p[k], p[k + 1], p[k + 2]
            for j in range(STATE_COUNT):
                px[j] -= cy * ph[j]
                py[j] += cx * ph[j]
        px, py, ph, pr = p[x], p[y], p[heading], p[rate]
        for j in range(STATE_COUNT):
            r = pr[j]
            px[j] -= time_to_mid_swing * dy * r
            py[j] += time_to_mid_swing * dx * r
            ph[j] += duration * r
            pr[j] = decay * r
        for row in p:
            for k in (0, STATES_PER_FOOT):
                row[k] -= cy * row[k + 2]
                row[k + 1] += cx * row[k + 2]
            r = row[rate]
            row[x] -= time_to_mid_swing * dy * r
            row[y] += time_to_mid_swing * dx * r
            row[heading] += duration * r
            row[rate] = decay * r
        xx, xy, yy = variance
        px[x] += xx
        px[y] += xy
        py[x] += xy
        py[y] += yy
        pr[rate] += DRIFT_RATE * DRIFT_RATE * (1.0 - decay * decay)
        self.rates[foot] *= decay

    def judge_stride(self, foot: int, degraded: bool, defect: bool) -> bool:
        """Count a stride of foot 0 or 1; return whether it is worse than the foot's usual ones, or has a `defect`.

        All strides of a sensor whose peaks are cut off are degraded, and have to be compared all the same."""
        share = self.degraded_shares[foot]
        self.degraded_shares[foot] = share + (float(degraded) - share) / DEGRADED_MEMORY
        return degraded and (defect or share < USUALLY_DEGRADED)

    def inflate(self, foot: int, distance: float) -> None:
        """Inflate the variance of the position of foot 0 or 1 by the square of `distance`, m."""
        p, x = self.covariance, foot * STATES_PER_FOOT
        p[x][x] += distance * distance
        p[x + Y][x + Y] += distance * distance

    def correct(self, terms: Sequence[Term], z: float, variance: float, gate: float) -> list[float] | None:
        """Correct the filter with the innovation `z` of a measurement with these terms and this noise variance.

        Returns the values to add to the states, or None when z^2 is more than `gate` times its predicted variance."""
        p = self.covariance
        ph, gains, errors = [0.0] * STATE_COUNT, [0.0] * STATE_COUNT, [0.0] * STATE_COUNT
        for j, row in enumerate(p):
            total = 0.0
            for state, k in terms:
                total += row[state] * k
            ph[j] = total
        total = 0.0
        for state, k in terms:
            total += ph[state] * k
        s = variance + total
        if not z * z <= gate * s:
            return None
        for j, cross_covariance in enumerate(ph):
            gains[j] = cross_covariance / s
        for left in range(STATES_PER_FOOT):
            right = left + STATES_PER_FOOT
            own_part, other_part = p[left][left] - p[left][right], p[right][right] - p[left][right]
            if own_part + other_part > 0.0:
                difference = gains[left] - gains[right]
                share = min(1.0, max(0.0, own_part / (own_part + other_part)))
                gains[left], gains[right] = share * difference, (share - 1.0) * difference
        self._joseph(gains, ph, s)
        for j, gain in enumerate(gains):
            errors[j] = gain * z
        self.rates[0] += errors[RATE]
        self.rates[1] += errors[RATE + STATES_PER_FOOT]
        return errors

    def _joseph(self, gains: list[float], ph: list[float], s: float) -> None:
        """Update the covariance: P <- (1 - K H) P (1 - K H)' + K R K', with P H' and S = H P H' + R."""
        # P - K (P H')' - P H' K' + K S K' = P + K (S K - P H')' - P H' K'
        rest = [s * gain - a for gain, a in zip(gains, ph, strict=True)]
        for row, gain, a in zip(self.covariance, gains, ph, strict=True):
            for j in range(STATE_COUNT):
                row[j] += gain * rest[j] - a * gains[j]


@frozen
class Measurement:
    """A measured difference of the errors of both tracks."""

    terms: tuple[Term, ...]
    """States, and the derivative of the measurement with respect to each."""
    z: float
    """Innovation: the expected difference minus that of the tracks, m."""
    variance: float
    """Variance of the measurement, m^2."""


def phase_times(event: StrideTaken) -> tuple[float, float]:
    """Return the stance time and the swing time of a stride, s, each up to `MAX_PHASE_TIME`."""
    t_toe_off = event.t_start if event.t_toe_off is None else event.t_toe_off
    stance, swing = t_toe_off - event.t_start, event.t_end - t_toe_off
    return max(0.0, min(stance, MAX_PHASE_TIME)), max(0.0, min(swing, MAX_PHASE_TIME))


def standing_foot(
    index: int,
    displacement: tuple[float, float],
    end: tuple[float, float],
    other: tuple[float, float],
    turn: float,
    times: tuple[float, float],
    width: float,
) -> tuple[Measurement, Measurement]:
    """Return the lateral and the longitudinal measurement of where the other foot stands during a stride.

    It should be beside the middle of the stride, at a lateral distance equal to the walking width. In a bend of `turn`
    rad, the chord of a stride of L m lies L turn / 8 inside the path.

    `displacement` and `end` of the stride of foot 0 (left) or 1 and the place of the `other` foot are in m, common
    frame. The stride turns by `turn` rad and has these `times` of stance and swing, s; `width` is the walking width,
    m."""
    this_x, this_y = index * STATES_PER_FOOT + X, index * STATES_PER_FOOT + Y
    other_x, other_y = (1 - index) * STATES_PER_FOOT + X, (1 - index) * STATES_PER_FOOT + Y
    heading, rate = index * STATES_PER_FOOT + HEADING, index * STATES_PER_FOOT + RATE
    other_heading = (1 - index) * STATES_PER_FOOT + HEADING
    (dx, dy), (stance, swing) = displacement, times
    length = hypot(dx, dy)
    # u: direction of the stride; n: to its left; m: from the middle of the stride to the standing foot
    ux, uy = dx / length, dy / length
    nx, ny = -uy, ux
    mx, my = other[0] - (end[0] - 0.5 * dx), other[1] - (end[1] - 0.5 * dy)
    ahead, leftward = ux * mx + uy * my, nx * mx + ny * my
    side = 1.0 if index == 1 else -1.0
    spread = TURN_ERROR * turn * length
    # u and the middle depend on the heading in mid-swing, psi - r T_swing / 2; the error of the turn is r T
    arm = 0.5 * length - ahead
    lateral = (
        (other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny), (heading, arm), (other_heading, -arm),
        (rate, length * (stance + swing) / 8.0 - 0.5 * swing * arm), (WIDTH, -side),
    )  # fmt: skip
    longitudinal = (
        (other_x, ux), (other_y, uy), (this_x, -ux), (this_y, -uy), (heading, leftward), (other_heading, -leftward),
        (rate, -0.5 * swing * leftward),
    )  # fmt: skip
    expected = side * width - length * turn / 8.0
    return (
        Measurement(lateral, expected - leftward, LATERAL_ERROR**2 + spread * spread),
        Measurement(longitudinal, -ahead, LONGITUDINAL_ERROR**2 + spread * spread),
    )


def feet_apart(index: int, place: tuple[float, float], other: tuple[float, float], reach: float) -> Measurement:
    """Return the measurement that foot 0 (left) or 1 at `place` is at most `reach` m from the `other` foot, m."""
    this_x, this_y = index * STATES_PER_FOOT + X, index * STATES_PER_FOOT + Y
    other_x, other_y = (1 - index) * STATES_PER_FOOT + X, (1 - index) * STATES_PER_FOOT + Y
    dx, dy = other[0] - place[0], other[1] - place[1]
    distance = hypot(dx, dy)
    nx, ny = dx / distance, dy / distance
    terms = ((other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny))
    return Measurement(terms, reach - distance, LONGITUDINAL_ERROR**2)


def moves_of(errors: list[float]) -> tuple[Vec3, Vec3]:
    """Return the moves in x and y, m, and the turns, rad, of the left and the right track for errors of all states."""
    r = STATES_PER_FOOT
    return (errors[X], errors[Y], errors[HEADING]), (errors[r + X], errors[r + Y], errors[r + HEADING])
