r"""Computes the outcomes that were requested of a walk, and puts them into sentences and tables.

    request = OutcomeRequest(test=WalkTest.SIX_MINUTE)
    print("\n".join(request.results(walk).lines()))

The report (show/report/sections/clinical.py) and the files (files.py) show the same results."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import define, field, frozen

from ...events import Event
from ...types import Foot, ValueEnum
from ...walk.walk import Walk
from ..tables.table import number, table
from .answer import answer
from .bouts import WalkingBout, walking_bouts
from .mobility import implausible, mobility_outcomes
from .references import Person
from .rows import (
    MINUTE_NAME,
    MOBILITY,
    OF_STRIDES,
    REFERENCE_HEADERS,
    SIX_MINUTE_WALK,
    UP_AND_GO,
    WALK,
    OutcomeRow,
    mobility_rows,
    six_minute_rows,
    steady_speed_row,
    stride_rows,
    up_and_go_rows,
    walk_rows,
)
from .spread import LEFT_OUT
from .walk_tests import SixMinuteWalk, six_minute_walk, timed_up_and_go, whole_walk

LABEL = (
    "Walking bouts and mobility outcomes are from foot-worn sensors, with the rules and limits of Mobilise-D (Kluge et "
    "al. 2021; mobgap 1.2). They are not outcomes of its validated pipeline, which uses one sensor at the lower back."
)
SIX_MINUTE_NOTE = (
    "The distance is the mean of what both feet went, stride by stride, turns included (ATS 2002 counts lengths of a "
    "course). While one foot alone is measured, it is that foot's. Stops are breaks of more than 3 s."
)
UP_AND_GO_NOTE = (
    "The total is the time between the two marks. It is not divided: sitting to standing cannot be seen from a foot."
)
WALK_NOTE = "Speed is of steady strides; distance and steps are of the whole recording."
NEEDED = (
    "Needed: strides for an interval of 20 % of a variability, or of 2 percentage points of an asymmetry, to each side."
)
SENSORS = (
    "The intervals are of the strides: sensors whose scales differ by 1 % make lengths and speeds differ by as much."
)
TOO_FEW = "There are too few steady strides for variability and asymmetry: four of a foot are needed."
NO_BOUT = "No walking bout: none has four strides without a break of more than 3 s."
NO_WALK = "No walking bout was found, so that there is no six-minute walk."
NO_STEP = "No step was found between the marks: are they times of the recording's clock?"
MARK_ERROR = 1.0
"""Time by which an observer's mark may lie before the first sample or after the last one, s; chosen by hand."""
INTERVAL_HEADER = ["outcome", "%", "95 % interval", "strides", "needed"]
BOUT_HEADER = ["bout", "start, s", "duration, s", "strides", "steps", "turns", "steps/min", "length, m", "speed, m/s"]
MAX_BOUTS = 12
"""Largest number of bouts that the text names one by one; bouts.csv has all of them."""

Span = tuple[float, float]


class WalkTest(ValueEnum):
    """A walk test that can be ordered."""

    SIX_MINUTE = "six-minute"
    UP_AND_GO = "tug"
    WALK = "walk"

    @property
    def title(self) -> str:
        """What the test is called in a title."""
        return {"six-minute": SIX_MINUTE_WALK, "tug": UP_AND_GO, "walk": WALK}[self.value].capitalize()


@frozen
class OutcomeTable:
    """A table whose first column names the outcomes, or numbers the bouts."""

    caption: str
    header: list[str]
    rows: list[list[str]]

    def text(self) -> str:
        """Return the table as plain text."""
        first, *others = [name.replace(",", "") for name in self.header]
        return table([self.caption.lower() if first == "outcome" else first, *others], self.rows)


@frozen
class OutcomeSection:
    """The outcomes of one request as people read them: sentences, then tables, then notes."""

    title: str
    sentences: list[str]
    tables: list[OutcomeTable] = field(factory=list)
    notes: list[str] = field(factory=list)

    def lines(self) -> list[str]:
        """Return the section as lines of plain text."""
        tables = [part for one in self.tables if one.rows for part in ("", one.text())]
        return ["", *self.sentences, *(tables if self.sentences else tables[1:]), *self.notes]


