"""Compares a walk with an earlier one: measures before and after, their change, and both tracks.

A change is judged by one rule: whether it reaches the smallest change that matters (outcomes/references.py). Measures
for which no publication gives one are not judged."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ...outcomes.references import WALKING_SPEED_CHANGE, SmallestChange
from ...tables.svg import add
from ..content import ReportContent
from ..figures.track import track_figure
from ..markup import notes, paragraph, section, table
from ..measures import Measure
from .facts import Facts, facts_of
from .heading import moment_words
from .headline import headline

HEADER = ("measure", "before", "after", "change", "smallest that matters", "reached")
NOTE = "People differ from day to day: a change of what has no smallest change that matters is not judged."
NO_COMMON = "The two walks have no measure in common."


def comparison(parent: Element, before: ReportContent, after: ReportContent, facts: Facts, *, tracks: bool) -> None:
    """Add the section that compares two walks, with their `tracks` or without."""
    earlier = facts_of(before)
    parent = section(parent, "comparison", "Compared with the walk before")
    moment = ", ".join([words for words in (before.source, *moment_words(before.when)) if words])
    paragraph(parent, f"Before{f' ({moment})' if moment else ''}: {headline(earlier)}")
    rows = [_row(one, other) for one in earlier.all_measures for other in facts.all_measures if one.name == other.name]
    if rows:
        table(parent, "Before and after", HEADER, rows, "numbers comparison")
        known = [(one.label.lower(), _smallest(one)) for one in facts.all_measures]
        words = "Smallest change of {} that matters: {} ({})."
        sources = [words.format(label, one.words, one.source) for label, one in known if one is not None]
        notes(parent, [*sources, NOTE])
    else:
        paragraph(parent, NO_COMMON)
    if tracks:
        figures = add(parent, "<div class='figures'/>")
        for name, one in (("before", before), ("after", after)):
            track_figure(figures, one, wide=False, name=f"track-{name}", title=f"Track {name}")


def _row(before: Measure, after: Measure) -> list[str]:
    change = after.value - before.value
    share = f" ({100.0 * change / abs(before.value):+.0f} %)" if before.value and after.unit not in ("%", "deg") else ""
    label = f"{'running: ' if after.running else ''}{after.label.lower()}, {after.unit}"
    known, judged = _smallest(after), ["-", "-"]
    if known is not None:
        judged = [f"{known.value:.{after.digits}f}", "yes" if known.reached_by(change) else "no"]
    return [label, before.text, after.text, f"{change:+.{after.digits}f}{share}", *judged]


def _smallest(measure: Measure) -> SmallestChange | None:
    """Return the smallest change of a measure that matters; None where no publication gives one."""
    return WALKING_SPEED_CHANGE if measure.name == "speed_m_per_s" else None
