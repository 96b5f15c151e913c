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

from ...foot.world import Covariance2
from ...types import OTHER, Foot, PerFoot, Vec2, per_foot
from ...types.attrs import define, field
from .common_error import Term, column

FEET = {Foot.LEFT: 0, Foot.RIGHT: 4}
"""First state of each foot."""
X, Y, HEADING, RATE = range(4)
"""States of a foot, from its first one on."""
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
HEADING_DRIFT = 0.0015
"""Random walk of the heading error that adds to the drift rate, rad/sqrt(s)."""
ALIGNMENT_ERROR = (0.15, 0.15, 0.05)
"""Standard deviations of x and y, m, and of the heading, rad, of a returned foot after its alignment."""
DEGRADED_ERROR = 0.06
"""Standard deviation of the heading error that a degraded stride adds, rad."""
USUALLY_DEGRADED, DEGRADED_MEMORY = 0.5, 10.0
"""Share of a foot's strides above which a degraded one is usual, and strides over which it is averaged (by hand)."""
LATERAL_ERROR, LONGITUDINAL_ERROR = 0.045, 0.15
"""Standard deviations of the standing foot's position relative to the middle of the other foot's stride, m."""
TURN_ERROR = 0.12
"""Additional standard deviation of both in a turn, m per m of stride length and rad of turn."""


Measurement = tuple[Sequence[Term], float, float]
"""The states with the derivative of the measurement by each; the innovation, m, and the variance of the measurement."""


def _zeros() -> list[list[float]]:
    return [[0.0] * STATE_COUNT for _ in range(STATE_COUNT)]


@define
class TrackErrorFilter:
    """The covariance of the errors of both tracks, and the estimated drift rates.

    Estimated errors are removed from the tracks at once, so only the rates are stored as estimates."""

    covariance: list[list[float]] = field(factory=_zeros)
    """Covariance of the states, `STATE_COUNT` rows, in units of m, rad and rad/s."""
    centre: Vec2 = (0.0, 0.0)
    """Point about which heading errors rotate the tracks, m, common frame."""
    rates: PerFoot[float] = field(factory=lambda: per_foot(float))
    """Correction of the heading rate of each track, rad/s, positive to the left."""
    degraded_shares: PerFoot[float] = field(factory=lambda: per_foot(float))
    """Share of the recent strides of each foot that were degraded."""

    def start(self) -> None:
        """Start with both feet side by side; their mean has no error, because it defines the world frame."""
        p = self.covariance = _zeros()
        self.rates = per_foot(float)
        for state, sigma in ((X, FIRST_POSITION_ERROR), (Y, FIRST_POSITION_ERROR), (HEADING, FIRST_HEADING_ERROR)):
            left, right = [first + state for first in FEET.values()]
            p[left][left] = p[right][right] = 0.25 * sigma * sigma
            p[left][right] = p[right][left] = -0.25 * sigma * sigma
        for first in FEET.values():
            p[first + RATE][first + RATE] = DRIFT_RATE * DRIFT_RATE
        p[WIDTH][WIDTH] = FIRST_WIDTH_ERROR * FIRST_WIDTH_ERROR

    @property
    def diverged(self) -> bool:
        """Flag: a variance exceeds `MAX_VARIANCE` or is not a number."""
        return any([not row[k] < MAX_VARIANCE for k, row in enumerate(self.covariance)])

    def align(self, foot: Foot) -> None:
        """Give a foot the errors of the other foot, with which its track was aligned. The foot keeps its own rate."""
        p = self.covariance
        for state, sigma in enumerate(ALIGNMENT_ERROR):
            moved, fixed = FEET[foot] + state, FEET[OTHER[foot]] + state
            p[moved] = [*p[fixed]]
            for row in p:
                row[moved] = row[fixed]
            p[moved][moved] += sigma * sigma

    def propagate(
        self, foot: Foot, times: Vec2, end: complex, displacement: complex, variance: Covariance2,
        degraded: bool,
    ) -> None:  # fmt: skip
        """Propagate the covariance over a stride of a foot, with the `times` of its stance and swing, s.

        `displacement` of the stride and its `end` are in m, common frame; `variance` is xx, xy, yy, m^2."""
        p, (stance, swing), moved = self.covariance, times, end - complex(*self.centre)
        self.centre = (end.real, end.imag)
        x = FEET[foot]
        y, heading, rate = x + Y, x + HEADING, x + RATE
        duration, time_to_mid_swing = stance + swing, stance + 0.5 * swing
        decay = exp(-duration / DRIFT_MEMORY)
        noise = DEGRADED_ERROR * DEGRADED_ERROR if degraded else 0.0
        p[heading][heading] += noise + HEADING_DRIFT * HEADING_DRIFT * duration
        # P <- F P F': F moves the centre for both feet, then adds the stride
        arm, other = time_to_mid_swing * displacement, FEET[OTHER[foot]]
        steps = (
            (x, heading, -moved.imag), (y, heading, moved.real),
            (other + X, other + HEADING, -moved.imag), (other + Y, other + HEADING, moved.real),
            (x, rate, -arm.imag), (y, rate, arm.real), (heading, rate, duration),
        )  # fmt: skip
        for _ in range(2):  # first the rows, then the columns
            for i, j, k in steps:
                p[i] = [a + k * b for a, b in zip(p[i], p[j], strict=True)]
            p[rate] = [a * decay for a in p[rate]]
            p = [[*column] for column in zip(*p, strict=True)]
        p[x][x] += variance[0]
        p[x][y] += variance[1]
        p[y][x] += variance[1]
        p[y][y] += variance[2]
        p[rate][rate] += DRIFT_RATE * DRIFT_RATE * (1.0 - decay * decay)
        self.covariance = p
        self.rates[foot] *= decay

    def judge_stride(self, foot: Foot, degraded: bool, defect: bool) -> bool:
        """Count a stride of a foot; return whether it is worse than the foot's usual ones, or has a `defect`.

        All strides of a sensor whose peaks are cut off are degraded, and have to be compared all the same."""
        share = self.degraded_shares[foot]
        self.degraded_shares[foot] = share + (float(degraded) - share) / DEGRADED_MEMORY
        return degraded and (defect or share < USUALLY_DEGRADED)

    def inflate(self, foot: Foot, distance: float) -> None:
        """Inflate the variance of the position of a foot by the square of `distance`, m."""
        for k in (FEET[foot] + X, FEET[foot] + Y):
            self.covariance[k][k] += distance * distance

    def correct(self, measured: Measurement, gate: float) -> list[float] | None:
        """Correct the filter with a measurement.

        Returns the values to add to the states, or None when the squared innovation is more than `gate` times its
        predicted variance."""
        p, (terms, z, s) = self.covariance, measured
        with_all, total = column(p, terms), 0.0
        for state, k in terms:
            total += with_all[state] * k
        s += total
        if not z * z <= gate * s:
            return None
        gains = [one / s for one in with_all]
        for left in range(FEET[Foot.RIGHT]):
            right = left + FEET[Foot.RIGHT]
            own_part, other_part = p[left][left] - p[left][right], p[right][right] - p[left][right]
            if own_part + other_part > 0.0:
                difference = gains[left] - gains[right]
                share = min(1.0, max(0.0, own_part / (own_part + other_part)))
                gains[left], gains[right] = share * difference, (share - 1.0) * difference
        # (1 - K H) P (1 - K H)' + K R K' = P - K (P H')' - P H' K' + K S K' = P + K (S K - P H')' - P H' K'
        rest = [s * gain - one for gain, one in zip(gains, with_all, strict=True)]
        self.covariance = [
            [a + (gain * b - one * c) for a, b, c in zip(row, rest, gains, strict=True)]
            for row, gain, one in zip(p, gains, with_all, strict=True)
        ]
        gains = [gain * z for gain in gains]
        for foot, first in FEET.items():
            self.rates[foot] += gains[first + RATE]
        return gains


