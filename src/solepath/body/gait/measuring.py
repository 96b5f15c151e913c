"""Measurement of one gait cycle, and the rule for steady strides.

GaitCycleMeasured defines the values. Only steady cycles enter the running means. A gait cycle is steady when

- no sample in it clipped, no gap in it is longer than `MAX_STEADY_GAP`, and none of its events is inferred;
- it follows another cycle without a pause. This leaves out the first three steps of a walk, after which gait is steady
  (Mann et al. 1979, J. Bone Joint Surg. Am. 61): the half stride from standing, and the first cycle;
- neither its time nor its length differs from that of the cycle before by a factor of `STEADY_FACTOR` or more, because
  a wearer who hesitates does not walk steadily;
- it turns by less than `MAX_TURN`, and its height changes by less than `MAX_SLOPE` of its length;
- a stride ends at the foot-flat after it, because stepping on the spot is not walking. This is checked only if the
  foot's position is known and there is such a foot-flat (a runner may have none).

A steady cycle enters the means when the next cycle of the foot follows, so the last cycle before a stop is left out."""

from __future__ import annotations

from ...events import GaitCycleMeasured
from ...types import Foot
from .footfalls import Footfalls, PendingCycle

STEADY_FACTOR = 1.5
"""Largest ratio of the times, and of the lengths, of two consecutive steady cycles."""
MAX_TURN = 0.2
"""Largest turn of a steady cycle, rad; straight strides vary by 0.05, and on a circle of 7 m radius it is 0.2."""
MAX_SLOPE = 0.15
"""Largest slope (height change / length) of a steady cycle; ramps for wheelchairs have 1 / 12, stairs have 1 / 2."""
MAX_VALUE = 1e4
"""Largest size of a reported value of a cycle, m or rad."""
CLEAR_SUPPORT = 0.05
"""Size from which a double support or a flight is not an error of heel-strike and toe-off, s.

A walk has no flight and a run no double support (Novacheck 1998, Gait & Posture 7), so a cycle with both is of feet
whose times do not belong together, or has a wrong event. With 30, 50 and 100 ms, 11, 9 and 4 of 1911 cycles of
ipol_10m_uturn are such; in none of them the events agree with the hand labels."""


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

    `number` counts the foot's cycles from 1, `previous` is its previous cycle, and `other` has the other foot's events.
    `tracked` says that the foot's position is known, `comparable` that the feet's clocks can be compared over the whole
    cycle."""
    start, toe_off, end, stride = cycle.start, cycle.toe_off, cycle.end, cycle.stride
    time = end - start
    contacts_between = [t for t in other.contacts if start < t < end]
    other_contact = contacts_between[0] if len(contacts_between) == 1 else None
    other_toe_off = None
    if other_contact is not None:
        earlier_toe_offs = [t for t in other.toe_offs if start - 0.5 * time < t < other_contact]
        other_toe_off = earlier_toe_offs[-1] if earlier_toe_offs else None
    # a clearance is negative, and counts as 0, when the corrected foot-flat height is above all heights of the swing
    length, clearance, off_angle, strike_angle, turning, rise = (
        (None,) * 6
        if stride is None
        else _keep_plausible(
            stride.length,
            max(0.0, stride.features.clearance),
            stride.features.toe_off_angle,
            stride.features.heel_strike_angle,
            stride.heading_change,
            stride.height_change,
        )
    )
    if not comparable or is_contradictory(cycle, other_contact, other_toe_off):
        other_contact = other_toe_off = None
    contact = other_contact
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
        clearance=clearance,
        toe_off_angle=off_angle,
        heel_strike_angle=strike_angle,
        turning_angle=turning,
        rise=rise,
        degraded=cycle.degraded,
        steady=is_steady(cycle, time, previous, tracked),
    )


def is_contradictory(cycle: PendingCycle, other_contact: float | None, other_toe_off: float | None) -> bool:
    """Return whether the other foot's events, s, would give the cycle a flight and a double support.

    Without the other foot's toe-off, a foot that is on the ground for half of the cycle or more is that of a walker,
    whose other foot lands before this one leaves the ground."""
    if other_contact is None:
        return False
    terminal = cycle.toe_off - other_contact
    if other_toe_off is None:
        return terminal < -CLEAR_SUPPORT and cycle.toe_off - cycle.start >= 0.5 * (cycle.end - cycle.start)
    initial = other_toe_off - cycle.start
    return min(initial, terminal) < -CLEAR_SUPPORT and max(initial, terminal) > CLEAR_SUPPORT


def is_steady(cycle: PendingCycle, time: float, previous: GaitCycleMeasured | None, tracked: bool) -> bool:
    """Return whether the cycle, whose duration is `time`, s, is steady by the rule at the top of this file."""
    if cycle.unsteady or not cycle.follows_cycle or previous is None or previous.t != cycle.start:
        return False
    if not _is_similar(time, previous.stride_time):
        return False
    stride = cycle.stride
    if stride is None:
        return not (tracked and cycle.foot_was_flat)
    if abs(stride.heading_change) > MAX_TURN or abs(stride.height_change) > MAX_SLOPE * stride.length:
        return False
    return previous.stride_length is None or _is_similar(stride.length, previous.stride_length)


def _is_similar(first: float, second: float) -> bool:
    return first < STEADY_FACTOR * second and second < STEADY_FACTOR * first


def _keep_plausible(*values: float | None) -> list[float | None]:
    """Return the values, with None for a value that is missing or too large."""
    return [value if value is not None and abs(value) < MAX_VALUE else None for value in values]
