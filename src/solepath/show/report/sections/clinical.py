"""Adds clinical outcomes to a report: the six-minute walk, the timed up and go, walking bouts and mobility outcomes."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ...outcomes.clinic import ClinicalResults
from ..markup import notes, paragraph, section, table


def clinical_sections(main: Element, results: ClinicalResults) -> None:
    """Add a section for each outcome that was requested."""
    for one in results.sections:
        parent = section(main, one.title.lower().replace(" ", "-"), one.title)
        for sentence in one.sentences:
            paragraph(parent, sentence)
        for shown in one.tables:
            if shown.rows:
                kind = "numbers titled" if shown.caption == one.title else "numbers"
                table(parent, shown.caption, shown.header, shown.rows, kind)
        notes(parent, one.notes)
