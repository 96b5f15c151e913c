"""The picture of a plan whatever its names are, where it cannot be written, and starts that cannot be."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
from attrs import evolve
from commands import run
from floorplans import FILES
from hypothesis import given
from hypothesis import strategies as st
from recordings import recorded
from walks import insoles

from solepath.floorplan.findings import find_findings
from solepath.floorplan.plan import Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, PlanFinding, Wall
from solepath.show.tables.plan import PlanPicture

any_text = st.text(st.characters(), min_size=1, max_size=12) | st.sampled_from(
    ["\x00", "\x08lift", "\ud800", "a\udfff", "\ufffe\uffff", "]]>", "<b>&amp;", "\x1b[31m", "\x85\u2028\r\n"]
)


def named(level: str, lift: str) -> FloorPlan:
    walls = (Wall((0.0, 0.0), (20.0, 0.0)), Wall((20.0, 0.0), (20.0, 10.0)))
    one = Connector(ConnectorKind.LIFT, lift, (ConnectorStop(level, (5.0, 5.0)),))
    return FloorPlan(level, (Level(level, lift, 0, 0.0, walls),), (one,))


@given(any_text, any_text, any_text)
def test_a_picture_is_xml_whatever_levels_lifts_and_recordings_are_called(level: str, lift: str, title: str) -> None:
    svg = ElementTree.tostring(PlanPicture(named(level, lift)).drawn(title), encoding="utf-8")
    assert ElementTree.fromstring(svg).tag == "{http://www.w3.org/2000/svg}svg"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_is_reported_with_the_name_of_the_picture() -> None:
    with pytest.raises(OSError, match="/dev/full"):
        PlanPicture(named("0", "lift")).write(Path("/dev/full"), "walk")


def test_a_picture_that_cannot_be_written_is_reported_before_the_walk_is_computed(tmp_path: Path) -> None:
    walk = recorded(tmp_path / "walk.jsonl", insoles().packets[:400])
    (tmp_path / "out" / "plan.svg").mkdir(parents=True)
    plan = FILES / "house.geojson"
    done = run("track", walk, "--floorplan", plan, "--out", tmp_path / "out")
    assert done.returncode == 2 and done.stdout == "" and "plan.svg" in done.stderr.splitlines()[-1]
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["plan.svg"], "nothing was written"


def offices(count: int, name: str = "office", *, corner: tuple[float, float] = (0.0, 0.0)) -> FloorPlan:
    """Rooms in a row, 3 m wide, each with two doors of 1 m and a lift in it."""
    (x0, y0), doors, rooms, lifts = corner, list[Door](), list[tuple[tuple[float, float], ...]](), list[Connector]()
    for k in range(count):
        x = x0 + 3.0 * k
        doors += [Door((x + 0.2, y), (x + 1.2, y)) for y in (y0, y0 + 4.0)]
        rooms.append(((x, y0), (x + 3.0, y0), (x + 3.0, y0 + 4.0), (x, y0 + 4.0)))
        stops = (ConnectorStop("0", (x + 1.5, y0 + 2.5)),)
        lifts.append(Connector(ConnectorKind.LIFT, f"lift {k}", stops))
    names = tuple([f"{name} {k}" for k in range(count)])
    wall = Wall((x0, y0), (x0 + 3.0 * count, y0))
    return FloorPlan("", (Level("0", "", 0, 0.0, (wall,), tuple(doors), tuple(rooms), names),), tuple(lifts))


def drawn(plan: FloorPlan, *findings: PlanFinding) -> ElementTree.Element:
    return PlanPicture(plan, columns=1, ids=True, findings=findings).drawn("plan")


def texts(svg: ElementTree.Element, kind: str) -> list[tuple[float, float, str]]:
    """Return the places, px, of the texts of this class, and the texts."""
    return [(float(one.get("x", "")), float(one.get("y", "")), one.text or "")
            for one in svg.iter("text") if one.get("class", "").startswith(kind)]  # fmt: skip


@pytest.mark.parametrize("name", ["office", "Verwaltungsfachangestellte", "w" * 300, "\u4f1a\u8b70\u5ba4" * 4])
@pytest.mark.parametrize("count", [1, 12, 80])
def test_no_id_is_over_another_one_and_those_without_room_are_told_to_who_points_at_them(count: int, name: str) -> None:
    svg = drawn(offices(count, name))
    ids = texts(svg, "id")
    assert max([len(text) for *_, text in ids]) <= 28
    for k, (x, y, text) in enumerate(ids):
        wide = 1 + any(ord(letter) > 0x2E80 for letter in text)
        for x2, y2, other in ids[:k]:
            half = 0.5 * 5.0 * wide * min(len(text), 28) + 0.5 * 5.0 * (1 + (other[0] > "\u2e80")) * len(other)
            assert abs(x - x2) >= half or abs(y - y2) >= 11.0, (text, other)
    pointed = [one for one in svg.iter("circle") if one.find("title") is not None and one.get("r") == "1.6"]
    assert len(ids) + len(pointed) == 4 * count, "nothing is lost"
    assert ("id on hover" in [one.text for one in svg.iter("text")]) == bool(pointed)


def test_a_drawing_grows_with_the_plan_so_that_ids_of_the_same_rooms_stay_readable() -> None:
    small, large = [float(drawn(offices(count)).get("width", "")) for count in (20, 80)]
    assert 3.0 < large / small < 4.5
    assert len(texts(drawn(offices(80)), "id room")) == 80


@pytest.mark.parametrize("columns", [1, 3])
def test_names_of_plans_and_levels_stay_within_their_panels(columns: int) -> None:
    level = evolve(offices(2).levels[0], name="W" * 300)
    plan = evolve(offices(2), levels=tuple([evolve(level, id=f"{k}") for k in range(3)]), connectors=())
    svg = PlanPicture(plan, width=240.0, columns=columns).drawn("M" * 300)
    for one in svg.iter("text"):
        size, letters = float(one.get("font-size", "12")), len(one.text or "")
        if size >= 13.0:
            assert 0.55 * size * letters < float(svg.get("width", "")) / (columns if size < 17.0 else 1)


@pytest.mark.parametrize("corner", [(0.0, 0.0), (691_000.0, 5_333_000.0), (-123_456.0, -1e6)])
def test_the_numbers_of_the_grid_are_whole_wherever_the_plan_lies(corner: tuple[float, float]) -> None:
    svg = drawn(offices(4, corner=corner))
    for one in svg.iter("text"):
        if one.get("class") == "tick" and one.get("text-anchor") == "end":
            assert float(one.get("x", "")) - 5.5 * len(one.text or "") >= 0.0, one.text


def test_the_legend_has_what_is_drawn_and_wrong_only_where_something_is() -> None:
    whole = offices(3)
    words = [one.text for one in drawn(whole, *find_findings(whole)).iter("text")]
    assert {"wall", "door", "lift", "grid: x and y, m"} <= set(words) and "wrong" in words
    words = [one.text for one in drawn(whole).iter("text")]
    assert "wrong" not in words and "stairs" not in words
