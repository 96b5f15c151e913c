r"""Computes the outcomes that were requested of a walk, and puts them into text.

    request = OutcomeRequest(outcomes=True)
    print("\n".join(request.lines(request.results(walk))))

The report (show/report/sections/clinical.py) and the files (files.py) show the same results."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import frozen

from ...events import Event
from ...types import Foot
from ...walk.walk import Walk
from ..tables.table import number, table
from .bouts import WalkingBout, walking_bouts
from .mobility import implausible, mobility_outcomes
from .references import Person
from .rows import (
    MOBILITY,
    OF_STRIDES,
    PARTS,
    SIX_MINUTE_WALK,
    UP_AND_GO,
    OutcomeRow,
    mobility_rows,
    six_minute_rows,
    stride_rows,
    up_and_go_rows,
)
from .walk_tests import SixMinuteWalk, TimedUpAndGo, six_minute_walk, timed_up_and_go

LABEL = (
    "Walking bouts and mobility outcomes are from foot-worn sensors, with the rules and limits of Mobilise-D (Kluge et "
    "al. 2021; mobgap 1.2). They are not outcomes of its validated pipeline, which uses one sensor at the lower back."
)
NEEDED = (
    "needed: strides for an interval of 20 % of a variability, or of 2 percentage points of an asymmetry, to each side"
)
SENSORS = (
    "the intervals are of the strides: sensors whose scales differ by 1 % make lengths and speeds differ by as much"
)
NO_BOUT = "no walking bout: none has four strides without a break of more than 3 s"
"""Line for a recording without a bout."""
NO_WALK = "No walking bout was found, so that there is no six-minute walk."
"""Sentence for a six-minute walk without a start."""
UP_AND_GO_NOTE = (
    "The total is the time between the two marks. It is not divided: sitting to standing cannot be seen from a foot."
)
NO_STEP = "No step was found between the marks: are they times of the recording's clock?"
"""Sentence for marks between which nobody walked."""
MARK_ERROR = 1.0
"""Time by which an observer's mark may lie before the first sample or after the last one, s; chosen by hand."""
INTERVAL_HEADER = ("%", "95 % interval", "strides", "needed")
BOUT_HEADER = ("bout", "start, s", "duration, s", "strides", "steps", "turns", "steps/min", "length, m", "speed, m/s")
"""Header of the table of bouts; plain text leaves out the commas."""
MAX_BOUTS = 12
"""Largest number of bouts that the text names one by one; bouts.csv has all of them."""


@frozen(kw_only=True)
class ClinicalResults:
    """All outcomes of a session that were requested."""

    bouts: list[WalkingBout]
    six_minutes: SixMinuteWalk | None
    """The six-minute walk; None if it was not requested or not found."""
    up_and_go: TimedUpAndGo | None
    six_minutes_fault: str = ""
    """Sentence on a start that is not within the recording; "" without one."""
    up_and_go_fault: str = ""
    """Sentence on marks that are not within the recording; "" without one."""
    rows: list[OutcomeRow]
    """Rows of all outcomes, in the order of PARTS."""

    def part(self, *names: str) -> list[OutcomeRow]:
        """Return the rows of some parts whose values are known."""
        return [row for row in self.rows if row.part in names and row.value is not None]

    def sources(self, *names: str) -> list[str]:
        """Return sentences on the references of some parts, with their sources."""
        return [
            f"Reference of {row.label}: {row.reference.words} ({row.reference.source})."
            for row in self.part(*names)
            if row.reference is not None
        ]


