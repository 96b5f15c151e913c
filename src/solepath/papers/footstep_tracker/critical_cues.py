"""Cues for heel-off, toe-off, heel-strike and foot-flat at the critical times of a stride (Liu et al. 2015, IEEE MASS).

Algorithm 1 gives the critical times. The detector that cuts the samples into strides (static_zones.StaticZones) passes
on all four at once. After a motion without a swing only foot-flat is reported."""

from __future__ import annotations

from collections.abc import Sequence

from ...foot.cues.cues import Cues, TimedCue
from ...foot.phase import REMAINING_CUES, Cue
from ...foot.stance.stance import Load, Stance
from ...types import Phase, Vec3
from ...types.attrs import define
from .segment import StrideSegment


@define
class CriticalCues(Cues):
    """Reports gait events at the critical times of a stride.

    Latency: all four are known when the static zone that ends the stride is detected, `loose_length` s after foot-flat
    (static_zones.py); toe-off, some 0.6 s after it happened. A foot that has only an insole has no cues."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[TimedCue]:  # fmt: skip
        """Return uplift, liftoff, landing and rest of the segment that ends at this sample, as cues (`Cues`)."""
        segment = stance.detail
        if not isinstance(segment, StrideSegment) or segment.times is None:
            if still and phase is not Phase.STATIONARY:
                return (TimedCue(Cue.FLAT, t),)
            return ()
        times = segment.times
        when = {Cue.LIFT: times.uplift, Cue.CLEAR: times.liftoff, Cue.CONTACT: times.landing, Cue.FLAT: times.rest}
        return [TimedCue(cue, when[cue]) for cue in REMAINING_CUES[phase]]

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[TimedCue]:
        return ()