def standing_foot(
    foot: Foot, displacement: complex, middle: complex, turn: float, times: Vec2, width: float
) -> tuple[Measurement, Measurement]:
    """Return the lateral and the longitudinal measurement of where the other foot stands during a stride of a foot.

    It should be beside the middle of the stride, at a lateral distance equal to the walking width. In a bend of `turn`
    rad, the chord of a stride of L m lies L turn / 8 inside the path.

    `displacement` is that of the stride, and `middle` leads from its middle to the other foot, both in m, common frame.
    The stride turns by `turn` rad and has these `times` of stance and swing, s; `width` is the walking width, m."""
    this, side = FEET[foot], -1.0 if foot is Foot.LEFT else 1.0
    (stance, swing), length = times, hypot(displacement.real, displacement.imag)
    along = displacement / length
    from_middle = along.conjugate() * middle
    ahead, leftward = from_middle.real, from_middle.imag
    spread = TURN_ERROR * turn * length
    # the direction and the middle depend on the heading in mid-swing, psi - r T_swing / 2; the error of the turn is r T
    arm = 0.5 * length - ahead
    rate = length * (stance + swing) / 8.0 - 0.5 * swing * arm
    lateral = [*_difference(foot, 1j * along, arm), (this + RATE, rate), (WIDTH, -side)]
    longitudinal = [*_difference(foot, along, leftward), (this + RATE, -0.5 * swing * leftward)]
    expected = side * width - length * turn / 8.0
    return (
        (lateral, expected - leftward, LATERAL_ERROR**2 + spread * spread),
        (longitudinal, -ahead, LONGITUDINAL_ERROR**2 + spread * spread),
    )


def feet_apart(foot: Foot, to_other: complex, reach: float) -> Measurement:
    """Return the measurement that a foot is at most `reach` m from the other foot, to which `to_other`, m, leads."""
    distance = hypot(to_other.real, to_other.imag)
    return _difference(foot, to_other / distance)[:4], reach - distance, LONGITUDINAL_ERROR**2


def _difference(foot: Foot, along: complex, arm: float = 0.0) -> list[Term]:
    """Return the terms of the other foot's error minus that of a foot along a direction, with the `arm` of headings."""
    this, other, x, y = FEET[foot], FEET[OTHER[foot]], along.real, along.imag
    return [
        (other + X, x), (other + Y, y), (this + X, -x), (this + Y, -y), (this + HEADING, arm), (other + HEADING, -arm)
    ]  # fmt: skip
