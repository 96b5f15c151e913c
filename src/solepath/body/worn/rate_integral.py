"""Integral of a foot's angular rate over the last second or two, which sides.py uses."""

from __future__ import annotations

from itertools import accumulate
from struct import Struct

from ...types import Vec3
from ...types.attrs import ROW_SIZE, define, field
from ...types.vector import ZERO

INSTANT = Struct("<i3q")
"""Time since the previous instant, ticks, and the components of the integral, in units of 1 / `UNITS_PER_RAD` rad."""
TICKS_PER_S = 2.0**19
"""Number of ticks in a second; a tick is 2 us."""
UNITS_PER_RAD = 2.0**13
"""Number of units in a radian; a unit is 0.12 mrad."""


@define
class RateIntegral:
    """The integral of the angular rate, rad, by component in the sensor frame (it is not an attitude)."""

    t: float | None = None
    """Time of the newest instant, s; None before any."""
    turn: Vec3 = ZERO
    """Integral up to the newest instant, rad."""
    instants: bytes = field(default=b"", metadata={ROW_SIZE: INSTANT.size})
    """The newest instants, oldest first, as `INSTANT` packs them."""

    def restart(self, t: float) -> None:
        """Start a new integral at `t`, s, because the turn before is not known."""
        self.t, self.turn, self.instants = t, ZERO, INSTANT.pack(0, 0, 0, 0)

    def add(self, t: float, dt: float, gyro: Vec3, max_instants: int) -> None:
        """Add an angular rate, rad/s, at `t`, s; `dt`, s, is the time since the newest instant, at most 0.12 s.

        When there are `max_instants` instants, the oldest eighth is discarded."""
        x, y, z = self.turn
        gx, gy, gz = gyro
        x, y, z = self.turn = (x + dt * gx, y + dt * gy, z + dt * gz)
        self.t = t
        kept, k = self.instants, UNITS_PER_RAD
        if len(kept) >= max_instants * INSTANT.size:
            kept = kept[max_instants // 8 * INSTANT.size :]
        self.instants = kept + INSTANT.pack(int(dt * TICKS_PER_S + 0.5), int(x * k), int(y * k), int(z * k))

    def keep_newest(self) -> None:
        """Discard all instants but the newest."""
        self.instants = self.instants[-INSTANT.size :]

    def clear(self) -> None:
        """Discard all instants."""
        self.t, self.turn, self.instants = None, ZERO, b""

    def times(self) -> list[float]:
        """Return the times of the instants, s, oldest first, accurate to 0.1 ms; an empty list before any."""
        if self.t is None:
            return []
        back = [-row[0] / TICKS_PER_S for row in INSTANT.iter_unpack(self.instants)]
        return [*accumulate([self.t, *back[:0:-1]])][::-1]

    def turns_between(self, i: int, j: int) -> list[Vec3]:
        """Return the turn since instant `i` at each instant from `i` to before `j`, rad."""
        rows = list(INSTANT.iter_unpack(self.instants))
        _, ax, ay, az = rows[i]
        return [
            ((x - ax) / UNITS_PER_RAD, (y - ay) / UNITS_PER_RAD, (z - az) / UNITS_PER_RAD) for _, x, y, z in rows[i:j]
        ]
