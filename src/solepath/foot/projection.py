"""Step length by projection onto the ground, and turn by the swing (Liu et al. 2015, footstep-tracker, sections IV.C
and IV.D).

    theta(t) = integral of g_x from uplift to t                                   (3)
    a_f = a_y cos(theta) + a_z sin(theta)                                         (2)
    a_m = a_f cos(phi) + a_x sin(phi)                                             (1), (4)
    S   = integral of the integral of a_m from liftoff to landing                 (5)
    S_x, S_y, S_z: the parts of S that come from a_x, a_y and a_z                 (6)
    alpha = integral of g_z from liftoff to landing                               (7)

Axes and signs are those of critical_times.py. What the paper leaves open:

- phi is the toe-out angle, from the foot's direction outwards. The paper's x points to the right, so that (1) as
  printed holds for a left foot whose toe points outwards: its way lies to the right of its direction. For a right foot
  a_x changes its sign.
- (5) begins with no velocity, but at liftoff a foot is fast already: its heel has risen for 0.2 s and more. As printed
  it has half of a step or less, on emulated feet and on recorded ones; figure 11 has 1.11 m of 1.23 m. From uplift,
  where the foot really rests, the same integral has 75 to 95 %, as the figure does. So the integrals begin at uplift.
- The paper's gyroscope ends at 250 degrees/s, which a swing exceeds; theta is then off when the foot is flat again,
  and what is left of gravity moves the step by some 20 %. At rest theta and the velocity are zero: what is left of them
  there has come in evenly, and is taken out (theta before (2), the velocity after it), and the integrals end at rest.
- "When the users are turning they always take the gravity direction as the axis": the rate about it is g_z while the
  foot is flat, and g_z cos(theta) + g_y sin(theta) in general. Where strides were surveyed this comes to 183, 200, 1092
  and 295 degrees from uplift to rest, of 178, 175, 1082 and 239; (7) as printed to 333, 352, 875 and 644.
  A foot that pivots on its sole, in what looks like a static zone, turns as its gyroscope says.
- `printed` does without all this.
- The integrals are trapezoidal. The critical times lie between two samples, where the signals are straight lines.
- From one rest to the next the foot goes where it points after half of the turn: along the chord of an arc.
- A step that lost samples for longer than `HOLE` is not one that these integrals hold for: it goes where the live
  track is, less the drift that its velocity shows at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

from attrs import define, evolve, field

from ..calibration import Calibration
from ..types import Foot, Phase, Quat, Vec3
from ..vector import GRAVITY, IDENTITY, ZERO, from_yaw, multiply, rotate, tipped
from .critical_times import CriticalTimes, Row
from .navigate import LONGEST_BRIDGE, Strapdown
from .segment import Segment
from .stance import Stance
from .turn import heading_turned
from .turning_steps import TurningSteps

HOLE = 0.12
"""s: two of the paper's samples."""
LONGEST = 2.0
"""A foot that has not lain still for longer than this is not followed any further before it does, s."""
PIVOT = 0.15
"""A foot that lies as if still and yet turns faster than this about the vertical pivots on its sole, rad/s."""
FURTHEST = 3.0
"""No step is longer, m."""


@define
class Projection(Strapdown):
    """Moves step by step. Frame as in `Corrector`; height is always 0, for the paper's track has none.

    Latency: a step is known when the static zone that ends it is. Meanwhile the live position and attitude are those of
    a strapdown, the former without its height, and leap to the step's own end.
    """

    toe_out: float = 0.0
    """phi of this foot, rad; outwards positive."""
    outwards: float = 1.0
    """1 for a left foot, -1 for a right one: phi of (1) is `toe_out` times this."""
    printed: bool = False
    """The equations as they are printed."""
    share: float = 0.1
    """What a step is wrong by, as a share of its length: the paper's figure 11."""
    turn_error: float = 0.05
    """What a step's turn is wrong by, rad."""
    turning: TurningSteps = field(factory=TurningSteps)
    # state
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
        return evolve(self, toe_out=calibration.toe_out.get(foot, self.toe_out), outwards=outwards)

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = self.stood = attitude
        self.velocity = self.position = self.anchored = ZERO
        self.force = self.rate = None
        self.moving = self.length = 0.0
        self.steps = 0

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        before = self.position
        self.integrate(dt, acc, gyro)
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
        if stance.segment is None:
            if self.printed or self.rate is None or abs(rotate(self.attitude, self.rate)[2]) < PIVOT:
                self.attitude = self.stood
        else:
            self._rest(stance.segment)
        self.position, self.velocity = self.anchored, ZERO
        self._level(min(self.moving, 0.1))
        self.stood, self.moving = self.attitude, 0.0
        return True

    def _rest(self, segment: Segment) -> None:
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

    def _stepped(self, segment: Segment, times: CriticalTimes) -> tuple[float, float]:
        phi = self.outwards * self.toe_out
        rows = segment.rows
        if self.printed:
            length, turn = sum(step_length(rows, times, phi)), turned(rows, times)
        else:
            length, turn = sum(closed_step_length(rows, times, phi)), turned_about_vertical(rows, times)
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

    def mend(self, yaw: float, position: Vec3) -> None:
        """As in `Corrector`, of a step that lost samples; the others are told by their own equations alone."""

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            return dt
        self.velocity = ZERO
        self.force = self.rate = None
        self.length += 1.0
        return 0.0

    def leap(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
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
        variance = (self.share * (self.length + hypot(x - x0, y - y0))) ** 2
        yaw = self.turn_error * self.turn_error * min(self.steps, 1000)
        return (variance, 0.0, 0.0, variance, 0.0, 0.0, yaw)

    def _level(self, dt: float) -> None:
        """Turn the attitude about f x z so that the specific force points up, by 1/s."""
        if self.force is None:
            return
        fx, fy, _ = self.force
        share = 0.5 * dt / GRAVITY
        self.attitude = tipped(self.attitude, share * fy, -share * fx)


# --- the equations ----------------------------------------------------------------------------------------------------


def step_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0) -> tuple[float, float, float]:
    """S_x, S_y, S_z of (6) in m, as printed; S of (5) is their sum. `toe_out`: phi of (1), rad."""
    theta = _integral(span(rows, times.uplift, times.liftoff), 4)
    return _lengths(span(rows, times.liftoff, times.landing), theta, 0.0, toe_out)[0]


