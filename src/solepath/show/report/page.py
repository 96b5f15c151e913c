"""The skeleton of the report: one HTML file that needs nothing else."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, tostring

from .markup import add
from .style import STYLE


def skeleton(title: str) -> tuple[Element, Element]:
    """(the document, where its contents go)."""
    html = Element("html", {"lang": "en"})
    head = add(html, "head")
    add(head, "meta", charset="utf-8")
    add(head, "meta", name="viewport", content="width=device-width, initial-scale=1")
    add(head, "meta", name="color-scheme", content="light dark")
    add(head, "title", title)
    add(head, "style").text = STYLE
    return html, add(add(html, "body"), "main")


def section(parent: Element, name: str, title: str) -> Element:
    """A part with a heading."""
    made = add(parent, "section", aria_labelledby=name)
    add(made, "h2", title, id=name)
    return made


def text_of(html: Element) -> str:
    """The whole file."""
    return "<!DOCTYPE html>\n" + tostring(html, encoding="unicode", method="html") + "\n"


def save(html: Element, path: Path) -> None:
    """UTF-8. OSError, naming the file, when it cannot be written (the disk is full)."""
    try:
        path.write_bytes(text_of(html).encode("utf-8"))
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
