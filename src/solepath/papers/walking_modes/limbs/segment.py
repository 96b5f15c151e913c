"""Attitude of one segment of the body from the attitude of its sensor, which may have any mounting (limbs.py)."""

from __future__ import annotations

from math import cos

from ....types import Quat
from ....types.attrs import define, field
from ....types.vector import IDENTITY, conjugate, from_yaw, multiply, normalise

LARGEST_SWAY = 0.04
"""Largest rotation of a still segment, rad: twice the 0.81 degrees accuracy of the paper's sensor, and some sway."""


@define
class LimbSegment:
    """The attitude of one segment, computed from that of its sensor."""

    t: float | None = field(default=None, init=False)
    """Time of the newest attitude, s."""
    sensor: Quat = field(default=IDENTITY, init=False)
    """Newest attitude, sensor frame to the world of the sensor."""
    earlier_t: float | None = field(default=None, init=False)
    """Time of the attitude before the newest, s."""
    earlier_attitude: Quat = field(default=IDENTITY, init=False)
    """Attitude before the newest, sensor frame to the world of the sensor."""
    anchor: Quat = field(default=IDENTITY, init=False)
    """Attitude at `still_since`, from which a still segment does not differ by more than LARGEST_SWAY."""
    still_since: float | None = field(default=None, init=False)
    """Time since which the segment has been still, s."""
    attitude_sum: Quat = field(default=(0.0, 0.0, 0.0, 0.0), init=False)
    """Sum of the attitudes since `still_since`."""
    standing: Quat | None = field(default=None, init=False)
    """Attitude of the sensor in the N-pose; None before it is known."""
    own_world: bool = field(default=False, init=False)
    """Flag: the sensor does not use the world that the devices share, but its own one."""
    heading: float | None = field(default=None, init=False)
    """Wearer's first heading in the sensor's own world, rad."""
    world_changed: bool = field(default=False, init=False)
    """Flag: the sensor restarted with another world, and the segment has not been still since."""
    world: Quat | None = field(default=None, init=False)
    """Rotation from the sensor's new world to its old one; None if it never changed."""

    def set_attitude(self, t: float, sensor: Quat) -> None:
        """Set a new attitude, a unit quaternion from the sensor frame to the world of the sensor."""
        if self.world is not None and not self.world_changed:
            sensor = multiply(self.world, sensor)
        self.earlier_t, self.earlier_attitude = self.t, self.sensor
        self.t = t
        self.sensor = sensor
        if self.standing is not None and not self.world_changed:
            return
        w, x, y, z = self.anchor
        dot = w * sensor[0] + x * sensor[1] + y * sensor[2] + z * sensor[3]
        if self.still_since is None or abs(dot) < cos(0.5 * LARGEST_SWAY) or t < self.still_since:
            self.anchor, self.attitude_sum, self.still_since = sensor, sensor, t
            return
        k = 1.0 if dot >= 0.0 else -1.0
        w, x, y, z = self.attitude_sum
        self.attitude_sum = (w + k * sensor[0], x + k * sensor[1], y + k * sensor[2], z + k * sensor[3])

    def still_time(self) -> float:
        """Return the time for which the segment has been still, s."""
        return 0.0 if self.t is None or self.still_since is None else self.t - self.still_since

    def sensor_at(self, t: float) -> Quat:
        """Return the sensor's attitude at `t` s, interpolated between the last two; outside their times, the nearer."""
        if self.t is None or self.earlier_t is None or t >= self.t or self.t <= self.earlier_t:
            return self.sensor
        if t <= self.earlier_t:
            return self.earlier_attitude
        k = (t - self.earlier_t) / (self.t - self.earlier_t)
        (aw, ax, ay, az), (bw, bx, by, bz) = self.earlier_attitude, self.sensor
        j = k - 1.0 if aw * bw + ax * bx + ay * by + az * bz < 0.0 else 1.0 - k
        return normalise((j * aw + k * bw, j * ax + k * bx, j * ay + k * by, j * az + k * bz))

    def attitude(self, facing: float, turn: float, t: float) -> Quat:
        """Return the attitude at `t` s, from the segment to the world frame.

        `facing` is the wearer's heading in the N-pose in the world that the devices share, rad. `turn` is the angle
        from that heading to the x axis of the world frame, rad, left positive."""
        if self.standing is None:
            return IDENTITY
        wearer_heading = (self.heading or 0.0) if self.own_world else facing
        rotation = multiply(self.sensor_at(t), conjugate(self.standing))
        if wearer_heading == turn == 0.0:
            return rotation
        return multiply(multiply(from_yaw(-wearer_heading - turn), rotation), from_yaw(wearer_heading))

    def upright(self, t: float) -> float:
        """Return the cosine of the segment's angle from the vertical at `t` s."""
        if self.standing is None:
            return 1.0
        _, x, y, _ = multiply(self.sensor_at(t), conjugate(self.standing))
        return 1.0 - 2.0 * (x * x + y * y)
