"""Adds clinical outcomes to a report: the six-minute walk, the timed up and go, walking bouts and mobility outcomes."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ...outcomes.clinic import (
    BOUT_HEADER,
    INTERVAL_HEADER,
    LABEL,
    MAX_BOUTS,
    NEEDED,
    NO_BOUT,
    NO_STEP,
    SENSORS,
    UP_AND_GO_NOTE,
    ClinicalResults,
    OutcomeRequest,
    bout_row,
    interval_row,
    walk_sentence,
)
from ...outcomes.rows import MOBILITY, OF_STRIDES, SIX_MINUTE_WALK, UP_AND_GO, OutcomeRow
from ..figures.minutes import minutes_figure
from ..markup import add, section, table, whole_sentences

SIX_MINUTE_NOTE = (
    "The distance is the mean of what both feet went, stride by stride, turns included (ATS 2002 counts lengths of a "
    "course). Stops are breaks of more than 3 s."
)
TOO_FEW = "There are too few steady strides for variability and asymmetry: four of a foot are needed."


def clinical_sections(main: Element, request: OutcomeRequest, results: ClinicalResults) -> None:
    """Add a section for each outcome that was requested."""
    if request.six_minutes:
        parent = section(main, "six-minute-walk", "Six-minute walk")
        walk = results.six_minutes
        add(parent, "p", walk_sentence(results))
        if walk is not None:
            figures = add(parent, "div", class_="figures")
            rows = [row for row in results.part(SIX_MINUTE_WALK) if not row.name.startswith("distance_minute")]
            _table(figures, "Six-minute walk", rows)
            minutes_figure(figures, walk.minutes)
            _notes(parent, [SIX_MINUTE_NOTE, *results.sources(SIX_MINUTE_WALK)])
    if results.up_and_go_fault:
        parent = section(main, "up-and-go", "Timed up and go")
        add(parent, "p", f"There is no timed up and go. {results.up_and_go_fault}")
    if results.up_and_go is not None:
        parent = section(main, "up-and-go", "Timed up and go")
        _table(parent, "Timed up and go", results.part(UP_AND_GO))
        notes = [UP_AND_GO_NOTE, *([] if results.up_and_go.steps else [NO_STEP]), *results.sources(UP_AND_GO)]
        _notes(parent, notes)
    if request.outcomes:
        parent = section(main, "outcomes", "Walking bouts and mobility outcomes")
        add(parent, "p", LABEL, class_="caution")
        if results.bouts:
            table(parent, "Walking bouts", BOUT_HEADER, [bout_row(bout) for bout in results.bouts[:MAX_BOUTS]])
        else:
            add(parent, "p", whole_sentences([NO_BOUT])[0])
        if len(results.bouts) > MAX_BOUTS:
            add(parent, "p", f"and {len(results.bouts) - MAX_BOUTS} more bouts", class_="note")
        _table(parent, "Mobility outcomes", results.part(MOBILITY))
        for part in OF_STRIDES:
            cells = [interval_row(row) for row in results.part(part)]
            if cells:
                table(parent, f"{part.capitalize()} of steady strides", (part, *INTERVAL_HEADER), cells)
        notes = [NEEDED.capitalize(), SENSORS.capitalize()] if results.part(*OF_STRIDES) else [TOO_FEW]
        _notes(parent, [*notes, *results.sources(MOBILITY)])


def _table(parent: Element, caption: str, rows: Sequence[OutcomeRow]) -> None:
    has_reference = any(row.reference_text for row in rows)
    header = ["outcome", "value", *(["reference"] if has_reference else [])]
    cells = []
    for row in rows:
        value = f"{row.shown(row.value)} {row.shown_unit}".rstrip()
        cells.append([row.label, value, *([row.reference_text or "-"] if has_reference else [])])
    table(parent, caption, header, cells)


def _notes(parent: Element, sentences: Sequence[str]) -> None:
    for sentence in sentences:
        add(parent, "p", f"{sentence.removesuffix('.')}.", class_="note")
