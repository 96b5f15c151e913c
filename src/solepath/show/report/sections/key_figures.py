"""Adds the large figures of a report, with bands of reference where there are any."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

from ...tables.svg import AxisScale, add
from ..bands import Band
from ..figures.axes import write
from ..markup import drawing, notes
from ..measures import SWING_DIFFERENCE, Measure
from .facts import Facts

WIDTH, HEIGHT = 220.0, 42.0
"""Size of the drawing of a band, px."""
EDGE = 16.0
"""Distance of the ends of the scale from the edges of the drawing, px."""
MARGIN_SHARE = 0.5
"""Part of the scale on each side of a band, as a share of the band's width."""
MEAN_MARGIN = 0.3
"""Part of the scale on each side of a mean, as a share of the mean."""


def key_figures(parent: Element, facts: Facts, bands: Mapping[str, Band]) -> None:
    """Add a card for each measure, and the sources of the bands."""
    cards = add(parent, "div", class_="cards")
    sources: dict[str, list[str]] = {}
    for measure in facts.measures:
        kind = measure.kind
        card = add(cards, "div", class_="card")
        add(card, "h3", kind.label)
        value = add(card, "p", class_="value")
        text, details = measure.text, [kind.detail]
        if measure.name == SWING_DIFFERENCE:
            text, details = text.lstrip("-"), [facts.difference_words]
        elif measure.spread is not None:
            details.append(f"\N{PLUS-MINUS SIGN} {measure.spread:.{kind.digits}f} stride to stride")
        add(value, "span", text)
        add(value, "small", kind.unit)
        if any(details):
            notes(card, ["; ".join(filter(None, details))])
        if (band := bands.get(measure.name)) is not None:
            _draw(card, measure, band)
            sources.setdefault(band.source, []).append(kind.label.lower())
    notes(parent, [f"Reference of {', '.join(labels)}: {source}" for source, labels in sources.items()])


def position_words(size: float, band: Band) -> str:
    """Return where a measure lies against its band."""
    if band.is_mean:
        return f"{100.0 * size / band.low:.0f} % of the mean"
    return "below the band" if size < band.low else "above the band" if size > band.high else "within the band"


def _draw(card: Element, measure: Measure, band: Band) -> None:
    """Draw the band as a horizontal scale with a mark at the measure's value."""
    kind, size, words = measure.kind, measure.size, position_words(measure.size, band)
    margin = MEAN_MARGIN * abs(band.low) if band.is_mean else MARGIN_SHARE * (band.high - band.low)
    x = AxisScale(min(band.low - margin, size), max(band.high + margin, size), EDGE, WIDTH - EDGE)
    ends = dict.fromkeys([band.low, band.high])
    reference = " to ".join([f"{end:g}" for end in ends])
    what = f"{kind.label} {measure.text} {kind.unit}, {words}; reference {reference} {kind.unit}."
    title = f"{kind.label} against its reference"
    svg = drawing(card, f"band-{measure.name}", title, what, HEIGHT, WIDTH)
    start, end = x(band.low), x(band.high)
    add(svg, "path", d=("M", x.start, "14H", x.end), class_="scale")
    add(svg, "path", d=("M", start, "7v14") if band.is_mean else ("M", start, "14H", end), class_="band")
    add(svg, "path", d=("M", x(size), "14m-6-12h12l-6 9z"), class_="pointer")
    for value in ends:
        write(svg, x(value), 36.0, f"{value:g}", "tick")
    notes(card, [words])