@frozen
class OutcomeRequest:
    """The outcomes that were requested. Their walk keeps all events: `Walk(limit=None)`."""

    outcomes: bool = False
    """True for bouts, mobility outcomes, variability and asymmetry."""
    six_minutes: bool = False
    """True for the six-minute walk."""
    six_minutes_start: float | None = None
    """Time at which the six minutes start, s; None for the first step."""
    up_and_go: tuple[float, float] | None = None
    """Times at which an observer marked start and stop of a timed up and go, s."""
    person: Person | None = None
    """Person for whom references are given."""

    def results(self, walk: Walk) -> ClinicalResults:
        """Return the outcomes of a walk so far."""
        rows: list[OutcomeRow] = []
        six_minutes = test = None
        events: list[Event] = [*walk.made_turns]
        for foot in Foot:
            events += [*walk.cycles[foot], *walk.strides[foot]]
        start_fault = _find_fault(walk.event_span, [] if self.six_minutes_start is None else [self.six_minutes_start])
        marks_fault = _find_fault(walk.event_span, self.up_and_go or [])
        if self.six_minutes and not start_fault:
            end = None if walk.event_span is None else walk.event_span[1]
            six_minutes = six_minute_walk(events, self.six_minutes_start, end)
            rows += [] if six_minutes is None else six_minute_rows(six_minutes, self.person)
        if self.up_and_go is not None and not marks_fault:
            test = timed_up_and_go(events, *self.up_and_go)
            rows += up_and_go_rows(test, self.person)
        bouts = walking_bouts(events)
        if self.outcomes:
            rows += [*mobility_rows(mobility_outcomes(bouts)), *stride_rows(events, self.person)]
        return ClinicalResults(
            bouts=bouts,
            six_minutes=six_minutes,
            up_and_go=test,
            six_minutes_fault=start_fault,
            up_and_go_fault=marks_fault,
            rows=rows,
        )

    def lines(self, results: ClinicalResults) -> list[str]:
        """Return the outcomes as plain text."""
        lines: list[str] = []
        if self.six_minutes:
            walk = results.six_minutes
            lines += ["", walk_sentence(results)]
            lines += _table(SIX_MINUTE_WALK, results.part(SIX_MINUTE_WALK)) if walk is not None else []
        if results.up_and_go_fault:
            lines += ["", f"There is no timed up and go. {results.up_and_go_fault}"]
        if results.up_and_go is not None:
            lines += ["", *_table(UP_AND_GO, results.part(UP_AND_GO)), UP_AND_GO_NOTE]
            lines += [NO_STEP] if not results.up_and_go.steps else []
        if self.outcomes:
            lines += ["", *bout_lines(results.bouts), ""]
            lines += _table("mobility outcomes", results.part(MOBILITY))
            for part in OF_STRIDES:
                lines += ["", *_interval_table(f"{part} of steady strides", results.part(part))]
            lines += [*([NEEDED, SENSORS] if results.part(*OF_STRIDES) else []), "", LABEL]
        return lines + results.sources(*PARTS)


def _find_fault(span: tuple[float, float] | None, marks: Sequence[float]) -> str:
    """Return a sentence on marks that are not within the recording, whose `span` is in s; "" if they are."""
    if span is None or all(span[0] - MARK_ERROR <= mark <= span[1] + MARK_ERROR for mark in marks):
        return ""
    given = " and ".join([f"{mark:.10g}" for mark in marks])
    return f"The recording is from {span[0]:.1f} to {span[1]:.1f} s on its clock; {given} s is not within it."


def walk_sentence(results: ClinicalResults) -> str:
    """Return the result of the six-minute walk as a sentence, or why there is none."""
    if results.six_minutes_fault:
        return f"There is no six-minute walk. {results.six_minutes_fault}"
    return NO_WALK if results.six_minutes is None else six_minute_sentence(results.six_minutes)


def six_minute_sentence(walk: SixMinuteWalk) -> str:
    """Return the result of a six-minute walk as a sentence."""
    distance = "an unknown distance" if walk.distance is None else f"{walk.distance:.1f} m"
    start = f"from {walk.t_start:.1f} s on the recording's clock"
    if walk.complete:
        return f"Walked {distance} in six minutes, {start}."
    return f"Walked {distance} in {walk.duration:.1f} s, {start}: the recording ends before the six minutes do."


def bout_lines(bouts: Sequence[WalkingBout]) -> list[str]:
    """Return a table of the first bouts as lines of text."""
    if not bouts:
        return [NO_BOUT]
    header = [name.replace(",", "") for name in BOUT_HEADER]
    lines = table(header, [bout_row(bout) for bout in bouts[:MAX_BOUTS]]).splitlines()
    return lines + ([f"and {len(bouts) - MAX_BOUTS} more"] if len(bouts) > MAX_BOUTS else [])


def bout_row(bout: WalkingBout) -> list[str]:
    """Return the cells of a bout in a table; an implausible mean, which counts in no outcome, is in brackets."""
    wrong = implausible(bout)
    digits = {"cadence": 1, "stride_length": 2, "walking_speed": 2}
    means = {name: number(getattr(bout, name), count) for name, count in digits.items()}
    shown = [f"({mean})" if name in wrong else mean for name, mean in means.items()]
    counts = [str(count) for count in (bout.strides, bout.steps, bout.turns)]
    return [str(bout.number), f"{bout.t_start:.1f}", f"{bout.duration:.1f}", *counts, *shown]


def _table(title: str, rows: Sequence[OutcomeRow]) -> list[str]:
    has_reference = any(row.reference_text for row in rows)
    header = [title, "value", "", *(["reference"] if has_reference else [])]
    cells = [[r.label, r.shown(r.value), r.shown_unit, *([r.reference_text] if has_reference else [])] for r in rows]
    return table(header, cells).splitlines()


def _interval_table(title: str, rows: Sequence[OutcomeRow]) -> list[str]:
    """Return a table of estimates with their intervals; none if there are too few strides."""
    if not rows:
        return [f"{title}: needs four steady strides of a foot, and of both feet for an asymmetry"]
    return table([title, *INTERVAL_HEADER], [interval_row(row) for row in rows]).splitlines()


def interval_row(row: OutcomeRow) -> list[str]:
    """Return the cells of an estimate in a table."""
    counts = ["", ""] if row.interval is None else [str(row.interval.strides), str(row.interval.needed)]
    return [row.label, row.shown(row.value), row.interval_text, *counts]
