"""Makes the parts of the page that many sections have: tables, lists and figures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element

from ..tables.svg import add
from .style import STYLE

NOTHING = ("", "-")
"""Cells of a table that hold nothing."""
MAX_LISTED = 40
"""Largest number of sentences of a list that are shown; chosen by hand."""
WIDTH = 400.0
"""Width of a drawing, px. It scales with the page: two are side by side on a desktop screen, one on a phone."""


def skeleton(title: str) -> tuple[Element, Element]:
    """Return the document and the element for its contents."""
    html = Element("html", {"lang": "en"})
    head = add(html, "head")
    add(head, "meta", charset="utf-8")
    add(head, "meta", name="generator", content="solepath")
    add(head, "meta", name="viewport", content="width=device-width, initial-scale=1")
    add(head, "meta", name="color-scheme", content="light dark")
    add(head, "title", title)
    add(head, "style").text = STYLE
    return html, add(add(html, "body"), "main")


def section(parent: Element, name: str, title: str) -> Element:
    """Add a section, with a heading that has the id `name`, and return the section."""
    element = add(parent, "section", aria_labelledby=name)
    add(element, "h2", title, id=name)
    return element


def sentences(parent: Element, texts: Sequence[str]) -> None:
    """Add a list of the first MAX_LISTED sentences, and the number of those left out."""
    items = add(parent, "ul")
    for text in texts[:MAX_LISTED]:
        add(items, "li", text)
    if len(texts) > MAX_LISTED:
        add(items, "li", f"and {len(texts) - MAX_LISTED} more")


def whole_sentences(texts: Iterable[str]) -> list[str]:
    """Return texts as sentences, each with a capital letter and a full stop."""
    return [f"{text[0].upper()}{text[1:].removesuffix('.')}." for text in texts if text]


def notes(parent: Element, texts: Iterable[str]) -> None:
    """Add paragraphs in smaller letters."""
    for text in texts:
        add(parent, "p", text, class_="note")


def terms(parent: Element, entries: Iterable[tuple[str, str]], kind: str) -> None:
    """Add a list of words with their meanings; words without a meaning are left out."""
    known = [(word, meaning) for word, meaning in entries if meaning]
    definitions = add(parent, "dl", class_=kind) if known else parent
    for word, meaning in known:
        pair = add(definitions, "div")
        add(pair, "dt", word)
        add(pair, "dd", meaning)


def drawing(parent: Element, name: str, title: str, what: str, height: float, width: float = WIDTH) -> Element:
    """Add an empty <svg> of this size, px, and return it.

    `name` is unique on the page. A screen reader reads `title` and the description `what` aloud."""
    labels = (f"{name}-title", f"{name}-what")
    svg = add(parent, "svg", viewBox=(0.0, 0.0, width, height), role="img", aria_labelledby=labels)
    add(svg, "title", title, id=labels[0])
    add(svg, "desc", what, id=labels[1])
    return svg


def caption(figure: Element, title: str, *notes: str) -> None:
    """Add the caption of a figure, with notes in smaller letters below."""
    figcaption = add(figure, "figcaption")
    add(figcaption, "strong", title)
    for note in notes:
        add(figcaption, "span", note, class_="note")


def figure(parent: Element, name: str, title: str, what: str, height: float, *notes: str) -> Element:
    """Add a figure with its caption, and return its drawing, which is still empty."""
    element = add(parent, "figure", class_=name)
    svg = drawing(element, name, title, what, height)
    caption(element, title, *notes)
    return svg


def table(
    parent: Element, caption: str, header: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers"
) -> None:
    """Add a table whose first column names its rows; rows and columns that hold nothing are left out.

    Every tag has its role as an attribute: on a phone the style sheet lays the rows out as grids, in which a screen
    reader would not recognize a table by its tags."""
    filled = [row for row in rows if not all(cell in NOTHING for cell in row[1:])]
    kept = [c for c in range(len(header)) if c == 0 or not all(row[c] in NOTHING for row in filled)]
    element = add(parent, "table", role="table", class_=kind)
    add(element, "caption", caption)
    row_element = add(add(element, "thead", role="rowgroup"), "tr", role="row")
    for c in kept:
        add(row_element, "th", header[c], scope="col", role="columnheader")
    body = add(element, "tbody", role="rowgroup")
    for row in filled:
        row_element = add(body, "tr", role="row")
        add(row_element, "th", row[0], scope="row", role="rowheader")
        for c in kept[1:]:
            cell = add(row_element, "td", role="cell")
            for line in row[c].split("\n"):
                add(cell, "span", line)
