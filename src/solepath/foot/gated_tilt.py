"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4:
tilt fed back in stance only, velocity and, on level steps, height losing what they gathered in a line.
"""

from __future__ import annotations

from collections import deque
from math import hypot, sqrt

from attrs import define, field

from ..types import Phase, Quat, Vec3
from ..vector import GRAVITY, TIE, ZERO, rotate
from .dedrift import LinearDedrift
from .posture import gravity_error, posture, turned
from .stance import Stance
from .steepness import steepness


@define
class ShoeSensing(LinearDedrift):
    """gyro' = gyro - Kp e stationary; Runge-Kutta quaternion; V(T) less e~ (T - t_a); S_z(T) less e~_s (T - t_a).

    Frame and units as in `Corrector`. Latency: velocity, position and, on a level step, height are put right, in one
    jump, with the first sample of stance. The feedback of a sample of stance turns the interval after it.

    e~ = (dv2 - dv1) / (t_b - t_a) of section 3.3 is the velocity that is left when the foot stands again, over the time
    since it last stood; removed from the velocity in a line it takes half of itself times that time from the position.
    Of section 3.4.2's height error, removed in the same way, nothing is left at t_b: the foot stands as high as before.
    Both V(T) and S_z(T) are printed with `stationary = 1` beside the moving foot and 0 beside the standing one; by
    section 3.1.2 it is the other way about.

    A step is level by its angle per metre (steepness.py). `eliminate`: take the height error of level steps out.
    `highest`: a step that is level by its angle and yet comes down further above or below than this has gone onto or
    off a stair with a long stride, and keeps its height, m. The paper's errors of a single step reach 0.29 m, so it
    cannot tell; ours do not come near a riser.
    """

    kp: float = 1.0
    """1/s; the paper has no figure."""
    eliminate: bool = True
    highest: float = 0.1
    behind: float = 0.05
    """By how much the detector is late, s: half of the window of `ShortTimeEnergy`, since "n is the position of the
    centre of the sliding window". A stance that has ended did so that long ago, and the motion since then counts."""
    # state
    lately: deque[tuple[float, float, Vec3]] = field(factory=deque, init=False)
    """Of the last samples of stance: its time and how long it was, s, and by how much it changed the velocity, m/s."""
    measured: Vec3 = field(default=ZERO, init=False)
    """acc of the last sample, sensor frame, m/s^2."""
    still: bool = field(default=True, init=False)
    """`stationary` of the last sample."""
    stood: Vec3 = field(default=ZERO, init=False)
    """Where the foot last stood, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        # the mean force of the rest that the attitude was found in, as the sensor has it
        w, x, y, z = attitude
        up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z)
        LinearDedrift.start(self, posture(up), tilt_sigma)
        self.stood = ZERO
        self.still = True
        self.lately.clear()
        self.measured = up

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        before = gyro if self.rate is None else self.rate
        self.rate = after = gyro
        attitude = self.attitude
        if self.still:
            k = min(self.kp, 0.5 / dt) if dt > 0.0 else 0.0
            ex, ey, ez = gravity_error(attitude, self.measured)
            ex, ey, ez = k * ex, k * ey, k * ez
            x, y, z = before
            before = (x - ex, y - ey, z - ez)
            x, y, z = after
            after = (x - ex, y - ey, z - ez)
        self.measured = acc
        self.attitude = attitude = turned(attitude, before, after, dt)
        fx, fy, fz = force = rotate(attitude, acc)
        px, py, pz = force if self.force is None else self.force
        self.force = force
        vx, vy, vz = self.velocity
        ux = vx + 0.5 * (fx + px) * dt
        uy = vy + 0.5 * (fy + py) * dt
        uz = vz + (0.5 * (fz + pz) - GRAVITY) * dt
        x, y, z = self.position
        half = 0.5 * dt
        self.position = (x + (vx + ux) * half, y + (vy + uy) * half, z + (vz + uz) * half)
        self.velocity = (ux, uy, uz)
        self.length += sqrt(ux * ux + uy * uy + uz * uz) * dt
        self.swing += dt
        self.lasted += dt

    def correct(self, t: float, stance: Stance) -> bool:
        stood = self.still
        self.still = stance.sigma <= self.trusted and stance.hint is not Phase.SWING
        if not self.still:
            if self.lately:
                self._set_out()
            return False
        rx, ry, rz = stance.v_ref
        vx, vy, vz = self.velocity
        x, y, z = self.position
        half = 0.5 * self.swing
        x, y, z = x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half
        sx, sy, sz = self.stood
        if self.eliminate and abs(z - sz) < self.highest and steepness(hypot(x - sx, y - sy), z - sz) == 0:
            z = sz
        self.stood = self.position = (x, y, z)
        self.velocity = stance.v_ref
        lately = self.lately
        if stood:
            lately.append((t, self.swing, (vx - rx, vy - ry, vz - rz)))
            oldest = t - self.behind + TIE
            while lately and lately[0][0] <= oldest:
                lately.popleft()
        self.swing = 0.0
        return True

    def _set_out(self) -> None:
        """The stance is over, and was so for the samples in `lately`."""
        latest = self.swing
        x = y = z = vx = vy = vz = 0.0
        for _, dt, (dx, dy, dz) in self.lately:
            x, y, z = x + (vx + 0.5 * dx) * dt, y + (vy + 0.5 * dy) * dt, z + (vz + 0.5 * dz) * dt
            vx, vy, vz = vx + dx, vy + dy, vz + dz
            self.swing += dt
        self.lately.clear()
        px, py, pz = self.position
        self.position = (px + x + vx * latest, py + y + vy * latest, pz + z + vz * latest)
        px, py, pz = self.velocity
        self.velocity = (px + vx, py + vy, pz + vz)

    def bridge(self, dt: float) -> float:
        self.lately.clear()
        return LinearDedrift.bridge(self, dt)

    def leap(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.lately.clear()
        LinearDedrift.leap(self, dt, attitude, velocity, position)

    def mend(self, yaw: float, position: Vec3) -> None:
        LinearDedrift.mend(self, yaw, position)
        self.stood = position
