"""Cues for toe-off and heel-strike from the centre of pressure (CoP), and the phases that follow from them.

After Chen et al. 2019 (IEEE Internet of Things Journal 6), section III.C.2 and fig. 4. While the foot is in the air the
CoP is set to the foot's centre. So the CoP jumps from the toes to the centre when the foot leaves the ground (samples A
and B of the figure), stays there in the air, and jumps to the heel when the foot lands (samples C and D).

- A motion starts after the last stationary sample, and ends with the next stationary sample.
- Toe-off (A) is the sample before the largest jump between motion start and the first sample of swing.
- Heel-strike (D) is the sample after the largest jump between swing and motion end.
- A jump is the "maximum of COP differential signal" of the paper's copY, which grows from toe to heel; `x` here grows
  from heel to toe.
- A swing is normal if the CoP stayed at the foot's centre for `REST_TIME` s. A stride without a normal swing is
  abnormal (section IV.A, the first left step of fig. 10): "toe-off and heel-strike were not extracted for that step".
  Its phases follow one another without a heel-strike. It has no mark of one, so it does not calibrate anything.

The inertial cues are used while the load is unknown, that is until it has fallen and risen once. A foot that slides
away without leaving the ground has its toe-off where it became fast, if it stays fast for `SHUFFLE_TIME`. `STAGES`
gives the next stage for each cue of the cells. A stage is not a phase: a toe-off is known as soon as the foot is in the
air, a heel-strike only when the foot lies flat, and a foot that was in the air for less than a swing has not left the
ground yet. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...foot.cues.cues import Cues, TimedCue
from ...foot.cues.inertial import SHUFFLE_SPEED, InertialCues
from ...foot.cues.touch import Touch, TouchSettings
from ...foot.phase import Cue
from ...foot.pressure.insole import centre
from ...foot.stance.stance import Load, Stance
from ...types import Layout, Phase, ValueEnum, Vec3
from ...types.attrs import field, state, stateful
from ...types.vector import TIME_EPSILON

LARGEST_JUMP = 1e3
"""Jump that the centre of pressure cannot exceed, m."""
REST_TIME, LONGEST_LANDING = 0.1, 0.4
"""Least time of the CoP at the foot's centre in a normal swing, and longest wait for a stationary foot on landing, s.

After the wait a heel-strike is reported even if the foot is not stationary yet."""
SHUFFLE_TIME = 0.25
"""Time, s, after which a foot that stays fast (InertialCues) without being in the air counts as swinging."""
AREA_ON, AREA_OFF = 0.05, 0.03
"""Loads for an insole alone, as shares of the full load.

