"""Makes HTML elements; text never becomes markup, since the tree is escaped when it is written."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element, SubElement

from ...recording import printable
from .style import STYLE

MAX_LENGTH = 300
"""Largest number of characters of a text that are shown; chosen by hand."""
NOTHING = ("", "-")
"""Cells of a table that hold nothing."""
MAX_LISTED = 40
"""Largest number of sentences of a list that are shown; chosen by hand."""


def add(parent: Element, tag: str, text: str = "", **attributes: str) -> Element:
    """Add a new last child to `parent` and return it.

    In names of attributes a trailing underscore is dropped, and other underscores become hyphens."""
    html_attributes = {
        name.removesuffix("_").replace("_", "-"): printable(value, 10**6) for name, value in attributes.items()
    }
    element = SubElement(parent, tag, html_attributes)
    if text:
        element.text = printable(text, MAX_LENGTH)
    return element


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
    if texts:
        items = add(parent, "ul")
        for text in texts[:MAX_LISTED]:
            add(items, "li", text)
        if len(texts) > MAX_LISTED:
            add(items, "li", f"and {len(texts) - MAX_LISTED} more")


def whole_sentences(texts: Sequence[str]) -> list[str]:
    """Return texts as sentences, each with a capital letter and a full stop."""
    return [f"{text[0].upper()}{text[1:].removesuffix('.')}." for text in texts if text]


def terms(parent: Element, entries: Iterable[tuple[str, str]], **attributes: str) -> None:
    """Add a list of words with their meanings."""
    definitions = add(parent, "dl", **attributes)
    for word, meaning in entries:
        pair = add(definitions, "div")
        add(pair, "dt", word)
        add(pair, "dd", meaning)


def figure(parent: Element, svg: Element, caption: str, *notes: str) -> Element:
    """Add a drawing with a caption, and notes in smaller letters below."""
    element = add(parent, "figure")
    element.append(svg)
    figcaption = add(element, "figcaption")
    add(figcaption, "strong", caption)
    for note in notes:
        add(figcaption, "span", note, **{"class": "note"})
    return element


def without_nothing(header: Sequence[str], rows: Sequence[Sequence[str]]) -> tuple[list[str], list[list[str]]]:
    """Return a table without the columns and rows whose cells are all empty or a dash; the first column names rows."""
    filled = [list(row) for row in rows if not all(cell in NOTHING for cell in row[1:])]
    kept = [c for c in range(len(header)) if c == 0 or not all(row[c] in NOTHING for row in filled)]
    return [header[c] for c in kept], [[row[c] for c in kept] for row in filled]


def table(
    parent: Element, caption: str, header: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers"
) -> Element:
    """Add a table whose first column names its rows; rows and columns that hold nothing are left out.

    Every tag has its role as an attribute: on a phone the style sheet lays the rows out as grids, in which a screen
    reader would not recognize a table by its tags."""
    header, rows = without_nothing(header, rows)
    element = add(parent, "table", role="table", class_=kind)
    add(element, "caption", caption)
    header_row = add(add(element, "thead", role="rowgroup"), "tr", role="row")
    for name in header:
        add(header_row, "th", name, scope="col", role="columnheader")
    body = add(element, "tbody", role="rowgroup")
    for first, *others in rows:
        row = add(body, "tr", role="row")
        add(row, "th", first, scope="row", role="rowheader")
        for cell in others:
            cell_element = add(row, "td", role="cell")
            for line in cell.split("\n"):
                add(cell_element, "span", line)
    return element