@define
class ClinicalResults:
    """All outcomes of a session that were requested."""

    bouts: list[WalkingBout]
    rows: list[OutcomeRow] = field(factory=list)
    """Rows of all outcomes, in the order of outcomes.csv."""
    sections: list[OutcomeSection] = field(factory=list)
    """A section for each request."""
    result: OutcomeRow | str | None = None
    """Result of the test that was ordered, or why there is none; None without a test."""

    def lines(self) -> list[str]:
        """Return the outcomes as plain text, that of the test first."""
        first = [] if self.result is None else ["", *self.answer()]
        return [*first, *[line for section in self.sections for line in section.lines()]]

    def answer(self, before: ClinicalResults | None = None) -> list[str]:
        """Return the result of the test that was ordered in sentences, with the change from the one `before`."""
        if self.result is None or isinstance(self.result, str):
            return [self.result] if self.result else []
        earlier = None if before is None else before.result
        if isinstance(earlier, str):
            return [*answer(self.result, None), f"Before: {earlier[0].lower()}{earlier[1:]}"]
        return answer(self.result, earlier)

    def table(self, caption: str, part: str) -> OutcomeTable:
        """Return the table of a part, with a column for each kind of reference that there is."""
        header, cells = ["outcome", "value", "unit", *REFERENCE_HEADERS], [row.cells for row in self.part(part)]
        used = [i for i in range(len(header)) if i < 3 or any([row[i] for row in cells])]
        return OutcomeTable(caption, [header[i] for i in used], [[row[i] for i in used] for row in cells])

    def part(self, part: str) -> list[OutcomeRow]:
        """Return the rows of a part whose values are known, without those that a sentence has."""
        return [
            row
            for row in self.rows
            if row.part == part and row.value is not None and not row.name.startswith(MINUTE_NAME)
        ]

    def sources(self, part: str) -> list[str]:
        """Return sentences on the references of a part, with their sources."""
        rows = self.part(part)
        known = [(f"Reference of {row.label}", row.reference) for row in rows]
        changes = [(f"Smallest change of {row.label} that matters", row.smallest_change) for row in rows]
        return [f"{label}: {one.words} ({one.source})." for label, one in [*known, *changes] if one is not None]

    def add_test(self, part: str, sentences: list[str], note: str) -> None:
        """Add the section of a walk test, whose rows there are already."""
        title = part.capitalize()
        self.result = self.rows[0]
        self.sections.append(OutcomeSection(title, sentences, [self.table(title, part)], [note, *self.sources(part)]))


