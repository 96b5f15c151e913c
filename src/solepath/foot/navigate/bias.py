"""Bias of a gyroscope, from rests of the foot.

A standing foot sways: it turns slowly to and fro within a small angle. The mean rate over a rest of the duration T is
the bias and the difference of the first and the last angle, divided by T. On recordings with long rests (hugadb,
ipol_10m_uturn, openshoe_loops) the angle is that of a first-order Gauss-Markov process with a correlation time of about
a second, so that the variance of the mean rate is

    2 s^2 (1 - exp(-T / tau)) / T^2,

where s^2 is the variance of the angle and tau the correlation time. A long rest therefore teaches far more than several
short ones. A Kalman filter takes each rest, up to half a minute of it, as one measurement, with one gain about the
vertical and one about the horizontal axes: a standing foot lies on the ground, so it turns less about the vertical. A
foot that trembles has a larger s, so that a restless rest teaches little. A foot starts to turn slowly before it leaves
the ground; the last span of a rest therefore teaches nothing, unless it is the first span of all."""

from __future__ import annotations

from math import exp, fsum

from ...types import Vec3
from ...types.attrs import define, evolve, frozen
from ...types.vector import ZERO, add, dot, sub

FIRST_BIAS = 0.009
"""Standard deviation of a bias that is not known yet, rad/s (0.5 degrees/s), unless the first one is larger."""
LEAST_REST_ERROR = 0.0009
"""Least standard deviation of the mean rate of a span of rest, rad/s (3 degrees a minute).

On recordings with the same sensor at several rests (gumushane_gcp, openshoe_loops, pyshoe_vicon, felius_2min_walk) the
mean rate of a span differs from the bias by about the standard deviation of the means of its blocks, and by this."""
UNKNOWN_REST_ERROR = 0.02
"""Standard deviation of the mean rate of a span with too few samples to tell, rad/s: the most that counts as rest."""
REST_SPAN, SWAY_SPANS, MOST_SPANS = 0.5, 2.0, 60
"""Duration of a span of rest, s, correlation time of the sway, in spans, and most spans that are one measurement."""
BIAS_ERROR = 1.5e-4
"""Standard deviation of the bias that even a long rest leaves, rad/s (0.5 degrees a minute).

The mean rates of both halves of rests of 16 s (hugadb) differ by 0.9 degrees a minute."""
BIAS_WANDER = 2e-5
"""Random walk of the bias, rad/s per sqrt(s): 0.02 degrees/s in five minutes, as if warmed by 2 K (ST DS12814)."""
LARGEST_SURPRISE = 25.0
"""Squared difference of a mean rate from the bias, divided by its variance, above which the bias is another one."""


@frozen
class RestSpan:
    """One span of rest."""

    t: float
    """End of the span, s."""
    rate: Vec3
    """Mean rate, rad/s."""
    blocks: tuple[Vec3, ...]
    """Mean rates of successive blocks of the span, rad/s."""
    up: Vec3
    """Direction of the mean specific force, a unit vector."""


@frozen
class Bias:
    """A gyroscope bias with its uncertainty."""

    value: Vec3 = ZERO
    """Bias, sensor frame, rad/s."""
    variances: tuple[float, float] = (FIRST_BIAS**2, FIRST_BIAS**2)
    """Variances of `value` at `t`, (rad/s)^2: about the vertical, and about each horizontal axis."""
    t: float | None = None
    """End of the newest span of rest that was used, s; None before any and after times restart."""
    change: float = 0.0
    """Sum of all changes of `value` about the vertical, rad/s."""
    spans: int = 0
    """Number of spans of rest that were used; 0 for a device of which none was."""
    device: int = 0
    """Number of times that another device may have been connected."""


@define
class BiasFilter:
    """The bias of a gyroscope, from all rests so far."""

    bias: Bias = Bias()
    before: Bias = Bias()
    """Bias before the current rest."""
    count: int = 0
    """Number of spans of the current rest that were used."""
    rate: Vec3 = ZERO
    """Mean rate over these spans, rad/s."""
    noise: tuple[float, float] = (0.0, 0.0)
    """Mean over these spans of the variance of the rate of one span, (rad/s)^2, about the axes of `Bias.variances`."""
    newest: RestSpan | None = None
    """Newest span, which is used once the next one is at rest too."""

    def add(self, span: RestSpan) -> None:
        """Add a span of rest that follows the one before without a break."""
        if self.newest is not None:
            self._learn(self.newest)
        elif not self.bias.spans:
            self._learn(span)
            return
        self.newest = span

    def end_rest(self) -> None:
        """Discard the newest span, because the foot moves; the next span starts another rest."""
        self.newest, self.count = None, 0

    def reset(self) -> None:
        """Discard the current rest, because times restart; the bias stays."""
        self.end_rest()
        self.bias = evolve(self.bias, t=None)

    def forget(self) -> None:
        """Discard the variances, because the device may be another one; its bias is perhaps the same."""
        self.reset()
        self.bias = Bias(self.bias.value, device=self.bias.device + 1)

    def _learn(self, span: RestSpan) -> None:
        if self.count >= MOST_SPANS:  # the bias wanders, so a very long rest is several
            self.count = 0
        if not self.count:
            self.before, self.rate, self.noise = self.bias, ZERO, (0.0, 0.0)
        before, up = self.before, span.up
        self.count += 1
        n, k = float(self.count), 1.0 / self.count
        self.rate = add(self.rate, sub(span.rate, self.rate), k)
        spreads = [_squares(sub(block, span.rate), up) for block in span.blocks]
        surprise = sub(self.rate, before.value)
        squares = _squares(surprise, up)
        # (1 - exp(-T / tau)) / T^2 relative to that of one span
        sway = (1.0 - exp(-n / SWAY_SPANS)) / ((1.0 - exp(-1.0 / SWAY_SPANS)) * n * n)
        elapsed = 0.0 if before.t is None else max(0.0, span.t - before.t)
        gains, variances, noises = [1.0, 1.0], [0.0, 0.0], [0.0, 0.0]
        for axis in range(2):
            seen = UNKNOWN_REST_ERROR * UNKNOWN_REST_ERROR
            if len(spreads) > 1:
                seen = fsum([one[axis] for one in spreads]) / (len(spreads) - 1)
            mean = self.noise[axis]
            noises[axis] = mean = mean + k * (LEAST_REST_ERROR * LEAST_REST_ERROR + seen - mean)
            wandered = BIAS_WANDER * BIAS_WANDER * n * REST_SPAN / 3.0
            noise = sway * mean + BIAS_ERROR * BIAS_ERROR + wandered
            known = before.variances[axis] + BIAS_WANDER * BIAS_WANDER * elapsed
            if squares[axis] > LARGEST_SURPRISE * (known + noise):
                known += squares[axis]
            gains[axis] = known / (known + noise)
            variances[axis] = (1.0 - gains[axis]) * known
        self.noise = (noises[0], noises[1])
        about_up = dot(surprise, up)
        value = add(add(before.value, surprise, gains[1]), up, (gains[0] - gains[1]) * about_up)
        change, spans = before.change + gains[0] * about_up, self.bias.spans + 1
        self.bias = Bias(value, (variances[0], variances[1]), span.t, change, spans, self.bias.device)


def _squares(w: Vec3, up: Vec3) -> tuple[float, float]:
    """Return the squared rate of `w` about `up`, and its mean square about the two horizontal axes."""
    about_up = dot(w, up) ** 2
    return about_up, max(0.0, 0.5 * (dot(w, w) - about_up))
