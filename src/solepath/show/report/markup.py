"""Makes HTML elements; text stays text, since the tree is escaped when it is written."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element, SubElement

from ...recording import printable
from .style import STYLE

MAX_LENGTH = 300
"""Characters of a sentence from outside that are shown."""
MAX_LISTED = 40
"""Sentences of a list that are shown."""


def add(parent: Element, tag: str, text: str = "", **attributes: str) -> Element:
    """Add a new last child to `parent` and return it.

    In names of attributes a trailing underscore is dropped, and others become hyphens."""
    named = {name.removesuffix("_").replace("_", "-"): printable(value, 10**6) for name, value in attributes.items()}
    made = SubElement(parent, tag, named)
    if text:
        made.text = printable(text, MAX_LENGTH)
    return made


def skeleton(title: str) -> tuple[Element, Element]:
    """Return the document and the element for its contents."""
    html = Element("html", {"lang": "en"})
    head = add(html, "head")
    add(head, "meta", charset="utf-8")
    add(head, "meta", name="viewport", content="width=device-width, initial-scale=1")
    add(head, "meta", name="color-scheme", content="light dark")
    add(head, "title", title)
    add(head, "style").text = STYLE
    return html, add(add(html, "body"), "main")


def section(parent: Element, name: str, title: str) -> Element:
    """Add a section with a heading and return it."""
    made = add(parent, "section", aria_labelledby=name)
    add(made, "h2", title, id=name)
    return made


def sentences(parent: Element, texts: Sequence[str]) -> None:
    """Add a list of sentences, and how many more there are."""
    if texts:
        listed = add(parent, "ul")
        for one in texts[:MAX_LISTED]:
            add(listed, "li", one)
        if len(texts) > MAX_LISTED:
            add(listed, "li", f"and {len(texts) - MAX_LISTED} more")


def terms(parent: Element, entries: Iterable[tuple[str, str]], **attributes: str) -> None:
    """Add words with their meanings."""
    listed = add(parent, "dl", **attributes)
    for word, meaning in entries:
        add(listed, "dt", word)
        add(listed, "dd", meaning)


def figure(parent: Element, svg: Element, caption: str, *notes: str) -> Element:
    """Add a drawing with a caption, and notes in smaller words below."""
    made = add(parent, "figure")
    made.append(svg)
    figcaption = add(made, "figcaption")
    add(figcaption, "strong", caption)
    for note in notes:
        add(figcaption, "span", note, **{"class": "note"})
    return made


def table(
    parent: Element, caption: str, header: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers"
) -> Element:
    """Add a table whose first column names its rows.

    Its roles stand beside the tags: on a phone the rows are laid out as grids, and a screen reader takes a table with
    such a style for no table."""
    made = add(parent, "table", role="table", class_=kind)
    add(made, "caption", caption)
    top = add(add(made, "thead", role="rowgroup"), "tr", role="row")
    for name in header:
        add(top, "th", name, scope="col", role="columnheader")
    body = add(made, "tbody", role="rowgroup")
    for first, *others in rows:
        row = add(body, "tr", role="row")
        add(row, "th", first, scope="row", role="rowheader")
        for cell in others:
            cell_element = add(row, "td", role="cell")
            for part in cell.split("\n"):
                add(cell_element, "span", part)
    return made
