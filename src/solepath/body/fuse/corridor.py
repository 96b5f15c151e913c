"""Straight corridors: the heading drift of a wearer who walks straight on.

Borenstein and Ojeda, "Heuristic drift elimination for personnel tracking systems", Journal of Navigation 63, 2010, take
whoever seems to walk straight as walking straight. Nothing measures that: it is an assumption about corridors. A bend
of 700 m in radius looks, at walking speed, like a gyroscope that drifts by a tenth of a degree a second; a wearer who
walks such bends must not choose this setting.

The path is cut into blocks that both feet walk. Consecutive blocks whose strides all point one way are a run; the
direction of its first block is held. The share of a difference that is drift follows from how fast a heading is known
to drift: a filter of two states, the heading (rad) since the run started and its drift rate (rad/s), is corrected by
each block. A difference beyond what drift explains ends the run: a bend of less than some 300 m in radius is never
straightened."""

from __future__ import annotations

from math import atan2, exp, hypot, pi

from ...types import Vec3
from ...types.attrs import define, field

MOST_STRIDES = 60
"""Largest number of strides in one block; more are no walk."""
BLOCK_LENGTH = 5.0
"""Length of a block, m."""
LARGEST_DEVIATION, LARGEST_TURN = 0.1, 0.17
"""Largest angle between a stride and its straight block, and largest turn of a foot in a stride, rad."""
SHORTEST_STRIDE = 0.3
"""Length of the shortest stride that is walking, m."""
PAUSE = 3.0
"""Longest time between strides of one walk, s; after a longer one the wearer has stood."""
DIRECTION_NOISE = 0.005
"""Standard deviation of a block's direction, rad: feet come down some centimetres to either side."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""Usual drift rate of the wearer's heading, rad/s, and for how long it lasts, s."""
HEADING_DRIFT = 0.001
"""Random walk of the heading error that adds to the drift rate, rad/sqrt(s)."""
INNOVATION_GATE = 9.0
"""Limit of the normalised squared difference that is taken for drift."""


@define
class Corridor:
    """Detects straight runs in the strides of both feet and returns a heading correction at the end of each block."""

    starts: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Start of the block for the left and the right foot, m."""
    ends: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Newest end of a stride in the block for the left and the right foot, m."""
    headings: list[float] = field(factory=list, init=False)
    """Directions of the block's strides, rad."""
    t_start: float = field(default=0.0, init=False)
    """End of the block's first stride, s."""
    newest: float | None = field(default=None, init=False)
    """End of the newest stride, s."""
    heading: float | None = field(default=None, init=False)
    """Direction of the run, rad; None before its first block."""
    drift_at: float | None = field(default=None, init=False)
    """Time at which `drift` holds, s."""
    drift: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)
    """Covariance of heading and drift rate: rad^2, rad^2/s, rad^2/s^2."""

    def add_stride(self, foot: int, t: float, start: Vec3, end: Vec3, turn: float) -> tuple[float, float] | None:
        """Add a stride of foot 0 or 1 that ended at `t`, s, in one frame for both, m; the foot turned by `turn` rad.

        Returns the corrections of the heading, rad, and of the rate at which it is turned on, rad/s."""
        dx, dy = end[0] - start[0], end[1] - start[1]
        paused = self.newest is None or t - self.newest > PAUSE
        self.newest = t
        if paused or abs(turn) > LARGEST_TURN or hypot(dx, dy) < SHORTEST_STRIDE or len(self.headings) >= MOST_STRIDES:
            self.end()
            return None
        if not self.headings:
            self.t_start = t
        self.headings.append(atan2(dy, dx))
        if self.starts[foot] is None:
            self.starts[foot] = start
        self.ends[foot] = end
        x = y = 0.0
        for first, reached in zip(self.starts, self.ends, strict=True):
            if first is None or reached is None:
                return None
            x, y = x + 0.5 * (reached[0] - first[0]), y + 0.5 * (reached[1] - first[1])
        return self._block(t, atan2(y, x)) if hypot(x, y) >= BLOCK_LENGTH else None

    def end(self) -> None:
        """End the run; the learnt drift rate stays."""
        self.starts, self.ends, self.headings = [None, None], [None, None], []
        self.heading = None

    def reset(self) -> None:
        """Reset the run and its times: they restart."""
        self.end()
        self.newest = self.drift_at = None

    def _block(self, t: float, heading: float) -> tuple[float, float] | None:
        middle = 0.5 * (self.t_start + t)
        straight = all([abs(wrapped(one - heading)) < LARGEST_DEVIATION for one in self.headings])
        self.starts, self.headings = [*self.ends], []
        if not straight:
            self.end()
            return None
        noise = DIRECTION_NOISE * DIRECTION_NOISE
        self._propagate(middle)
        if self.heading is None:
            self.heading = heading
            self.drift = (noise, 0.0, self.drift[2])
            return None
        pp, pr, rr = self.drift
        angle, s = wrapped(heading - self.heading), pp + noise
        if angle * angle > INNOVATION_GATE * s:
            self.end()
            return None
        a, b = pp / s, pr / s
        self.drift = ((1.0 - a) * pp, (1.0 - a) * pr, rr - b * pr)
        return (-a * angle - b * angle * (t - middle), -b * angle)

    def _propagate(self, t: float) -> None:
        """Propagate the two states to `t`, s."""
        usual = DRIFT_RATE * DRIFT_RATE
        if self.drift_at is None:
            self.drift_at, self.drift = t, (0.0, 0.0, usual)
        dt = max(0.0, t - self.drift_at)
        self.drift_at = t
        pp, pr, rr = self.drift
        keep = exp(-dt / DRIFT_MEMORY)
        self.drift = (
            pp + 2.0 * dt * pr + dt * dt * rr + HEADING_DRIFT * HEADING_DRIFT * dt,
            keep * (pr + dt * rr),
            keep * keep * rr + usual * (1.0 - keep * keep),
        )


def wrapped(angle: float) -> float:
    """Return the angle within half a turn, rad."""
    return (angle + pi) % (2.0 * pi) - pi