Foot-flat starts when both areas exceed the first, and lasts until one falls below the second."""
LOAD_VALID_TIME = 0.05
"""Longest time, s, for which samples without a load are skipped, because cells are read less often than the IMU."""


class StrideStage(ValueEnum):
    """The stage of a stride by the pressure cells."""

    STANDING = "standing"  # stationary
    LEAVING = "leaving"  # moving, but not yet in swing
    FLYING = "flying"  # in the air
    LANDING = "landing"  # on the ground again after a normal swing


class CellCue(ValueEnum):
    """A cue from the pressure cells of one sample."""

    STANDS = "stands"  # the foot lies still on the ground
    MOVES = "moves"  # the foot does not lie still
    LEAVES = "leaves"  # the foot is in the air
    BRUSHES = "brushes"  # the foot is on the ground again, too soon for a swing
    LANDS = "lands"  # the foot is on the ground again after a normal swing
    LINGERS = "lingers"  # the foot landed long ago and does not lie still


_STANDING, _LEAVING, _FLYING, _LANDING = StrideStage
STAGES: dict[tuple[StrideStage, CellCue], tuple[StrideStage, tuple[Cue, ...]]] = {
    (_STANDING, CellCue.MOVES): (_LEAVING, (Cue.LIFT,)),
    (_STANDING, CellCue.LEAVES): (_FLYING, (Cue.LIFT, Cue.CLEAR)),
    (_LEAVING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_LEAVING, CellCue.LEAVES): (_FLYING, (Cue.CLEAR,)),
    (_FLYING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_FLYING, CellCue.BRUSHES): (_LEAVING, ()),  # no swing yet: a better candidate for toe-off may come
    (_FLYING, CellCue.LANDS): (_LANDING, ()),
    (_LANDING, CellCue.STANDS): (_STANDING, (Cue.CONTACT, Cue.FLAT)),
    (_LANDING, CellCue.LEAVES): (_FLYING, (Cue.CONTACT, Cue.CLEAR)),  # never flat: toe walking, running
    (_LANDING, CellCue.LINGERS): (_LANDING, (Cue.CONTACT,)),
}
"""Next stage and reported cues; a cue of a stage that is not here changes nothing."""


@stateful
class CopCues(Cues):
    """Reports toe-off and heel-strike from the centre of pressure.

    Latency: toe-off and heel-off are known one sample later, heel-strike and foot-flat at the first stationary sample,
    as in the paper."""

    uses_centre: ClassVar[bool] = True

    settings: TouchSettings = field(default=TouchSettings())
    inertial: InertialCues = state(factory=InertialCues)
    touch: Touch = field(init=False)
    sagittal: float = 0.0
    """Rate about the axis to the wearer's left in the last sample, positive toe down, rad/s (`Cues`)."""
    mark: Cue | None = None
    """Mark of the last sample, None without one. `Cue.CLEAR` means that the sample before it is the best candidate so
    far for toe-off, `Cue.CONTACT` that the last sample is the best candidate for heel-strike."""
    foot_centre: float | None = None
    """Coordinate x of the foot's centre, foot frame, m; None without a layout."""
    stage: StrideStage = StrideStage.LEAVING
    """Stage of the stride by the cells."""
    cop: float | None = None
    """Coordinate x of the centre of pressure in the last sample, foot frame, m."""
    load_t: float | None = None
    """Time of the last sample with a load, s."""
    largest_jump: float = -1.0
    """Largest jump of the CoP so far in this stage, m; before the first a jump that no CoP can make."""
    candidate_t: float | None = None
    """Time of the best candidate for toe-off or heel-strike, s."""
    ground_t: float | None = None
    """Time of the last sample on the ground, s."""
    stage_t_start: float = 0.0
    """Start of the stage, s."""
    airborne_t_start: float | None = None
    """Start of the time in the air, s; None on the ground."""
    contact_reported: bool = False
    """Flag: the heel-strike of this landing was reported."""
    fast_t_start: float | None = None
    """Time since which the foot has been fast, s; None while it is not."""
    areas_loaded: bool = False
    """Flag, for an insole alone: both areas are loaded."""

    def __attrs_post_init__(self) -> None:
        self.touch = Touch(self.settings)

    def set_layout(self, layout: Layout) -> None:
        self.foot_centre = centre(layout)
        self.touch.set_layout(layout)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[TimedCue]:  # fmt: skip
        self.mark = None
        seen = self.inertial.update(t, dt, acc, gyro, still, speed, phase)
        self.sagittal = 0.0 if self.inertial.axis is None else self.inertial.sagittal
        if load is None and self.load_t is not None and t - self.load_t < LOAD_VALID_TIME:
            return ()
        stationary = still and stance.hint is Phase.STATIONARY
        airborne = self.touch.update(t, load, stationary)
        if load is None or not self.touch.trusted:
            self._discard_load(t)
            return () if seen is None else (seen,)
        cues = self._start(t, airborne, phase) if self.load_t is None else []
        cues += self._add_load(t, stationary, airborne, load)
        if self.stage is StrideStage.LEAVING and phase is not Phase.SWING and speed >= SHUFFLE_SPEED:
            if self.fast_t_start is None:
                self.fast_t_start = t
            elif t - self.fast_t_start >= SHUFFLE_TIME - TIME_EPSILON:
                cues.append(TimedCue(Cue.CLEAR, self.fast_t_start))
        else:
            self.fast_t_start = None
        return cues

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[TimedCue]:
        """Return the cues of one sample of an insole alone (`Cues`); a foot is stationary when both areas are loaded.

        Without a layout there are no areas; then a heel-strike is reported `LONGEST_LANDING` late, and foot-flat
        never."""
        least = min(load.heel or 0.0, load.forefoot or 0.0)
        self.areas_loaded = least >= (AREA_OFF if self.areas_loaded else AREA_ON)
        return self._add_load(t, self.areas_loaded, self.touch.update(t, load), load)

    def _start(self, t: float, airborne: bool, phase: Phase) -> list[TimedCue]:
        """Return the cues at the first sample with a known load, when the foot swings or has just landed."""
        if airborne:
            self.stage, self.airborne_t_start = StrideStage.FLYING, t - REST_TIME
            moved_t = t if self.touch.moving_since is None else self.touch.moving_since
            return [] if phase is Phase.SWING else [TimedCue(Cue.CLEAR, moved_t)]
        if phase is Phase.SWING:
            self._enter(StrideStage.LANDING, t)
            self.largest_jump, self.candidate_t = LARGEST_JUMP, t  # report this sample, but never set a mark
        return []

    def _add_load(self, t: float, stationary: bool, airborne: bool, load: Load) -> list[TimedCue]:
        last_cop, last_t = self.cop, self.load_t
        self.load_t = t
        ground_cop = last_cop if load.centre is None else load.centre[0]
        new_cop = self.foot_centre if airborne else ground_cop
        self.cop = new_cop
        jump = 0.0 if last_cop is None or new_cop is None else last_cop - new_cop  # x falls towards the heel
        cues: list[TimedCue] = []
        for cue in self._cell_cues(t, stationary, airborne):
            stage, reported = STAGES.get((self.stage, cue), (self.stage, ()))
            cues += self._with_times(reported, t)
            if stage is self.stage or cue is CellCue.LEAVES or cue is CellCue.BRUSHES:
                self.stage = stage  # the search for the largest jump continues
            else:
                self._enter(stage, t)
            if cue is CellCue.MOVES or cue is CellCue.LANDS:
                self._update_candidate(jump, last_t, t)
        if not airborne:
            self.ground_t, self.airborne_t_start = t, None
        elif self.airborne_t_start is None:
            self.airborne_t_start = t
        return cues

    def _cell_cues(self, t: float, stationary: bool, airborne: bool) -> list[CellCue]:
        """Return the cues of the cells in this sample, in order."""
        rested = self.airborne_t_start is not None and t - self.airborne_t_start >= REST_TIME - TIME_EPSILON
        landing = self.stage is StrideStage.LANDING
        if airborne:
            if landing:
                return [CellCue.LEAVES] if rested else []
            return [CellCue.MOVES, CellCue.LEAVES]
        if self.stage is StrideStage.FLYING:
            touched = CellCue.LANDS if rested else CellCue.BRUSHES
            return [touched, CellCue.STANDS] if stationary else [touched]
        if stationary:
            return [CellCue.STANDS]
        lingers = landing and t - self.stage_t_start >= LONGEST_LANDING - TIME_EPSILON
        return [CellCue.MOVES, CellCue.LINGERS] if lingers else [CellCue.MOVES]

    def _update_candidate(self, jump: float, last_t: float | None, t: float) -> None:
        """Make the sample the best candidate if its jump, m, since `last_t`, s, is the largest of this stage.

        Without a layout nothing jumps; then toe-off is the last sample on the ground."""
        if jump <= self.largest_jump:
            return
        if self.stage is StrideStage.LEAVING and last_t is not None and self.foot_centre is not None:
            self.largest_jump, self.candidate_t, self.mark = jump, last_t, Cue.CLEAR
        elif self.stage is StrideStage.LANDING and not self.contact_reported:
            self.largest_jump, self.candidate_t, self.mark = jump, t, Cue.CONTACT

    def _with_times(self, cues: Sequence[Cue], t: float) -> list[TimedCue]:
        timed_cues: list[TimedCue] = []
        for cue in cues:
            cue_t: float | None = t
            if cue is Cue.CONTACT:
                cue_t = None if self.contact_reported else self.candidate_t
                self.contact_reported = self.contact_reported or self.candidate_t is not None
            elif cue is Cue.CLEAR:
                landing = self.stage is StrideStage.LANDING  # then the candidate is one for heel-strike
                cue_t = self.candidate_t if self.candidate_t is not None and not landing else self.ground_t
                if cue_t is None:
                    cue_t = self.airborne_t_start if landing else t
            if cue_t is not None:
                timed_cues.append(TimedCue(cue, cue_t))
        return timed_cues

    def _enter(self, stage: StrideStage, t: float) -> None:
        self.stage = stage
        self.stage_t_start = t
        self.largest_jump = -1.0
        self.candidate_t = self.airborne_t_start = None
        self.contact_reported = False

    def _discard_load(self, t: float) -> None:
        """Discard what depends on the load, which is now unknown; so the present stride is not a normal one."""
        if self.load_t is not None or self.stage is not StrideStage.LEAVING:
            self._enter(StrideStage.LEAVING, t)
        self.load_t = self.cop = self.ground_t = None

    def make_hidden_toe_off(self, t: float) -> TimedCue:
        return self.inertial.make_hidden_toe_off(t)

    def reset(self) -> None:
        self.inertial.reset()
        self.fast_t_start = None
        if self.load_t is not None:
            self._discard_load(self.load_t)

    def restart(self) -> None:
        self.inertial = self.inertial.restart()
        self.touch = self.touch.restart()
        self._enter(StrideStage.LEAVING, 0.0)
        self.cop = self.load_t = self.ground_t = self.fast_t_start = self.mark = None
        self.areas_loaded = False
