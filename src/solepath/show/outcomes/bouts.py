"""Walking bouts by the rules of Mobilise-D, from the gait cycles of foot-worn sensors.

Sources: Kluge et al. 2021, PLoS ONE 16 e0256541 (the consensus on what walking and a walking bout are); Kirk et al.
2024, Sci. Rep. 14 1754 (the pipeline); the rules as numbers are those of the project's own program, mobgap 1.2
(`StrideSelection`, `WbAssembly`, Apache-2.0). These outcomes are not those of the validated pipeline, which uses one
sensor at the lower back: here the strides are gait cycles that foot-worn sensors measured, from initial contact to
initial contact of a foot. Only the rules are the same."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf, radians
from statistics import fmean

from attrs import frozen

from ...events import Event, GaitCycleMeasured, TurnMade

MIN_STRIDE_TIME, MAX_STRIDE_TIME = 0.2, 3.0
"""Durations between which a stride counts, s; the lower one is excluded, the upper one included (mobgap)."""
MIN_STRIDE_LENGTH = 0.15
"""Length above which a stride counts, m (mobgap); a stride whose length is not known counts."""
MIN_STRIDES = 4
"""Least number of strides of a walking bout, of both feet together.

Kluge et al. say two strides of each foot. The written rule of mobgap also accepts three strides of one foot, but its
program checks the four alone; so does this one, and a wearer of one sensor needs four strides of that foot."""
MAX_BREAK = 3.0
"""Longest time from the end of a stride to the start of the next one, of either foot, within a bout, s (mobgap)."""
ROUNDING = 1e-6
"""Time by which a duration may be above its limit, s: more than differences of times are rounded by."""
MIN_TURN = radians(45.0)
"""Least angle of a turn that counts, rad (El-Gohary et al. 2014, Sensors 14; mobgap)."""


@frozen(kw_only=True)
class WalkingBout:
    """One walking bout: at least four strides without a break of more than 3 s (Kluge et al. 2021; mobgap).

    Means are over all its strides of both feet that are not degraded, also those of its turns, of stairs and of its
    first and last steps, unlike the means of steady strides in `Session.gait`. Runners' strides belong to no bout."""

    number: int
    """Number of the bout in the recording, from 1."""
    t_start: float
    """Time of the first initial contact, s."""
    t_end: float
    """Time of the last initial contact, s."""
    strides: int
    """Number of strides of both feet."""
    steps: int
    """Number of initial contacts of both feet, which Mobilise-D counts as steps; of a wearer of one sensor, twice the
    contacts of that foot."""
    turns: int | None
    """Number of turns by 45 degrees or more whose middle is in the bout (El-Gohary et al. 2014).

    None when no length is known: pressure cells alone show no turns."""
    stride_duration: float | None
    """Mean stride time, s; None when all strides are degraded, as of the other means."""
    cadence: float | None
    """Mean of the strides' cadences, steps a minute."""
    stride_length: float | None
    """Mean stride length, m; None when no length is known."""
    walking_speed: float | None
    """Mean of the strides' speeds, m/s; None when no length is known."""
    degraded: int
    """Number of strides that are degraded; they are in no mean."""

    @property
    def duration(self) -> float:
        """Time from the first to the last initial contact, s."""
        return self.t_end - self.t_start


def is_selected(cycle: GaitCycleMeasured) -> bool:
    """Return whether a gait cycle is a stride by the stride selection of Mobilise-D, and not a runner's."""
    if cycle.running or not MIN_STRIDE_TIME < cycle.stride_time <= MAX_STRIDE_TIME + ROUNDING:
        return False
    return cycle.stride_length is None or cycle.stride_length > MIN_STRIDE_LENGTH


def walking_bouts(events: Iterable[Event]) -> list[WalkingBout]:
    """Return the walking bouts of a session, in order, from its events GaitCycleMeasured and TurnMade.

    Events of other kinds are left out. The feet's times must be on one clock. Strides are put in order of their starts;
    a bout ends where the next stride starts more than 3 s after the end of the last one."""
    events = list(events)
    cycles = [event for event in events if isinstance(event, GaitCycleMeasured) and is_selected(event)]
    cycles.sort(key=lambda cycle: (cycle.t_start, cycle.t))
    turns = [event for event in events if isinstance(event, TurnMade) and event.final and abs(event.angle) >= MIN_TURN]
    groups: list[list[GaitCycleMeasured]] = []
    for cycle in cycles:
        if not groups or cycle.t_start - groups[-1][-1].t > MAX_BREAK + ROUNDING:
            groups.append([])
        groups[-1].append(cycle)
    kept = [group for group in groups if len(group) >= MIN_STRIDES]
    return [_bout(number, group, turns) for number, group in enumerate(kept, start=1)]


def count_contacts(cycles: Sequence[GaitCycleMeasured], after: float = -inf, until: float = inf) -> int:
    """Return the number of initial contacts of gait cycles, later than `after` and not later than `until`, s.

    With cycles of one foot only, at any time, it is twice the number, because a stride has two steps."""
    found = {(cycle.foot, t) for cycle in cycles for t in (cycle.t_start, cycle.t) if after < t <= until}
    return len(found) * (2 if len({cycle.foot for cycle in cycles}) == 1 else 1)


def _bout(number: int, cycles: Sequence[GaitCycleMeasured], turns: Sequence[TurnMade]) -> WalkingBout:
    start, end = cycles[0].t_start, max([cycle.t for cycle in cycles])
    good = [cycle for cycle in cycles if not cycle.degraded]
    made = [turn for turn in turns if start <= 0.5 * (turn.t_start + turn.t) <= end]
    return WalkingBout(
        number=number,
        t_start=start,
        t_end=end,
        strides=len(cycles),
        steps=count_contacts(cycles),
        turns=None if all([cycle.stride_length is None for cycle in cycles]) else len(made),
        stride_duration=mean_of([cycle.stride_time for cycle in good]),
        cadence=mean_of([cycle.cadence for cycle in good]),
        stride_length=mean_of([cycle.stride_length for cycle in good]),
        walking_speed=mean_of([cycle.speed for cycle in good]),
        degraded=len([cycle for cycle in cycles if cycle.degraded]),
    )


def mean_of(values: Iterable[float | None]) -> float | None:
    """Return the mean of the values that are known; None when none is."""
    known = [value for value in values if value is not None]
    return fmean(known) if known else None