@frozen
class OutcomeRequest:
    """The outcomes that were requested. Their walk keeps all events: `Walk(limit=None)`."""

    outcomes: bool = False
    """True for bouts, mobility outcomes, variability and asymmetry."""
    test: WalkTest | None = None
    """The walk test that was ordered."""
    marks: tuple[float, ...] = ()
    """Times that an observer marked, s: the start of a six-minute walk, or start and stop of a timed up and go.

    Without a start the six minutes begin with the first step."""
    person: Person | None = None
    """Person for whom references are given."""

    @property
    def usual_pace(self) -> bool:
        """True if the wearer walked at the usual pace, so that references and limits of its speed hold."""
        return self.test in (None, WalkTest.WALK)

    def results(self, walk: Walk) -> ClinicalResults:
        """Return the outcomes of a walk so far."""
        events: list[Event] = [*walk.made_turns, *walk.absences]
        for foot in Foot:
            events += [*walk.cycles[foot], *walk.strides[foot]]
        results = ClinicalResults(walking_bouts(events))
        if self.test is not None:
            self._add_test(results, self.test, events, walk.event_span)
        if self.outcomes:
            self._add_outcomes(results, events)
        return results

    def _add_test(self, results: ClinicalResults, test: WalkTest, events: list[Event], span: Span | None) -> None:
        if fault := _find_fault(span, self.marks):
            results.result = f"There is no outcome of the {test.title.lower()}. {fault}"
        elif test is WalkTest.WALK:
            steps, distance = whole_walk(events)
            results.rows += walk_rows(events, steps, distance, self.person)
            results.add_test(WALK, [], WALK_NOTE)
        elif test is WalkTest.UP_AND_GO:
            start, stop = self.marks
            timed = timed_up_and_go(events, start, stop)
            results.rows += up_and_go_rows(timed, self.person)
            results.add_test(UP_AND_GO, [] if timed.steps else [NO_STEP], UP_AND_GO_NOTE)
        elif (walk := six_minute_walk(events, self.marks[0] if self.marks else None, span and span[1])) is None:
            results.result = NO_WALK
        else:
            results.rows += six_minute_rows(walk, self.person)
            results.add_test(SIX_MINUTE_WALK, [six_minute_sentence(walk)], SIX_MINUTE_NOTE)

    def _add_outcomes(self, results: ClinicalResults, events: list[Event]) -> None:
        bouts = results.bouts
        person = self.person if self.usual_pace else None
        results.rows += [*mobility_rows(mobility_outcomes(bouts)), steady_speed_row(events, person)]
        estimates = stride_rows(events)
        vague = [row for row in estimates if (one := row.interval) and one.is_vague]
        results.rows += [row for row in estimates if row not in vague]
        tables = [
            OutcomeTable("Walking bouts", BOUT_HEADER, [bout_row(bout) for bout in bouts[:MAX_BOUTS]]),
            results.table("Mobility outcomes", MOBILITY),
        ]
        for part in OF_STRIDES:
            rows = [row.interval_cells for row in results.part(part)]
            tables.append(OutcomeTable(f"{part.capitalize()} of steady strides", INTERVAL_HEADER, rows))
        more = len(bouts) - MAX_BOUTS
        notes = [f"The first {MAX_BOUTS} bouts are shown; there are {more} more."] if more > 0 else []
        if vague:
            left_out = ", ".join([f"{row.part} of {row.label}" for row in vague])
            notes.append(LEFT_OUT.format(left_out))
        notes += [NEEDED, SENSORS] if any([results.part(part) for part in OF_STRIDES]) else [TOO_FEW]
        notes += results.sources(MOBILITY)
        sentences = [LABEL, *([] if bouts else [NO_BOUT])]
        results.sections.append(OutcomeSection("Walking bouts and mobility outcomes", sentences, tables, notes))


def _find_fault(span: Span | None, marks: Sequence[float]) -> str:
    """Return a sentence on marks that are not within the recording, whose `span` is in s; "" if they are."""
    if span is None:
        return ""
    outside = [f"{mark:.10g}" for mark in marks if not span[0] - MARK_ERROR <= mark <= span[1] + MARK_ERROR]
    if not outside:
        return ""
    verb = "is" if len(outside) == 1 else "are"
    given = f"{' and '.join(outside)} s {verb} not within it"
    return f"The recording is from {span[0]:.1f} to {span[1]:.1f} s on its clock; {given}."


def six_minute_sentence(walk: SixMinuteWalk) -> str:
    """Return the result of a six-minute walk as a sentence."""
    distance = "an unknown distance" if walk.distance is None else f"{walk.distance:.1f} m"
    least = "" if walk.measured else "at least "
    duration = "six minutes" if walk.complete else f"{walk.duration:.1f} s"
    minutes = ", ".join([number(metres, 0) for metres in walk.minutes])
    each = f" Each minute: {minutes} m." if minutes else ""
    return f"Walked {least}{distance} in {duration}, from {walk.t_start:.1f} s on the recording's clock.{each}"


def bout_row(bout: WalkingBout) -> list[str]:
    """Return the cells of a bout in a table; an implausible mean, which counts in no outcome, is in brackets."""
    wrong = implausible(bout)
    means = {
        "cadence": number(bout.cadence, 1),
        "stride_length": number(bout.stride_length),
        "walking_speed": number(bout.walking_speed),
    }
    shown = [f"({mean})" if name in wrong else mean for name, mean in means.items()]
    counts = [number(count, 0) for count in (bout.strides, bout.steps, bout.turns)]
    return [str(bout.number), f"{bout.t_start:.1f}", f"{bout.duration:.1f}", *counts, *shown]
