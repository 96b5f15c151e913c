"""Navigation by Li et al. 2016 (printed.py) with what joggers, landings and cheap accelerometers need beyond the paper.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from math import hypot
from typing import ClassVar

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.navigate.level import LevelGround
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec2, Vec3
from ...types.attrs import state, stateful
from ...types.vector import GRAVITY, TIME_EPSILON, ZERO, add, dot, sub, tipped
from .printed import GatedTilt

SHORTEST_SWING = 0.3
"""Duration of the shortest swing, s."""
SHORTEST_STANCE = 0.03
"""Duration of the shortest stance, s."""
REPORT_DELAY = 0.05
"""Time after which an uncertain stance is reported even if the previous stance became certain, s."""
OVERDUE_LIMIT_GROWTH = 10.0
"""Growth of the speed limit with the square of the time after `LONGEST_SWING`, m/s^3: speeds may err by any amount."""
HEIGHT_SIGMA = 0.05
"""Standard deviation of the height of a motion of 1 s, m; it grows with the square of time, and its scale is learnt."""
TURN_LEFT = 0.36
"""Share of a turn that still shows in the tilt after the next stance.

The feedback leaves exp(-0.5) of it in half a second of stance, and `tilt_share` leaves 0.6 of that."""
LARGEST_SETTLED_TURN = 0.2
"""Turn that the tilt has not followed from which on a stride with a small height is level, rad."""
LARGEST_LEVEL_HEIGHT = 0.12
"""Absolute height change, m, up to which a height is small in that sense; a riser is higher."""
UNCERTAIN_SIGMA, LONGEST_SWING = 0.04, 0.9
"""Largest sigma of a stance, m/s, and time without a stance, s, after which twice that sigma is accepted."""
SPEED_LIMIT_GROWTH, UNCERTAIN_SHARE = 1.0, 0.5
"""Growth of the limit of the integrated speed with time since the last stance, m/s^2; and its factor.

