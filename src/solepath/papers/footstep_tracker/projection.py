"""Step by step over the ground (Liu et al. 2015, IEEE MASS, sections IV.C and IV.D): the corrector.

How long a step is and how far it turns are the equations of step_length.py. What the paper leaves open:

- From one rest to the next the foot goes where it points after half of the turn: along the chord of an arc.
- A step that lost samples for longer than `HOLE` is not one that these integrals hold for: it goes where the live
  track is, less the drift that its velocity shows at rest.
- A foot that pivots on its sole, in what looks like a static zone, turns as its gyroscope says.
- `printed` does with the equations as they are printed, and without all this.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, sin

from ...body.gait.turning_steps import TurningSteps
from ...calibration import Calibration
from ...foot.navigate.corrector import LONGEST_BRIDGE
from ...foot.navigate.strapdown import Strapdown
from ...foot.stance.stance import Stance
from ...types import Foot, Phase, Quat, Vec3
from ...types.attrs import define, evolve, field, frozen
from ...types.vector import GRAVITY, IDENTITY, ZERO, from_yaw, heading_turned, multiply, rotate, tipped
from .critical_times import CriticalTimes
from .segment import StepSegment
from .step_length import closed_step_length, step_length, turned, turned_about_vertical

HOLE = 0.12
"""s: two of the paper's samples."""
LONGEST = 2.0
"""A foot that has not lain still for longer than this is not followed any further before it does, s."""
PIVOT = 0.15
"""A foot that lies as if still and yet turns faster than this about the vertical pivots on its sole, rad/s."""
ENDS = 0.8
"""The bias is taken off already: the ends of a gyroscope's ranges differ by no more than this share."""
AT_END = 0.95
"""Rates about the foot's axes are somewhat less than about the sensor's, which are up to 15 degrees off."""
FURTHEST = 3.0
"""No step is longer, m."""
STEP_ERROR, TURN_ERROR = 0.1, 0.05
"""What a step is wrong by, as a share of its length: the paper's figure 11; what its turn is wrong by, rad."""


@frozen
class ProjectionSettings:
    """What `Projection` is set to; phi of (1) is the product of the first two."""

    toe_out: float = 0.0
    """phi of this foot, rad, outwards positive."""
    outwards: float = 1.0
    """1 for a left foot, -1 for a right one."""
    printed: bool = False
    """The equations as they are printed."""


