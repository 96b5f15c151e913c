"""Parses an HTML page as a tree, without any code that writes the report."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

from attrs import define, field

VOID = {"meta", "br", "hr", "img", "input", "link", "base"}


@define
class Node:
    tag: str
    attributes: dict[str, str]
    words: list[str] = field(factory=list)
    children: list[Node] = field(factory=list)

    def all(self, tag: str = "") -> list[Node]:
        """Return this node and all nodes below it in the order of the page; with `tag`, only those with this tag."""
        nodes = [self] if tag in ("", self.tag) else []
        return nodes + [node for child in self.children for node in child.all(tag)]

    def first(self, tag: str) -> Node:
        return self.all(tag)[0]

    def named(self, name: str) -> Node:
        """Return the first element with this class."""
        return next(node for node in self.all() if name in node.attributes.get("class", "").split())

    @property
    def text(self) -> str:
        """Text of this node, then of the nodes below it."""
        return " ".join([text for text in [*self.words, *(child.text for child in self.children)] if text])


class Reader(HTMLParser):
    """A parser of a page as a tree; a tag that is closed out of order fails."""

    def __init__(self) -> None:
        super().__init__()
        self.open = [Node("", {})]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        node = Node(tag, {name: value or "" for name, value in attrs})
        self.open[-1].children.append(node)
        if tag not in VOID:
            self.open.append(node)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop().tag == tag

    def handle_data(self, data: str) -> None:
        if data.strip():
            self.open[-1].words.append(data.strip().replace("\N{NO-BREAK SPACE}", " "))


def read_page(path: Path) -> Node:
    """Return the page of a file."""
    return parse_page(path.read_text(encoding="utf-8"))


def parse_page(text: str) -> Node:
    reader = Reader()
    reader.feed(text)
    reader.close()
    assert [one.tag for one in reader.open] == [""], "every tag is closed"
    return reader.open[0]
