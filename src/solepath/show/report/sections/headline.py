"""Says how the walk was: one sentence for somebody who has ten seconds, and a second one if the data are not sound.

docs/clinic.md documents the rules."""

from __future__ import annotations

from collections.abc import Mapping

from ....types import Activity
from ...findings import NOTHING_RIGHT
from ...tables.summary import NO_DATA
from ...tables.table import counted, duration_text, number, times
from ...tables.words import directions
from ..markup import whole_sentences
from ..walk_summary import STEP_TIME, STRIDE_LENGTH, SWING_TIME, FootDifference
from .facts import Facts

MIN_BOUT_SHARE = 0.1
"""Least duration of a run or a walk that is mentioned, as a share of that of the other; chosen by hand."""
SENSOR_DIFFERENCE = "check the sensors, for both feet of a walker go equally far"
CLOCK_DIFFERENCE = "check the sensors' clocks, for the swings do not differ"


def headline(facts: Facts) -> str:
    """Return one sentence that says how the walk was."""
    walk, bouts = facts.report.walk, facts.bouts
    if walk.event_span is None:
        return whole_sentences([NO_DATA])[0]
    longest = max([bout.duration for bout in bouts.values()], default=0.0)
    clauses = [_way(facts, is_run) for is_run in bouts if bouts[is_run].duration >= MIN_BOUT_SHARE * longest]
    if flights := [f"{way} {count}" for way, count in directions(walk.flights)]:
        several = "s" * (walk.flights.total() > 1)
        clauses.append(f"went {' and '.join(flights)} flight{several} of stairs")
    for kind, counts in (("a lift", walk.elevator_rides), ("an escalator", walk.escalator_rides)):
        if rides := [f"{way} {times(count)}" for way, count in directions(counts)]:
            clauses.append(f"rode {kind} {' and '.join(rides)}")
    if not clauses:
        if walk.known_feet and not walk.measured_feet:
            return f"Recorded for {duration_text(facts.duration)}; {NOTHING_RIGHT}."
        stood = Activity.STANDING in walk.timeline.durations(facts.report.clock.end)
        return f"{'Stood' if stood else 'Recorded'} for {duration_text(facts.duration)}; no stride was taken."
    if bouts and len(walk.measured_feet) == 1:
        clauses[-1] += f", measured at the {walk.measured_feet[0]} foot alone"
    return whole_sentences(["; ".join([*clauses, *difference_clauses(facts.differences)])])[0]


def _way(facts: Facts, is_run: bool) -> str:
    """Return a walk or a run as a clause, such as "walked 36 m in 31 s, in steady strides at 1.13 m/s"."""
    bout, text = facts.bouts[is_run], "ran" if is_run else "walked"
    if bout.distance is not None:
        text += f" {number(bout.distance, 0 if bout.distance >= 9.95 else 1)} m"
    text += f" {'for' if bout.distance is None else 'in'} {duration_text(bout.duration)}"
    known = [one for one in facts.all_measures if one.running is is_run]
    pace = [one for one in known if one.label in ("Speed", "Cadence")]
    if pace:
        words = [f"{one.text} {one.unit.replace('steps/min', 'steps a minute')}" for one in pace]
        return f"{text}, in steady strides {'with' if len(pace) == 1 else 'at'} {' and '.join(words)}"
    taken = f" ({counted(bout.cycles, 'gait cycle')})" if bout.cycles else ""
    return f"{text}{taken}, too short for steady strides"


def difference_clauses(differences: Mapping[str, FootDifference]) -> list[str]:
    """Return clauses on the differences between the feet that are certain: of the length, and of swing or step times.

    On a straight way both feet go equally far, so that another length is one of the sensors. A difference of step times
    without one of swing times may be one of the clocks."""
    shares = {name: f"{100.0 * abs(one.value):.0f} %" for name, one in differences.items() if one.is_certain}
    clauses = []
    if STRIDE_LENGTH in shares:
        clauses.append(f"left and right differ by {shares[STRIDE_LENGTH]} in stride length: {SENSOR_DIFFERENCE}")
    if SWING_TIME in shares:
        longer, shorter = ("right", "left") if differences[SWING_TIME].value > 0.0 else ("left", "right")
        clauses.append(f"the {longer} foot swings {shares[SWING_TIME]} longer than the {shorter} one")
    elif STEP_TIME in shares:
        check = f": {CLOCK_DIFFERENCE}" if SWING_TIME in differences else ""
        clauses.append(f"left and right differ by {shares[STEP_TIME]} in step time{check}")
    return clauses
