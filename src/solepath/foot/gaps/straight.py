"""Correction of the heading error of a gap, because wearers walk straight on most of the time.

If a foot comes down after a gap with about the heading that it had before, the gap has caused the difference
("heuristic drift elimination": Borenstein, Ojeda, Kwanmuang, J. Navigation 62, 2009). The heading then errs by the
difference between one footfall and the next, however many gaps there are. A wearer who turns has turned further than
that, and the heading is not changed."""

from __future__ import annotations

from math import exp, pi

from ...types.attrs import define, field

STRAIGHT = 0.8
"""Share of strides that go straight on; the others may have any heading."""
FOOTFALL_SIGMA = 0.025
"""Standard deviation of a footfall's heading from the mean of those before in straight walking, rad."""
HEADING_MEMORY = 0.3
"""Weight of the newest footfall in the mean heading."""
NEW_HEADING, SEEN_NEW_HEADING = 0.12, 0.0625
"""Smallest turn that starts a new mean heading, rad: for a stride with a gap, and without one."""
GAP_TURN = 0.08
"""Standard deviation of the heading after 0.3 s of infill, rad."""


@define
class StraightOn:
    """The mean heading of the footfalls, and the difference of the newest one from it."""

    yaw: float = field(default=0.0, init=False)
    """Heading of the newest footfall relative to the first, rad."""
    heading: float = field(default=0.0, init=False)
    """Heading of the newest footfall relative to the mean heading, rad."""
    footfalls: int = field(default=0, init=False)
    """Number of footfalls in this mean heading, up to 3."""

    def repair(self, turn: float, unsure: float, sparse: float) -> float:
        """Return the most likely correction of a stride's turn, rad.

        `turn`, rad, is measured from foot-flat to foot-flat. `unsure`, 0 to 1, is the share of the stride without
        samples. `sparse`, s, is the interval between samples if a swing has few of them, else 0."""
        if self.footfalls < 3:
            return 0.0
        off = self.heading + turn
        # the error of a straight line between two samples grows with the square of the time
        heading_sigma = GAP_TURN * min(2.0, unsure + 200.0 * sparse * sparse)
        return -off * share(off * off, heading_sigma, FOOTFALL_SIGMA, pi, 1)

    def footfall(self, turn: float, repair: float, unsure: float, sparse: float) -> None:
        """Add a foot-flat with its `turn` and the `repair` of it, rad.

        `unsure` and `sparse` are the same as in `repair`."""
        off = self.heading + turn + repair
        self.yaw = (self.yaw + (turn + repair) + pi) % (2.0 * pi) - pi
        # a stride without a gap that differs by more than footfalls do is a turn of the wearer, and may go on
        bend = NEW_HEADING if unsure > 0.0 or sparse > 0.0 else SEEN_NEW_HEADING
        if abs(off) > bend * (1.0 + sparse / 0.1):
            self.heading, self.footfalls = 0.0, 1
        else:
            self.heading = off * (1.0 - HEADING_MEMORY)
            self.footfalls = min(self.footfalls + 1, 3)


def share(square: float, unsure: float, sigma: float, room: float, dimensions: int) -> float:
    """Return the share of a difference from the usual value to remove.

    It is the gain of a Kalman update, times the probability that the motion was as usual and not anywhere within
    `room`. `square` is the square of the difference."""
    spread = unsure * unsure + sigma * sigma
    likely = STRAIGHT * exp(-0.5 * square / spread) / float((2.0 * pi * spread) ** (0.5 * dimensions))
    return likely / (likely + (1.0 - STRAIGHT) / room) * unsure * unsure / spread
