"""What the other foot knows of this one: a foot that has just come down is turned and shifted where it stands."""

from __future__ import annotations

from ...types import Vec3
from ...types.vector import from_yaw, multiply
from ..gait import Gait
from .error_state import ErrorStateFilter


def shift(gait: Gait, corrector: ErrorStateFilter, yaw: float, by: Vec3) -> None:
    """From here on the foot heads `yaw` rad further and stands `by` m off (world frame): its live track and its next
    steps. The steps that were taken stay as they were told, and no step gets longer by it. Call it with the foot-flat
    that ended a step, before the next sample."""
    x, y, z = by
    if gait.world.north is not None:
        c, s = gait.world.north  # the turn from the navigation frame to the world frame, undone
        x, y = c * x + s * y, c * y - s * x
    corrector.shift(yaw, (x, y, z))
    step = gait.step
    px, py, pz = step.start
    step.start = (px + x, py + y, pz + z)
    step.attitude = multiply(from_yaw(yaw), step.attitude)
    px, py, pz = gait.anchored
    gait.anchored = (px + x, py + y, pz + z)
