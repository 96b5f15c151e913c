"""Computes the body figure of a page: the legs at a touchdown, or some times a second from the session itself."""

from __future__ import annotations

from math import hypot, inf
from typing import Any

from attrs import define, field

from ...session import Session
from ...types import Vec3
from .messages import plain

Legs = tuple[tuple[Vec3, ...], tuple[Vec3, ...]]
"""Rods of the left and the right leg: hip, knee, ankle and end of the foot as in `TouchedDown.legs`, m."""
INTERVAL = 0.1
"""Least time between two figures, s: enough to see how the legs move; chosen by hand."""


@define
class LiveBody:
    """The legs of a session that is shown, read when a watcher gets a frame, so that no event is needed for them."""

    session: Session
    _updated_at: float | None = field(default=None, init=False)
    """Time of the session of the newest figure, s."""
    _frame: dict[str, Any] | None = field(default=None, init=False)

    def frame(self, now: float) -> dict[str, Any] | None:
        """Return the member "body" of a frame at `now`, s, a new one every INTERVAL at most.

        It is None for a recipe without legs, and while an attitude is missing."""
        if self._updated_at is None or abs(now - self._updated_at) >= INTERVAL:
            legs, self._updated_at = self.session._state.find_attribute("legs"), now
            self._frame = None if legs is None else body_frame(*legs)
        return self._frame


def body_frame(t: float, legs: Legs) -> dict[str, Any] | None:
    """Return the member "body": the legs at `t`, s, seen from the wearer's right; None if no direction is ahead.

    Coordinates are ahead of the middle of the hips and above it, m. Ahead is the mean horizontal direction from the
    ankles to the ends of the feet."""
    x, y = [sum([end[k] - ankle[k] for _, _, ankle, end in legs]) for k in (0, 1)]
    length = hypot(x, y)
    if not 0.0 < length < inf:
        return None
    left, right = [[((a * x + b * y) / length, up) for a, b, up in leg] for leg in legs]
    return {"t": plain(t), "left": plain(left), "right": plain(right)}
