"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4:
tilt fed back in stance only, velocity and, on level steps, height losing what they gathered in a line.
"""

from __future__ import annotations

from collections import deque
from math import hypot, sqrt

from ...body.activity.steepness import steepness
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, TIE, ZERO, rotate, tipped
from .posture import gravity_error, posture, turned

WHOLE = 0.5
"""A step shorter than this says little of what every metre adds to the height, m."""
LEARNT = 8
"""Level steps whose mean is the lean; then older ones fade."""
BROKEN = 0.3
"""s: no swing is shorter."""
USUAL = 1.2
"""A step that lasts longer has missed a stance, and gathers errors with the square of time, s."""
LEAST = 0.03
"""s: no stance is shorter."""
TOLD = 0.05
"""Who stood certainly will do so again: a stance after such a one is told when it is certain, or has lasted so long,
s."""
LOST = 10.0
"""m/s^2 for each s: an attitude that saturated gyroscopes have spoilt makes any speed, and must not for ever keep a
foot from standing."""
FASTEST = 15.0
"""No foot is faster, m/s."""
HIGHEST = 0.12
"""A step that comes down so much or more above or below where it stood is no level one, m."""
DOUBTFUL, LATE = 0.04, 0.9
"""A stance whose evidence has a larger sigma than the first, m/s, is doubtful; of a foot that has moved for so many s
without a stance, twice as large."""
SLOW, DRIFTING, STRICT = 0.5, 1.0, 0.5
"""How fast a standing foot may seem, m/s, and how much more with each second since it last stood, m/s^2: a tilt that is
off by 6 degrees makes as much. The share of that which doubtful evidence is believed up to."""


@frozen
class ShoeSensingSettings(DedriftSettings):
    """What `ShoeSensing` is set to."""

    kp: float = 1.0
    """How fast stance pulls the tilt upright, 1/s; the paper has no figure."""
    heed: float = 0.4
    """How much of the tilt that would explain the velocity left at the end of a motion is believed: joggers stand too
    shortly for the feedback. Not in the paper; 0 leaves it out."""
    eliminate: bool = True
    """Take the height error of level steps out."""
    behind: float = 0.15
    """How late the detector may be, s: the window of `ShortTimeEnergy`. A stance that has ended may have done so that
    long ago, so what the samples since then gained counts as motion."""


@define
class ShoeSensing(LinearDedrift):
    """gyro' = gyro - Kp e stationary; Runge-Kutta quaternion; V(T) less e~ (T - t_a); S_z(T) less e~_s (T - t_a).

    Frame and units as in `Corrector`. Latency: velocity, position and, on a level step, height are put right, in one
    jump, with the first sample of stance, and once more when a doubtful stance becomes certain. The feedback of a
    sample of stance turns the interval after it.

    e~ = (dv2 - dv1) / (t_b - t_a) of section 3.3 is the velocity that is left when the foot stands again, over the time
    since it last stood; removed from the velocity in a line it takes half of itself times that time from the position.
    Of section 3.4.2's height error, removed in the same way, nothing is left at t_b: the foot stands as high as before.
    e~_s itself is only known at t_b, and the paper does not say how its live track has it before. Here it has not:
    within a step the live height (`FootMoved`) is as integration has it, with all that it has drifted since t_a, and
    the line is taken off in one jump when the foot stands; heights of the samples in between are not told again.
    Both V(T) and S_z(T) are printed with `stationary = 1` beside the moving foot and 0 beside the standing one; by
    section 3.1.2 it is the other way about.

    A step is level by its angle per metre (steepness.py).

    What is beyond the paper. In the middle of a swing, and before a foot is flat, there are moments without
    acceleration, and joggers hardly have longer ones. So evidence without the hint STATIONARY is stance for the time
    being: only later than `BROKEN` after the last stance, of a sigma up to `DOUBTFUL`, and when the integration says
    that the foot is slow. Should the foot then stand more certainly, the motion is put right by that later moment, and
    a wearer whose last stance became certain is not told to stand before: walkers' steps end with certainty, a jogger's
    first one may be told as one with the second. What velocity was left when a stance is over turns the tilt (`heed`).
    And most of a level step's height is a tilt that an accelerometer's bias makes, so much a metre in step after step
    (25 mg make 3.5 cm of 1.4 m): what the level steps so far had in common, `lean`, is taken off every step before it
    is judged. What then still comes down `HIGHEST` or more above or below where it stood is no level step, whatever its
    angle: it has gone onto or off a stair with a long stride, and keeps its height.
    """

    settings: ShoeSensingSettings = ShoeSensingSettings()
    lean: float = field(default=0.0, init=False)
    """Height gained by level steps for each metre of theirs, m; zero without `eliminate`."""
    levelled: int = field(default=0, init=False)
    """How many steps that comes from, up to `LEARNT`."""
    slope: float = field(default=0.0, init=False)
    """What the step that led to this stance adds to it, if it was a level one."""
    measured: Vec3 = field(default=ZERO, init=False)
    """acc of the last sample, sensor frame, m/s^2."""
    gained: Vec3 = field(default=ZERO, init=False)
    """By how much it changed the velocity, m/s."""
    lately: deque[tuple[float, float, Vec3]] = field(factory=deque, init=False)
    """Of the last samples of stance: its time and how long it was, s, and by how much it changed the velocity, m/s."""
    still: bool = field(default=True, init=False)
    """The last sample was one of stance."""
    best: float = field(default=0.0, init=False)
    """The least sigma of this stance, m/s."""
    came: float = field(default=0.0, init=False)
    """How long ago this stance, or the last one, began, s."""
    sure: bool = field(default=True, init=False)
    """The last stance became a certain one."""
    tipping: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """What the attitude will be turned by when this stance is over, half angles about x and y, rad."""
    raw: tuple[Vec3, Vec3] | None = field(default=None, init=False)
    """Position and velocity if the motion before this stance went on, m and m/s, as long as a more certain moment may
    put it right."""
    raw_swing: float = field(default=0.0, init=False)
    """For how long that motion has gone on, s."""
    step: float = field(default=0.0, init=False)
    """How long the last sample was, s."""
    stood: Vec3 = field(default=ZERO, init=False)
    """Where the foot stands, or last stood, m."""
    before: Vec3 = field(default=ZERO, init=False)
    """Where it stood before that, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        # the mean force of the rest that the attitude was found in, as the sensor has it
        w, x, y, z = attitude
        up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z)
        LinearDedrift.start(self, posture(up), tilt_sigma)
        self.stood = self.before = ZERO
        self.still = True
        self.best = 0.0
        self.came = self.raw_swing = self.slope = 0.0
        self.raw = None
        self.sure = True
        self.tipping = (0.0, 0.0)
        self.lately.clear()
        self.measured = up

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        before = gyro if self.rate is None else self.rate
        self.rate = after = gyro
        attitude = self.attitude
        if self.still:
            k = min(self.settings.kp, 0.5 / dt) if dt > 0.0 else 0.0
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
        half = 0.5 * dt
        dx, dy, dz = self.gained = ((fx + px) * half, (fy + py) * half, (fz + pz) * half - GRAVITY * dt)
        vx, vy, vz = self.velocity
        ux, uy, uz = vx + dx, vy + dy, vz + dz
        x, y, z = self.position
        self.position = (x + (vx + ux) * half, y + (vy + uy) * half, z + (vz + uz) * half)
        speed = sqrt(ux * ux + uy * uy + uz * uz)
        if speed > FASTEST:
            k = FASTEST / speed
            ux, uy, uz, speed = ux * k, uy * k, uz * k, FASTEST
        self.velocity = (ux, uy, uz)
        self.length += speed * dt
        if self.raw is not None:
            (x, y, z), (vx, vy, vz) = self.raw
            x, y, z = x + (vx + 0.5 * dx) * dt, y + (vy + 0.5 * dy) * dt, z + (vz + 0.5 * dz) * dt
            self.raw = ((x, y, z), (vx + dx, vy + dy, vz + dz))
            self.raw_swing += dt
        self.step = dt
        self.came += dt
        self.swing += dt
        self.lasted += dt

    def correct(self, t: float, stance: Stance) -> bool:
        stood = self.still
        self.still = still = self._stands(stance)
        if not still:
            if stood:
                self._set_out()
            elif self.came >= BROKEN:
                self.raw = None
            return False
        if stood:
            lately = self.lately
            lately.append((t, self.step, self.gained))
            oldest = t - self.settings.behind + TIE
            while lately and lately[0][0] <= oldest:
                lately.popleft()
        elif self.raw is None:
            self.before = self.stood
            self.raw, self.raw_swing = (self.position, self.velocity), self.swing
            self.came = self.best = 0.0
        if self.raw is not None and not 0.0 < self.best <= stance.sigma:
            self._come_down(*self.raw, stance)
        self.swing = 0.0
        self.position = self.stood
        self.velocity = stance.v_ref
        return self.raw is None or not self.sure or self.came >= TOLD

    def _stands(self, stance: Stance) -> bool:
        sigma, sure = stance.sigma, stance.hint is Phase.STATIONARY
        if self.still and self.came < LEAST:
            return True
        if stance.hint is Phase.SWING or sigma > 2.0 * DOUBTFUL:
            return False
        if self.still:
            return sigma <= max(DOUBTFUL, self.best)
        (vx, vy, vz), swing = self.velocity, self.swing
        if self.raw is not None:
            if sigma >= self.best:
                return False
            (_, (vx, vy, vz)), swing = self.raw, self.raw_swing
        elif swing < BROKEN and not sure:
            return False
        limit = SLOW + DRIFTING * swing
        if not sure:
            limit *= STRICT
        if swing > LATE:
            limit += LOST * (swing - LATE) ** 2
        elif sigma > DOUBTFUL:
            return False
        return vx * vx + vy * vy + vz * vz < limit * limit

    def _come_down(self, place: Vec3, velocity: Vec3, stance: Stance) -> None:
        """The foot stands, more certainly than it did before, where the motion led to this place and velocity."""
        (x, y, z), (vx, vy, vz), (rx, ry, rz) = place, velocity, stance.v_ref
        half = 0.5 * self.raw_swing
        k = 0.5 * self.settings.heed / (GRAVITY * max(self.raw_swing, BROKEN))
        self.tipping = (k * (vy - ry), -k * (vx - rx))
        x, y, z = x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half
        if self.settings.eliminate:
            z = self._height(x, y, z)
        self.stood = (x, y, z)
        self.best = stance.sigma
        if stance.hint is Phase.STATIONARY:
            self.raw = None

    def _height(self, x: float, y: float, z: float) -> float:
        """S_z at the end of a step that integration has brought to (x, y, z), m."""
        bx, by, bz = self.before
        ground = hypot(x - bx, y - by)
        height = z - bz - self.lean * ground
        highest = HIGHEST * max(1.0, self.raw_swing / USUAL) ** 2
        if abs(height) >= highest or steepness(ground, height) != 0:
            self.slope = 0.0
            return bz + height
        self.slope = height / ground if ground > WHOLE else 0.0
        return bz

    def _set_out(self) -> None:
        """The stance is over, and was so for the samples in `lately`."""
        if self.slope != 0.0:
            self.levelled = min(self.levelled + 1, LEARNT)
            self.lean += self.slope / self.levelled
            self.slope = 0.0
        self.sure = self.raw is None
        self.attitude = tipped(self.attitude, *self.tipping)
        self.tipping = (0.0, 0.0)
        self.swing = 0.0
        x, y, z = self.stood
        vx = vy = vz = 0.0
        for _, dt, (dx, dy, dz) in (*self.lately, (0.0, self.step, self.gained)):
            x, y, z = x + (vx + 0.5 * dx) * dt, y + (vy + 0.5 * dy) * dt, z + (vz + 0.5 * dz) * dt
            vx, vy, vz = vx + dx, vy + dy, vz + dz
            self.swing += dt
        self.lately.clear()
        self.position, self.velocity = (x, y, z), (vx, vy, vz)

    def bridge(self, dt: float) -> float:
        self._forget()
        return LinearDedrift.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self._forget()
        self.still = False
        LinearDedrift.infill(self, dt, attitude, velocity, position)

    def repair(self, yaw: float, position: Vec3) -> None:
        LinearDedrift.repair(self, yaw, position)
        self.stood = self.before = position
        self._forget()

    def _forget(self) -> None:
        """What the last samples said is of no use any more."""
        self.raw = None
        self.lately.clear()
