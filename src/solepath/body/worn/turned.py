"""How a foot has turned over its last second or two, eight bytes an instant: what sides.py sees a step by."""

from __future__ import annotations

from itertools import accumulate
from struct import Struct

from attrs import define

from ...types import Vec3
from ...types.vector import ZERO

ROW = Struct("<4H")
"""An instant: the time since the one before, and the three parts of the turn, all of them modulo 2^16."""
TICKS = 2.0**19
"""Of the time, a second: 2 us, and no more than 0.125 s."""
STEPS = 2.0**13
"""Of the turn, a radian: 0.12 mrad. Two instants of a step are less than 4 rad apart, half of what 16 bits hold."""
ALL, HALF = 1 << 16, 1 << 15
SIZE = ROW.size
_pack = ROW.pack


@define
class RateIntegral:
    """The integral of the angular rate, rad, sensor frame: its parts along axes that are fixed in the foot."""

    t: float | None = None
    """The newest instant, s; None before any."""
    turn: Vec3 = ZERO
    """The integral up to it."""
    rows: bytes = b""
    """The newest instants, oldest first (`ROW`)."""

    def begin(self, t: float) -> None:
        """Of what was before nothing is known."""
        self.t, self.turn, self.rows = t, ZERO, ROW.pack(0, 0, 0, 0)

    def add(self, t: float, dt: float, gyro: Vec3, most: int) -> None:
        """An angular rate at `t`, s, in rad/s, for `dt` s since the newest instant, 0.12 s at the most. Of more than
        `most` instants an eighth is forgotten."""
        x, y, z = self.turn
        gx, gy, gz = gyro
        x, y, z = self.turn = (x + dt * gx, y + dt * gy, z + dt * gz)
        self.t = t
        rows = self.rows
        if len(rows) >= most * SIZE:
            rows = rows[most // 8 * SIZE :]
        k, low = STEPS, ALL - 1
        self.rows = rows + _pack(int(dt * TICKS + 0.5), int(x * k) & low, int(y * k) & low, int(z * k) & low)

    def keep_newest(self) -> None:
        """All others are of no more use."""
        self.rows = self.rows[-SIZE:]

    def forget(self) -> None:
        """All of it is of no more use."""
        self.t, self.turn, self.rows = None, ZERO, b""

    def times(self) -> list[float]:
        """Of the instants, s, oldest first; none before any. They are right to 0.1 ms."""
        if self.t is None:
            return []
        back = [-row[0] / TICKS for row in ROW.iter_unpack(self.rows)]
        return [*accumulate([self.t, *back[:0:-1]])][::-1]

    def between(self, i: int, j: int) -> list[Vec3]:
        """How it has turned since instant `i` at each one from there to before `j`, rad."""
        rows = self.rows[i * SIZE : j * SIZE]
        _, ax, ay, az = ROW.unpack_from(rows)
        return [
            (
                ((x - ax + HALF) % ALL - HALF) / STEPS,
                ((y - ay + HALF) % ALL - HALF) / STEPS,
                ((z - az + HALF) % ALL - HALF) / STEPS,
            )
            for _, x, y, z in ROW.iter_unpack(rows)
        ]
