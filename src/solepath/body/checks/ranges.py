"""Detection of a sensor whose range is too small for the motion, from peaks that end at the same value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ...events import Defect
from ...types import Vec3
from ...types.attrs import define, field
from .finding import Finding

SAME = 1e-4
"""Relative difference within which two values are the same end of a range; peaks differ by more."""
LEAST_BLOCKS, LEAST_PAIRS = 3, 5
"""Number of blocks with, and of pairs of neighbours among, samples at the end of a range that show clipping.

Of 378 recordings of a foot, none of a sensor that does not clip has more than one pair in 20 s of walking."""
SPOILING_SHARE = 0.01
"""Share of the recent samples at the end of a range above which a track cannot be trusted."""
RECENT_SAMPLES = 2000
"""Number of samples after which the share is computed from the later half alone: a wearer may walk slowly first."""

Extremes = tuple[float, float, float, float, float, float]
"""Largest value of x, of -x, of y, of -y, of z and of -z, m/s^2 or rad/s."""


class RangeKind(NamedTuple):
    """The properties of a kind of sensor."""

    name: str
    """Name in sentences."""
    unit: str
    """Unit in sentences."""
    least: float
    """Smallest end of a range that counts; a smaller value is gravity, or the noise of a foot at rest."""


ACCELEROMETER = RangeKind("accelerometer", "m/s^2", 12.0)
"""An accelerometer, m/s^2."""
GYROSCOPE = RangeKind("gyroscope", "rad/s", 2.0)
"""A gyroscope, rad/s."""


def find_extremes(values: Sequence[Vec3]) -> Extremes:
    """Return the extremes of every other sample of a block, among which is one of any two neighbours at an end."""
    most_x, most_y, most_z = least_x, least_y, least_z = values[0]
    for x, y, z in values[::2]:
        if x > most_x:
            most_x = x
        elif x < least_x:
            least_x = x
        if y > most_y:
            most_y = y
        elif y < least_y:
            least_y = y
        if z > most_z:
            most_z = z
        elif z < least_z:
            least_z = z
    return most_x, -least_x, most_y, -least_y, most_z, -least_z


@define
class ChannelEnd:
    """One end of the range of one axis: the largest value so far, and how often it came."""

    largest: float = 0.0
    """Largest value so far, m/s^2 or rad/s."""
    samples: int = 0
    """Number of samples at `largest`."""
    pairs: int = 0
    """Number of neighbours that are both at `largest`."""
    blocks: int = 0
    """Number of blocks with samples at `largest`."""
    first: int = 0
    """Number of samples before those of which `samples` are counted."""


@define
class RangeCheck:
    """Looks at the largest and the smallest value of each axis of one sensor."""

    ends: list[ChannelEnd] = field(factory=lambda: [ChannelEnd() for _ in range(6)])
    """Ends of the ranges: upper and lower end of x, then of y, then of z."""
    samples: int = 0
    """Number of samples so far."""
    cuts_off: bool = False
    """Flag: peaks are cut off."""

    def add(self, kind: RangeKind, values: Sequence[Vec3], extremes: Extremes) -> Finding | None:
        """Add a block of samples with its `find_extremes`; return an end of the range that cuts off peaks, if any."""
        found = None
        if max(extremes) > kind.least:
            for i, (end, extreme) in enumerate(zip(self.ends, extremes, strict=True)):
                if extreme > kind.least and extreme >= end.largest * (1.0 - SAME):
                    axis, sign = i // 2, -1.0 if i % 2 else 1.0
                    if self._add_block(end, [sign * value[axis] for value in values]):
                        found = end
        self.samples += len(values)
        if found is None:
            return None
        self.cuts_off = True
        share = found.samples / (self.samples - found.first)
        if self.samples - found.first > RECENT_SAMPLES:
            found.samples, found.first = found.samples // 2, (found.first + self.samples) // 2
        percent = f"{100.0 * share:.0f}" if share >= 0.1 else f"{100.0 * share:.2g}"
        text = f"the {kind.name} cuts off peaks at {found.largest:.3g} {kind.unit}, in {percent} % of samples"
        return Finding(Defect.CLIPPED, f"{text}: choose a larger range, if it has one", spoils=share > SPOILING_SHARE)

    def _add_block(self, end: ChannelEnd, channel: list[float]) -> bool:
        """Add a block that reaches the end of the range; return whether it now is seen to cut off peaks."""
        extreme = max(channel)
        if extreme > end.largest * (1.0 + SAME):
            end.largest, end.samples, end.pairs, end.blocks, end.first = extreme, 0, 0, 0, self.samples
        limit = end.largest * (1.0 - SAME)
        at_end = [value >= limit for value in channel]
        end.blocks += 1
        end.samples += at_end.count(True)
        end.pairs += [a and b for a, b in zip(at_end, at_end[1:], strict=False)].count(True)
        return end.blocks >= LEAST_BLOCKS and end.pairs >= LEAST_PAIRS