The factor applies without the hint STATIONARY. A tilt error of 6 degrees makes the speed grow by 1 m/s^2."""


Motion = tuple[Vec3, Vec3]
"""Position, m, and velocity, m/s, navigation frame."""


@stateful
class ShoeSensing(GatedTilt):
    """Corrector of `GatedTilt` that also finds the stances of joggers, corrects tilt after a motion and keeps landings.

    Latency: velocity, position and height are corrected in one jump at the first sample of stance, and once more when
    an uncertain stance becomes certain.

    There are moments without acceleration in mid-swing and before foot-flat. The moments without acceleration in the
    stance of joggers are hardly longer. So evidence without the hint STATIONARY is only an uncertain stance: the last
    stance must have been `SHORTEST_SWING` before, sigma at most `UNCERTAIN_SIGMA`, and the integrated speed low. If
    more certain evidence follows, the motion is corrected again at that later sample. After a certain stance an
    uncertain one is reported only when it has lasted for `REPORT_DELAY`, because every stance of a walker becomes
    certain. So a jogger's first two strides may become one. The velocity left at the end of a motion also corrects the
    tilt (`tilt_share`).

    Most of the height error of a level stride comes from a tilt due to an accelerometer bias. This error per metre is
    equal in all strides (25 mg make 3.5 cm in 1.4 m). A stride onto or off a stair, a kerb and a ramp have an angle per
    metre of level ground. `LevelGround` learns that error and removes it from every stride. It keeps heights that
    differ from those of level strides, and those of strides after which the foot is pitched. The tilt is one of the
    sensor and turns with it, but only in stance: in a turn, and just after one, small heights say nothing."""

    initial_time: ClassVar[float] = 0.0
    """0: the first attitude is known at once, from the mean specific force of the first samples at rest."""
    tilt_share: ClassVar[float] = 0.4
    """Share of the tilt error that is corrected after a motion, 0 to 1. The tilt error is computed from the velocity
    left at the end of the motion. The stances of joggers are too short for the feedback."""
    detector_delay: ClassVar[float] = 0.15
    """Longest delay of the detector, s: the window of `ShortTimeEnergy`. The samples of this time before the detected
    end of a stance count as motion."""
    speed_limit: ClassVar[float] = 0.5
    """Limit of the integrated speed at a stance, m/s."""

    level: LevelGround = state(factory=LevelGround)
    """Decision which strides are level."""
    turned: float = 0.0
    """Turn that the tilt has not yet followed, rad."""
    motion_time: float = 0.0
    """Duration of the last motion, s."""
    recent_samples: deque[tuple[float, float, Vec3]] = state(factory=deque)
    """Last samples of stance, each with its time, s, duration, s, and change of the velocity, m/s."""
    least_sigma: float = 0.0
    """Least sigma of this stance, m/s."""
    stance_age: float = 0.0
    """Time since the start of the latest stance, s."""
    is_certain: bool = True
    """Flag: the last stance became certain."""
    tilt_correction: Vec2 = (0.0, 0.0)
    """Rotation of the attitude at the end of this stance: half angles about the world's x and y, rad."""
    continued_motion: Motion | None = None
    """Position, m, and velocity, m/s, integrated without stopping at this uncertain stance; None once it is certain."""
    continued_time: float = 0.0
    """Duration of `continued_motion`, s."""
    last_dt: float = 0.0
    """Time between the last two samples, s."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        GatedTilt.start(self, attitude, tilt_sigma)
        self.least_sigma = self.stance_age = self.continued_time = self.motion_time = self.turned = 0.0
        self.continued_motion = None
        self.is_certain = True
        self.tilt_correction = (0.0, 0.0)
        self.recent_samples.clear()

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        GatedTilt.predict(self, dt, acc, gyro, saturated)
        if self.continued_motion is not None:
            self.continued_motion = _moved(*self.continued_motion, self.velocity_change, dt)
            self.continued_time += dt
        self.last_dt = dt
        self.stance_age += dt

    def correct(self, t: float, stance: Stance) -> bool:
        was_standing = self.standing
        self.standing = standing = self._is_stance(stance)
        if not standing:
            if was_standing:
                self._start_motion()
            elif self.stance_age >= SHORTEST_SWING:
                self.continued_motion = None
            return False
        if was_standing:
            recent_samples = self.recent_samples
            recent_samples.append((t, self.last_dt, self.velocity_change))
            oldest = t - self.detector_delay + TIME_EPSILON
            while recent_samples and recent_samples[0][0] <= oldest:
                recent_samples.popleft()
        elif self.continued_motion is None:
            self.previous_position = self.stance_position
            self.continued_motion, self.continued_time = (self.position, self.velocity), self.swing
            self.stance_age = self.least_sigma = 0.0
        if self.continued_motion is not None and not 0.0 < self.least_sigma <= stance.sigma:
            self._end_motion(*self.continued_motion, stance)
        self.swing = 0.0
        self.position = self.stance_position
        self.velocity = stance.v_ref
        return self.continued_motion is None or not self.is_certain or self.stance_age >= REPORT_DELAY

    def _is_stance(self, stance: Stance) -> bool:
        sigma, is_certain = stance.sigma, stance.hint is Phase.STATIONARY
        if self.standing and self.stance_age < SHORTEST_STANCE:
            return True
        if stance.hint is Phase.SWING or sigma > 2.0 * UNCERTAIN_SIGMA:
            return False
        if self.standing:
            return sigma <= max(UNCERTAIN_SIGMA, self.least_sigma)
        velocity, swing = self.velocity, self.swing
        if self.continued_motion is not None:
            if sigma >= self.least_sigma:
                return False
            (_, velocity), swing = self.continued_motion, self.continued_time
        elif swing < SHORTEST_SWING and not is_certain:
            return False
        limit = self.speed_limit + SPEED_LIMIT_GROWTH * swing
        if not is_certain:
            limit *= UNCERTAIN_SHARE
        if swing > LONGEST_SWING:
            limit += OVERDUE_LIMIT_GROWTH * (swing - LONGEST_SWING) ** 2
        elif sigma > UNCERTAIN_SIGMA:
            return False
        return dot(velocity, velocity) < limit * limit

    def _end_motion(self, position: Vec3, velocity: Vec3, stance: Stance) -> None:
        """End the motion at this position and velocity, because the evidence is the most certain so far."""
        (vx, vy, _), (rx, ry, _) = velocity, stance.v_ref
        k = 0.5 * self.tilt_share / (GRAVITY * max(self.continued_time, SHORTEST_SWING))  # half angles
        self.tilt_correction = (k * (vy - ry), -k * (vx - rx))
        self.stance_position = self.dedrifted(position, velocity, self.continued_time, stance.v_ref)
        self.least_sigma, self.motion_time = stance.sigma, self.continued_time
        if stance.hint is Phase.STATIONARY:
            self.continued_motion = None

    def height_at_end(self, x: float, y: float, z: float) -> float:
        return z

    def flat(self, start: Vec3, turn: float) -> None:
        if not self.standing:
            return
        way = sub(self.stance_position, start)
        sigma = HEIGHT_SIGMA * max(self.motion_time, SHORTEST_SWING) ** 2
        self.turned = TURN_LEFT * self.turned + abs(turn)
        rise = way[2] - self.level.rise_bias * hypot(way[0], way[1])
        height = 0.0
        if self.turned < LARGEST_SETTLED_TURN or abs(rise) >= LARGEST_LEVEL_HEIGHT:
            height, _ = self.level.judge(way, turn, sigma * sigma, self.attitude)
        removed = (0.0, 0.0, height - way[2])
        self.position = self.stance_position = add(self.stance_position, removed)
        if self.continued_motion is not None:  # what was removed stays removed when the stance becomes certain
            position, velocity = self.continued_motion
            self.continued_motion = (add(position, removed), velocity)

    def _start_motion(self) -> None:
        """Start a motion with the samples in `recent_samples`, in which the foot moved already."""
        self.is_certain = self.continued_motion is None
        self.attitude = tipped(self.attitude, *self.tilt_correction)
        self.tilt_correction = (0.0, 0.0)
        self.swing, motion = 0.0, (self.stance_position, ZERO)
        for _, dt, change in (*self.recent_samples, (0.0, self.last_dt, self.velocity_change)):
            motion = _moved(*motion, change, dt)
            self.swing += dt
        self.recent_samples.clear()
        self.position, self.velocity = motion

    def bridge(self, dt: float) -> float:
        self._discard_recent_samples()
        return LinearDedrift.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self._discard_recent_samples()
        GatedTilt.infill(self, dt, attitude, velocity, position)

    def repair(self, yaw: float, position: Vec3) -> None:
        GatedTilt.repair(self, yaw, position)
        self._discard_recent_samples()

    def _discard_recent_samples(self) -> None:
        self.continued_motion = None
        self.recent_samples.clear()


def _moved(position: Vec3, velocity: Vec3, change: Vec3, dt: float) -> Motion:
    """Return position, m, and velocity, m/s, after `dt` s in which the velocity changed evenly by `change`, m/s."""
    return add(position, add(velocity, change, 0.5), dt), add(velocity, change)
