"""Compares a walk with an earlier one: measures before and after, their change, and both tracks.

A change is judged by one rule: whether it reaches the smallest change that matters (outcomes/references.py). Measures
for which no publication gives one are not judged."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ...outcomes.answer import change_of
from ...outcomes.clinic import WalkTest
from ...outcomes.references import WALKING_SPEED_CHANGE, SmallestChange
from ...outcomes.rows import OutcomeRow
from ...tables.svg import add
from ..content import ReportContent
from ..figures.track import track_figure
from ..markup import notes, paragraph, section, table
from ..measures import Measure
from .facts import Facts
from .heading import moment_words
from .headline import headline

HEADER = ("measure", "before", "after", "change", "smallest that matters", "reached")
NOTE = "People differ from day to day: a change of what has no smallest change that matters is not judged."
NO_COMMON = "The two walks have no measure in common."


def comparison(
    parent: Element,
    before: ReportContent,
    after: ReportContent,
    facts: Facts,
    earlier: Facts,
    results: Sequence[OutcomeRow] = (),
) -> None:
    """Add the section that compares two walks, with their tracks, or with the `results` of a test that was ordered.

    The smallest change of speed that matters is of walks at the usual pace, and judges no other ones."""
    test = None if after.outcomes is None else after.outcomes.test
    usual_pace = after.outcomes is None or after.outcomes.usual_pace
    parent = section(parent, "comparison", "Compared with the walk before")
    moment = ", ".join([words for words in (before.source, *moment_words(before.when)) if words])
    paragraph(parent, f"Before{f' ({moment})' if moment else ''}: {headline(earlier)}")
    pairs = [(one, other) for one in earlier.all_measures for other in facts.all_measures if one.name == other.name]
    rows = [_row(one, other, usual_pace) for one, other in pairs]
    if len(results) == 2 and test is not WalkTest.WALK:  # the speed of a walk is a measure
        rows.insert(0, _result_row(*results))
    if rows:
        table(parent, "Before and after", HEADER, rows, "numbers comparison")
        known = [(one.label.lower(), _smallest(one, usual_pace)) for one in facts.all_measures]
        words = "Smallest change of {} that matters: {} ({})."
        sources = [words.format(label, one.words, one.source) for label, one in known if one is not None]
        notes(parent, [*sources, NOTE])
    else:
        paragraph(parent, NO_COMMON)
    if test is None:
        figures = add(parent, "<div class='figures'/>")
        for name, one in (("before", before), ("after", after)):
            track_figure(figures, one, wide=False, name=f"track-{name}", title=f"Track {name}")


def _result_row(before: OutcomeRow, after: OutcomeRow) -> list[str]:
    """Return the row of the result of a test; what was not measured of the whole test is not judged."""
    label, known = f"{after.label}, {after.unit}", after.smallest_change
    shown = ["-" if one.value is None else one.least + one.shown(one.value) for one in (before, after)]
    change = change_of(after, before)
    if change is None or after.value is None:
        return [label, *shown, "-", "-", "-"]
    return [label, *shown, *_change(change, before.value, after.digits(after.value), known)]


def _row(before: Measure, after: Measure, usual_pace: bool) -> list[str]:
    label = f"{'running: ' if after.running else ''}{after.label.lower()}, {after.unit}"
    change, base = after.value - before.value, before.value if after.unit not in ("%", "deg") else None
    known = _smallest(after, usual_pace)
    return [label, before.text, after.text, *_change(change, base, after.digits, known, after.unit)]


def _change(change: float, base: float | None, digits: int, known: SmallestChange | None, unit: str = "") -> list[str]:
    """Return the cells of a change: the change, also in percent of `base`, and how it is judged.

    The change of a share is in points."""
    share = f" ({100.0 * change / abs(base):+z.0f} %)" if base else " points" if unit == "%" else ""
    judged = ["-", "-"] if known is None else [f"{known.value:.{digits}f}", "yes" if known.reached_by(change) else "no"]
    return [f"{change:+z.{digits}f}{share}", *judged]


def _smallest(measure: Measure, usual_pace: bool) -> SmallestChange | None:
    """Return the smallest change of a measure that matters; None where no publication gives one."""
    return WALKING_SPEED_CHANGE if usual_pace and measure.name == "speed_m_per_s" else None
