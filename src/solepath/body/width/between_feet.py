"""Step length and step width from ranges between the feet.

The part is loaded with the first sample that has a range (body/gait/cycles.py)."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, isfinite, remainder, sin, sqrt, tau
from typing import ClassVar

from ...events import GaitCycleMeasured, SampleGap, StrideTaken
from ...foot.view import FootView
from ...types import SITE_OF_FOOT, Foot, Site, Vec3
from ...types.attrs import define, evolve, field
from ..part import Part, PartInput, PartOutput
from .ranged_track import RangedStride, RangedTrack
from .relative_place import RelativePlace

FIRST_WIDTH, WIDTH_SIGMA = 0.12, 0.06
"""Width before any range, and its standard deviation, m: healthy adults walk 0.05 to 0.18 m wide."""
STEP_SHARE = 0.15
"""Standard deviation of the step length about half of the stride, as a share of the stride."""
MIN_LENGTH, MAX_TURN, MAX_RISE = 0.4, 0.4, 0.08
"""Least length, m, largest turn, rad, and largest change of height, m, of a stride from which ranges are used."""
MAX_RANGE = 3.0
"""Largest distance between the feet of a walker, m."""
MAX_PENDING = 64
"""Largest number of ranges that wait for the other foot's samples."""
MAX_GATED = 50
"""Number of successive ranges that do not fit, after which the estimate restarts."""
MAX_GAP, UNSEEN_MOVE = 0.1, 0.05
"""Longest gap in a foot's samples after which the estimate goes on, s, and the standard deviation that it adds, m."""
WIDTH_MEMORY = 4
"""Number of strides whose mean width must not be negative.

Ranges on a straight way do not show on which side the other foot is, so feet that cross on average are those of a
mirrored estimate."""
MAX_SIGMA = 0.05
"""Largest standard deviation of a step length or width that is reported, m."""
PLACEMENT_NOISE = 0.01
"""Standard deviation of the places of three foot-flats relative to the line of a stride, m."""


@define
class BetweenFeet(Part):
    """Measures step length and step width of gait cycles, from samples that have ranges."""

    needs_samples: ClassVar[bool] = True

    left: RangedTrack = field(factory=RangedTrack, init=False)
    right: RangedTrack = field(factory=RangedTrack, init=False)
    pending: list[tuple[float, float]] = field(factory=list, init=False)
    """Ranges, m, with their times, s, that wait for samples of both feet."""
    estimate: RelativePlace | None = field(default=None, init=False)
    """Place of one foot relative to the other; None while unknown."""
    last: RelativePlace | None = field(default=None, init=False)
    """The estimate before the newest restart, which knows the sensor's errors; None before any."""
    usual_width: float = field(default=FIRST_WIDTH, init=False)
    """Mean width of the newest strides, m."""

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add a sample of a foot, with its range and its strides; returns no output."""
        if view is None:
            return ()
        sample, track = view.sample, self.left if view.foot is Foot.LEFT else self.right
        if sample.range is not None and 0.0 < sample.range < MAX_RANGE:
            self.pending = [*self.pending[1 - MAX_PENDING :], (view.t, sample.range)]
        if view.levelled and view.moved_at == view.t:
            track.add_sample(view)
        for event in events:
            if isinstance(event, StrideTaken):
                self._add_stride(track, event, view)
            elif isinstance(event, SampleGap) and event.site is SITE_OF_FOOT[view.foot]:
                self._inflate(event.duration <= MAX_GAP)
        if self.pending:
            self._use_ranges()
        if self.estimate is not None and track.moved:
            # the covariance grows with each stride, also without ranges
            self._propagate(self._common_time())
        return ()

    def complete(self, event: GaitCycleMeasured) -> GaitCycleMeasured:
        """Return a measured gait cycle with step length and step width, if they are known."""
        is_left = event.foot is Foot.LEFT
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        stride = next((one for one in this.strides if one.contact == event.t), None)
        standing = None if stride is None else _standing(stride, other)
        if stride is None or standing is None or self.estimate is None or not stride.usable:
            return event
        length, width, sigmas = _placement(self.estimate, stride, standing, is_left)
        if not (sigmas[0] < MAX_SIGMA and sigmas[1] < MAX_SIGMA):
            return event
        return evolve(
            event, step_length=length, step_width=width, step_length_sigma=sigmas[0], step_width_sigma=sigmas[1]
        )

    def reset(self, site: Site) -> None:
        """Forget a foot whose clock or device has changed."""
        if site.foot is Foot.LEFT:
            self.left = RangedTrack()
        elif site.foot is Foot.RIGHT:
            self.right = RangedTrack()
        self.estimate, self.last, self.pending = None, None, []

    def _add_stride(self, track: RangedTrack, event: StrideTaken, view: FootView) -> None:
        is_level = abs(event.height_change) < MAX_RISE
        stride = track.add_stride(event, view.attitude, is_level and not event.degraded)
        if event.degraded or not is_level:
            self._inflate(is_level)
        if stride is None or not stride.usable:
            return
        is_left = track is self.left
        standing = _standing(stride, self.right if is_left else self.left)
        if self.estimate is not None and standing is not None and abs(stride.turn) < MAX_TURN:
            width = _placement(self.estimate, stride, standing, is_left)[1]
            self.usual_width += (width - self.usual_width) / WIDTH_MEMORY
            if self.usual_width < 0.0:
                self._inflate(False)
        if self.estimate is None:
            self._start(stride, is_left)

    def _inflate(self, is_small: bool) -> None:
        """Add the variance of a small move that was not seen; after a large one, restart with the sensor's errors."""
        if self.estimate is not None and is_small:
            for k in range(2):
                self.estimate.covariance[k][k] += UNSEEN_MOVE * UNSEEN_MOVE
        elif self.estimate is not None:
            known = isfinite(self.estimate.mean[3]) and isfinite(self.estimate.covariance[3][3])
            self.last, self.estimate = self.estimate if known else None, None

    def _start(self, stride: RangedStride, is_left: bool) -> None:
        """Start from a stride that passes the other foot, whose place is assumed with large errors."""
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        standing = _standing(stride, other)
        if standing is None or not other.strides:
            return
        last = other.strides[-1]
        straight = abs(stride.turn) < MAX_TURN and abs(last.turn) < MAX_TURN and last.usable
        own, others = _direction(stride), _direction(last)
        if not straight or min(own[1], others[1]) < MIN_LENGTH or this.t is None:
            return
        left, right = (own, others) if is_left else (others, own)
        ahead, (c, s) = (-0.5 if is_left else 0.5) * own[1], (cos(left[0]), sin(left[0]))
        along, across = STEP_SHARE * STEP_SHARE * own[1] * own[1], WIDTH_SIGMA * WIDTH_SIGMA
        spread = (c * c * along + s * s * across, c * s * (along - across), s * s * along + c * c * across)
        place = (c * ahead + s * FIRST_WIDTH, s * ahead - c * FIRST_WIDTH)
        places = (stride.end, standing) if is_left else (standing, stride.end)
        self.usual_width = FIRST_WIDTH
        self.estimate = RelativePlace()
        self.estimate.start(this.t, *places, place, spread, remainder(left[0] - right[0], tau))
        if self.last is not None:
            self.estimate.keep_errors(self.last)

    def _common_time(self) -> float | None:
        """Return the time of the newest points that both feet have, s; None before any."""
        left, right = self.left.points, self.right.points
        return min(left[-1][0], right[-1][0]) if left and right else None

    def _use_ranges(self) -> None:
        """Use the ranges up to the newest points that both feet have."""
        until = self._common_time()
        if until is None or self.pending[0][0] > until:
            return
        ready = [one for one in self.pending if one[0] <= until]
        self.pending = [one for one in self.pending if one[0] > until]
        for t, measured in ready:
            velocities = self._propagate(t)
            if velocities is not None and self.estimate is not None:
                self.estimate.use_range(measured, *velocities)
                if self.estimate.gated > MAX_GATED:
                    self._inflate(False)

    def _propagate(self, t: float | None) -> tuple[Vec3, Vec3] | None:
        """Propagate the estimate to `t`, s, and return the velocities of both feet there, m/s; None if it cannot."""
        if self.estimate is None or t is None or t < self.estimate.t:
            return None
        left, right = self.left.at(t), self.right.at(t)
        if left is None or right is None:
            return None
        self.estimate.propagate(t, left[0], right[0])
        return left[1], right[1]


