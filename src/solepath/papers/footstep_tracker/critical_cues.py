"""Cues for heel-off, toe-off, heel-strike and foot-flat at the critical times of a step (Liu et al. 2015, IEEE MASS).

By algorithm 1. A detector that cuts the samples into steps (static_zones.StaticZones) gives all four at once. A foot
that lies still again without a swing has taken no step and gives no cues."""

from __future__ import annotations

from collections.abc import Sequence

from ...foot.cues.cues import Cues, SeenCue
from ...foot.cues.pressure import PressureCues
from ...foot.phase import TO_COME, Cue
from ...foot.stance.stance import Load, Stance
from ...types import Phase, Vec3
from ...types.attrs import define, field
from .segment import StepSegment


@define
class CriticalCues(Cues):
    """Reports gait events at the critical times of a step.

    Latency: all four are known when the static zone that ends the step is, `loose_length` s (static_zones.py) after
    foot-flat; so toe-off some 0.6 s after it happened. `PressureCues` handles an insole alone."""

    pressure: PressureCues = field(factory=PressureCues)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[SeenCue]:  # fmt: skip
        """Return uplift, liftoff, landing and rest of the segment that ends here, as cues (`Cues`)."""
        segment = stance.detail
        if not isinstance(segment, StepSegment) or segment.times is None:
            if still and phase is not Phase.STATIONARY:
                return (SeenCue(Cue.FLAT, t),)
            return ()
        times = segment.times
        when = {Cue.LIFT: times.uplift, Cue.CLEAR: times.liftoff, Cue.CONTACT: times.landing, Cue.FLAT: times.rest}
        return [SeenCue(cue, when[cue]) for cue in TO_COME[phase]]

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[SeenCue]:
        seen = self.pressure.update(t, dt, load, phase) or self.pressure.update_areas(t, load, phase)
        return () if seen is None else (seen,)

    def restart(self) -> None:
        self.pressure = PressureCues()
