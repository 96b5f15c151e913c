"""Height of a sensor above the point over which the foot rolls, learnt from the wearer's own stances.

A foot on the ground is never quite still. It rolls over heel, sole and forefoot, and a sensor at distance r from the
point of contact moves at v = w x r. On the instep of a brisk walker this is 5 cm/s at the stillest moment, so zero
velocity makes every stride some per cent too short.

The height h of the sensor need not be configured, because the accelerometer measures the same motion: within one
stance, the change of velocity is the change of w x r. Let c = w x up, rad/s, and let u be the integral of the
acceleration, m/s; both are horizontal. The tilt is not known exactly, so u has an error that grows evenly. The equation

    u(t) = h c(t) + a + b t

is fitted by least squares to each stance. h is pooled over the stances, with less weight for older ones.

The numbers were chosen by hand on the recordings of docs/accuracy.md and not swept."""

from __future__ import annotations

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import TIE

Sums = tuple[
    float, float, float, float, float, float, float, float, float,
    float, float, float, float, float, float, float, float, float,
]  # fmt: skip
"""State of a stance, 18 numbers, in the units of the module.

They are: number of samples, time; last acceleration x, y; u x, y; sums of t and t^2; sums of c^2 and u c over both
axes; sums of u, t u, c and t c, each on x and on y."""
EMPTY: Sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""State of a stance without samples."""

INITIAL_HEIGHT = 0.05
"""Height before any stance, m: between that of a sensor in the sole and that of one on the instep."""
INITIAL_WEIGHT = 0.005
"""Weight of the initial height as a sum of c^2 dt, (rad/s)^2 s: half of what a slow stance gives."""
STANCE_MEMORY = 0.95
"""Factor by which each stance reduces the weight of the earlier ones."""
SHORTEST_STANCE, LONGEST_STANCE = 0.06, 0.6
"""Shortest and longest stance that is used, s.

A longer stance is cut into pieces, because the integral of the acceleration drifts."""
LOWEST_HEIGHT, HIGHEST_HEIGHT = -0.03, 0.2
"""Limits of the estimated height, m."""


@define
class SensorHeight:
    """The estimate of the height of the sensor above the point over which the foot rolls, updated by each stance."""

    height: float = field(default=INITIAL_HEIGHT, init=False)
    """Current estimate of the height, m."""
    product: float = field(default=INITIAL_HEIGHT * INITIAL_WEIGHT, init=False)
    """Weighted sum of u c dt over the stances, m (rad/s)^2 s."""
    square: float = field(default=INITIAL_WEIGHT, init=False)
    """Weighted sum of c^2 dt over the stances, (rad/s)^2 s."""
    sums: Sums = field(default=EMPTY, init=False)
    """State of the current stance."""

    def roll(self, dt: float, acc: Vec3, gyro: Vec3, attitude: Quat) -> tuple[float, float]:
        """Add one sample of a foot on the ground; return h w x up, the velocity x, y, m/s, navigation frame.

        `acc` is in m/s^2, `gyro` in rad/s, both in the sensor frame. `attitude` is sensor to navigation frame."""
        w, x, y, z = attitude
        # the first two rows of the rotation matrix
        xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
        yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
        wx, wy, wz = gyro
        fx, fy, fz = acc
        cx, cy = yx * wx + yy * wy + yz * wz, -(xx * wx + xy * wy + xz * wz)
        ax, ay = xx * fx + xy * fy + xz * fz, yx * fx + yy * fy + yz * fz
        n, t, bx, by, ux, uy, st, stt, scc, suc, sux, suy, stux, stuy, scx, scy, stcx, stcy = self.sums
        if n:
            t += dt
            ux += 0.5 * dt * (ax + bx)
            uy += 0.5 * dt * (ay + by)
        self.sums = (
            n + 1.0, t, ax, ay, ux, uy, st + t, stt + t * t, scc + cx * cx + cy * cy, suc + ux * cx + uy * cy,
            sux + ux, suy + uy, stux + t * ux, stuy + t * uy, scx + cx, scy + cy, stcx + t * cx, stcy + t * cy,
        )  # fmt: skip
        if t > LONGEST_STANCE + TIE:
            self.end_stance()
        return self.height * cx, self.height * cy

    def end_stance(self) -> None:
        """End the stance and update the height from it."""
        n, t, _, _, _, _, st, stt, scc, suc, sux, suy, stux, stuy, scx, scy, stcx, stcy = self.sums
        self.sums = EMPTY
        d = n * stt - st * st
        if t < SHORTEST_STANCE - TIE or n < 5.0 or d <= 0.0:
            return
        # sums of u c and c^2 after the best a + b t was subtracted from u and c, axis by axis
        square = (
            scc
            - (stt * (scx * scx + scy * scy) - 2.0 * st * (scx * stcx + scy * stcy) + n * (stcx * stcx + stcy * stcy))
            / d
        )
        product = (
            suc
            - (
                stt * (sux * scx + suy * scy)
                - st * (sux * stcx + stux * scx + suy * stcy + stuy * scy)
                + n * (stux * stcx + stuy * stcy)
            )
            / d
        )
        if (
            square <= 0.0
            or not 2.0 * LOWEST_HEIGHT - HIGHEST_HEIGHT < product / square < 2.0 * HIGHEST_HEIGHT - LOWEST_HEIGHT
        ):
            return  # no sensor on a foot has this height, so it was no stance
        dt = t / n
        self.square = STANCE_MEMORY * self.square + square * dt
        self.product = STANCE_MEMORY * self.product + product * dt
        self.height = min(max(self.product / self.square, LOWEST_HEIGHT), HIGHEST_HEIGHT)
