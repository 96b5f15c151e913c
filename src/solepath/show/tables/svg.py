"""Writes text into SVG pictures."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

PAPER_COLOUR, INK_COLOUR = "#ffffff", "#1f2933"


def write_text(
    parent: Element,
    x: float,
    y: float,
    words: str,
    *,
    size: float,
    colour: str = INK_COLOUR,
    weight: str = "400",
    anchor: str = "start",
    halo: bool = False,
) -> None:
    """Write words at (x, y), px; with `halo`, in an edge of the colour of paper."""
    look = {"x": px(x), "y": px(y), "font-size": px(size), "font-weight": weight, "text-anchor": anchor}
    plain = plain_text(words)
    if halo:
        edge = {"fill": PAPER_COLOUR, "stroke": PAPER_COLOUR, "stroke-width": "3", "stroke-linejoin": "round"}
        SubElement(parent, "text", {**look, **edge}).text = plain
    SubElement(parent, "text", {**look, "fill": colour}).text = plain


def plain_text(words: str) -> str:
    """Replace control characters and lone surrogates, which XML cannot contain, by spaces."""
    return "".join([c if c.isprintable() else " " for c in words])


def px(value: float) -> str:
    """Return px as text with at most one digit after the point, the same on every platform."""
    short = f"{value:.1f}".removesuffix(".0")
    return "0" if short == "-0" else short
