"""Adds the large figures of a report, with bands of reference where there are any."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element

from ...tables.svg import px
from ..bands import Band
from ..figures.axes import AxisScale, drawing, tick_labels, write
from ..markup import add
from ..measures import SWING_DIFFERENCE, Measure

WIDTH, HEIGHT = 220.0, 42.0
"""Size of the drawing of a band, px."""
EDGE = 16.0
"""Distance of the ends of the scale from the edges of the drawing, px."""
MARGIN_SHARE = 0.5
"""Part of the scale on each side of a band, as a share of the band's width."""
MEAN_MARGIN = 0.3
"""Part of the scale on each side of a mean, as a share of the mean."""


def key_figures(parent: Element, measures: Sequence[Measure], bands: Mapping[str, Band], difference: str) -> None:
    """Add a card for each measure; `difference` says in words what the left/right difference is."""
    cards = add(parent, "div", class_="cards")
    for measure in measures:
        card = add(cards, "div", class_="card")
        add(card, "h3", measure.label)
        value = add(card, "p", class_="value")
        add(value, "span", measure.text if measure.name != SWING_DIFFERENCE else measure.text.lstrip("-"))
        add(value, "small", measure.unit)
        is_difference = measure.name == SWING_DIFFERENCE
        detail = difference if is_difference else measure.detail
        if measure.spread is not None and not is_difference:
            varies = f"\N{PLUS-MINUS SIGN} {measure.spread:.{measure.digits}f} stride to stride"
            detail = f"{detail}; {varies}" if detail else varies
        if detail:
            add(card, "p", detail, class_="note")
        if (band := bands.get(measure.name)) is not None:
            _draw(card, measure, band)
    sources = {bands[measure.name].source: None for measure in measures if measure.name in bands}
    for source in sources:
        labels = [one.label.lower() for one in measures if one.name in bands and bands[one.name].source == source]
        add(parent, "p", f"Reference of {', '.join(labels)}: {source}", class_="note")


def position_words(measure: Measure, band: Band) -> str:
    """Return where a measure lies against its band."""
    value = abs(measure.value) if measure.name == SWING_DIFFERENCE else measure.value
    if band.is_mean:
        return f"{100.0 * value / band.low:.0f} % of the mean"
    return "below the band" if value < band.low else "above the band" if value > band.high else "within the band"


def _draw(card: Element, measure: Measure, band: Band) -> None:
    """Draw the band as a horizontal scale with a mark at the measure's value."""
    value = abs(measure.value) if measure.name == SWING_DIFFERENCE else measure.value
    margin = MEAN_MARGIN * abs(band.low) if band.is_mean else MARGIN_SHARE * (band.high - band.low)
    low, high = min(band.low - margin, value), max(band.high + margin, value)
    x = AxisScale(low, high, EDGE, WIDTH - EDGE)
    ends = f"{band.low:g}" if band.is_mean else f"{band.low:g} to {band.high:g}"
    words = position_words(measure, band)
    what = f"{measure.label} {measure.text} {measure.unit}, {words}; reference {ends} {measure.unit}."
    svg = drawing(f"band-{measure.name}", f"{measure.label} against its reference", what, HEIGHT, WIDTH)
    add(svg, "path", d=f"M{px(x.start)} 14H{px(x.end)}", class_="scale")
    start, end = x.at(band.low), x.at(band.high)
    if band.is_mean:
        add(svg, "path", d=f"M{px(start)} 7v14", class_="band")
    else:
        add(svg, "path", d=f"M{px(start)} 14H{px(end)}", class_="band")
    mark = x.at(value)
    add(svg, "path", d=f"M{px(mark)} 14m-6-12h12l-6 9z", class_="pointer")
    shown = [(start, band.low, "middle")] if band.is_mean else [(start, band.low, "middle"), (end, band.high, "middle")]
    labels = tick_labels([at for _, at, _ in shown]) if len(shown) < 2 else [f"{at:g}" for _, at, _ in shown]
    for (a, _, anchor), label in zip(shown, labels, strict=True):
        write(svg, a, 36.0, label, "tick", anchor)
    card.append(svg)
    add(card, "p", words, class_="note")
