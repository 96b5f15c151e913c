"""What turns the numbers of a foot into cues, as a part of a recipe; and the part that most recipes have.

`GaitCues` reads the inertial sensor and, where there are cells, the load: contact and clear are the pressure's to say,
flat and lift the inertial sensor's, and the heel dates the lift.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Protocol

from attrs import define, evolve, field

from ...types import Layout, Phase, Vec3
from ..phase import Cue
from ..stance.stance import Load, Stance
from .inertial import InertialCues, PressureCues, Seen
from .touch import FEW, Touch


class Cues(Protocol):
    """What the tracker needs of a way to see what a foot does."""

    @property
    def axis(self) -> Vec3 | None:
        """Unit vector to the wearer's left, sensor frame; None while it is not known."""

    @property
    def sagittal(self) -> float:
        """Rate about that axis in the last sample, positive toe down, rad/s; 0 while it is not known."""

    @property
    def mark(self) -> Cue | None:
        """CONTACT: of all samples so far the last is most likely that of heel-strike. CLEAR: the one before it is most
        likely that of toe-off (Corrector.mark)."""

    def update(
        self,
        t: float,
        dt: float,
        acc: Vec3,
        gyro: Vec3,
        still: bool,
        speed: float,
        phase: Phase,
        load: Load | None,
        stance: Stance,
    ) -> Sequence[Seen]:
        """One corrected sample: `acc` in m/s^2, `gyro` in rad/s without bias, `still`: the evidence of zero velocity
        was believed, `speed` in m/s, `phase` before it. What was seen, in order."""

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[Seen]:
        """The same for an insole without an inertial sensor."""

    def cleared(self, t: float) -> Seen:
        """The toe left the ground at `t`, in a gap, and the swing was under way when that ended."""

    def interrupt(self) -> None:
        """There was a gap: what lasts must be seen to last."""

    def anew(self) -> None:
        """Times begin anew: what was learnt stays, what lasted does not."""


@define
class GaitCues:
    """Latency: that of `InertialCues`, or of `PressureCues` where there are cells."""

    inertial: InertialCues = field(factory=InertialCues)
    pressure: PressureCues = field(factory=PressureCues)
    touch: Touch = field(factory=Touch)
    """For insoles of few cells."""
    mark: ClassVar[Cue | None] = None
    """No corrector is told: cues here are never taken back."""

    def wear(self, layout: Layout) -> None:
        """The device said where its cells are."""
        self.touch.wear(layout)

    @property
    def axis(self) -> Vec3 | None:
        """As in `Cues`."""
        return self.inertial.axis

    @property
    def sagittal(self) -> float:
        """As in `Cues`."""
        inertial = self.inertial
        return 0.0 if inertial.axis is None else inertial.sagittal

    def update(
        self,
        t: float,
        dt: float,
        acc: Vec3,
        gyro: Vec3,
        still: bool,
        speed: float,
        phase: Phase,
        load: Load | None,
        stance: Stance,
    ) -> Sequence[Seen]:
        """As in `Cues`; at most one."""
        seen = self.inertial.update(t, dt, acc, gyro, still, speed, phase)
        if load is None and seen is None:
            return ()
        if load is not None:
            pressed = self.pressure.update(t, dt, load, phase)
            if len(load.cells) <= FEW:
                airborne = self.touch.update(t, load, still)
                if not self.touch.known:
                    return () if seen is None else (seen,)
                pressed = None
                if airborne is not (phase is Phase.SWING):
                    pressed = Seen(Cue.CLEAR if airborne else Cue.CONTACT, t)
            if pressed is not None:
                if pressed.cue is Cue.CLEAR:
                    self.inertial.pushed_off(phase)
                return (pressed,)
            if seen is not None and seen.cue is not Cue.FLAT:
                seen = self.pressure.dated(seen) if seen.cue is Cue.LIFT else None
        return () if seen is None else (seen,)

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[Seen]:
        """As in `Cues`: heel and forefoot say what stillness would have said."""
        seen = self.pressure.update(t, dt, load, phase) or self.pressure.areas(t, load, phase)
        return () if seen is None else (seen,)

    def cleared(self, t: float) -> Seen:
        """As in `Cues`."""
        return self.inertial.cleared(t)

    def interrupt(self) -> None:
        """As in `Cues`."""
        self.inertial.interrupt()

    def anew(self) -> None:
        """As in `Cues`."""
        axis = self.inertial.axis
        self.inertial = evolve(self.inertial)
        self.inertial.axis = axis
        self.pressure = evolve(self.pressure)
        self.touch = self.touch.anew()
