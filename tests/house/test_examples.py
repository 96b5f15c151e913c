"""Every program in examples/ runs as its first lines describe, and prints what they promise."""

import io
import runpy
from contextlib import redirect_stderr, redirect_stdout
from math import pi
from unittest.mock import patch

import pytest
from here import EXAMPLES
from recordings import recorded
from walks import insoles

from solepath.emulate import Radio, Route, Walker, emulate
from solepath.types import Foot

ROUTE = Route().stand(2.0).walk(6.0, speed=1.3).stop(1.5)


def run(name: str, *arguments: object) -> str:
    """Return the output of the program; it must end well and without warnings."""
    path = str(EXAMPLES / f"{name}.py")
    with (
        patch("sys.argv", [path, *map(str, arguments)]),
        redirect_stdout(io.StringIO()) as out,
        redirect_stderr(io.StringIO()) as err,
    ):
        runpy.run_path(path, run_name="__main__")
    assert err.getvalue() == ""
    return out.getvalue()


def test_the_loop_ends_where_an_emulated_route_ends():
    lines = run("own_loop").splitlines()
    assert {"HeelStrike", "FootFlat", "HeelOff", "ToeOff"} <= {line.split()[3] for line in lines if " known " in line}
    (end,) = [line.split() for line in lines if line.startswith("The route ends")]
    (stands,) = [line.split() for line in lines if line.startswith("The wearer stands")]
    assert float(stands[5]) == pytest.approx(float(end[5]), abs=0.5)
    assert float(stands[8]) == pytest.approx(float(end[9]), abs=0.5)


def test_the_loop_prints_the_strides_of_a_recording(tmp_path):
    walk = insoles(ROUTE, Radio(corrupt=0.02), seed=2)
    lines_out = run("own_loop", recorded(tmp_path / "walk.jsonl", walk.packets))
    for foot in Foot:
        assert lines_out.count(f"{foot.value:5}  stride ") == len(walk.truth.strides(foot))
    assert "a packet was not used: checksum" in lines_out


def test_each_right_heel_strike_rings_and_a_left_stance_that_gets_too_long(tmp_path):
    walk = insoles(Route().stand(2.0).walk(5.0, speed=1.3).walk(5.0, speed=0.7).stop(1.5))
    lines_out = run("feedback", recorded(tmp_path / "walk.jsonl", walk.packets)).splitlines()
    contacts = walk.truth.feet[Foot.RIGHT].heel_strikes
    assert len(contacts) - 2 <= sum("right  EveryHeelStrike" in line for line in lines_out) <= len(contacts)
    assert any("left   StanceLonger 0.7" in line for line in lines_out) and all(line[0] == "\a" for line in lines_out)


@pytest.mark.soak
def test_feedback_in_real_time_is_in_time():
    lines_out = run("feedback").splitlines()
    assert sum("EveryHeelStrike" in line for line in lines_out) > 4
    assert all(float(line.split()[-3]) <= 200.0 for line in lines_out)


def test_a_walk_that_was_saved_half_way_goes_on_as_if_nothing_had_happened():
    assert "the same as without the pause: True" in run("save_and_resume")


def test_the_tables_of_a_lab_become_strides_and_a_report(tmp_path):
    lines = run("researcher", tmp_path).splitlines()
    left, right = (
        sum(line.split()[:1] == [foot] and len(line.split()) == 6 for line in lines) for foot in ("left", "right")
    )
    walker = Walker(Route().stand(3).walk(12, speed=1.3).turn(pi, radius=1).walk(12).stop(2))
    assert (left, right) == tuple(len(walker.truth().strides(foot)) for foot in Foot)
    assert "left foot took" in (tmp_path / "report.html").read_text()
    (tmp_path / "left.csv").write_text("Zeit;AX;AY;AZ\n0;0;0;1\n10;0;0;1\n")
    with pytest.raises(SystemExit) as stopped:
        run("researcher", tmp_path, tmp_path / "left.csv")
    assert all([name in str(stopped.value) for name in ("Time_ms", "GX", "GY", "GZ")])


