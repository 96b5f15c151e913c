"""Tests the report: it holds what the session reported, needs no other file, and can be made from any events."""

from __future__ import annotations

import re
from functools import cache
from math import radians
from pathlib import Path
from random import Random
from typing import Any

import happenings
import pytest
from attrs import evolve
from floors import LOW, OFFICE, Pedestrian, office
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pages import Node, parse_page, read_page
from shown import later
from walks import insoles, of, run_session

from solepath import Connected, Defect, DefectFound, LinkTrouble, PacketsLost, PlaceLost, Session, Site
from solepath.body.gait.means import GaitMeans
from solepath.body.place.particles import Particles
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.events import Event, FootMoved, FootPressed, GaitCycleMeasured, LayoutKnown, StrideTaken, WearerMoved
from solepath.floorplan.plan import Start
from solepath.show.report import Report, ReportDetails
from solepath.show.tables.gait import gait_rows
from solepath.show.tables.table import number, percent
from solepath.types import Foot

CORNER = Route().stand(1.5).walk(12.0, 1.3).turn(radians(90), radius=1.5).walk(3.0).stop(1.0)
LEADS = {"src", "href", "action", "data", "poster", "srcset", "xlink:href", "background", "formaction", "ping", "style"}
"""Attributes with which an element loads something or links to another page."""
NO_NUMBER = re.compile(r"\b(nan|inf)\b", re.IGNORECASE)


@cache
def walk_events() -> tuple[Event, ...]:
    """Return all events of a session with insoles on a walk round a corner."""
    return tuple(run_session(insoles(CORNER, cells=24).packets, poses=True, pressures=True))


def left_foot_events() -> list[Event]:
    """Return the events of `walk_events` without those of the right foot."""
    return [event for event in walk_events() if getattr(event, "foot", Foot.LEFT) is Foot.LEFT]


def report_of(*events: Event, source: str = "a walk", **more: Any) -> Report:
    report = Report(source, recipe="default", version="1.0", **more)
    report.take(None, events)
    return report


def shown(report: Report) -> Node:
    return parse_page(report.text())


def captions(page: Node) -> list[str]:
    return [one.first("strong").text for one in page.all("figcaption")]


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
    for row in gait_rows(parameters):
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
    assert "The wearer made 1 turn to the left." in sentences
    samples = [event.t for event in of(FootMoved, walk_events())]
    assert "on Monday" in page.named("facts").text
    facts = page.all("dl")[-1].text
    assert "a walk" in facts and "default" in facts and "solepath 1.0" in facts
    assert f"{min(samples):.1f} to {max(samples):.1f} s" in facts
    assert "motion and pressure" in facts
    assert "no diagnosis" in page.text


def test_runs_and_walks_have_a_table_each() -> None:
    strides = of(GaitCycleMeasured, walk_events())
    runs = [evolve(later(one, 60.0), stance_time=0.3) for one in strides]
    captions = [one.first("caption").text for one in shown(report_of(*strides, *runs)).all("table")]
    assert [one.partition(":")[0] for one in captions if "steady" in one] == ["Walking", "Running"]


def test_a_recording_whose_clock_started_long_ago_is_shown_from_its_start() -> None:
    moved = [evolve(later(event, 1.7e9), position=(0.0, 0.0, event.t)) for event in of(FootMoved, walk_events())]
    assert "time from the beginning, s" in shown(report_of(*moved)).text


def test_faults_are_shown_in_words_and_in_the_table_of_links() -> None:
    link = [
        Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device="a", name="sole 7", signal=-50),
        PacketsLost(t=3.0, known_at=3.0, site=Site.LEFT_FOOT, channel="insole/frame", count=11),
        LinkTrouble(t=4.0, known_at=4.0, site=Site.LEFT_FOOT, what="the battery is nearly empty"),
    ]
    page = shown(report_of(*link, *walk_events()))
    health = next(one for one in page.all("section") if one.attributes["aria-labelledby"] == "health")
    assert "11" in health.text and "the battery is nearly empty" in health.text
    assert "left foot (sole 7)" in page.all("dl")[-1].text
    assert "Nothing was wrong" not in health.text
    assert "Nothing was wrong" in shown(report_of(link[0])).text


def test_data_that_cannot_be_right_come_first_in_the_report() -> None:
    what = "the axes of the gyroscope do not fit those of the accelerometer"
    defect = DefectFound(t=3.0, known_at=3.0, site=Site.RIGHT_FOOT, defect=Defect.AXES, what=what)
    page = shown(report_of(*walk_events(), defect))
    assert "Do not use the figures before this is checked: data that cannot be right." in page.named("warning").text
    assert "Cannot be right" in [one.text for one in page.all("h3")]
    whole = page.text
    assert whole.index("Do not use") < whole.index("The recording lasts") < whole.index(what)
    assert "Cannot be right" not in shown(report_of(*walk_events())).text


def report_after_silence(silence: float, back: float) -> Report:
    """Return the report of a walk that is silent for `silence` s in its middle, then continues `back` s earlier."""
    session, report = Session(poses=True, pressures=True), Report("a walk")
    now = 0.0
    for packet in insoles(Route().stand(1.5).walk(12.0, 1.3).stop(1.0), cells=24).packets:
        t = packet.t + 5000.0 + (silence - back if packet.t > 6.0 else 0.0)
        if now and t - now > 1.0:
            report.take(None, session.advance(t - 0.1))
        now, packet = t, evolve(packet, t=t)
        report.take(packet, session.feed(packet))
    report.take(None, session.finish())
    return report


