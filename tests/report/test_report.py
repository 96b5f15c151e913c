"""Tests the report: it holds what the session reported, needs no other file, and can be made from any events."""

from __future__ import annotations

import re
from functools import cache
from math import inf, nan, radians
from pathlib import Path
from random import Random
from typing import Any, get_args

import pytest
from attrs import asdict, evolve
from made import Maker
from pages import Node, parse_page, read_page
from walks import insoles, of, run_session

from solepath import Connected, LinkTrouble, PlaceLost, SampleGap, Site
from solepath.body.gait.means import GaitMeans
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.events import Event, FootMoved, GaitCycleMeasured, StrideTaken, WearerMoved
from solepath.show.report import Report, ReportDetails
from solepath.show.tables.gait import sure_rows
from solepath.show.tables.table import number, percent
from solepath.types import Foot

CORNER = Route().stand(1.5).walk(12.0, 1.3).turn(radians(90), radius=1.5).walk(3.0).stop(1.0)
LEADS = {"src", "href", "action", "data", "poster", "srcset", "xlink:href", "background", "formaction", "ping", "style"}
"""Attributes with which an element loads something or links to another page."""
ODD = (nan, inf, -inf, -1e11, 1e11)
NO_NUMBER = re.compile(r"\b(nan|inf)\b", re.IGNORECASE)


@cache
def walk_events() -> tuple[Event, ...]:
    """Return all events of a session with insoles on a walk round a corner."""
    return tuple(run_session(insoles(CORNER, cells=24).packets, poses=True, pressures=True))


def report_of(*events: Event, source: str = "a walk", **more: Any) -> Report:
    report = Report(source, recipe="default", version="1.0", **more)
    report.take(None, events)
    return report


def shown(report: Report) -> Node:
    return parse_page(report.text())


def rows_of(page: Node) -> dict[str, list[str]]:
    """Return the cells of each row of the gait table by the row's name."""
    table = page.named("gait")
    return {row.first("th").text: [cell.text for cell in row.all("td")] for row in table.all("tr")}


def test_the_gait_table_has_the_numbers_of_the_session() -> None:
    means = GaitMeans()
    for event in of(GaitCycleMeasured, walk_events()):
        means.add(event, 10**9)
    parameters = means.of(False)
    assert parameters is not None
    rows = rows_of(shown(report_of(*walk_events())))
    for row in sure_rows(parameters, of(GaitCycleMeasured, walk_events()))[0]:
        spread = "" if row.sd is None else f" \N{PLUS-MINUS SIGN} {number(row.sd, row.digits)}"
        both = f"{number(row.both, row.digits)}{spread}"
        feet = [number(one, row.digits) for one in (row.left, row.right)]
        assert rows[f"{row.label}, {row.unit}"] == [*feet, both, percent(row.cv), row.asymmetry_text]
    assert rows["cadence, steps/min"][2] == number(parameters.cadence, 1)
    assert len(rows) > 10


def test_the_summary_holds_duration_distance_and_activities() -> None:
    page = shown(report_of(*walk_events(), when="on Monday"))
    sentences = [one.text for one in page.all("li")]
    for foot in Foot:
        taken = [event for event in of(StrideTaken, walk_events()) if event.foot is foot]
        distance = sum(event.length for event in taken)
        assert f"The {foot.value} foot took {len(taken)} strides over {distance:.1f} m." in sentences
    assert any(one.startswith("Activities: standing ") and " walking " in one for one in sentences)
    assert "Turns: 1 to the left." in sentences
    samples = [event.t for event in of(FootMoved, walk_events())]
    assert "on Monday" in page.named("facts").text
    facts = page.all("dl")[-1].text
    assert "a walk" in facts and "default" in facts and "solepath 1.0" in facts
    assert f"{min(samples):.1f} to {max(samples):.1f} s" in facts
    assert "motion and pressure" in facts
    assert "no diagnosis" in page.text


