"""Correction of the heading error of a gap, because wearers walk straight on most of the time.

If a foot comes down after a gap with about the heading that it had before, the gap has caused the difference, which is
removed ("heuristic drift elimination": Borenstein, Ojeda, Kwanmuang, J. Navigation 62, 2009). However many gaps there
are, the error of the heading then stays as small as the difference between one footfall and the next. A wearer who
turns causes a larger difference, which is kept.

Angles are positive to the left. The numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import exp, pi

from ...types.attrs import define, field

STRAIGHT_SHARE = 0.8
"""Prior probability that a stride goes straight on; otherwise it may have any heading."""
FOOTFALL_SIGMA = 0.025
"""Standard deviation of a footfall's heading from the mean heading in straight walking, rad."""
HEADING_MEMORY = 0.3
"""Weight of the newest footfall in the mean heading, 0 to 1."""
NEW_HEADING_TURN, SAMPLED_NEW_HEADING_TURN = 0.12, 0.0625
"""Smallest turn that starts a new mean heading, rad: for a stride with a gap, and without one."""
GAP_TURN_SIGMA = 0.08
"""Standard deviation of the heading after 0.3 s of infill, rad."""


@define
class StraightOn:
    """The mean heading of the footfalls, and the difference of the newest footfall from it."""

    yaw: float = field(default=0.0, init=False)
    """Heading of the newest footfall relative to the first, rad."""
    heading: float = field(default=0.0, init=False)
    """Heading of the newest footfall relative to the mean heading, rad."""
    footfalls: int = field(default=0, init=False)
    """Number of footfalls in the mean heading, counted up to 3, from which on it is used."""

    def repair(self, turn: float, gap_share: float, sparse_interval: float) -> float:
        """Return the most likely correction of a stride's turn, rad.

        `turn`, rad, is measured from foot-flat to foot-flat. `gap_share`, 0 to 1, is the duration of infill in units of
        0.3 s. `sparse_interval`, s, is the interval between samples if a swing has few of them, else 0."""
        if self.footfalls < 3:
            return 0.0
        difference = self.heading + turn
        # the error of a straight line between two samples grows with the square of the time
        heading_sigma = GAP_TURN_SIGMA * min(2.0, gap_share + 200.0 * sparse_interval * sparse_interval)
        return -difference * correction_share(difference * difference, heading_sigma, FOOTFALL_SIGMA, pi, 1)

    def add_footfall(self, turn: float, repair: float, gap_share: float, sparse_interval: float) -> None:
        """Add a foot-flat after a stride with this `turn`, which was corrected by `repair`, rad.

        `gap_share` and `sparse_interval` are the same as in the method `repair`."""
        difference = self.heading + turn + repair
        self.yaw = (self.yaw + (turn + repair) + pi) % (2.0 * pi) - pi
        # a stride without a gap that differs by more than footfalls do is a turn, which may go on in the next stride
        new_heading_turn = NEW_HEADING_TURN if gap_share > 0.0 or sparse_interval > 0.0 else SAMPLED_NEW_HEADING_TURN
        if abs(difference) > new_heading_turn * (1.0 + sparse_interval / 0.1):
            self.heading, self.footfalls = 0.0, 1
        else:
            self.heading = difference * (1.0 - HEADING_MEMORY)
            self.footfalls = min(self.footfalls + 1, 3)


def correction_share(square: float, gap_sigma: float, sigma: float, possible_range: float, dimensions: int) -> float:
    """Return the share of a difference from the usual value that is to be removed, 0 to 1.

    It is the gain of a Kalman update, times the probability that the motion was as usual. Otherwise any value within
    `possible_range` is equally likely. `square` is the square of the difference. `gap_sigma` is the standard deviation
    that the gap causes and `sigma` that of usual motion, all in one unit."""
    variance = gap_sigma * gap_sigma + sigma * sigma
    likelihood = STRAIGHT_SHARE * exp(-0.5 * square / variance) / float((2.0 * pi * variance) ** (0.5 * dimensions))
    return likelihood / (likelihood + (1.0 - STRAIGHT_SHARE) / possible_range) * gap_sigma * gap_sigma / variance