def closed_step_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0) -> tuple[float, float, float]:
    """The same from uplift to rest, where theta and the velocity are zero again."""
    step = span(rows, times.uplift, times.rest)
    lasted = times.rest - times.uplift
    if not lasted > 0.0:
        return (0.0, 0.0, 0.0)
    (x, y, z), (vx, vy, vz) = _lengths(step, 0.0, _integral(step, 4) / lasted, toe_out)
    half = 0.5 * lasted
    return (x - half * vx, y - half * vy, z - half * vz)


def turned(rows: Sequence[Row], times: CriticalTimes) -> float:
    """alpha of (7), as printed: positive to the left, rad."""
    return _integral(span(rows, times.liftoff, times.landing), 6)


def turned_about_vertical(rows: Sequence[Row], times: CriticalTimes) -> float:
    """The same of the rate about the vertical, from uplift to the last row: a flat foot may pivot yet."""
    step = span(rows, times.uplift, max(times.rest, rows[-1][0]))
    lasted = times.rest - times.uplift
    if not lasted > 0.0:
        return 0.0
    drift = _integral(span(rows, times.uplift, times.rest), 4) / lasted
    theta, angle = 0.0, 0.0
    t, gx, was = step[0][0], step[0][4], step[0][6]
    for row in step[1:]:
        dt = row[0] - t
        theta = theta + (0.5 * (gx + row[4]) - drift) * dt if row[0] <= times.rest else 0.0
        now = row[6] * cos(theta) + row[5] * sin(theta)
        angle += 0.5 * (was + now) * dt
        t, gx, was = row[0], row[4], now
    return angle


def _lengths(step: Sequence[Row], theta: float, drift: float, toe_out: float) -> tuple[Vec3, Vec3]:
    """The parts of (6), m, and of the velocity at the end, m/s. `theta` at the beginning, rad; `drift` is taken off
    g_x, rad/s."""
    along, across = cos(toe_out), sin(toe_out)
    v_x = v_y = v_z = s_x = s_y = s_z = 0.0
    t, ax, ay, az, gx, _, _ = step[0]
    x, y, z = ax * across, ay * cos(theta) * along, az * sin(theta) * along
    for row in step[1:]:
        dt = row[0] - t
        theta += (0.5 * (gx + row[4]) - drift) * dt  # (3)
        t, ax, ay, az, gx, _, _ = row
        was_x, was_y, was_z = x, y, z
        x, y, z = ax * across, ay * cos(theta) * along, az * sin(theta) * along  # (2), (4)
        s_x += (v_x + (2.0 * was_x + x) * dt / 6.0) * dt
        s_y += (v_y + (2.0 * was_y + y) * dt / 6.0) * dt
        s_z += (v_z + (2.0 * was_z + z) * dt / 6.0) * dt
        v_x += 0.5 * (was_x + x) * dt
        v_y += 0.5 * (was_y + y) * dt
        v_z += 0.5 * (was_z + z) * dt
    return (s_x, s_y, s_z), (v_x, v_y, v_z)


def span(rows: Sequence[Row], begin: float, end: float) -> list[Row]:
    """The rows from `begin` to `end`, s, with those in between two rows at either end."""
    inside = [row for row in rows if begin < row[0] < end]
    return [_at(rows, begin), *inside, _at(rows, end)]


def _at(rows: Sequence[Row], t: float) -> Row:
    before = rows[0]
    for row in rows:
        if row[0] >= t:
            k = 1.0 if row[0] <= before[0] else (t - before[0]) / (row[0] - before[0])
            k = max(k, 0.0)
            x, y, z, u, v, w = (b + k * (n - b) for b, n in zip(before[1:], row[1:], strict=True))
            return (t, x, y, z, u, v, w)
        before = row
    return (t, *rows[-1][1:])


def _integral(rows: Sequence[Row], column: int) -> float:
    total = 0.0
    for before, row in zip(rows, rows[1:], strict=False):
        total += 0.5 * (before[column] + row[column]) * (row[0] - before[0])
    return total
