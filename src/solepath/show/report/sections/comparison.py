"""Compares a walk with an earlier one: measures before and after, their change, and both tracks.

A change counts as larger than the variation from stride to stride if it exceeds the pooled standard deviation of the
strides, the root of the mean of both variances (Cohen 1988). It does not say how a person differs from day to day."""

from __future__ import annotations

from math import hypot, sqrt
from xml.etree.ElementTree import Element

from ...tables.svg import add
from ..content import ReportContent
from ..figures.track import track_figure
from ..markup import notes, paragraph, section, table
from ..measures import SWING_DIFFERENCE, Measure
from .facts import Facts, facts_of
from .heading import moment_words
from .headline import headline

HEADER = ("measure", "before", "after", "change", "strides vary by", "beyond that")
NOTE = (
    "Strides vary by the pooled standard deviation of both walks. A larger change is not yet a change of the person: "
    "people differ from day to day. For the asymmetry, both 95 % intervals count instead."
)
NO_COMMON = "The two walks have no measure in common."


def comparison(parent: Element, before: ReportContent, after: ReportContent, facts: Facts) -> None:
    """Add the section that compares two walks."""
    earlier = facts_of(before)
    parent = section(parent, "comparison", "Compared with the walk before")
    moment = ", ".join([words for words in (before.source, *moment_words(before.when)) if words])
    paragraph(parent, f"Before{f' ({moment})' if moment else ''}: {headline(earlier)}")
    rows = [_row(one, other) for one in earlier.all_measures for other in facts.all_measures if one.name == other.name]
    if rows:
        table(parent, "Before and after", HEADER, rows, "numbers comparison")
        notes(parent, [NOTE])
    else:
        paragraph(parent, NO_COMMON)
    figures = add(parent, "<div class='figures'/>")
    for name, one in (("before", before), ("after", after)):
        track_figure(figures, one, wide=False, name=f"track-{name}", title=f"Track {name}")


def _row(before: Measure, after: Measure) -> list[str]:
    change = after.value - before.value
    share = f" ({100.0 * change / abs(before.value):+.0f} %)" if before.value and after.unit not in ("%", "deg") else ""
    label = f"{'running: ' if after.running else ''}{after.label.lower()}, {after.unit}"
    spread = words = "-"
    if before.spread is not None and after.spread is not None:
        least = hypot(before.spread, after.spread)
        if after.name != SWING_DIFFERENCE:
            least *= sqrt(0.5)
            spread = f"{least:.{max(after.digits, 1)}f}"
        words = "yes" if abs(change) > least else "no"
    return [label, before.text, after.text, f"{change:+.{after.digits}f}{share}", spread, words]
