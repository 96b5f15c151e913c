"""Compares a walk with an earlier one: measures before and after, their change, and both tracks.

A change counts as larger than the variation from stride to stride if it exceeds the pooled standard deviation of the
strides, the root of the mean of both variances (Cohen 1988). It does not say how a person differs from day to day."""

from __future__ import annotations

from math import hypot, sqrt
from xml.etree.ElementTree import Element

from ..content import ReportContent
from ..figures.track import track_figure
from ..markup import add, section, table
from ..measures import SWING_DIFFERENCE, Measure
from .facts import Facts, facts_of
from .heading import date_words, moment_words
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
    day, time = moment_words(before.when)
    moment = ", ".join([words for words in (before.source, day and date_words(day), time) if words])
    add(parent, "p", f"Before{f' ({moment})' if moment else ''}: {headline(earlier.walk)}")
    pairs = [(one, other) for one in earlier.all_measures for other in facts.all_measures if one.name == other.name]
    if pairs:
        table(parent, "Before and after", HEADER, [_row(*pair) for pair in pairs], "numbers comparison")
        add(parent, "p", NOTE, class_="note")
    else:
        add(parent, "p", NO_COMMON)
    figures = add(parent, "div", class_="figures")
    for name, report in (("before", before), ("after", after)):
        track_figure(
            figures,
            report.track,
            report.foot_tracks,
            report.clock,
            wide=False,
            name=f"track-{name}",
            title=f"Track {name}",
        )
    if not len(figures):
        parent.remove(figures)


def _row(before: Measure, after: Measure) -> list[str]:
    digits = after.digits
    change = after.value - before.value
    share = f" ({100.0 * change / abs(before.value):+.0f} %)" if before.value and after.unit not in ("%", "deg") else ""
    label = f"{'running: ' if is_of_run(after) else ''}{after.label.lower()}, {after.unit}"
    spread = words = "-"
    if after.name == SWING_DIFFERENCE and before.spread is not None and after.spread is not None:
        words = "yes" if abs(change) > hypot(before.spread, after.spread) else "no"
    elif before.spread is not None and after.spread is not None:
        pooled = sqrt(0.5 * (before.spread**2 + after.spread**2))
        spread = f"{pooled:.{max(digits, 1)}f}"
        words = "yes" if abs(change) > pooled else "no"
    return [label, before.text, after.text, f"{change:+.{digits}f}{share}", spread, words]


def is_of_run(measure: Measure) -> bool:
    """Return whether a measure is one of running."""
    return measure.name.startswith(("run_", "contact", "flight", "strike", "vertical"))