@pytest.mark.long
def test_a_fleet_that_is_killed_twice_has_every_event_once(tmp_path):
    lines = run("fleet", tmp_path / "fleet").splitlines()
    assert [line.split()[0] for line in lines[:3]] == ["killed", "killed", "finished"]
    truth = emulate(Route().stand(1).walk(4).stop(1), seed=1).truth
    strides = sum(len(truth.strides(foot)) for foot in Foot)
    assert lines[3:] == [f"w-{number:02}: {strides} strides" for number in range(10)]


@pytest.mark.soak
def test_two_recipes_on_one_walk_are_set_beside_the_truth():
    title, *rows = run("compare_detectors").splitlines()
    assert title.split()[:2] == ["recipe", "foot"] and len(rows) == 4
    for row in rows:
        found, true, length_error, _ = row.split()[-4:]
        assert found == true and float(length_error) < 5.0


def test_a_device_of_ones_own_is_one_file_and_its_vectors():
    first, *lines_out = run("own_device").splitlines()
    assert first == "the vectors agree"
    true = len(Walker(Route().stand(2).walk(8).stop(2)).truth().strides(Foot.LEFT))
    assert sum(" stride " in line for line in lines_out) == true
    assert sum("3 samples missing" in line for line in lines_out) == 1
    assert sum("with a gap in it" in line for line in lines_out) == 1


def test_a_suit_that_sends_over_udp_says_where_each_foot_comes_down():
    """Eight steps of 6 m and the last one beside it, through a true socket."""
    *lines_out, last = run("suit_over_udp").splitlines()
    assert last == "7 sensors sent"
    places = [float(line.split()[5]) for line in lines_out if " comes down at x " in line]
    assert len(places) == len(lines_out) and places == sorted(places)
    assert places[-1] == pytest.approx(6.0, abs=0.3)
    assert [line.split()[0] for line in lines_out[:4]] in (["left", "right"] * 2, ["right", "left"] * 2)


def test_two_insoles_give_the_way_of_both_feet():
    lines = run("two_insoles").splitlines()
    assert [line.split()[0] for line in lines[:2]] == ["left", "right"]
    assert all("96 cells" in line for line in lines[:2])
    assert float(lines[-1].split()[0]) == pytest.approx(20.0, abs=0.4)
    assert any(line.split()[3] != line.split()[6] for line in lines[2:-1]), "no stride was calibrated by the other foot"


@pytest.mark.soak
def test_in_a_building_walls_leave_one_place_of_many():
    lines_out = run("indoors").splitlines()
    possible = [int(line.split()[2]) for line in lines_out if " possible place" in line]
    assert possible == sorted(possible, reverse=True) and possible[0] > possible[-1] == 1
    did = [line.split()[2] for line in lines_out if line.split()[1:2] == ["s"] and line.split()[2].isupper()]
    assert did[:2] == ["STANDING", "ELEVATOR_DOWN"] and "WALKING" in did and "ELEVATOR_UP" in did
    assert float(lines_out[-1].split()[-4]) < 3.0


@pytest.mark.soak
def test_an_app_of_a_thread_and_a_queue_loses_nothing_unsaid_and_ends():
    lines_out = run("thread_and_queue").splitlines()
    for foot in Foot:
        strides = [line for line in lines_out if f" {foot.value} stride of " in line]
        assert len(strides) >= 7, "a walk of 16 m, in spite of it all"
        assert any(f"{foot.value}_foot: StreamStale" in line for line in lines_out)
        assert any(f"{foot.value}_foot: StreamResumed" in line for line in lines_out)
    dropped = [int(line.split()[-1]) for line in lines_out if "PacketsDropped" in line]
    assert sum(dropped) >= 20
