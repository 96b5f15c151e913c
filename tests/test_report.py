"""A walk as one file: what it says is what the session said, it needs nothing else, and it comes of anything."""

from __future__ import annotations

from functools import cache
from html.parser import HTMLParser
from math import radians
from pathlib import Path

from attrs import define, field

from solepath import Session
from solepath.body.gait_means import GaitMeans
from solepath.events import Event, StrideMeasured
from solepath.report import Report
from solepath.sim.route import Route
from solepath.view.gait_rows import gait_rows
from solepath.view.table import number
from walks import insoles

CORNER = Route().stand(1.5).walk(12.0, 1.3).turn(radians(90), radius=1.5).walk(3.0).stop(1.0)
VOID = {"meta", "br", "hr", "img", "input", "link", "base"}
LEADS = {"src", "href", "action", "data", "poster", "srcset", "xlink:href", "xmlns", "background", "formaction"}
"""Attributes that fetch something or lead elsewhere."""


@define
class Node:
    tag: str
    attributes: dict[str, str]
    words: list[str] = field(factory=list)
    children: list[Node] = field(factory=list)

    def all(self, tag: str) -> list[Node]:
        found = [self] if self.tag == tag else []
        return found + [one for child in self.children for one in child.all(tag)]

    @property
    def text(self) -> str:
        """In the order of reading, but for what stands after a child."""
        return " ".join([*self.words, *(child.text for child in self.children)]).strip()


class Reader(HTMLParser):
    """The page as a tree; a tag that is not closed in its turn is an error."""

    def __init__(self) -> None:
        super().__init__()
        self.open = [Node("", {})]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        node = Node(tag, {name: value or "" for name, value in attrs})
        self.open[-1].children.append(node)
        if tag not in VOID:
            self.open.append(node)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop().tag == tag.lower()

    def handle_data(self, data: str) -> None:
        if data.strip():
            self.open[-1].words.append(data.strip())


def page(report: Report, path: Path) -> Node:
    report.write(path)
    reader = Reader()
    reader.feed(path.read_text(encoding="utf-8"))
    assert [one.tag for one in reader.open] == [""], "every tag is closed"
    return reader.open[0]


@cache
def walked() -> tuple[Event, ...]:
    """All that a session with insoles says of a walk round a corner."""
    session = Session(poses=True, pressures=True)
    return (*session.feed(insoles(CORNER, cells=24).packets), *session.finish())


def told(*events: Event, title: str = "a walk") -> Report:
    report = Report(title, recipe="default", version="1.0")
    for event in events:
        report.add(event)
    return report


def test_the_report_of_a_walk_has_its_gait_table_with_the_numbers_of_the_session(tmp_path: Path) -> None:
    means = GaitMeans(memory=10**9)
    for event in walked():
        if isinstance(event, StrideMeasured):
            means.hear(event)
    parameters = means.of(False)
    assert parameters is not None
    read = page(told(*walked()), tmp_path / "r.html")
    table = next(one for one in read.all("table") if "gait" in one.attributes["class"])
    rows = {row.all("th")[0].text: [cell.all("span")[0].text for cell in row.all("td")] for row in table.all("tr")}
    for row in gait_rows(parameters):
        expected = [number(one, row.digits) for one in (row.left, row.right, row.both)]
        assert rows[f"{row.label}, {row.unit}"][:3] == expected
