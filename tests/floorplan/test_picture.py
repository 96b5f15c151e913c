"""The picture of a plan whatever its names are, where it cannot be written, and starts that cannot be."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
from commands import run
from floorplans import FILES
from hypothesis import given
from hypothesis import strategies as st
from recordings import recorded
from walks import insoles

from solepath.floorplan.plan import Connector, ConnectorKind, ConnectorStop, FloorPlan, Level, Wall
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
