"""Attitude of one segment of the body from the attitude of its sensor, which may have any mounting (limbs.py)."""

from __future__ import annotations

from math import cos

from ....types import Quat
from ....types.attrs import stateful
from ....types.vector import IDENTITY, add_quat, conjugate, multiply, normalise

LARGEST_SWAY = 0.04
"""Largest rotation of a still segment, rad: twice the 0.81 degrees accuracy of the paper's sensor, and some sway."""

LARGEST_JUMP = 1.0
"""Largest rotation between the attitudes before and after a restart of the sensor's clock in one world, rad."""


@stateful
class LimbSegment:
    """The attitude of one segment, computed from that of its sensor."""

    t: float | None = None
    """Time of the newest attitude, s."""
    sensor: Quat = IDENTITY
    """Newest attitude, sensor frame to the world that the sensors share."""
    earlier_t: float | None = None
    """Time of the attitude before the newest, s."""
    earlier_attitude: Quat = IDENTITY
    """Attitude before the newest, sensor frame to the world that the sensors share."""
    anchor: Quat = IDENTITY
    """Attitude at `still_since`, from which a still segment does not differ by more than LARGEST_SWAY."""
    still_since: float | None = None
    """Time since which the segment has been still, s."""
    attitude_sum: Quat = (0.0, 0.0, 0.0, 0.0)
    """Sum of the attitudes since `still_since`."""
    standing: Quat | None = None
    """Attitude of the sensor in the N-pose; None before it is known."""

    def set_attitude(self, t: float, sensor: Quat) -> bool:
        """Set a new attitude, a unit quaternion from the sensor frame to the shared world.

        Return whether it is that of a sensor that restarted with another world."""
        restarted = self.standing is not None and self.t is None
        jumps = restarted and abs(_dot(self.sensor, sensor)) < cos(0.5 * LARGEST_JUMP)
        self.earlier_t, self.earlier_attitude = self.t, self.sensor
        self.t, self.sensor = t, sensor
        if self.standing is not None:
            return jumps
        dot = _dot(self.anchor, sensor)
        if self.still_since is None or abs(dot) < cos(0.5 * LARGEST_SWAY) or t < self.still_since:
            self.anchor, self.attitude_sum, self.still_since = sensor, sensor, t
        else:
            self.attitude_sum = add_quat(self.attitude_sum, sensor, 1.0 if dot >= 0.0 else -1.0)
        return False

    def still_time(self) -> float:
        """Return the time for which the segment has been still, s."""
        return 0.0 if self.t is None or self.still_since is None else self.t - self.still_since

    def rotation(self, t: float) -> Quat:
        """Return the rotation at `t` s since the N-pose, in the shared world; the identity before that pose.

        The sensor's attitude is interpolated between the last two; outside their times, it is the nearer."""
        if self.standing is None:
            return IDENTITY
        attitude = self.sensor
        if self.t is not None and self.earlier_t is not None and self.earlier_t < self.t and t < self.t:
            k = max(0.0, (t - self.earlier_t) / (self.t - self.earlier_t))
            opposite = _dot(self.earlier_attitude, self.sensor) < 0.0
            earlier = add_quat((0.0, 0.0, 0.0, 0.0), self.earlier_attitude, k - 1.0 if opposite else 1.0 - k)
            attitude = normalise(add_quat(earlier, self.sensor, k))
        return multiply(attitude, conjugate(self.standing))


def _dot(p: Quat, q: Quat) -> float:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]
