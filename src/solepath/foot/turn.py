"""How far a foot has turned about the vertical."""

from __future__ import annotations

from math import atan2, pi

from ..types import Quat
from ..types.vector import conjugate, multiply


def heading_turned(before: Quat, after: Quat) -> float:
    """The twist about the vertical of the turn from one attitude to another, in (-pi, pi], rad."""
    q, _, _, k = multiply(after, conjugate(before))
    turn = 2.0 * atan2(k, q)
    return turn - 2.0 * pi if turn > pi else turn + 2.0 * pi if turn <= -pi else turn
