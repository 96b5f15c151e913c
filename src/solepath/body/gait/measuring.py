"""Measurement of one gait cycle, and the rule for steady strides.

GaitCycleMeasured describes the values and their definitions. Steady strides count in the running means. A stride is
steady when

- no sample was saturated in it, none was missing for longer than `LONGEST_GAP`, and none of its events is inferred;
- it follows another stride without a pause. With the half stride from the first stand that leaves out the first three
  steps of a walk, after which gait is steady (Mann et al. 1979, J. Bone Joint Surg. Am. 61);
- it is as long, in s and m, as the one before it, within a factor of `STEADY_FACTOR`: a wearer who hesitates does not
  walk steadily;
- it turns by less than `LARGEST_TURN`, and climbs less than `LARGEST_SLOPE` of its length;
- the foot has a stride in it, where it has a track: stepping on the spot is no walk.

It is counted once the next stride of the foot follows, so that the last one before a stop is not."""

from __future__ import annotations

from ...events import GaitCycleMeasured
from ...types import Foot
from .footfalls import Footfalls, PendingCycle

STEADY_FACTOR = 1.5
"""Largest ratio of two consecutive steady strides, in time and in length."""
LARGEST_TURN = 0.2
"""Largest turn of a steady stride, rad: straight strides differ by 0.05, and on a circle of 7 m each turns by this."""
LARGEST_SLOPE = 0.15
"""Largest slope of a steady stride: a ramp for wheelchairs climbs 1 in 12, stairs 1 in 2."""
LARGEST_VALUE = 1e4
"""Largest value of a stride that is reported, m and rad."""


def measure_cycle(
    foot: Foot,
    number: int,
    cycle: PendingCycle,
    previous: GaitCycleMeasured | None,
    other: Footfalls,
    tracked: bool,
    comparable: bool,
    known_at: float,
) -> GaitCycleMeasured:
    """Return the measurement of one gait cycle of `foot`.

    `previous` is the foot's newest stride, `other` the other foot. `tracked`: the foot has a track. `comparable`: the
    feet's clocks can be compared over the whole cycle."""
    start, toe_off, end, stride = cycle.start, cycle.toe_off, cycle.end, cycle.stride
    time = end - start
    between = [t for t in other.contacts if start < t < end]
    other_contact = between[0] if len(between) == 1 else None
    other_toe_off = None
    if other_contact is not None:
        earlier = [t for t in other.toe_offs if start - 0.5 * time < t < other_contact]
        other_toe_off = earlier[-1] if earlier else None
    # the height corrected at the foot-flat may be above all heights of the swing
    length, clearance, off_angle, strike_angle, turning, rise = (
        (None,) * 6
        if stride is None
        else _plausible(
            stride.length,
            max(0.0, stride.features.clearance),
            stride.features.toe_off_angle,
            stride.features.heel_strike_angle,
            stride.heading_change,
            stride.height_change,
        )
    )
    contact = other_contact if comparable else None
    other_toe_off = other_toe_off if comparable else None
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
        initial_double_support=None if other_toe_off is None else other_toe_off - start,
        terminal_double_support=None if contact is None else toe_off - contact,
        single_support=None
        if other_toe_off is None or contact is None
        else min(toe_off, contact) - max(start, other_toe_off),
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
        steady=is_steady(cycle, time, previous, tracked),
    )


def is_steady(cycle: PendingCycle, time: float, previous: GaitCycleMeasured | None, tracked: bool) -> bool:
    """Return whether the cycle is steady by the rule at the top of this file; `time`: its duration, s."""
    if cycle.unsteady or not cycle.follows or previous is None or previous.t != cycle.start:
        return False
    if not _is_similar(time, previous.stride_time):
        return False
    stride = cycle.stride
    if stride is None:
        return not (tracked and cycle.flat)
    if abs(stride.heading_change) > LARGEST_TURN or abs(stride.height_change) > LARGEST_SLOPE * stride.length:
        return False
    return previous.stride_length is None or _is_similar(stride.length, previous.stride_length)


def _is_similar(one: float, other: float) -> bool:
    return one < STEADY_FACTOR * other and other < STEADY_FACTOR * one


def _plausible(*values: float | None) -> list[float | None]:
    """Return the values, with None for those that are missing or too large."""
    return [value if value is not None and abs(value) < LARGEST_VALUE else None for value in values]
