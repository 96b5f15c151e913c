"""Drift of the heading from straight ways.

Borenstein and Ojeda, "Heuristic drift elimination for personnel tracking systems", Journal of Navigation 63, 2010,
assume that a nearly straight path is straight: people walk straight on for long stretches, in any direction, and a
gyroscope that drifts bends these stretches by nearly the same angle in every stride. No sensor measures that a stretch
is straight, so it is tested.

A stretch consists of strides in nearly one direction. At its end a parabola is fitted to it. People wander about a
straight line by some centimetres, which leaves its curvature uncertain: by 1.3 1/km after 20 m of straight way, by 0.1
1/km after 60 m. The curvature that remains is that of the drift, of a gentle bend, or of a bend. The probability of
each follows from the curvature (all three are normal distributions) and from how often each was met before on this
walk, so that the drift is learnt in corridors, and not in a ring, on a track or on a plaza. A stretch that leaves its
parabola by more than people wander is not straight."""

from __future__ import annotations

from math import atan2, cos, exp, fsum, hypot, pi, sin, sqrt

from ...types.attrs import define, field, frozen

MAX_FOOT_TURN = 0.2
"""Largest turn of a foot in a stride of a stretch, rad; feet turn by some degrees from stride to stride anyway."""
MIN_ADVANCE = 0.4
"""Shortest stride of a stretch, m."""
MAX_DEVIATION, DEVIATION_STRIDES = 0.17, 4
"""Largest angle between the way of the last strides and the stretch so far, rad, and number of these strides."""
MAX_PAUSE = 3.0
"""Longest time between the ends of two strides of a stretch, s."""
MIN_LENGTH, MAX_LENGTH = 7.0, 80.0
"""Shortest stretch that is used, and length at which a longer one is divided, m."""
MIN_STRIDES = 8
"""Least number of strides of a stretch that is used."""
FOOTFALL = 0.015
"""Standard deviation of the middle of both feet from the smooth way of the body, m; feet land 2 to 3 cm to a side."""
USUAL_WANDER, WANDER_WEIGHT, MAX_WANDER_WEIGHT = 0.05, 4.0, 30.0
"""Usual standard deviation of the wandering about a straight line, m, the number of stretches as which it counts in the
mean over the stretches of a wearer, and the largest such number. (Legs of 9 m in `ipol_10m_uturn` bow by 5 to 7 cm.)"""
WANDER_LENGTH, MIN_INDEPENDENT = 4.5, 7.0
"""Length after which the wandering is another one, m, and least number of such lengths that a curvature counts.

Both describe the curvature of parabolas that are fitted to a spline with random knots every 5 m. Emulated wearers
wander by the same spline (emulate/routes/wander.py), so they do not prove these numbers."""
MAX_WANDER_SHARE, HALF_SHARE_LENGTH = 0.75, 16.0
"""Share of the wandering that a parabola through a long stretch leaves, and length at which it leaves half of that, m;
of the same spline."""
FITTED_PLACES = 6.0
"""Number of places that is added to that of a stretch, because the factor below holds for many only."""
CURVATURE_FACTOR = sqrt(720.0)
"""Standard deviation of the curvature of a parabola through n points of standard deviation s on a length L: this number
times s / (L^2 sqrt(n)), for large n."""
MAX_RESIDUAL = 5.0
"""Largest ratio of the mean square of the distances from the parabola to the expected one."""
DRIFT_SCATTER = 2.5e-4
"""Standard deviation of the drift of one stretch from the mean drift, rad a stride, because the bias wanders."""
GATE = 9.0
"""Largest squared drift, divided by its variance, that is attributed to the gyroscope."""
GENTLE_BEND, BEND = 0.006, 0.03
"""Standard deviations of the curvature of ways that bend gently, and of bends, 1/m."""
FIRST_COUNTS = (1.0, 1.0, 1.0)
"""Number of stretches as which it counts before any walk that stretches are straight, bend gently, and bend."""
FORGETTING = 0.97
"""Factor of all counts at each stretch: about the last thirty count."""


