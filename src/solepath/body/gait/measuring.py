"""A gait cycle in numbers, and whether it is a steady one. What is measured, and by whose definition, is told where
GaitCycleMeasured is.

Steady strides count in the running means. A stride is steady when

- no sample was saturated in it, none was missing for longer than `GAP`, and none of its events is inferred;
- it follows another stride without a pause. With the half stride from the first stand that leaves out the first three
  steps of a walk, after which gait is steady (Mann et al. 1979, J. Bone Joint Surg. Am. 61);
- it is as long, in s and m, as the one before it, within a factor of `ALIKE`: who hesitates is not walking steadily;
- it turns by less than `TURNS`, and climbs less than `CLIMBS` of its length;
- the foot took a step in it, where it has a track: stepping on the spot is no walk.

It is counted once the next stride of the foot follows, so that the last one before a stop is not.
"""

from __future__ import annotations

from ...events import GaitCycleMeasured
from ...types import Foot
from .footfalls import Footfalls, PendingCycle

ALIKE = 1.5
"""Two steady strides in a row differ by less than this factor."""
TURNS = 0.2
"""rad: strides straight on differ by 0.05, and on a circle of 7 m each turns by this."""
CLIMBS = 0.15
"""A ramp for wheelchairs climbs 1 in 12, stairs 1 in 2."""
ABSURD = 1e4
"""No figure of a stride is as large, m, rad: it is none."""


def measured(
    foot: Foot,
    number: int,
    cycle: PendingCycle,
    before: GaitCycleMeasured | None,
    other: Footfalls,
    tracked: bool,
    compared: bool,
    known_at: float,
) -> GaitCycleMeasured:
    """A cycle of `foot` in numbers. `before`: the foot's newest stride; `other`: the other foot; `tracked`: the foot
    has a track; `compared`: the feet's clocks can be, over the whole cycle."""
    start, toe_off, end, step = cycle.start, cycle.toe_off, cycle.end, cycle.step
    time = end - start
    between = [t for t in other.contacts if start < t < end]
    struck = between[0] if len(between) == 1 else None
    cleared = None
    if struck is not None:
        earlier = [t for t in other.toe_offs if start - 0.5 * time < t < struck]
        cleared = earlier[-1] if earlier else None
    # a height that was corrected at the foot-flat may be above all that the swing was seen to reach
    length, clearance, off_angle, strike_angle, turning, rise = (
        (None,) * 6
        if step is None
        else _sound(
            step.length,
            max(0.0, step.features.clearance),
            step.features.toe_off_angle,
            step.features.heel_strike_angle,
            step.heading_change,
            step.height_change,
        )
    )
    contact = struck if compared else None
    cleared = cleared if compared else None
    return GaitCycleMeasured(
        t=end,
        known_at=max(known_at, end),
        foot=foot,
        number=number,
        t_start=start,
        t_toe_off=toe_off,
        stride_time=time,
        stance_time=toe_off - start,
        swing_time=end - toe_off,
        cadence=120.0 / time,
        step_time=None if contact is None else end - contact,
        initial_double_support=None if cleared is None else cleared - start,
        terminal_double_support=None if contact is None else toe_off - contact,
        single_support=None if cleared is None or contact is None else min(toe_off, contact) - max(start, cleared),
        phase=None if contact is None else (contact - start) / time,
        stride_length=length,
        speed=None if length is None else length / time,
        step_length=None,
        step_width=None,
        clearance=clearance,
        toe_off_angle=off_angle,
        heel_strike_angle=strike_angle,
        turning_angle=turning,
        rise=rise,
        degraded=cycle.degraded,
        steady=is_steady(cycle, time, before, tracked),
    )


def is_steady(cycle: PendingCycle, time: float, before: GaitCycleMeasured | None, tracked: bool) -> bool:
    """By the rule at the top of this file; `time`: of the cycle, s."""
    if cycle.spoilt or not cycle.follows or before is None or before.t != cycle.start:
        return False
    if not _alike(time, before.stride_time):
        return False
    step = cycle.step
    if step is None:
        return not (tracked and cycle.flat)
    if abs(step.heading_change) > TURNS or abs(step.height_change) > CLIMBS * step.length:
        return False
    return before.stride_length is None or _alike(step.length, before.stride_length)


def _alike(one: float, other: float) -> bool:
    return one < ALIKE * other and other < ALIKE * one


def _sound(*values: float | None) -> list[float | None]:
    """None for those that are none or too large."""
    return [value if value is not None and abs(value) < ABSURD else None for value in values]
