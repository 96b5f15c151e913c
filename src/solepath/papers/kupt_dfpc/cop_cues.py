"""Toe-off and heel-strike from the centre of pressure; the phases that follow from them.

After Chen et al. 2019 (IEEE Internet of Things Journal 6), section III.C.2 and fig. 4. In the air the centre of
pressure is set to the foot's centre. Along the foot it jumps there from the toes when the foot leaves the ground (from
sample A to B of the figure), rests there in the air, and jumps from there to the heel when it lands (C to D).

- Toe-off is the sample before the largest jump from motion start to the first sample of swing (point A).
- Heel-strike is the sample after the largest jump from swing to motion end (point D).
- Motion ends and starts with the first and after the last sample that the detector calls stationary.
- A swing is normal when the centre of pressure rested at the foot's centre for `REST` s. A step without one is abnormal
  (section IV.A): "toe-off and heel-strike were not extracted for that step". Its phases go on all the same, without a
  heel-strike, and no mark is set, so that nothing is calibrated by it.

Where there is no load yet (it is not known before it has fallen and risen once) the inertial cues speak. A foot that
slides away without ever leaving the ground has cleared it when it has been fast for `SHUFFLE_TIME`. What follows from
what the cells show is the table of stages.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...foot.cues.cues import Cues, SeenCue
from ...foot.cues.inertial import SHUFFLE_SPEED, InertialCues
from ...foot.cues.touch import Touch
from ...foot.phase import Cue
from ...foot.pressure.cells import centre
from ...foot.stance.stance import Load, Stance
from ...types import Layout, Phase, Vec3
from ...types.attrs import define, field
from ...types.vector import TIE
from .stages import STAGES, CellCue, StepStage

FARTHEST = 1e3
"""No centre of pressure jumps so far, m."""
REST, LONGEST_LANDING = 0.1, 0.4
"""In a normal swing the centre of pressure rests at the foot's centre for the first of these times, s. A heel-strike is
reported after the second, s, even when the foot is not stationary yet."""
SHUFFLE_TIME = 0.25
"""How long a foot must be fast (InertialCues) to have left without ever being in the air, s."""
AREA_ON, AREA_OFF = 0.05, 0.03
"""Of an insole alone the foot is flat from when heel and forefoot are above the first of these shares of the full load
until one of them is below the second."""
STALE = 0.05
"""Samples without cells, where those come more slowly, are no matter for so long, s."""


@define
class CopCues(Cues):
    """Latency: toe-off one sample; heel-strike and foot-flat at the first stationary sample, as the paper has it;
    heel-off one sample."""

    inertial: InertialCues = field(factory=InertialCues)
    touch: Touch = field(factory=Touch)
    sagittal: float = field(default=0.0, init=False)
    """As in `Cues`."""
    mark: Cue | None = field(default=None, init=False)
    """CLEAR: the sample before the last is the best candidate so far for toe-off. CONTACT: the last sample is that for
    heel-strike."""
    middle: float | None = field(default=None, init=False)
    """x of the foot's centre, m; None without a layout."""
    stage: StepStage = field(default=StepStage.LEAVING, init=False)
    cop: float | None = field(default=None, init=False)
    """x of the centre of pressure in the last sample, m."""
    pressed_at: float | None = field(default=None, init=False)
    """The last sample with a load, s."""
    jump: float = field(default=-1.0, init=False)
    """The largest so far of those looked for, m."""
    moment: float | None = field(default=None, init=False)
    """When it was: the best candidate for toe-off or heel-strike, s."""
    loaded_at: float | None = field(default=None, init=False)
    """The last sample on the ground, s."""
    since: float = field(default=0.0, init=False)
    """When the stage began, s."""
    airborne_since: float | None = field(default=None, init=False)
    told: bool = field(default=False, init=False)
    """The heel-strike of this landing was told."""
    fast_since: float | None = field(default=None, init=False)
    flat: bool = field(default=False, init=False)
    """For an insole alone: both areas are loaded."""

    def set_layout(self, layout: Layout) -> None:
        self.middle = centre(layout)
        self.touch.set_layout(layout)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[SeenCue]:  # fmt: skip
        self.mark = None
        seen = self.inertial.update(t, dt, acc, gyro, still, speed, phase)
        self.sagittal = 0.0 if self.inertial.axis is None else self.inertial.sagittal
        if load is None and self.pressed_at is not None and t - self.pressed_at < STALE:
            return ()
        stationary = still and stance.hint is Phase.STATIONARY
        airborne = self.touch.update(t, load, stationary)
        if load is None or not self.touch.trusted:
            self._forget(t)
            return () if seen is None else (seen,)
        found = self._begin(t, airborne, phase) if self.pressed_at is None else []
        found += self._step(t, stationary, airborne, load)
        if self.stage is StepStage.LEAVING and phase is not Phase.SWING and speed >= SHUFFLE_SPEED:
            if self.fast_since is None:
                self.fast_since = t
            elif t - self.fast_since >= SHUFFLE_TIME - TIE:
                found.append(SeenCue(Cue.CLEAR, self.fast_since))
        else:
            self.fast_since = None
        return found

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[SeenCue]:
        """As in `Cues`: both areas loaded say what the detector would have said. Without a layout there are no areas;
        a heel-strike is then told at once, and nothing of the sole lying flat."""
        if load.heel is None or load.forefoot is None:
            self.flat = False
            found = self._step(t, False, self.touch.update(t, load), load)
            if self.stage is StepStage.LANDING:
                found += self._dated((Cue.CONTACT,), t)
            return found
        self.flat = min(load.heel, load.forefoot) >= (AREA_OFF if self.flat else AREA_ON)
        return self._step(t, self.flat, self.touch.update(t, load), load)

    def _begin(self, t: float, airborne: bool, phase: Phase) -> list[SeenCue]:
        """The cells are believed from here on, in a swing or at its end."""
        if airborne:
            left = self.touch.moving_since
            self.stage = StepStage.FLYING
            self.airborne_since = t - REST
            return [] if phase is Phase.SWING else [SeenCue(Cue.CLEAR, t if left is None else left)]
        if phase is Phase.SWING:
            self._enter(StepStage.LANDING, t)
            self.jump, self.moment = FARTHEST, t  # it was the first of its load that was seen: told, but no mark
        return []

    def _step(self, t: float, stationary: bool, airborne: bool, load: Load) -> list[SeenCue]:
        was, before = self.cop, self.pressed_at
        self.pressed_at = t
        on_ground = was if load.centre is None else load.centre[0]
        now = self.middle if airborne else on_ground
        self.cop = now
        jump = 0.0 if was is None or now is None else abs(now - was)
        found: list[SeenCue] = []
        for cue in self._cell_cues(t, stationary, airborne):
            stage, reported = STAGES[self.stage][cue]
            found += self._dated(reported, t)
            if stage is self.stage or cue is CellCue.LEAVES or cue is CellCue.BRUSHES:
                self.stage = stage  # what is looked for goes on
            else:
                self._enter(stage, t)
            if cue is CellCue.MOVES or cue is CellCue.LANDS:
                self._compare(jump, before, t)
        if not airborne:
            self.loaded_at, self.airborne_since = t, None
        elif self.airborne_since is None:
            self.airborne_since = t
        return found

    def _cell_cues(self, t: float, stationary: bool, airborne: bool) -> list[CellCue]:
        """From numbers to cues: what this sample shows, in order."""
        rested = self.airborne_since is not None and t - self.airborne_since >= REST - TIE
        landing = self.stage is StepStage.LANDING
        if airborne:
            if landing:
                return [CellCue.LEAVES] if rested else []
            return [CellCue.MOVES, CellCue.LEAVES]
        if self.stage is StepStage.FLYING:
            touched = CellCue.LANDS if rested else CellCue.BRUSHES
            return [touched, CellCue.STANDS] if stationary else [touched]
        if stationary:
            return [CellCue.STANDS]
        lingers = landing and t - self.since >= LONGEST_LANDING - TIE
        return [CellCue.MOVES, CellCue.LINGERS] if lingers else [CellCue.MOVES]

    def _compare(self, jump: float, before: float | None, t: float) -> None:
        """The centre of pressure has jumped by `jump` m since the sample at `before` s: the best candidate so far?"""
        if jump <= self.jump:
            return
        if self.stage is StepStage.LEAVING and before is not None:
            self.jump, self.moment, self.mark = jump, before, Cue.CLEAR
        elif self.stage is StepStage.LANDING and not self.told:
            self.jump, self.moment, self.mark = jump, t, Cue.CONTACT

    def _dated(self, cues: Sequence[Cue], t: float) -> list[SeenCue]:
        """The cues with their times."""
        found: list[SeenCue] = []
        for cue in cues:
            at: float | None = t
            if cue is Cue.CONTACT:
                at, self.told = None if self.told else self.moment, self.told or self.moment is not None
            elif cue is Cue.CLEAR:
                landing = self.stage is StepStage.LANDING  # the candidate is one for heel-strike
                at = self.moment if self.moment is not None and not landing else self.loaded_at
                if at is None:
                    at = self.airborne_since if landing else t
            if at is not None:
                found.append(SeenCue(cue, at))
        return found

    def _enter(self, stage: StepStage, t: float) -> None:
        self.stage = stage
        self.since = t
        self.jump = -1.0
        self.moment = self.airborne_since = None
        self.told = False

    def _forget(self, t: float) -> None:
        """Nothing is known of the load: the step under way is not a normal one."""
        if self.pressed_at is not None or self.stage is not StepStage.LEAVING:
            self._enter(StepStage.LEAVING, t)
        self.pressed_at = self.cop = self.loaded_at = None

    def cleared(self, t: float) -> SeenCue:
        return self.inertial.cleared(t)

    def reset(self) -> None:
        self.inertial.reset()
        self.fast_since = None
        if self.pressed_at is not None:
            self._forget(self.pressed_at)

    def restart(self) -> None:
        self.inertial = self.inertial.restart()
        self.touch = self.touch.restart()
        self._enter(StepStage.LEAVING, 0.0)
        self.cop = self.pressed_at = self.loaded_at = self.fast_since = self.mark = None
        self.flat = False
