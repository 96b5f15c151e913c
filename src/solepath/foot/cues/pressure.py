"""Cues from the load of the pressure cells.

The numbers were chosen by hand on the recordings of docs/accuracy.md that have cells, and not swept."""

from __future__ import annotations

from typing import Final

from ...types import Phase
from ...types.attrs import define, field
from ..phase import Cue
from ..stance.stance import Load
from .cues import TimedCue

# Local names, because one look-up in the enum costs as much as five multiplications.
SWING: Final = Phase.SWING
STATIONARY: Final = Phase.STATIONARY
PUSH_OFF: Final = Phase.PUSH_OFF
LOADING: Final = Phase.LOADING

CONTACT_LOAD, CLEAR_LOAD = 0.05, 0.03
"""Total loads above which the foot has touched the ground, and below which it has left it (shares of the full load).

The full load is that of all cells when they bear the wearer (pressure/insole.py)."""
AREA_LOADED = 0.06
"""Load above which an area, heel or forefoot, is loaded, as a share of the full load."""
AREA_UNLOADED = 0.03
"""Load below which an area, heel or forefoot, is unloaded, as a share of the full load."""
LONGEST_DATING_BACK = 0.3
"""Longest time by which a heel-off is dated back to the last load of the heel, s."""


@define
class PressureCues:
    """Detects CONTACT and CLEAR from the total load, FLAT and LIFT from heel and forefoot. Latency: one sample."""

    previous_load: float = field(default=0.0, init=False)
    """Total load of the last sample, as a share of the full load."""
    heel_loaded_at: float | None = field(default=None, init=False)
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
