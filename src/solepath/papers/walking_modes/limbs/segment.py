"""One segment of the body: its attitude, from that of the sensor that is strapped on in any way (limbs.py)."""

from __future__ import annotations

from math import cos

from ....types import Quat
from ....types.attrs import define, field
from ....types.vector import IDENTITY, conjugate, from_yaw, multiply, normalise

QUIET = 0.04
"""A segment that turns by no more than this is quiet, rad: twice the 0.81 degrees to which the paper's sensor is good,
and some sway."""


@define
class LimbSegment:
    """One segment's attitude, from its sensor's."""

    t: float | None = field(default=None, init=False)
    """Of the newest attitude, s."""
    sensor: Quat = field(default=IDENTITY, init=False)
    """Sensor to its own world."""
    earlier: float | None = field(default=None, init=False)
    """Of the attitude before the newest, s."""
    before: Quat = field(default=IDENTITY, init=False)
    """That attitude."""
    anchor: Quat = field(default=IDENTITY, init=False)
    """About where it was since `quiet_since`, s."""
    quiet_since: float | None = field(default=None, init=False)
    total: Quat = field(default=(0.0, 0.0, 0.0, 0.0), init=False)
    """Sum of the attitudes since."""
    standing: Quat | None = field(default=None, init=False)
    """The sensor's attitude in the N-pose."""
    own: bool = field(default=False, init=False)
    """Its world is its own, not the one that the devices share."""
    heading: float | None = field(default=None, init=False)
    """Of the wearer's first heading in its own world, rad."""
    adrift: bool = field(default=False, init=False)
    """Its world is another since it began anew, and it has not stood quiet since."""
    world: Quat | None = field(default=None, init=False)
    """From that world to the one before."""

    def told(self, t: float, sensor: Quat) -> None:
        """A new attitude: sensor to its own world, a unit quaternion."""
        if self.world is not None and not self.adrift:
            sensor = multiply(self.world, sensor)
        self.earlier, self.before = self.t, self.sensor
        self.t = t
        self.sensor = sensor
        if self.standing is not None and not self.adrift:
            return
        w, x, y, z = self.anchor
        dot = w * sensor[0] + x * sensor[1] + y * sensor[2] + z * sensor[3]
        if self.quiet_since is None or abs(dot) < cos(0.5 * QUIET) or t < self.quiet_since:
            self.anchor, self.total, self.quiet_since = sensor, sensor, t
            return
        k = 1.0 if dot >= 0.0 else -1.0
        w, x, y, z = self.total
        self.total = (w + k * sensor[0], x + k * sensor[1], y + k * sensor[2], z + k * sensor[3])

    def quiet_for(self) -> float:
        """s."""
        return 0.0 if self.t is None or self.quiet_since is None else self.t - self.quiet_since

    def sensor_at(self, t: float) -> Quat:
        """The sensor's attitude at an instant between its last two, s; else the nearer one."""
        if self.t is None or self.earlier is None or t >= self.t or self.t <= self.earlier:
            return self.sensor
        if t <= self.earlier:
            return self.before
        k = (t - self.earlier) / (self.t - self.earlier)
        (aw, ax, ay, az), (bw, bx, by, bz) = self.before, self.sensor
        j = k - 1.0 if aw * bw + ax * bx + ay * by + az * bz < 0.0 else 1.0 - k
        return normalise((j * aw + k * bw, j * ax + k * bx, j * ay + k * by, j * az + k * bz))

    def attitude(self, facing: float, turn: float, t: float) -> Quat:
        """Segment to world at `t` s. `facing`: where the wearer looked in the N-pose, in the devices' world, rad;
        `turn`: from there to the x axis of the world."""
        if self.standing is None:
            return IDENTITY
        looked = (self.heading or 0.0) if self.own else facing
        turned = multiply(self.sensor_at(t), conjugate(self.standing))
        if looked == turn == 0.0:
            return turned
        return multiply(multiply(from_yaw(-looked - turn), turned), from_yaw(looked))

    def upright(self, t: float) -> float:
        """Cosine of its lean from the vertical at `t` s."""
        if self.standing is None:
            return 1.0
        _, x, y, _ = multiply(self.sensor_at(t), conjugate(self.standing))
        return 1.0 - 2.0 * (x * x + y * y)
