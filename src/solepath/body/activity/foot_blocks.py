"""The newest half seconds of one foot: sums of samples, and what its strides were like."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import sqrt
from typing import Protocol

from ...events import Event, FootFlat, HeelStrike, StrideTaken
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO
from .block import ActivityBlock, BlockStride
from .features import BEYOND, BEYOND_RATE, BINS, BLOCK, REACH, features_of

KEPT = 2 * REACH + 1
"""Blocks that are kept."""
STEPS = 3
"""Strides that are kept: as many as a window holds of a runner."""
LONGEST = 1.6
"""A stride that lasted longer began with standing, s."""


class FootTrack(Protocol):
    """Where a foot is: position in m and velocity in m/s, z up."""

    @property
    def position(self) -> Vec3: ...
    @property
    def velocity(self) -> Vec3: ...


@define
class FootBlocks:
    """The newest blocks of one foot. `add` every sample; `close` when a block is over; `features` of a block."""

    index: int | None = None
    """Of the block under way."""
    force: float = 0.0
    squares: float = 0.0
    acc_bins: list[int] = field(factory=lambda: [0] * BINS)
    """Of the samples of the block under way; every one is in a bin."""
    rate_squares: float = 0.0
    gyro_bins: list[int] = field(factory=lambda: [0] * BINS)
    bias: Vec3 = ZERO
    """Of the gyroscope, rad/s, as the foot had it when the block began."""
    grain: float = 0.0
    """What a count of its accelerometer is worth, m/s^2; 0 when nobody knows."""
    tracked: bool = False
    climb: float = 0.0
    sink: float = 0.0
    speed: float = 0.0
    flat: float = 0.0
    """Height at the last foot-flat, navigation frame, m."""
    top: float = 0.0
    bottom: float = 0.0
    struck: float | None = None
    blocks: deque[ActivityBlock] = field(factory=deque)
    """The newest, at most `KEPT`, oldest first."""
    steps: deque[BlockStride] = field(factory=deque)

    def begin(self, index: int, bias: Vec3, grain: float) -> None:
        """A block begins. `bias`: of the gyroscope, rad/s; `grain`: what a count of the accelerometer is worth, m/s^2,
        0 when nobody knows."""
        self.index = index
        self.force = self.squares = self.rate_squares = 0.0
        self.acc_bins = [0] * BINS
        self.gyro_bins = [0] * BINS
        self.bias = bias
        self.grain = grain
        self.tracked = False
        self.climb = self.sink = self.speed = 0.0

    def add(self, acc: Vec3, gyro: Vec3 | None, track: FootTrack | None) -> None:
        """A sample of the block under way. `track`: where the foot is after it; None when nobody knows."""
        x, y, z = acc
        square = x * x + y * y + z * z
        length = sqrt(square)
        self.force += length
        self.squares += square
        self.acc_bins[int(length * 0.5) if length < BEYOND else BINS - 1] += 1
        if gyro is None:
            return
        x, y, z = gyro
        bx, by, bz = self.bias
        x -= bx
        y -= by
        z -= bz
        square = x * x + y * y + z * z
        self.rate_squares += square
        self.gyro_bins[int(sqrt(square)) if square < BEYOND_RATE else BINS - 1] += 1
        if track is None:
            return
        self.tracked = True
        x, y, z = track.velocity
        if z > self.climb:
            self.climb = z
        elif z < self.sink:
            self.sink = z
        square = x * x + y * y
        if square > self.speed:
            self.speed = square
        z = track.position[2]
        if z > self.top:
            self.top = z
        elif z < self.bottom:
            self.bottom = z

    def heard(self, events: Sequence[Event], height: float) -> None:
        """What came of the sample, and how high the foot is, m."""
        for event in events:
            if isinstance(event, StrideTaken):
                self._stepped(event)
            elif isinstance(event, HeelStrike):
                self.struck = height
        for event in events:
            if isinstance(event, FootFlat):
                self.flat = self.top = self.bottom = height
                self.struck = None

    def close(self) -> None:
        """The block under way is over."""
        n, rates = sum(self.acc_bins), sum(self.gyro_bins)
        if self.index is None or not n:
            return
        mean = self.force / n
        self.blocks.append(
            ActivityBlock(
                self.index,
                n,
                round(mean, 6),
                round(max(0.0, self.squares / n - mean * mean), 6),
                _limited(self.acc_bins),
                rates,
                round(self.rate_squares / rates, 6) if rates else 0.0,
                _limited(self.gyro_bins),
                self.tracked,
                round(self.climb, 4),
                round(self.sink, 4),
                round(sqrt(self.speed), 4),
            )
        )
        if len(self.blocks) > KEPT:
            self.blocks.popleft()

    def _stepped(self, step: StrideTaken) -> None:
        seen = step.features
        # heights as integration has them: what is told from them was learnt so
        rise = step.height_change if seen.rise is None else seen.rise
        clearance = seen.clearance + max(step.height_change, 0.0) - max(rise, 0.0)
        self.steps.append(
            BlockStride(
                step.t_start,
                step.t_end,
                round(step.length, 4),
                round(rise, 4),
                round(clearance, 4),
                round(seen.peak_speed, 4),
                round(seen.swing_pitch, 4),
                round(self.top - self.flat, 4),
                round(self.bottom - self.flat, 4),
                round((self.struck if self.struck is not None else self.flat) - self.flat, 4),
            )
        )
        if len(self.steps) > STEPS:
            self.steps.popleft()

    def restart(self) -> None:
        """Times begin anew."""
        self.index = None
        self.acc_bins = [0] * BINS
        self.blocks.clear()
        self.steps.clear()

    def block(self, index: int) -> ActivityBlock | None:
        """The block of that number; None when nothing was heard in it."""
        for block in self.blocks:
            if block.index == index:
                return block
        return None

    def features(self, index: int, t: float) -> list[float] | None:
        """Of the block of that number, whose middle is at `t` s, with `REACH` blocks before and after it; None when
        nothing was heard in it."""
        here = self.block(index)
        if here is None:
            return None
        near = [block for block in self.blocks if -REACH <= block.index - index <= REACH]
        return features_of(here, near, self._step(t))

    def _step(self, t: float) -> BlockStride | None:
        """The step that was under way at `t` s, or was a quarter of a second off."""
        best, nearest = None, 0.5 * BLOCK
        for step in self.steps:
            start = max(step.start, step.end - LONGEST)
            away = max(start - t, t - step.end, 0.0)
            if away <= nearest:
                best, nearest = step, away
        return best


def _limited(bins: list[int]) -> tuple[int, ...]:
    return tuple([min(n, 255) for n in bins])
