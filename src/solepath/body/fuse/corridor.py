"""Straight ways: what a heading that drifts looks like to somebody who walks straight on.

Borenstein and Ojeda, "Heuristic drift elimination for personnel tracking systems", Journal of Navigation 63, 2010, take
whoever seems to walk straight as walking straight. Nothing measures that: it is a belief about corridors. A bend of
700 m in radius looks, at a walk, like a gyroscope that drifts by a tenth of a degree a second, so who walks such bends
must not ask for it.

The way is cut into blocks that both feet walk. Blocks in a row whose strides all point one way are a run; the
direction of its first block is held. How much of a difference is drift follows from how fast a heading is known to
drift: a filter of two states, the heading (rad) since the run began and the rate of its drift (rad/s), is corrected by
each block. A difference beyond what drift explains ends the run: a bend of less than some 300 m in radius is never
straightened.
"""

from __future__ import annotations

from math import atan2, exp, hypot, pi

from ...types import Vec3
from ...types.attrs import define, field

MOST = 60
"""Strides of one block: more are no walk."""
BLOCK_WAY = 5.0
"""Length of a block, m."""
STRAIGHT, FOOT_TURN = 0.1, 0.17
"""No stride of a block points further off its direction than the first, rad, nor does the foot turn further in one than
the second, rad."""
SHORTEST_STRIDE = 0.3
"""A shorter stride is no walk, m."""
PAUSE = 3.0
"""Who does not step for so long stands between, s."""
DIRECTION_NOISE = 0.005
"""Standard deviation of a block's direction, rad: feet come down some centimetres to either side."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""How fast the heading of the wearer drifts as a rule, rad/s, and for how long it does so, s."""
HEADING_DRIFT = 0.001
"""Growth of the heading error besides, rad/sqrt(s)."""
BELIEVED = 9.0
"""Largest normalised square of a difference that is taken for drift."""


@define
class Corridor:
    """Strides of both feet in, corrections of the heading out, each with the stride that ends a block."""

    begins: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Where the block began, left and right, m."""
    ends: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Where it has come to."""
    headings: list[float] = field(factory=list, init=False)
    """Of its strides, rad."""
    began: float = field(default=0.0, init=False)
    """When its first stride was over, s."""
    newest: float | None = field(default=None, init=False)
    """When the last stride was, s."""
    heading: float | None = field(default=None, init=False)
    """Of the run, rad; None before its first block."""
    known: float | None = field(default=None, init=False)
    """The time that `drift` is of, s."""
    drift: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)
    """Covariance of the two states: rad^2, rad^2/s, rad^2/s^2."""

    def stride(self, foot: int, t: float, start: Vec3, end: Vec3, turn: float) -> tuple[float, float] | None:
        """A stride of foot 0 or 1 that ended at `t`, s, in one frame for both, m; the foot turned by `turn` rad.

        Returns what to add to the heading, rad, and to the rate at which it is turned on, rad/s.
        """
        dx, dy = end[0] - start[0], end[1] - start[1]
        stood = self.newest is None or t - self.newest > PAUSE
        self.newest = t
        if stood or abs(turn) > FOOT_TURN or hypot(dx, dy) < SHORTEST_STRIDE or len(self.headings) >= MOST:
            self.end()
            return None
        if not self.headings:
            self.began = t
        self.headings.append(atan2(dy, dx))
        if self.begins[foot] is None:
            self.begins[foot] = start
        self.ends[foot] = end
        x = y = 0.0
        for begin, reached in zip(self.begins, self.ends, strict=True):
            if begin is None or reached is None:
                return None
            x, y = x + 0.5 * (reached[0] - begin[0]), y + 0.5 * (reached[1] - begin[1])
        return self._block(t, atan2(y, x)) if hypot(x, y) >= BLOCK_WAY else None

    def end(self) -> None:
        """The run is over; what was learnt of the drift stays."""
        self.begins, self.ends, self.headings = [None, None], [None, None], []
        self.heading = None

    def reset(self) -> None:
        """Times begin anew."""
        self.end()
        self.newest = self.known = None

    def _block(self, t: float, heading: float) -> tuple[float, float] | None:
        middle = 0.5 * (self.began + t)
        straight = all([abs(wrapped(one - heading)) < STRAIGHT for one in self.headings])
        self.begins, self.headings = [*self.ends], []
        if not straight:
            self.end()
            return None
        noise = DIRECTION_NOISE * DIRECTION_NOISE
        self._until(middle)
        if self.heading is None:
            self.heading = heading
            self.drift = (noise, 0.0, self.drift[2])
            return None
        pp, pr, rr = self.drift
        angle, s = wrapped(heading - self.heading), pp + noise
        if angle * angle > BELIEVED * s:
            self.end()
            return None
        a, b = pp / s, pr / s
        self.drift = ((1.0 - a) * pp, (1.0 - a) * pr, rr - b * pr)
        return (-a * angle - b * angle * (t - middle), -b * angle)

    def _until(self, t: float) -> None:
        """The two states at `t`, s."""
        usual = DRIFT_RATE * DRIFT_RATE
        if self.known is None:
            self.known, self.drift = t, (0.0, 0.0, usual)
        dt = max(0.0, t - self.known)
        self.known = t
        pp, pr, rr = self.drift
        keep = exp(-dt / DRIFT_MEMORY)
        self.drift = (
            pp + 2.0 * dt * pr + dt * dt * rr + HEADING_DRIFT * HEADING_DRIFT * dt,
            keep * (pr + dt * rr),
            keep * keep * rr + usual * (1.0 - keep * keep),
        )


def wrapped(angle: float) -> float:
    """Within half a turn, rad."""
    return (angle + pi) % (2.0 * pi) - pi
