"""State of the integration at one sample of a motion, which the correctors of KUPT keep for a few samples."""

from __future__ import annotations

from ....types import Vec3
from ....types.attrs import frozen


@frozen
class MotionMoment:
    """The state of the integration at one sample of a motion, navigation frame."""

    elapsed: float
    """Time since motion start, s."""
    raw_displacement: Vec3
    """Integral of the raw velocity, m."""
    known_displacement: Vec3
    """Integral of the known velocities, m."""
    error: Vec3 | None
    """Mean raw velocity minus known velocity over the interval that ended here, m/s; None when unknown."""
    drift: float = 0.0
    """Sum since motion start of the squared changes of specific force between samples times time, m^2/s^2."""
    drift_moment: float = 0.0
    """Sum of the same terms, each times its time since motion start, m^2/s."""
    cos_pitch: float = 1.0
    """Cosine of the tilt of the sensor since motion start."""
    lift_rate: float = 0.0
    """Rate at which `cos_pitch` fell in the interval that ended here, 1/s."""
    rise_error: float = 0.0
    """Rise by the raw velocity minus that by the rolling shoe in push-off, m."""
