"""From loads to cues: what the cells under a foot show.

The numbers were chosen by hand on the recordings of docs/accuracy.md that have cells, and not swept.
"""

from __future__ import annotations

from typing import Final

from ...types import Phase
from ...types.attrs import define, field
from ..phase import Cue
from ..stance.stance import Load
from .cues import SeenCue

SWING: Final = Phase.SWING
STATIONARY: Final = Phase.STATIONARY
PUSH_OFF: Final = Phase.PUSH_OFF
LOADING: Final = Phase.LOADING
"""Looked up once: a word of an enum costs as much as five multiplications."""
CONTACT_LOAD, CLEAR_LOAD = 0.05, 0.03
"""Contact: the load rises above the first of these shares of the wearer's full load. Clear: it falls below the
other."""
AREA_ON = 0.06
"""An area, heel or forefoot, is loaded above this share of the wearer's full load."""
AREA_OFF = 0.03
"""An area is unloaded below this share of it."""
RECENT = 0.3
"""The heel's last load before a lift may date it this far back, s."""


@define
class PressureCues:
    """Contact and clear from the total load, flat and lift from heel and forefoot. Latency: one sample."""

    before: float = field(default=0.0, init=False)
    """The total load of the sample before, as a share of the wearer's full load."""
    heel_loaded: float | None = field(default=None, init=False)
    """When the heel was last seen to carry load, s."""

    def update(self, t: float, dt: float, load: Load, phase: Phase) -> SeenCue | None:
        before, now = self.before, load.total
        self.before = now
        if load.heel is not None and load.heel > AREA_OFF:
            self.heel_loaded = t
        if phase is SWING:
            return SeenCue(Cue.CONTACT, _crossing(t, dt, before, now, CONTACT_LOAD)) if now > CONTACT_LOAD else None
        if now < CLEAR_LOAD:
            return SeenCue(Cue.CLEAR, _crossing(t, dt, before, now, CLEAR_LOAD))
        return None

    def date_lift(self, lift: SeenCue) -> SeenCue:
        """The inertial sensor saw the heel lift; the cells know when it did, if the heel has any."""
        if self.heel_loaded is None or not 0.0 <= lift.t - self.heel_loaded < RECENT:
            return lift
        return SeenCue(lift.cue, self.heel_loaded)

    def update_areas(self, t: float, load: Load, phase: Phase) -> SeenCue | None:
        """For an insole without an inertial sensor: heel and forefoot say what stillness would have said."""
        if load.heel is None or load.forefoot is None:
            return None
        if phase is LOADING and load.heel > AREA_OFF and load.forefoot > AREA_ON:
            return SeenCue(Cue.FLAT, t)
        if phase is STATIONARY and load.heel < AREA_OFF and load.forefoot > AREA_ON:
            return SeenCue(Cue.LIFT, t)
        if phase is PUSH_OFF and load.heel > AREA_ON and load.forefoot > AREA_ON:
            return SeenCue(Cue.FLAT, t)
        return None


def _crossing(t: float, dt: float, before: float, now: float, level: float) -> float:
    """When the straight line between the last two samples met the level, s."""
    if (before - level) * (now - level) >= 0.0:
        return t
    return t - dt * (now - level) / (now - before)
