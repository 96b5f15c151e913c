"""Heading drift of a wearer who walks straight corridors.

Borenstein and Ojeda, "Heuristic drift elimination for personnel tracking systems", Journal of Navigation 63, 2010,
assume that a nearly straight path is straight. No sensor measures that; it is an assumption about corridors. At walking
speed, a bend of 700 m in radius looks like a gyroscope that drifts by 0.1 degrees per second. A wearer who walks such
bends must not choose this setting.

The path is cut into sections of both feet's strides. Consecutive sections in which all strides have nearly one
direction form a straight; the direction of the first section is the reference of the straight. A Kalman filter of two
states, the heading error (rad) since the straight started and its drift rate (rad/s), decides how much of a section's
difference to the reference is drift. A difference that drift does not explain ends the straight, so a bend of less than
some 300 m in radius is never straightened."""

from __future__ import annotations

from math import atan2, exp, hypot, pi

from ...types import Vec3
from ...types.attrs import define, field

MAX_STRIDES = 60
"""Largest number of strides in one section; more strides in its length are not walking."""
SECTION_LENGTH = 5.0
"""Length of a section, m."""
MAX_DIRECTION_DEVIATION, MAX_TURN = 0.1, 0.17
"""Largest angle between a stride and its section, and largest turn of a foot in a stride, rad, in a straight."""
MIN_STRIDE_LENGTH = 0.3
"""Shortest stride that counts as walking, m."""
MAX_PAUSE = 3.0
"""Longest time between two strides of a straight, s."""
DIRECTION_NOISE = 0.005
"""Standard deviation of a section's direction, rad, because feet land some centimetres to either side."""
DRIFT_RATE, DRIFT_MEMORY = 0.0012, 100.0
"""Standard deviation of the drift rate of the heading, rad/s, and its correlation time, s."""
HEADING_DRIFT = 0.001
"""Random walk of the heading error that adds to the drift rate, rad/sqrt(s)."""
INNOVATION_GATE = 9.0
"""Largest squared difference, divided by its variance, that is attributed to drift."""


@define
class Corridor:
    """Detects straights in the strides of both feet and returns a heading correction at the end of each section."""

    starts: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Start of the section for the left and the right foot, m, common frame of both tracks."""
    ends: list[Vec3 | None] = field(factory=lambda: [None, None], init=False)
    """Newest end of a stride in the section for the left and the right foot, m."""
    headings: list[float] = field(factory=list, init=False)
    """Directions of the strides in the section, rad."""
    t_start: float = field(default=0.0, init=False)
    """End of the section's first stride, s."""
    newest_end: float | None = field(default=None, init=False)
    """End of the newest stride, s."""
    heading: float | None = field(default=None, init=False)
    """Direction of the first section of the straight, rad; None before any."""
    drift_at: float | None = field(default=None, init=False)
    """Time for which `drift` is valid, s."""
    drift: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)
    """Covariance of heading error and drift rate: variance, rad^2; covariance, rad^2/s; variance, rad^2/s^2."""

    def add_stride(self, foot: int, t: float, start: Vec3, end: Vec3, turn: float) -> tuple[float, float] | None:
        """Add a stride of foot 0 (left) or 1 that ended at `t`, s, with a turn of `turn` rad; return the correction.

        `start` and `end` are in the common frame of both tracks, m. The correction has a value to add to the heading,
        rad, and one to add to its rate, rad/s; it is None unless the stride ends a section of a straight."""
        dx, dy = end[0] - start[0], end[1] - start[1]
        paused = self.newest_end is None or t - self.newest_end > MAX_PAUSE
        self.newest_end = t
        if paused or abs(turn) > MAX_TURN or hypot(dx, dy) < MIN_STRIDE_LENGTH or len(self.headings) >= MAX_STRIDES:
            self.end()
            return None
        if not self.headings:
            self.t_start = t
        self.headings.append(atan2(dy, dx))
        if self.starts[foot] is None:
            self.starts[foot] = start
        self.ends[foot] = end
        x = y = 0.0
        for section_start, section_end in zip(self.starts, self.ends, strict=True):
            if section_start is None or section_end is None:
                return None
            x, y = x + 0.5 * (section_end[0] - section_start[0]), y + 0.5 * (section_end[1] - section_start[1])
        return self._end_section(t, atan2(y, x)) if hypot(x, y) >= SECTION_LENGTH else None

    def end(self) -> None:
        """End the straight; the learnt drift rate stays."""
        self.starts, self.ends, self.headings = [None, None], [None, None], []
        self.heading = None

    def reset(self) -> None:
        """End the straight and discard its times, because the clock restarts."""
        self.end()
        self.newest_end = self.drift_at = None

    def _end_section(self, t: float, heading: float) -> tuple[float, float] | None:
        middle = 0.5 * (self.t_start + t)
        straight = all([abs(wrap_angle(direction - heading)) < MAX_DIRECTION_DEVIATION for direction in self.headings])
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
        angle, s = wrap_angle(heading - self.heading), pp + noise
        if angle * angle > INNOVATION_GATE * s:
            self.end()
            return None
        a, b = pp / s, pr / s
        self.drift = ((1.0 - a) * pp, (1.0 - a) * pr, rr - b * pr)
        # minus: corrections oppose the drift; the heading's is extrapolated from the middle of the section to its end
        return (-a * angle - b * angle * (t - middle), -b * angle)

    def _propagate(self, t: float) -> None:
        """Propagate the two states to `t`, s."""
        usual = DRIFT_RATE * DRIFT_RATE
        if self.drift_at is None:
            self.drift_at, self.drift = t, (0.0, 0.0, usual)
        dt = max(0.0, t - self.drift_at)
        self.drift_at = t
        pp, pr, rr = self.drift
        decay = exp(-dt / DRIFT_MEMORY)
        self.drift = (
            pp + 2.0 * dt * pr + dt * dt * rr + HEADING_DRIFT * HEADING_DRIFT * dt,
            decay * (pr + dt * rr),
            decay * decay * rr + usual * (1.0 - decay * decay),
        )


def wrap_angle(angle: float) -> float:
    """Return the angle plus whole turns, from -pi to pi, rad."""
    return (angle + pi) % (2.0 * pi) - pi
