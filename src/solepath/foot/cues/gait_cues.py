"""The cues that most recipes have.

`GaitCues` reads the inertial sensor and, where there are cells, the load: contact and clear are the pressure's to say,
flat and lift the inertial sensor's, and the heel dates the lift.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...types import Layout, Phase, Vec3
from ...types.attrs import define, evolve, field
from ..phase import Cue
from ..stance.stance import Load, Stance
from .cues import Cues, SeenCue
from .inertial import InertialCues
from .pressure import PressureCues
from .touch import FEW, Touch


@define
class GaitCues(Cues):
    """Latency: that of `InertialCues`, or of `PressureCues` where there are cells."""

    inertial: InertialCues = field(factory=InertialCues)
    pressure: PressureCues = field(factory=PressureCues)
    touch: Touch = field(factory=Touch)
    """For insoles of few cells."""
    sagittal: float = field(default=0.0, init=False)
    """As in `Cues`."""

    def set_layout(self, layout: Layout) -> None:
        """The device said where its cells are."""
        self.touch.set_layout(layout)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[SeenCue]:  # fmt: skip
        """As in `Cues`; at most one."""
        inertial = self.inertial
        seen = inertial.update(t, dt, acc, gyro, still, speed, phase)
        self.sagittal = 0.0 if inertial.axis is None else inertial.sagittal
        if load is None and seen is None:
            return ()
        if load is not None:
            pressed = self.pressure.update(t, dt, load, phase)
            if len(load.cells) <= FEW:
                airborne = self.touch.update(t, load, still)
                if not self.touch.trusted:
                    return () if seen is None else (seen,)
                pressed = None
                if airborne is not (phase is Phase.SWING):
                    pressed = SeenCue(Cue.CLEAR if airborne else Cue.CONTACT, t)
            if pressed is not None:
                if pressed.cue is Cue.CLEAR:
                    inertial.apply_toe_off(phase)
                    self.sagittal = 0.0 if inertial.axis is None else inertial.sagittal
                return (pressed,)
            if seen is not None and seen.cue is not Cue.FLAT:
                seen = self.pressure.date_lift(seen) if seen.cue is Cue.LIFT else None
        return () if seen is None else (seen,)

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[SeenCue]:
        """As in `Cues`: heel and forefoot say what stillness would have said."""
        seen = self.pressure.update(t, dt, load, phase) or self.pressure.update_areas(t, load, phase)
        return () if seen is None else (seen,)

    def cleared(self, t: float) -> SeenCue:
        """As in `Cues`."""
        return self.inertial.cleared(t)

    def reset(self) -> None:
        """As in `Cues`."""
        self.inertial.reset()

    def restart(self) -> None:
        """As in `Cues`."""
        self.inertial = self.inertial.restart()
        self.pressure = evolve(self.pressure)
        self.touch = self.touch.restart()
