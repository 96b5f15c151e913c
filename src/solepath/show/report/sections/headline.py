"""Says how the walk was: one sentence for somebody who has ten seconds, and a second one if the data are not sound.

docs/report.md documents the rules."""

from __future__ import annotations

from collections.abc import Mapping

from attrs import field, frozen

from ...tables.summary import NO_DATA
from ...tables.table import counted, duration_text, number, times
from ..markup import whole_sentences
from ..measures import Measure
from ..walk_summary import STEP_TIME, STRIDE_LENGTH, SWING_TIME, FootDifference
from .quality import Judgement, QualityVerdict

SENSOR_DIFFERENCE = "check the sensors, for both feet of a walker go equally far"
MIN_BOUT_SHARE = 0.1
"""Least duration of a run or a walk that is mentioned, as a share of that of the other; chosen by hand."""
CLOCK_DIFFERENCE = "check the sensors' clocks, for the swings do not differ"


@frozen(kw_only=True)
class Bout:
    """A walk or a run of a recording: its duration and distance, with its measures by their names."""

    duration: float
    """Duration, s; 0 if it is not known."""
    distance: float | None
    """Distance, m; None if it is not known."""
    strides: int
    """Number of gait cycles of both feet."""
    measures: Mapping[str, Measure]
    prefix: str = ""
    """Prefix of the names of `measures`."""

    def clause(self, verb: str) -> str:
        """Return the way as a clause, such as "walked 36 m in 31 s, in steady strides at 1.13 m/s"."""
        text = verb
        if self.distance is not None:
            text += f" {number(self.distance, 0 if self.distance >= 9.95 else 1)} m"
        if self.duration > 0.0:
            text += f"{' in' if self.distance is not None else ' for'} {duration_text(self.duration)}"
        speed = self.measures.get(f"{self.prefix}speed_m_per_s")
        cadence = self.measures.get(f"{self.prefix}cadence_steps_per_min")
        steady = [f"at {speed.text} m/s"] if speed is not None else []
        steady += [f"{'' if steady else 'with '}{cadence.text} steps a minute"] if cadence is not None else []
        if steady:
            return f"{text}, in steady strides {' and '.join(steady)}"
        taken = f" ({counted(self.strides, 'stride')})" if self.strides else ""
        return f"{text}{taken}, too short for steady strides"


@frozen(kw_only=True)
class WalkFacts:
    """All that the first sentence of a report may mention."""

    has_data: bool
    duration: float
    """Duration of the recording, s."""
    stood: bool
    """True if the wearer stood, by the activities."""
    walk: Bout | None
    run: Bout | None
    flights: Mapping[bool, int] = field(factory=dict)
    """Numbers of flights of stairs, up (True) and down."""
    rides: Mapping[bool, int] = field(factory=dict)
    """Numbers of lift rides, up (True) and down."""
    only_foot: str = ""
    """Name of the foot that alone was measured; "" with both."""
    differences: Mapping[str, FootDifference] = field(factory=dict)


def headline(facts: WalkFacts) -> str:
    """Return one sentence that says how the walk was."""
    if not facts.has_data:
        return whole_sentences([NO_DATA])[0]
    ways = [(bout, verb) for bout, verb in ((facts.walk, "walked"), (facts.run, "ran")) if bout is not None]
    longest = max([bout.duration for bout, _ in ways], default=0.0)
    clauses = [bout.clause(verb) for bout, verb in ways if bout.duration >= MIN_BOUT_SHARE * longest]
    if flights := _directions(facts.flights):
        several = sum(facts.flights.values()) > 1  # whole numbers
        clauses.append(f"went {flights} flight{'s' * several} of stairs")
    rides = [f"{word} {times(facts.rides[up])}" for up, word in ((True, "up"), (False, "down")) if facts.rides.get(up)]
    if rides:
        clauses.append(f"rode a lift {' and '.join(rides)}")
    if not clauses:
        what = "Stood" if facts.stood else "Recorded"
        return f"{what} for {duration_text(facts.duration)}; no stride was taken."
    if facts.only_foot:
        clauses[-1] += f", measured at the {facts.only_foot} foot alone"
    clauses += difference_clauses(facts.differences)
    sentence = "; ".join(clauses)
    return f"{sentence[0].upper()}{sentence[1:]}."


def difference_clauses(differences: Mapping[str, FootDifference]) -> list[str]:
    """Return clauses on the differences between the feet that are certain: of the length, and of swing or step times.

    On a straight way both feet go equally far, so that another length is one of the sensors. A difference of step times
    without one of swing times may be one of the clocks."""
    certain = {name: one for name, one in differences.items() if one.is_certain}
    clauses = []
    if (length := certain.get(STRIDE_LENGTH)) is not None:
        share = f"{100.0 * abs(length.value):.0f} %"
        clauses.append(f"left and right differ by {share} in stride length: {SENSOR_DIFFERENCE}")
    swing, step = certain.get(SWING_TIME), certain.get(STEP_TIME)
    if swing is not None:
        longer, shorter = ("right", "left") if swing.value > 0.0 else ("left", "right")
        share = f"{100.0 * abs(swing.value):.0f} %"
        clauses.append(f"the {longer} foot swings {share} longer than the {shorter} one")
    elif step is not None:
        share = f"{100.0 * abs(step.value):.0f} %"
        check = f": {CLOCK_DIFFERENCE}" if SWING_TIME in differences else ""
        clauses.append(f"left and right differ by {share} in step time{check}")
    return clauses


def warning(judgements: list[Judgement]) -> str:
    """Return a sentence on what to check before the figures are used; "" if nothing is wrong."""
    stops = [one.concern for one in judgements if one.verdict is QualityVerdict.STOP]
    looks = [one.concern for one in judgements if one.verdict is QualityVerdict.LOOK]
    if stops:
        return f"Do not use the figures before this is checked: {', '.join(stops)}."
    return f"Check before use: {', '.join(looks)}." if looks else ""


def _directions(counts: Mapping[bool, int]) -> str:
    return " and ".join([f"{word} {counts[up]}" for up, word in ((True, "up"), (False, "down")) if counts.get(up)])