@frozen
class StretchDrift:
    """The drift that a straight stretch shows."""

    drift: float
    """Turn of the heading in a usual stride that makes the stretch straight, rad, positive to the left."""
    variance: float
    """Variance of `drift`, rad^2."""
    weight: float
    """Probability that the stretch is straight, from 0 to 1."""
    stride_time: float
    """Mean duration of a usual stride of the stretch, s."""


@frozen
class Places:
    """The sums over the places of a stretch from which a parabola through them is found."""

    t: float
    """Time of the newest place, s."""
    x: float
    """Newest place along the first direction of the stretch, from its start, m."""
    y: float
    """Newest place to the left of that direction, m."""
    strides: float = 0.0
    """Number of usual strides in which the heading of the mean of both feet has drifted since the start."""
    count: int = 0
    powers: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """Sums of x, x^2, x^3 and x^4."""
    products: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """Sums of y, x y, x^2 y and y^2."""

    def add(self, t: float, x: float, y: float, strides: float) -> Places:
        """Return the places with one more at `t`, s, after `strides` more usual strides."""
        square = x * x
        a, b, c, d = self.powers
        e, f, g, h = self.products
        return Places(
            t, x, y, self.strides + strides, self.count + 1,
            (a + x, b + square, c + square * x, d + square * square), (e + y, f + x * y, g + square * y, h + y * y),
        )  # fmt: skip

    def parabola(self) -> tuple[float, float] | None:
        """Return the curvature, 1/m, of the parabola of least squares and the mean square distance from it, m^2."""
        n = float(self.count)
        (s1, s2, s3, s4), (t0, t1, t2, square) = self.powers, self.products
        # normal equations of y = a + b x + c x^2, solved by Cramer's rule
        m0, m1, m2 = s2 * s4 - s3 * s3, s1 * s4 - s2 * s3, s1 * s3 - s2 * s2
        determinant = n * m0 - s1 * m1 + s2 * m2
        if determinant <= 0.0:
            return None
        a = (t0 * m0 - t1 * m1 + t2 * m2) / determinant
        b = (-t0 * m1 + t1 * (n * s4 - s2 * s2) - t2 * (n * s3 - s1 * s2)) / determinant
        c = (t0 * m2 - t1 * (n * s3 - s1 * s2) + t2 * (n * s2 - s1 * s1)) / determinant
        return 2.0 * c, max(0.0, square - a * t0 - b * t1 - c * t2) / n


@frozen
class Stretch:
    """Strides in nearly one direction that have ended."""

    t_start: float
    """End of the first stride, s."""
    end: Places
    """The places, up to the last stride."""