@pytest.mark.parametrize(("silence", "back", "lasts"), [(60.0, 0.0, 72.0), (0.0, 1000.0, 12.0), (0.0, 0.0, 12.0)])
def test_a_silence_and_a_clock_that_is_set_back_make_no_other_rate_and_no_longer_walk(
    silence: float, back: float, lasts: float
) -> None:
    report = report_after_silence(silence, back)
    for one in report.observer.links.values():
        assert one.rate == pytest.approx(100.0, abs=0.5)
    found = re.search(r"The recording lasts (?:(\d+) min )?(\d+) s[.;]", shown(report).text)
    assert found is not None
    assert 60.0 * float(found[1] or 0) + float(found[2]) == pytest.approx(lasts, abs=2.0)


def test_a_long_name_hides_nothing_else() -> None:
    names = [
        Connected(t=0.0, known_at=0.0, site=site, device="a", name=f"{site.value} {'W' * 240}", signal=None)
        for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)
    ]
    facts = shown(report_of(*names, *walk_events())).all("dl")[-1].text
    assert "left_foot WWW" in facts and "right_foot WWW" in facts and facts.count("motion and pressure") == 2


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


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="report.html"):
        Report("a walk").write(tmp_path / "no" / "report.html")


def test_a_screen_reader_finds_its_way() -> None:
    page = shown(report_of(*walk_events()))
    assert page.first("html").attributes["lang"] == "en"
    assert [one.text for one in page.all("h1")] == ["Gait report"]
    headings = {one.text for one in page.all("h2")}
    assert {"Figures", "Gait", "Where the wearer went", "Pressure", "Sensors and links"} <= headings
    ids = [one.attributes["id"] for one in page.all() if "id" in one.attributes]
    assert len(ids) == len(set(ids))
    named = [name for one in page.all() for name in one.attributes.get("aria-labelledby", "").split()]
    assert set(named) <= set(ids)
    for svg in page.all("svg"):
        assert svg.attributes["role"] == "img"
        assert svg.first("title").text and svg.first("desc").text
    for table in page.all("table"):
        assert table.first("caption").text
        assert {one.attributes["scope"] for one in table.all("th")} == {"row", "col"}


def test_there_is_a_figure_for_what_there_is() -> None:
    assert captions(shown(report_of(*walk_events()))) == [
        "Track from above", "Activities over time", "Mean gait cycle, walking", "Stride length over time",
        "Stride time over time", "Speed over time", "Mean load of a contact", "Peak load of a contact",
        "Mean force over a contact",
    ]  # fmt: skip


def test_there_is_a_sentence_for_what_there_is_not() -> None:
    page = shown(Report("nothing"))
    assert not page.all("svg") and not page.all("table")
    assert page.named("headline").text == "No data from either foot."
    assert [one.text for one in page.all("h2")] == ["How this report was made"]
    planned = shown(Report("nothing", BUILDING))
    assert "Where on the floor plan the wearer was is not known." in planned.text


def test_one_foot_alone_has_its_own_report() -> None:
    page = shown(report_of(*[event for event in left_foot_events() if not isinstance(event, WearerMoved)]))
    assert {"Mean gait cycle, walking", "Track from above", "Mean load of a contact"} <= set(captions(page))
    assert [one.text for one in page.named("gait").first("tr").all("th")] == ["parameter", "left", "CV %"]
    assert "measured at the left foot alone" in page.named("headline").text


def test_pressure_alone_has_times_and_no_track() -> None:
    only = of((GaitCycleMeasured, FootPressed, LayoutKnown), walk_events())
    lost = {"stride_length": None, "speed": None, "clearance": None, "turning_angle": None, "rise": None}
    events = [evolve(event, **lost) if isinstance(event, GaitCycleMeasured) else event for event in only]
    page = shown(report_of(*events))
    assert "Stride time over time" in captions(page) and "Stride length over time" not in captions(page)
    assert not {"Track from above", "Height of the feet over time"} & set(captions(page))
    assert "how far is not known" in page.text and page.named("headline").text.startswith("Walked for ")
    assert "stance, %" in rows_of(page)


def test_on_a_floor_plan_the_track_is_drawn_on_it() -> None:
    report, part, one = Report("indoors", office()), Particles(), Pedestrian(32, "0", (12.0, LOW))
    one.walk((24.0, LOW))
    part.set_out(Start("0", (12.0, LOW), -one.turned))
    for step in one.received:
        report.take(None, part.follow(OFFICE, step.events, step.here))
    page = shown(report)
    assert "Track on the floor plan" in captions(page)
    assert page.named("plan").all("polyline")
    assert "Levels where the wearer was not are left out." in page.text


@settings(max_examples=40, suppress_health_check=list(HealthCheck))
@given(events=st.lists(happenings.events(), max_size=10), seed=st.integers(0, 999), count=st.integers(0, 60))
def test_any_events_in_any_order_make_a_page_without_a_number_that_is_none(
    events: list[Event], seed: int, count: int
) -> None:
    report = Report("any", BUILDING)
    report.take(None, [*events, *Random(seed).sample(walk_events(), count), *events])
    for svg in shown(report).all("svg"):
        for one in svg.all():
            coordinates = {k: v for k, v in one.attributes.items() if k not in ("id", "class", "aria-labelledby")}
            assert not any(NO_NUMBER.search(value) for value in coordinates.values())


def test_memory_does_not_grow_with_the_time_walked() -> None:
    kinds = (GaitCycleMeasured, StrideTaken, WearerMoved)
    events = [event for kind in kinds for event in of(kind, left_foot_events())[-4:]]
    report, sizes = report_of(*walk_events()), []
    for k in range(1, 501):
        report.take(None, [evolve(event, t=event.t + 20.0 * k) for event in events])
        if k in (250, 500):
            sizes.append(len(repr(report)))
    assert report.strides[Foot.LEFT].count > 1500 and report.wearer_track.count > 2000
    assert sizes[1] < 1.3 * sizes[0]