def _standing(stride: RangedStride, other: RangedTrack) -> Vec3 | None:
    """Return where the other foot stood while a foot took a stride; None if it did not come to stand in that time."""
    found = [one.end for one in other.strides if stride.t_start < one.t_end < stride.t_end]
    return found[-1] if found else None


def _direction(stride: RangedStride) -> tuple[float, float]:
    """Return direction, rad, and length, m, of a stride in the frame of its track."""
    x, y = stride.end[0] - stride.start[0], stride.end[1] - stride.start[1]
    return atan2(y, x), hypot(x, y)


def _placement(
    estimate: RelativePlace, stride: RangedStride, standing: Vec3, is_left: bool
) -> tuple[float, float, tuple[float, float]]:
    """Return step length and step width, m, and their standard deviations."""
    x, y, turn, _, _ = estimate.mean
    c, s = cos(turn), sin(turn)
    (lx, ly, _), (rx, ry, _) = (stride.end, standing) if is_left else (standing, stride.end)
    dx, dy = rx - estimate.right[0], ry - estimate.right[1]
    mx, my = c * dx - s * dy, s * dx + c * dy
    # the right foot relative to the left one, both at rest, and its derivative with respect to the turn
    vx, vy, wx, wy = x + mx - (lx - estimate.left[0]), y + my - (ly - estimate.left[1]), -my, mx
    direction = _direction(stride)[0] + (0.0 if is_left else turn)
    ux, uy = cos(direction), sin(direction)
    sign = -1.0 if is_left else 1.0
    length, width = sign * (vx * ux + vy * uy), vx * uy - vy * ux
    along, across = (sign * ux, sign * uy, sign * (wx * ux + wy * uy)), (uy, -ux, wx * uy - wy * ux)
    if not is_left:  # the direction turns too
        along = (along[0], along[1], along[2] + sign * (-vx * uy + vy * ux))
        across = (across[0], across[1], across[2] + vx * ux + vy * uy)
    sigmas = [sqrt(_variance(estimate.covariance, row) + PLACEMENT_NOISE * PLACEMENT_NOISE) for row in (along, across)]
    return length, width, (sigmas[0], sigmas[1])


def _variance(covariance: list[list[float]], row: tuple[float, float, float]) -> float:
    value = 0.0
    for j in range(3):
        for k in range(3):
            value += row[j] * covariance[j][k] * row[k]
    return max(0.0, value)
