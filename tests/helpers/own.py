"""A detector, a corrector and cues that an app could define, and a walk to test them with."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from attrs import define, evolve, field

from solepath import Foot, Phase
from solepath.calibration import Calibration
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.foot.cues.cues import Cues, TimedCue
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.phase import Cue
from solepath.foot.stance.stance import Detector, Load, Stance
from solepath.types import Layout, Quat, Vec3
from solepath.types.vector import IDENTITY, ZERO

CELLS = layout(24, Foot.LEFT)
WALKED = tuple(Walker(Route().stand(2).walk(8).stop(2)).samples(Foot.LEFT, 50.0, layout=CELLS))


@define
class StillDetector(Detector):
    """A detector of stance: the rate was at most `limit` rad/s for `hold` s."""

    limit: float = 0.8
    hold: float = 0.04
    since: float | None = field(default=None, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = (x * x + y * y + z * z) ** 0.5
        if rate > self.limit:
            self.since = None
            return Stance(ZERO, inf, rate, None)
        self.since = t if self.since is None else self.since
        is_still = t - self.since >= self.hold
        return Stance(ZERO, 0.01 if is_still else 0.1, rate, Phase.STATIONARY if is_still else None)


@define
class Resets(LinearDedrift):
    """A corrector that resets the velocity in stance and leaves the position unchanged."""

    resets: int = field(default=0, init=False)

    def correct(self, t: float, stance: Stance) -> bool:
        position = self.position
        if not LinearDedrift.correct(self, t, stance):
            return False
        self.position = position
        self.resets += 1
        return True


@define
class ByMotion(Cues):
    """Cues by motion: a still foot is flat on the ground, a moving foot is lifted, and a fast foot is in the air."""

    fast: float = 1.0
    for_foot: str = ""
    cells: int = field(default=0, init=False)
    stood: float | None = field(default=None, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[TimedCue]:  # fmt: skip
        if still:
            self.stood = t
            return (TimedCue(Cue.CONTACT, t), TimedCue(Cue.FLAT, t)) if phase is not Phase.STATIONARY else ()
        if phase is Phase.STATIONARY:
            return (TimedCue(Cue.LIFT, t),)
        return (TimedCue(Cue.CLEAR, t),) if speed > self.fast and phase is not Phase.SWING else ()

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[TimedCue]:
        return (TimedCue(Cue.CLEAR if load.airborne else Cue.CONTACT, t),)

    def set_layout(self, layout: Layout) -> None:
        self.cells = len(layout.cells)

    def calibrated(self, foot: Foot, calibration: Calibration) -> ByMotion:
        return evolve(self, for_foot=foot.value)
