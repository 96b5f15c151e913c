"""Cues of most recipes, from the inertial sensor and the pressure cells.

Without cells all four cues come from the inertial sensor. With cells the load gives CONTACT (heel-strike) and CLEAR
(toe-off); FLAT (foot-flat) and LIFT (heel-off) still come from the inertial sensor. The load of the heel then gives the
time of LIFT."""

from __future__ import annotations

from collections.abc import Sequence

from ...types import Layout, Phase, Vec3
from ...types.attrs import define, evolve, field
from ..phase import Cue
from ..stance.stance import Load, Stance
from .cues import Cues, TimedCue
from .inertial import InertialCues
from .pressure import PressureCues
from .touch import MOST_SINGLE_CELLS, Touch


@define
class GaitCues(Cues):
    """Detects gait events from the inertial sensor and the load.

    Latency: that of `InertialCues`, or of `PressureCues` with pressure cells."""

    inertial: InertialCues = field(factory=InertialCues)
    pressure: PressureCues = field(factory=PressureCues)
    touch: Touch = field(factory=Touch)
    """Detector of ground contact for insoles of few cells."""
    sagittal: float = field(default=0.0, init=False)
    """Rate of the last sample about the axis to the wearer's left, positive toe down, rad/s; 0 if unknown."""

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells."""
        self.touch.set_layout(layout)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[TimedCue]:  # fmt: skip
        """Return at most one cue; arguments as in `Cues`."""
        inertial = self.inertial
        seen = inertial.update(t, dt, acc, gyro, still, speed, phase)
        self.sagittal = 0.0 if inertial.axis is None else inertial.sagittal
        if load is None and seen is None:
            return ()
        if load is not None:
            pressure_cue = self.pressure.update(t, dt, load, phase)
            if len(load.cells) <= MOST_SINGLE_CELLS:
                airborne = self.touch.update(t, load, still)
                if not self.touch.trusted:
                    return () if seen is None else (seen,)
                pressure_cue = None
                if airborne is not (phase is Phase.SWING):
                    pressure_cue = TimedCue(Cue.CLEAR if airborne else Cue.CONTACT, t)
            if pressure_cue is not None:
                if pressure_cue.cue is Cue.CLEAR:
                    inertial.apply_toe_off(phase)
                    self.sagittal = 0.0 if inertial.axis is None else inertial.sagittal
                return (pressure_cue,)
            if seen is not None and seen.cue is not Cue.FLAT:
                seen = self.pressure.date_lift(seen) if seen.cue is Cue.LIFT else None
        return () if seen is None else (seen,)

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[TimedCue]:
        """Return the cue of an insole without inertial sensor, from the loads of heel and forefoot."""
        seen = self.pressure.update(t, dt, load, phase) or self.pressure.update_areas(t, load, phase)
        return () if seen is None else (seen,)

    def make_hidden_toe_off(self, t: float) -> TimedCue:
        """Return a toe-off at `t`, s, which a gap has hidden."""
        return self.inertial.make_hidden_toe_off(t)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, after a gap."""
        self.inertial.reset()

    def restart(self) -> None:
        """Discard what depends on times, because times restart; what was learnt stays."""
        self.inertial = self.inertial.restart()
        self.pressure = evolve(self.pressure)
        self.touch = self.touch.restart()