def test_faults_are_shown_in_words_and_in_the_table_of_links() -> None:
    link = [
        Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device="a", name="sole 7", signal=-50),
        SampleGap(t=3.0, known_at=3.0, site=Site.LEFT_FOOT, duration=0.12, count=11),
        LinkTrouble(t=4.0, known_at=4.0, site=Site.LEFT_FOOT, what="the battery is nearly empty"),
    ]
    page = shown(report_of(*link, *walk_events()))
    health = next(one for one in page.all("section") if one.attributes["aria-labelledby"] == "health")
    assert "11" in health.text and "the battery is nearly empty" in health.text
    assert "left foot (sole 7)" in page.all("dl")[-1].text
    assert "Nothing was wrong" not in health.text
    assert "Nothing was wrong" in shown(report_of(link[0])).text


def test_the_file_leads_nowhere_and_runs_nothing(tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    report_of(*walk_events()).write(path)
    text = path.read_text(encoding="utf-8")
    assert text.startswith('<!DOCTYPE html>\n<html lang="en">')
    page = read_page(path)
    for one in page.all():
        assert one.tag not in {"script", "link", "iframe", "object", "embed", "img", "image", "use", "a", "base"}
        assert not LEADS & one.attributes.keys()
        assert not any(name.startswith("on") for name in one.attributes)
    assert not re.search(r"url\(|@import|https?:|//[a-z]", text)
    assert page.first("meta").attributes == {"charset": "utf-8"}
    assert len(text) < 200_000


def test_names_from_outside_stay_text() -> None:
    bad = '</title><script>alert("1")</script> & <b onload=x>\x00\ud800'
    events = [
        PlaceLost(t=1.0, known_at=1.0, what=bad),
        LinkTrouble(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, what=bad),
        Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device=bad, name=bad, signal=None),
    ]
    report = report_of(*events, source=bad, when=bad, details=ReportDetails(bad, bad, bad, bad))
    report.recipe = bad
    report.plan = evolve(BUILDING, name=bad)
    page = shown(report)
    assert not page.all("script") and not page.all("b")
    assert page.first("h1").text.startswith('</title><script>alert("1")</script> & <b onload=x>')
    assert page.text.count("<script>") >= 8


def test_there_is_a_sentence_for_what_there_is_not() -> None:
    page = shown(Report("nothing"))
    assert not page.all("svg") and not page.all("table")
    assert page.named("headline").text == "No data from either foot."
    assert [one.text for one in page.all("h2")] == ["How this report was made"]
    planned = shown(Report("nothing", BUILDING))
    assert "Where on the floor plan the wearer was is not known." in planned.text


def any_events(seed: int) -> list[Event]:
    """Return twenty events of any class, with some numbers that are none or very large."""
    random, made = Random(seed), Maker(seed, seed)

    def other(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple([other(one) for one in value])
        return random.choice(ODD) if isinstance(value, float) and random.random() < 0.3 else value

    return [type(one)(**{name: other(value) for name, value in asdict(one, recurse=False).items()})
            for one in map(made.of, random.choices(get_args(Event), k=20))]  # fmt: skip


@pytest.mark.parametrize("seed", range(20))
def test_any_events_in_any_order_make_a_page_without_a_number_that_is_none(seed: int) -> None:
    report, events = Report("any", BUILDING), any_events(seed)
    report.take(None, [*events, *Random(seed).sample(walk_events(), 3 * seed), *events])
    for svg in shown(report).all("svg"):
        for one in svg.all():
            coordinates = {k: v for k, v in one.attributes.items() if k not in ("id", "class", "aria-labelledby")}
            assert not any(NO_NUMBER.search(value) for value in coordinates.values())


@pytest.mark.long
def test_memory_does_not_grow_with_the_time_walked() -> None:
    kinds = (GaitCycleMeasured, StrideTaken, WearerMoved)
    events = [event for kind in kinds for event in of(kind, walk_events())[-8:]]
    report, sizes = report_of(*walk_events()), []
    for k in range(1, 501):
        report.take(None, [evolve(event, t=event.t + 20.0 * k) for event in events])
        if k in (250, 500):
            sizes.append(len(repr(report)))
    assert min(one.count for one in report.walk.strides.values()) > 1500 and report.walk.wearer_track.count > 2000
    assert sizes[1] < 1.3 * sizes[0]
