"""How a foot has turned over its last second or two: what sides.py sees a step by."""

from __future__ import annotations

from itertools import accumulate

from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO

Instant = tuple[int, int, int, int]
"""The time since the one before, in ticks, and the three parts of the turn up to it, in steps."""
TICKS = 2.0**19
"""Of the time, a second: 2 us."""
STEPS = 2.0**13
"""Of the turn, a radian: 0.12 mrad."""


@define
class RateIntegral:
    """The integral of the angular rate, rad, sensor frame: its parts along axes that are fixed in the foot."""

    t: float | None = None
    """The newest instant, s; None before any."""
    turn: Vec3 = ZERO
    """The integral up to it."""
    rows: list[Instant] = field(factory=list)
    """The newest instants, oldest first."""

    def begin(self, t: float) -> None:
        """Of what was before nothing is known."""
        self.t, self.turn, self.rows = t, ZERO, [(0, 0, 0, 0)]

    def add(self, t: float, dt: float, gyro: Vec3, most: int) -> None:
        """An angular rate at `t`, s, in rad/s, for `dt` s since the newest instant, 0.12 s at the most. Of more than
        `most` instants an eighth is forgotten."""
        x, y, z = self.turn
        gx, gy, gz = gyro
        x, y, z = self.turn = (x + dt * gx, y + dt * gy, z + dt * gz)
        self.t = t
        if len(self.rows) >= most:
            del self.rows[: most // 8]
        k = STEPS
        self.rows.append((int(dt * TICKS + 0.5), int(x * k), int(y * k), int(z * k)))

    def keep_newest(self) -> None:
        """All others are of no more use."""
        del self.rows[:-1]

    def forget(self) -> None:
        """All of it is of no more use."""
        self.t, self.turn, self.rows = None, ZERO, []

    def times(self) -> list[float]:
        """Of the instants, s, oldest first; none before any. They are right to 0.1 ms."""
        if self.t is None:
            return []
        back = [-row[0] / TICKS for row in self.rows]
        return [*accumulate([self.t, *back[:0:-1]])][::-1]

    def between(self, i: int, j: int) -> list[Vec3]:
        """How it has turned since instant `i` at each one from there to before `j`, rad."""
        _, ax, ay, az = self.rows[i]
        return [((x - ax) / STEPS, (y - ay) / STEPS, (z - az) / STEPS) for _, x, y, z in self.rows[i:j]]