@define
class Projection(Strapdown):
    """Moves step by step. Frame as in `Corrector`; height is always 0, for the paper's track has none.

    Latency: a step is known when the static zone that ends it is. Meanwhile the live position and attitude are those of
    a strapdown, the former without its height, and leap to the step's own end.
    """

    settings: ProjectionSettings = ProjectionSettings()
    turning: TurningSteps = field(factory=TurningSteps)
    end: float = field(default=0.0, init=False)
    """The largest rate about an axis that the device called saturated, rad/s; 0 when it never did;"""
    near: float = field(default=0.0, init=False)
    """the least of them, but for those of an accelerometer's saturation."""
    stood: Quat = field(default=IDENTITY, init=False)
    """Attitude at the last rest."""
    anchored: Vec3 = field(default=ZERO, init=False)
    """Position then, m."""
    moving: float = field(default=0.0, init=False)
    """Time since, s."""
    length: float = field(default=0.0, init=False)
    """Way since the last anchor, m."""
    steps: int = field(default=0, init=False)
    """Steps since then."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> Projection:
        """The same for this foot, with its toe-out angle where it is known."""
        outwards = 1.0 if foot is Foot.LEFT else -1.0
        toe_out = calibration.toe_out.get(foot, self.settings.toe_out)
        return evolve(self, settings=evolve(self.settings, toe_out=toe_out, outwards=outwards))

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = self.stood = attitude
        self.velocity = self.position = self.anchored = ZERO
        self.force = self.rate = None
        self.moving = self.length = 0.0
        self.steps = 0

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        before = self.position
        self.integrate(dt, acc, gyro)
        if saturated:
            x, y, z = gyro
            rate = max(abs(x), abs(y), abs(z))
            self.end = max(self.end, rate)
            if self.near < ENDS * self.end or ENDS * self.end <= rate < self.near:
                self.near = rate
        self.moving += dt
        if self.moving > LONGEST:
            self.velocity, self.position = ZERO, before
            return
        vx, vy, _ = self.velocity
        x, y, _ = self.position
        self.velocity, self.position = (vx, vy, 0.0), (x, y, 0.0)

    def correct(self, t: float, stance: Stance) -> bool:
        if stance.hint is not Phase.STATIONARY:
            return False
        segment = stance.detail
        if isinstance(segment, StepSegment):
            self._rest(segment)
        elif self.settings.printed or self.rate is None or abs(rotate(self.attitude, self.rate)[2]) < PIVOT:
            self.attitude = self.stood
        self.position, self.velocity = self.anchored, ZERO
        self._level(min(self.moving, 0.1))
        self.stood, self.moving = self.attitude, 0.0
        return True

    def _rest(self, segment: StepSegment) -> None:
        """The foot lies still again: where it went."""
        x, y, _ = self.anchored
        if segment.longest_gap >= HOLE:
            x, y = self._drifted()
        elif segment.times is not None:
            x, y = self._stepped(segment, segment.times)
        # else it turned on the spot, or shook; it did not swing
        x0, y0, _ = self.anchored
        self.length += hypot(x - x0, y - y0)
        self.steps += 1
        self.attitude = multiply(from_yaw(heading_turned(self.stood, self.attitude)), self.stood)
        self.anchored = (x, y, 0.0)

    def _stepped(self, segment: StepSegment, times: CriticalTimes) -> tuple[float, float]:
        settings, rows = self.settings, segment.rows
        phi = settings.outwards * settings.toe_out
        if settings.printed:
            length, turn = sum(step_length(rows, times, phi)), turned(rows, times)
        else:
            end = AT_END * self.near if self.near > 0.0 else inf
            length, turn = sum(closed_step_length(rows, times, phi, end)), turned_about_vertical(rows, times, end)
        turn = self.turning.turn(turn)
        fx, fy, _ = rotate(self.stood, segment.forward)
        # x is to the right: from the foot's direction the way lies phi to that side
        way = atan2(fy, fx) + 0.5 * turn - phi
        self.attitude = multiply(from_yaw(turn), self.stood)
        length = min(max(length, -FURTHEST), FURTHEST)
        x, y, _ = self.anchored
        return x + length * cos(way), y + length * sin(way)

    def _drifted(self) -> tuple[float, float]:
        x, y, _ = self.position
        vx, vy, _ = self.velocity
        half = 0.5 * min(self.moving, LONGEST)
        x, y = x - vx * half, y - vy * half
        x0, y0, _ = self.anchored
        k = FURTHEST / max(FURTHEST, hypot(x - x0, y - y0))
        return x0 + k * (x - x0), y0 + k * (y - y0)

    def repair(self, yaw: float, position: Vec3) -> None:
        """As in `Corrector`, of a step that lost samples; the others are told by their own equations alone."""

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            return dt
        self.velocity = ZERO
        self.force = self.rate = None
        self.length += 1.0
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self.moving += dt

    def anchor(self) -> tuple[float, ...]:
        stretch = self.covariance()
        self.length, self.steps = 0.0, 0
        return stretch

    def covariance(self) -> tuple[float, ...]:
        x, y, _ = self.position
        x0, y0, _ = self.anchored
        variance = (STEP_ERROR * (self.length + hypot(x - x0, y - y0))) ** 2
        yaw = TURN_ERROR * TURN_ERROR * min(self.steps, 1000)
        return (variance, 0.0, 0.0, variance, 0.0, 0.0, yaw)

    def _level(self, dt: float) -> None:
        """Turn the attitude about f x z so that the specific force points up, by 1/s."""
        if self.force is None:
            return
        fx, fy, _ = self.force
        share = 0.5 * dt / GRAVITY
        self.attitude = tipped(self.attitude, share * fy, -share * fx)
