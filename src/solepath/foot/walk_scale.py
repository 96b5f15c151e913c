"""Accelerometer scale of a foot that has not stood still yet, from its strides.

A scale error shows in two ways. In the stillest part of a stance the specific force is not 1 g; but a runner's foot is
never still. From one stance to the next the vertical velocity drifts by the error times the duration; but an impact
that was sampled too slowly or clipped makes it drift too. Nothing but the scale does both, so the smaller of the two is
used if both have the same sign."""

from __future__ import annotations

from ..types import Vec3
from ..types.attrs import define, field
from ..types.vector import GRAVITY, TIE
from .attitude import LARGEST_MOTION, LARGEST_SCALE, LEAST_SCALE, SHORT_SPAN, SampleSpan, amount_of_motion

SHORTEST_SWING, LONGEST_SWING = 0.25, 2.0
"""Limits of the time between two stances over which a drift is measured, s."""
MOST_STRIDES = 20
"""Number of strides that are averaged."""
LARGEST_DEVIATION = 0.25 * GRAVITY
"""Largest deviation from 1 g in one stride, m/s^2; a larger one counts as this."""


@define
class WalkScale:
    """Learns the accelerometer scale from strides.

    A deviation is the difference between the reading of a standing foot and 1 g, m/s^2. The numbers were chosen by hand
    and not swept."""

    span: SampleSpan = field(factory=SampleSpan, init=False)
    """Sums over the current short span."""
    span_start: float | None = field(default=None, init=False)
    """Start of the current short span, s; None before any sample."""
    least_motion: float = field(default=LARGEST_MOTION, init=False)
    """Least amount of motion of a short span since the last stride, (m/s^2)^2."""
    force: float = field(default=GRAVITY, init=False)
    """Specific force in the short span of `least_motion`, m/s^2."""
    accepted_at: float | None = field(default=None, init=False)
    """Time of the last accepted evidence, s; None before any."""
    strides: int = field(default=0, init=False)
    """Number of strides in the means, at most MOST_STRIDES."""
    stance_deviation: float = field(default=0.0, init=False)
    """Mean deviation in stance."""
    drift_deviation: float = field(default=0.0, init=False)
    """Mean deviation from the drift of the vertical velocity."""

    def add_sample(self, t: float, acc: Vec3, gyro: Vec3) -> None:
        """Add one sample without calibration."""
        if self.span_start is None:
            self.span_start = t
        span = self.span
        span.add(acc, gyro)
        if t - self.span_start < SHORT_SPAN - TIE or span.count < 2:
            return
        motion = amount_of_motion(span)
        if motion < self.least_motion:
            (x, y, z), _ = span.means()
            self.least_motion, self.force = motion, (x * x + y * y + z * z) ** 0.5
        self.span = SampleSpan()
        self.span_start = t

    def add_evidence(self, t: float, drift: float, scale: float) -> float:
        """Return the scale after evidence that was accepted at `t`, s, and that corrected the velocity.

        `drift` is the vertical velocity that the correction removed, m/s, integrated with `scale`."""
        since = None if self.accepted_at is None else t - self.accepted_at
        self.accepted_at = t
        if since is None or not SHORTEST_SWING <= since <= LONGEST_SWING or self.least_motion == LARGEST_MOTION:
            return scale
        self.strides = min(self.strides + 1, MOST_STRIDES)
        stance, moving = self.force - GRAVITY, (GRAVITY + drift / since) / scale - GRAVITY
        self.stance_deviation += (_limited(stance) - self.stance_deviation) / self.strides
        self.drift_deviation += (_limited(moving) - self.drift_deviation) / self.strides
        self.least_motion = LARGEST_MOTION
        least, most = sorted((self.stance_deviation, self.drift_deviation), key=abs)
        deviation = least if least * most > 0.0 else 0.0
        return min(max(GRAVITY / (GRAVITY + deviation), LEAST_SCALE), LARGEST_SCALE)

    def reset(self) -> None:
        """Discard what depends on unbroken times."""
        self.span = SampleSpan()
        self.span_start = self.accepted_at = None
        self.least_motion = LARGEST_MOTION


def _limited(deviation: float) -> float:
    return min(max(deviation, -LARGEST_DEVIATION), LARGEST_DEVIATION)
