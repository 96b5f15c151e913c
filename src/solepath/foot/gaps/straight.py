"""Who walks goes straight on most of the time: what a gap has turned is told from what the wearer has.

When a foot comes down after a gap about as it stood before, it was the gap that turned it ("heuristic drift
elimination": Borenstein, Ojeda, Kwanmuang, J. Navigation 62, 2009), and then its heading errs by what one footfall
differs from the next, however many gaps there are. A wearer who turned has turned further than that, and is left alone.
"""

from __future__ import annotations

from math import exp, pi

from ...types.attrs import define, field

STRAIGHT = 0.8
"""Share of strides that go on as those before; the others go anywhere."""
FOOTFALL_SIGMA = 0.025
"""What the heading of one footfall differs by from those before, of who walks straight on, rad."""
HEADING_MEMORY = 0.3
"""Weight of the newest footfall in the heading that is kept."""
NEW_HEADING, SEEN_NEW_HEADING = 0.12, 0.0625
"""A footfall turned further than this begins another heading, rad, and one that was seen whole further than the
other."""
GAP_TURN = 0.08
"""What a stride's heading errs by after a third of a second by habit, rad."""


@define
class StraightOn:
    """The heading that the footfalls keep, and how far the newest one is off it."""

    yaw: float = field(default=0.0, init=False)
    """Heading of the newest footfall against the first, rad."""
    heading: float = field(default=0.0, init=False)
    """Of the newest footfall against the heading that is kept, rad."""
    footfalls: int = field(default=0, init=False)
    """So many in this heading, up to 3."""

    def repair(self, turn: float, unsure: float, sparse: float) -> float:
        """The foot is flat, turned by `turn` (rad) since it was so last; what to add to that most likely, rad.

        `unsure`, 0 to 1: how much of the stride was not seen. `sparse`, s: the time between samples where few make a
        swing, else 0.
        """
        if self.footfalls < 3:
            return 0.0
        off = self.heading + turn
        # between two samples a straight line errs by the square of the time
        heading_sigma = GAP_TURN * min(2.0, unsure + 200.0 * sparse * sparse)
        return -off * share(off * off, heading_sigma, FOOTFALL_SIGMA, pi, 1)

    def footfall(self, turn: float, repair: float, unsure: float, sparse: float) -> None:
        """The foot is flat, turned by `turn` and `repair`, rad; the others as above."""
        off = self.heading + turn + repair
        self.yaw = (self.yaw + (turn + repair) + pi) % (2.0 * pi) - pi
        # what was seen whole and is further off than footfalls are is the wearer's doing, and so may the next be
        bend = NEW_HEADING if unsure > 0.0 or sparse > 0.0 else SEEN_NEW_HEADING
        if abs(off) > bend * (1.0 + sparse / 0.1):
            self.heading, self.footfalls = 0.0, 1
        else:
            self.heading = off * (1.0 - HEADING_MEMORY)
            self.footfalls = min(self.footfalls + 1, 3)


def share(square: float, unsure: float, sigma: float, room: float, dimensions: int) -> float:
    """How much of a difference to what is usual (its square is given) to take back: what a Kalman update would, times
    how likely it is that things were as usual and did not go anywhere within `room`."""
    spread = unsure * unsure + sigma * sigma
    likely = STRAIGHT * exp(-0.5 * square / spread) / float((2.0 * pi * spread) ** (0.5 * dimensions))
    return likely / (likely + (1.0 - STRAIGHT) / room) * unsure * unsure / spread
