"""Makes the parts of the page that many sections have: tables, lists and figures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element, fromstring

from ..tables.svg import add
from .style import STYLE

NOTHING = ("", "-")
"""Cells of a table that hold nothing."""
MAX_PHONE_COLUMNS = 5
"""Largest number of columns of a table that stand side by side on a phone; others follow below."""
MAX_LISTED = 40
"""Largest number of sentences of a list that are shown; chosen by hand."""
WIDTH = 400.0
"""Width of a drawing, px. It scales with the page: two are side by side on a desktop screen, one on a phone."""
HEAD = """<head><meta charset='utf-8'/><meta name='generator' content='solepath'/>
<meta name='viewport' content='width=device-width, initial-scale=1'/><meta name='color-scheme' content='light dark'/>
<title>{}</title><style/></head>"""


UNIT = re.compile(r"(?<=\d) (?=(?:m/s|mm|cm|ms|min|m|s|h|%|Hz|deg|points)(?![\w/]))")
"""Space between a number and its unit."""


def keep_units(page: Element) -> None:
    """Keep each number and its unit on one line, in all words of a page."""
    for one in page.iter():
        if one.tag not in ("style", "title"):
            one.text, one.tail = [words and UNIT.sub("\N{NO-BREAK SPACE}", words) for words in (one.text, one.tail)]


def skeleton(title: str) -> tuple[Element, Element]:
    """Return the document and the element for its contents."""
    html = fromstring("<html lang='en'/>")
    add(html, HEAD, title)[-1].text = STYLE
    return html, add(html, "<body><main/></body>")[0]


def section(parent: Element, name: str, title: str) -> Element:
    """Add a section, with a heading that has the id `name`, and return the section."""
    return add(parent, "<section aria-labelledby='{}'><h2 id='{}'>{}</h2></section>", name, name, title)


def paragraph(parent: Element, text: str) -> None:
    """Add a paragraph."""
    add(parent, "<p>{}</p>", text)


def notes(parent: Element, texts: Iterable[str]) -> None:
    """Add paragraphs in smaller letters."""
    for text in texts:
        add(parent, "<p class='note'>{}</p>", text)


def sentences(parent: Element, texts: Sequence[str]) -> None:
    """Add a list of the first MAX_LISTED sentences, and the number of those left out."""
    items = add(parent, "<ul/>")
    left_out = [f"and {len(texts) - MAX_LISTED} more"] if len(texts) > MAX_LISTED else []
    for text in [*texts[:MAX_LISTED], *left_out]:
        add(items, "<li>{}</li>", text)


def whole_sentences(texts: Iterable[str]) -> list[str]:
    """Return texts as sentences, each with a capital letter and a full stop."""
    return [f"{text[0].upper()}{text[1:].removesuffix('.')}." for text in texts if text]


def terms(parent: Element, entries: Iterable[tuple[str, str]], kind: str) -> None:
    """Add a list of words with their meanings; words without a meaning are left out."""
    known = [(word, meaning) for word, meaning in entries if meaning]
    definitions = add(parent, "<dl class='{}'/>", kind) if known else parent
    for word, meaning in known:
        add(definitions, "<div><dt>{}</dt><dd>{}</dd></div>", word, meaning)


def drawing(parent: Element, name: str, title: str, what: str, height: float, width: float = WIDTH) -> Element:
    """Add an empty <svg> of this size, px, and return it.

    `name` is unique on the page. A screen reader reads `title` and the description `what` aloud."""
    template = (
        "<svg viewBox='0 0 {2} {3}' role='img' aria-labelledby='{0}-title {0}-what'>"
        "<title id='{0}-title'>{1}</title><desc id='{0}-what'>{4}</desc></svg>"
    )
    return add(parent, template, name, title, width, height, what)


def caption(figure: Element, title: str, *notes: str) -> None:
    """Add the caption of a figure, with notes in smaller letters below."""
    figcaption = add(figure, "<figcaption><strong>{}</strong></figcaption>", title)
    for note in notes:
        add(figcaption, "<span class='note'>{}</span>", note)


def figure(parent: Element, name: str, title: str, what: str, height: float, *notes: str) -> Element:
    """Add a figure with its caption, and return its drawing, which is still empty."""
    element = add(parent, "<figure class='{}'/>", name)
    svg = drawing(element, name, title, what, height)
    caption(element, title, *notes)
    return svg


def table(
    parent: Element, caption: str, header: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers"
) -> None:
    """Add a table whose first column names its rows; rows and columns that hold nothing are left out.

    Every tag has its role as an attribute: on a phone the style sheet lays the rows out as grids, in which a screen
    reader would not recognize a table by its tags."""
    filled = [row for row in rows if not all([cell in NOTHING for cell in row[1:]])]
    kept = [c for c in range(len(header)) if c == 0 or not all([row[c] in NOTHING for row in filled])]
    template = (
        "<table role='table' class='{} columns-{}'><caption>{}</caption>"
        "<thead role='rowgroup'><tr role='row'/></thead><tbody role='rowgroup'/></table>"
    )
    _, head, body = add(parent, template, kind, str(min(len(kept) - 1, MAX_PHONE_COLUMNS)), caption)
    for c in kept:
        add(head[0], "<th scope='col' role='columnheader'>{}</th>", header[c])
    for row in filled:
        row_element = add(body, "<tr role='row'><th scope='row' role='rowheader'>{}</th></tr>", row[0])
        for c in kept[1:]:
            cell = add(row_element, "<td role='cell'/>")
            for text in row[c].split("\n"):
                add(cell, "<span>{}</span>", text)
