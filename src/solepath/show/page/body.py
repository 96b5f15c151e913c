"""Computes the body figure of a page: the legs at a touchdown, or some times a second from the session itself."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, isfinite
from typing import Any

from attrs import define, field

from ...session import Session
from ...types import Vec3
from .messages import rounded, rounded_all

Legs = tuple[float, tuple[tuple[Vec3, ...], tuple[Vec3, ...]]]
"""Time, s, and rods of the left and the right leg: hip, knee, ankle and end of the foot as in `TouchedDown.legs`, m."""
INTERVAL = 0.1
"""Least time between two figures, s: enough to see how the legs move; chosen by hand."""


@define
class LiveBody:
    """The legs of a session that is shown, read when a watcher gets a frame, so that no event is needed for them.

    `legs` returns them (`legs_of`) for the session that is shown now, which a player replaces when it seeks."""

    legs: Callable[[], Legs | None]
    _updated_at: float | None = field(default=None, init=False)
    """Time of the session of the newest figure, s."""
    _frame: dict[str, Any] | None = field(default=None, init=False)

    def frame(self, now: float) -> dict[str, Any] | None:
        """Return the member "body" of a frame at `now`, s, a new one every INTERVAL at most; None without legs."""
        if self._updated_at is None or abs(now - self._updated_at) >= INTERVAL:
            legs, self._updated_at = self.legs(), now
            self._frame = None if legs is None else body_frame(*legs)
        return self._frame


def legs_of(session: Session) -> Legs | None:
    """Return the newest legs of a session whose recipe has them; None for others, and while an attitude is missing."""
    legs: Legs | None = session._state.find_attribute("legs")
    return legs


def body_frame(t: float, legs: tuple[tuple[Vec3, ...], tuple[Vec3, ...]]) -> dict[str, Any] | None:
    """Return the member "body": the legs at `t`, s, seen from the wearer's right; None if no direction is ahead.

    Coordinates are ahead of the middle of the hips and above it, m. Ahead is the mean horizontal direction from the
    ankles to the ends of the feet."""
    x = y = 0.0
    for _, _, ankle, end in legs:
        x, y = x + end[0] - ankle[0], y + end[1] - ankle[1]
    length = hypot(x, y)
    if not (isfinite(length) and length > 0.0):
        return None
    sides = [[[(a * x + b * y) / length, up] for a, b, up in leg] for leg in legs]
    left, right = [[rounded_all(point) for point in side] for side in sides]
    return {"t": rounded(t), "left": left, "right": right}
