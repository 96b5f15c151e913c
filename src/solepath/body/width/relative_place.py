"""Kalman filter of the place of the right foot relative to the left one, from their motions and ranges between them."""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO

TURN_SIGMA = 0.06
"""Standard deviation of the angle between the directions of two successive strides of both feet, rad."""
TRACK_NOISE = 0.015
"""Standard deviation of the displacement of a foot over 1 m, m: the error of a stride is about 1 % of its length.

Errors of step lengths on 12 emulated walks are 1.1, 1.0 and 0.9 cm with 0.012, 0.015 and 0.02 by ultrasound, and 1.3 cm
with each by ultra-wideband radio."""
TURN_NOISE = 0.01
"""Standard deviation by which the headings of the two tracks diverge over 1 m, rad."""
BIAS_SIGMA = 0.05
"""Standard deviation of the constant error of a range sensor, m (assumed)."""
BIAS_NOISE = 0.001
"""Standard deviation of the change of the constant error over 1 m, m (assumed)."""
PLACE_NOISE = 0.01
"""Standard deviation of a foot's place amid a stride, m: a swing is corrected at its end only."""
START_NOISE, LEAST_NOISE, NOISE_MEMORY = 0.05, 0.003, 100
"""First and least standard deviation of a range, m, and number of ranges by which it is estimated."""
GATE = 16.0
"""Largest squared innovation, divided by its variance, of a range that is used."""
ITERATIONS = 3
"""Number of linearisations of a range: near the other foot, its direction depends on the place that it corrects."""
MIN_DISTANCE = 0.02
"""Least distance between two sensors, m."""

LAG_SIGMA = 0.01
"""Standard deviation of the time by which samples lag behind ranges, s.

A low pass at 50 Hz delays samples by 4.5 ms, in which a swinging foot moves 2 cm, and clocks of devices differ by up to
5 ms (link/clock.py)."""
STATES = 5
"""Number of states."""
Pair = tuple[float, float]
"""A place in the horizontal plane, m."""


@define
class RelativePlace:
    """The place of the right foot in the left track's frame, m, and what else the ranges show.

    States: x and y of the right foot relative to the left one, m; the turn from the right track's frame to the left
    one's, rad; the constant error of the ranges, m; the time by which the samples lag behind the ranges, s."""

    t: float = field(default=0.0, init=False)
    """Time of the estimates, s."""
    left: Vec3 = field(default=ZERO, init=False)
    """Place of the left foot on its own track at `t`, m."""
    right: Vec3 = field(default=ZERO, init=False)
    """Place of the right foot on its own track at `t`, m."""
    mean: list[float] = field(factory=list, init=False)
    """Estimates of the five states."""
    covariance: list[list[float]] = field(factory=list, init=False)
    """Covariance of the states."""
    noise: float = field(default=START_NOISE * START_NOISE, init=False)
    """Variance of a range, m^2."""
    gated: int = field(default=0, init=False)
    """Number of ranges since the newest one that was used."""

    def start(self, t: float, left: Vec3, right: Vec3, place: Pair, across: Vec3, turn: float) -> None:
        """Start at `t`, s, where the right foot is at `place`, m, relative to the left one.

        `across` is the covariance xx, xy, yy of that place, m^2, and `turn` the turn between the tracks, rad."""
        self.t, self.left, self.right = t, left, right
        self.mean = [*place, turn, 0.0, 0.0]
        xx, xy, yy = across
        self.covariance = [[xx, xy, 0.0, 0.0, 0.0], [xy, yy, 0.0, 0.0, 0.0]]
        for k, sigma in ((2, TURN_SIGMA), (3, BIAS_SIGMA), (4, LAG_SIGMA)):
            self.covariance.append([sigma * sigma if j == k else 0.0 for j in range(STATES)])

    def keep_errors(self, last: RelativePlace) -> None:
        """Take over what an earlier estimate knows of the ranges: their constant error, their lag and their noise."""
        self.noise = last.noise
        for j in (3, 4):
            self.mean[j] = last.mean[j]
            for k in (3, 4):
                self.covariance[j][k] = last.covariance[j][k]

    def propagate(self, t: float, left: Vec3, right: Vec3) -> None:
        """Move both feet to their places on their own tracks at `t`, s."""
        lx, ly = left[0] - self.left[0], left[1] - self.left[1]
        rx, ry = right[0] - self.right[0], right[1] - self.right[1]
        mean, p = self.mean, self.covariance
        c, s = cos(mean[2]), sin(mean[2])
        mean[0] += c * rx - s * ry - lx
        mean[1] += s * rx + c * ry - ly
        fx, fy = -(s * rx + c * ry), c * rx - s * ry
        for k in range(STATES):
            p[0][k] += fx * p[2][k]
            p[1][k] += fy * p[2][k]
        for k in range(STATES):
            p[k][0] += fx * p[k][2]
            p[k][1] += fy * p[k][2]
        walked = hypot(lx, ly) + hypot(rx, ry)
        p[0][0] += TRACK_NOISE * TRACK_NOISE * walked
        p[1][1] += TRACK_NOISE * TRACK_NOISE * walked
        p[2][2] += TURN_NOISE * TURN_NOISE * walked
        p[3][3] += BIAS_NOISE * BIAS_NOISE * walked
        self.t, self.left, self.right = t, left, right

    def use_range(self, measured: float, left_velocity: Vec3, right_velocity: Vec3) -> None:
        """Correct the states by a range between the feet, m, at their newest places, where they have these velocities.

        Velocities are on each foot's own track, m/s."""
        prior, p, dz = self.mean, self.covariance, self.right[2] - self.left[2]
        c, s, (ax, ay, az), (bx, by, bz) = cos(prior[2]), sin(prior[2]), left_velocity, right_velocity
        vx, vy, vz = c * bx - s * by - ax, s * bx + c * by - ay, bz - az
        x, y, _, bias, lag = prior
        for number in range(ITERATIONS):
            distance = max(MIN_DISTANCE, sqrt(x * x + y * y + dz * dz))
            rate = (x * vx + y * vy + dz * vz) / distance
            row = (x / distance, y / distance, 0.0, 1.0, rate)
            column = [row[0] * p[k][0] + row[1] * p[k][1] + p[k][3] + rate * p[k][4] for k in range(STATES)]
            known = row[0] * column[0] + row[1] * column[1] + column[3] + rate * column[4]
            misfit = measured - distance - bias - rate * lag
            variance = known + self.noise + PLACE_NOISE * PLACE_NOISE
            if number == 0:
                excess = misfit * misfit - known - PLACE_NOISE * PLACE_NOISE
                if not misfit * misfit <= GATE * variance:
                    self.gated += 1
                    return
                self.noise += (max(excess, 0.0) - self.noise) / NOISE_MEMORY
                self.noise = max(LEAST_NOISE * LEAST_NOISE, self.noise)
            # of an iterated extended Kalman filter: the misfit as it was at the prior, by the new linearisation
            misfit -= row[0] * (prior[0] - x) + row[1] * (prior[1] - y) + prior[3] - bias + rate * (prior[4] - lag)
            gain = [value / variance for value in column]
            x, y, bias, lag = (prior[k] + gain[k] * misfit for k in (0, 1, 3, 4))
        self.mean = [prior[k] + gain[k] * misfit for k in range(STATES)]
        for j in range(STATES):
            for k in range(j + 1):
                p[j][k] = p[k][j] = p[j][k] - gain[j] * column[k]
        self.gated = 0
