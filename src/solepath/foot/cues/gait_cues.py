"""Cues of most recipes, from the inertial sensor and the pressure cells.

Without cells all four cues come from the inertial sensor. With cells the load gives CONTACT (heel-strike) and CLEAR
(toe-off); FLAT (foot-flat) and LIFT (heel-off) still come from the inertial sensor. The load of the heel then gives the
time of LIFT."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...types import Layout, Phase, Vec3
from ...types.attrs import define, state, stateful
from ..phase import LOADING, PUSH_OFF, STATIONARY, SWING, Cue
from ..stance.stance import Load, Stance
from .cues import MOST_SINGLE_CELLS, Cues, TimedCue
from .inertial import InertialCues

if TYPE_CHECKING:
    from .touch import Touch

CONTACT_LOAD, CLEAR_LOAD = 0.05, 0.03
"""Total loads above which the foot has touched the ground, and below which it has left it (shares of the full load).

The full load is that of all cells when they bear the wearer (pressure/insole.py)."""
AREA_LOADED = 0.06
"""Load above which an area, heel or forefoot, is loaded, as a share of the full load."""
AREA_UNLOADED = 0.03
"""Load below which an area, heel or forefoot, is unloaded, as a share of the full load."""
LEAST_SWING_SPEED, LARGEST_LANDING_SPEED = 1.0, 0.6
"""Speed that a foot reaches in a swing, m/s, and the highest at which it lands, as a share of that swing's highest.

On soles with cells it lands at 0.1 to 0.35 of it."""
LONGEST_DENIAL = 0.25
"""Time for which a foot may move as only one in the air does while its cells show load, s."""
LONGEST_DATING_BACK = 0.3
"""Longest time by which a heel-off is dated back to the last load of the heel, s."""


@define
class PressureCues:
    """Detects CONTACT and CLEAR from the total load. Latency: one sample.

    On a foot without an inertial sensor, FLAT and LIFT follow from the loads of heel and forefoot (`update_areas`)."""

    previous_load: float = 0.0
    """Total load of the last sample, as a share of the full load."""
    heel_loaded_at: float | None = None
    """Time at which the heel was last above AREA_UNLOADED, s; None before any."""

    def update(self, t: float, dt: float, load: Load, phase: Phase) -> TimedCue | None:
        """Return CONTACT or CLEAR if the total load shows it in this sample, or None."""
        previous_load, current_load = self.previous_load, load.total
        self.previous_load = current_load
        if load.heel is not None and load.heel > AREA_UNLOADED:
            self.heel_loaded_at = t
        if phase is SWING:
            return (
                TimedCue(Cue.CONTACT, _crossing(t, dt, previous_load, current_load, CONTACT_LOAD))
                if current_load > CONTACT_LOAD
                else None
            )
        if current_load < CLEAR_LOAD:
            return TimedCue(Cue.CLEAR, _crossing(t, dt, previous_load, current_load, CLEAR_LOAD))
        return None

    def date_lift(self, lift: TimedCue) -> TimedCue:
        """Return `lift`, seen by the inertial sensor, with the time at which the heel was last loaded, if known."""
        if self.heel_loaded_at is None or not 0.0 <= lift.t - self.heel_loaded_at < LONGEST_DATING_BACK:
            return lift
        return TimedCue(lift.cue, self.heel_loaded_at)

    def update_areas(self, t: float, load: Load, phase: Phase) -> TimedCue | None:
        """Return FLAT or LIFT from heel and forefoot, for an insole without inertial sensor, or None."""
        if load.heel is None or load.forefoot is None:
            return None
        if phase is LOADING and load.heel > AREA_UNLOADED and load.forefoot > AREA_LOADED:
            return TimedCue(Cue.FLAT, t)
        if phase is STATIONARY and load.heel < AREA_UNLOADED and load.forefoot > AREA_LOADED:
            return TimedCue(Cue.LIFT, t)
        if phase is PUSH_OFF and load.heel > AREA_LOADED and load.forefoot > AREA_LOADED:
            return TimedCue(Cue.FLAT, t)
        return None


def _crossing(t: float, dt: float, previous_load: float, current_load: float, level: float) -> float:
    """Return the time at which a straight line between the last two samples crosses the level, s."""
    if (previous_load - level) * (current_load - level) >= 0.0:
        return t
    return t - dt * (current_load - level) / (current_load - previous_load)


@stateful
class GaitCues(Cues):
    """Detects gait events from the inertial sensor and the load.

    Latency: that of `InertialCues`, or of `PressureCues` with pressure cells."""

    inertial: InertialCues = state(factory=InertialCues)
    pressure: PressureCues = state(factory=PressureCues)
    touch: Touch | None = None
    """Detector of ground contact for an insole of few cells; None until there is one."""
    contradicted: bool = False
    """The cells showed load while the foot moved as only a foot in the air does, and have shown no swing since."""
    sagittal: float = 0.0
    """Rate of the last sample about the axis to the wearer's left, positive toe down, rad/s; 0 if unknown."""

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells, which only `touch` uses."""
        if len(layout.cells) <= MOST_SINGLE_CELLS:
            self._make_touch().set_layout(layout)

    def _make_touch(self) -> Touch:
        from .touch import Touch  # few insoles need it

        touch = self.touch = self.touch or Touch()
        return touch

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
            # a foot that has pushed off and moves fast is in the air: its cells have drifted, jumped or are stuck
            fast_since = inertial.fast_since
            if phase is PUSH_OFF and fast_since is not None and t - fast_since >= LONGEST_DENIAL:
                self.contradicted = True
                return (inertial.make_hidden_toe_off(fast_since),)
            pressure_cue = self.pressure.update(t, dt, load, phase)
            if len(load.cells) <= MOST_SINGLE_CELLS:
                touch = self.touch or self._make_touch()
                airborne = touch.update(t, load, still)
                if phase is SWING and airborne:
                    self.contradicted = False
                if not touch.trusted or self.contradicted:
                    return () if seen is None else (seen,)
                pressure_cue = None
                if airborne is not (phase is Phase.SWING):
                    pressure_cue = TimedCue(Cue.CLEAR if airborne else Cue.CONTACT, t)
            elif self.contradicted:
                if phase is SWING and load.total < CLEAR_LOAD:
                    self.contradicted = False
                return () if seen is None else (seen,)
            if pressure_cue is not None and pressure_cue.cue is Cue.CONTACT:
                peak = inertial.impact.peak_speed
                if peak > LEAST_SWING_SPEED and speed > LARGEST_LANDING_SPEED * peak:
                    pressure_cue = None
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

    @property
    def impact_at(self) -> float | None:
        """Time of the impact that the inertial sensor has shown in this swing, s; None before it."""
        return self.inertial.impact_at

    def make_hidden_toe_off(self, t: float) -> TimedCue:
        """Return a toe-off at `t`, s, which a gap has hidden."""
        return self.inertial.make_hidden_toe_off(t)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, after a gap."""
        self.inertial.reset()

    def restart(self) -> None:
        """Discard what depends on times, because times restart; what was learnt stays."""
        self.inertial = self.inertial.restart()
        self.pressure = PressureCues()
        if self.touch is not None:
            self.touch = self.touch.restart()