@define
class Straightness:
    """Collects the strides of a stretch, and keeps what was learnt from earlier stretches."""

    direction: float = field(default=0.0, init=False)
    """Direction of the first stride of the stretch, rad, world frame."""
    t: float | None = field(default=None, init=False)
    """End of the newest stride, s; None before any stretch."""
    t_start: float = field(default=0.0, init=False)
    """End of the first stride of the stretch, s."""
    recent: list[Places] = field(factory=list, init=False)
    """The places after each of the last strides, the newest last; empty without a stretch."""
    left_out: int = field(default=0, init=False)
    """Number of strides that are left out before the next stretch starts, because the wearer still turns."""
    counts: tuple[float, float, float] = field(default=FIRST_COUNTS, init=False)
    """Number of stretches that were straight, that bent gently and that bent, each fading by `FORGETTING`."""
    wander: tuple[float, float] = field(default=(USUAL_WANDER * USUAL_WANDER, WANDER_WEIGHT), init=False)
    """Variance of the wandering, m^2, and the number of stretches as which it counts."""

    def add_stride(
        self, t: float, displacement: tuple[float, float], share: float, strides: float, turn: float
    ) -> Stretch | None:
        """Add a stride that ended at `t`, s; return the stretch that it has ended, if that is long enough.

        `displacement` is in m, world frame, `turn` that of the foot, rad. The mean of both feet moves and drifts by
        `share` of the stride, which counts as `strides` usual ones."""
        dx, dy = displacement
        paused = self.t is not None and abs(t - self.t) > MAX_PAUSE  # the feet's clocks may be apart
        self.t = t
        if paused or abs(turn) > MAX_FOOT_TURN or hypot(dx, dy) < MIN_ADVANCE:
            return self.break_off()
        if self.left_out:
            self.left_out -= 1
            return None
        if not self.recent:
            self._start(atan2(dy, dx))
        newest, earlier = self.recent[-1], self.recent[0]
        c, s = cos(self.direction), sin(self.direction)
        x, y = newest.x + share * (c * dx + s * dy), newest.y + share * (c * dy - s * dx)
        if len(self.recent) > DEVIATION_STRIDES:
            deviation = atan2(y - earlier.y, x - earlier.x) - atan2(y, x)
            if abs(wrap_angle(deviation)) > MAX_DEVIATION:  # the wearer has turned off, perhaps some strides ago
                found = self._end(earlier)
                self.recent, self.left_out = [], DEVIATION_STRIDES // 2
                return found
        self.recent = [*self.recent[-DEVIATION_STRIDES:], newest.add(t, x, y, share * strides)]
        if x <= MAX_LENGTH:
            return None
        found = self._end(self.recent[-1])
        self._start(self.direction)
        return found

    def break_off(self) -> Stretch | None:
        """End the stretch at a stride that cannot belong to one; return it, if it is long enough."""
        found = self._end(self.recent[-1]) if self.recent else None
        self.recent, self.left_out = [], 0
        return found

    def reset(self) -> None:
        """Discard the stretch, because the clock restarts."""
        self.recent, self.left_out, self.t = [], 0, None

    def drift_of(self, stretch: Stretch, drift_sigma: float) -> StretchDrift | None:
        """Return the drift that a stretch shows, and learn from it how this wearer walks; None without a parabola.

        `drift_sigma` is the standard deviation of the estimated drift, rad a stride, which is already removed from the
        strides."""
        places, length = stretch.end, stretch.end.x
        fit = places.parabola()
        if fit is None:
            return None
        curvature, mean_square = fit
        variance, weight = self.wander
        footfall = FOOTFALL * FOOTFALL
        independent = max(MIN_INDEPENDENT, length / WANDER_LENGTH)
        error = (CURVATURE_FACTOR / (length * length)) ** 2 * (
            variance / independent + footfall / (places.count + FITTED_PLACES)
        )
        per_stride = length / places.strides  # rad a stride for a curvature in 1/m
        z, noise = -curvature * per_stride, error * per_stride * per_stride + DRIFT_SCATTER * DRIFT_SCATTER
        s = drift_sigma * drift_sigma + noise
        share = MAX_WANDER_SHARE * length * length / (length * length + HALF_SHARE_LENGTH * HALF_SHARE_LENGTH)
        expected = share * share * variance + footfall
        variances = (s, s + (GENTLE_BEND * per_stride) ** 2, s + (BEND * per_stride) ** 2)
        likely = [count * exp(-0.5 * z * z / v) / sqrt(v) for count, v in zip(self.counts, variances, strict=True)]
        if z * z > GATE * s or mean_square > MAX_RESIDUAL * expected:
            likely[0] = 0.0
        total = fsum(likely)
        shares = [one / total for one in likely] if total > 0.0 else [0.0, 0.0, 1.0]
        straight, gentle, bent = [FORGETTING * old + new for old, new in zip(self.counts, shares, strict=True)]
        self.counts = (straight, gentle, bent)
        if shares[0] > 0.5 and length > 2.0 * MIN_LENGTH:
            seen = max(0.0, mean_square - footfall) / (share * share)
            self.wander = (variance + (seen - variance) / (weight + 1.0), min(weight + 1.0, MAX_WANDER_WEIGHT))
        return StretchDrift(z, noise, shares[0], max(0.0, (places.t - stretch.t_start) / places.strides))

    def _end(self, places: Places) -> Stretch | None:
        is_long = places.count >= MIN_STRIDES and places.x >= MIN_LENGTH and places.strides > 0.0
        return Stretch(self.t_start, places) if is_long else None

    def _start(self, direction: float) -> None:
        self.direction, self.t_start = direction, self.t or 0.0
        self.recent = [Places(self.t_start, 0.0, 0.0).add(self.t_start, 0.0, 0.0, 0.0)]


def wrap_angle(angle: float) -> float:
    """Return the angle plus whole turns, from -pi to pi, rad."""
    return (angle + pi) % (2.0 * pi) - pi
