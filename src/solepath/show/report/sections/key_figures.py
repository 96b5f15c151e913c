"""Adds the large figures of a report, with bands of reference where there are any."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

from ...tables.svg import AxisScale, add, write
from ..bands import Band
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

CARD = "<div class='card'><h3>{}</h3><p class='value'><span>{}</span><small>{}</small></p></div>"


def key_figures(parent: Element, facts: Facts, bands: Mapping[str, Band]) -> None:
    """Add a card for each measure, and the sources of the bands."""
    cards = add(parent, "<div class='cards'/>")
    sources: dict[str, list[str]] = {}
    for measure in facts.measures:
        text = measure.text
        details = [measure.detail]
        if measure.name == SWING_DIFFERENCE:
            text, details = text.lstrip("-"), [facts.difference_words]
        elif measure.spread is not None:
            details.append(f"\N{PLUS-MINUS SIGN} {measure.spread:.{measure.digits}f} stride to stride")
        card = add(cards, CARD, measure.label, text, measure.unit)
        notes(card, filter(None, ["; ".join(filter(None, details))]))
        if (band := bands.get(measure.name)) is not None:
            _draw(card, measure, band)
            sources.setdefault(band.source, []).append(measure.label.lower())
    notes(parent, [f"Reference of {', '.join(labels)}: {source}" for source, labels in sources.items()])
    notes(parent, filter(None, [facts.left_out]))


def position_words(size: float, band: Band) -> str:
    """Return where a measure lies against its band."""
    if band.is_mean:
        return f"{100.0 * size / band.low:.0f} % of the mean"
    return "below the band" if size < band.low else "above the band" if size > band.high else "within the band"


def _draw(card: Element, measure: Measure, band: Band) -> None:
    """Draw the band as a horizontal scale with a mark at the measure's value."""
    size, words = measure.size, position_words(measure.size, band)
    margin = MEAN_MARGIN * abs(band.low) if band.is_mean else MARGIN_SHARE * (band.high - band.low)
    x = AxisScale(min(band.low - margin, size), max(band.high + margin, size), EDGE, WIDTH - EDGE)
    ends = dict.fromkeys([band.low, band.high])
    reference = " to ".join([f"{end:g}" for end in ends])
    what = f"{measure.label} {measure.text} {measure.unit}, {words}; reference {reference} {measure.unit}."
    title = f"{measure.label} against its reference"
    svg = drawing(card, f"band-{measure.name}", title, what, HEIGHT, WIDTH)
    start, end = x(band.low), x(band.high)
    add(svg, "<path d='M{} 14H{}' class='scale'/>", x.start, x.end)
    shape = "<path d='M{} 7v14' class='band'/>" if band.is_mean else "<path d='M{} 14H{}' class='band'/>"
    add(svg, shape, start, end)
    add(svg, "<path d='M{} 14m-6-12h12l-6 9z' class='pointer'/>", x(size))
    for value in ends:
        write(svg, x(value), 36.0, f"{value:g}", "tick")
    notes(card, [words])
