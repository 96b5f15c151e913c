"""Every program in examples/ runs as its first lines describe, and prints what they promise."""

import ast
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from here import EXAMPLES, TESTS
from recordings import recorded

from solepath.emulate import Radio, Route, Walker, emulate
from solepath.types import Foot

APPS = ("edge_box", "thread_and_queue")
"""Whole apps; the others are short programs."""
ROUTE = Route().stand(2.0).walk(6.0, speed=1.3).stop(1.5)


def run(name: str, *arguments: object) -> str:
    """Return the output of the program; it must end well and without warnings."""
    command = [sys.executable, EXAMPLES / f"{name}.py", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_every_example_is_run_here_and_is_short():
    others = ("fleet/test_spark_job.py", "life/test_edge_box.py")
    here = "".join(path.read_text() for path in (Path(__file__), *map(TESTS.joinpath, others)))
    for path in EXAMPLES.glob("*.py"):
        assert f'run("{path.stem}"' in here or f'EXAMPLES / "{path.name}"' in here, path.name
        assert len(path.read_text().splitlines()) < (150 if path.stem in APPS else 80), path.name
        docstring = ast.get_docstring(ast.parse(path.read_text())) or ""
        assert docstring and f"{path.name}" in docstring, "what it shows, and how it is run"


def test_an_emulated_walk_ends_where_its_route_ends():
    lines = run("emulated_walk").splitlines()
    assert {"HeelStrike", "FootFlat", "HeelOff", "ToeOff"} <= {line.split()[3] for line in lines if " known " in line}
    (ends,) = [line.split() for line in lines if line.startswith("The route ends")]
    (session_line,) = [line.split() for line in lines if line.startswith("The session says")]
    assert float(session_line[4]) == pytest.approx(float(ends[5]), abs=0.5)
    assert float(session_line[7]) == pytest.approx(float(ends[9]), abs=0.5)


def test_emulated_insoles_are_received_over_bluetooth():
    lines_out = run("bluetooth").splitlines()
    assert {"left_foot: connected to solepath L", "right_foot: connected to solepath R"} <= set(lines_out)
    strides = [line for line in lines_out if " stride of " in line]
    assert {line.split()[0] for line in strides} == {"left", "right"}
    assert sum(float(line.split()[3]) for line in strides) == pytest.approx(8.0, rel=0.05)  # 4 m with each foot


def test_the_loop_prints_the_strides_of_a_recording(tmp_path):
    walk = emulate(ROUTE, radio=Radio(corrupt=0.02), seed=2)
    lines_out = run("own_loop", recorded(tmp_path / "walk.jsonl", walk.packets))
    for foot in Foot:
        assert lines_out.count(f"{foot.value} stride of") == len(walk.truth.strides(foot))
    assert "a packet was not used: checksum" in lines_out


def test_a_walk_that_was_saved_half_way_goes_on_as_if_nothing_had_happened():
    assert "the same as without the pause: True" in run("save_and_resume")


def test_samples_of_ones_own_give_strides(tmp_path):
    assert "stride 9" in run("own_samples")
    samples = Walker(ROUTE).samples(Foot.RIGHT, 100.0)
    rows = [(sample.t, *(sample.acc or ()), *(sample.gyro or ())) for sample in samples]
    header = "t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z"
    np.savetxt(tmp_path / "walk.csv", rows, delimiter=",", header=header, comments="")
    true = len(Walker(ROUTE).truth().strides(Foot.RIGHT))
    assert run("own_samples", tmp_path / "walk.csv").count(" stride ") == true


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
    assert sum("3 packets lost" in line for line in lines_out) == 1
    assert sum("with a gap in it" in line for line in lines_out) == 1
    assert "battery 87%" in lines_out[0]


def test_two_insoles_give_the_way_of_both_feet():
    lines = run("two_insoles").splitlines()
    assert [line.split()[0] for line in lines[:2]] == ["left", "right"]
    assert all("96 cells" in line for line in lines[:2])
    assert float(lines[-1].split()[0]) == pytest.approx(20.0, abs=0.4)
    assert any(line.split()[3] != line.split()[6] for line in lines[2:-1]), "no stride was calibrated by the other foot"


def test_in_a_building_walls_leave_one_place_of_many():
    lines_out = run("indoors").splitlines()
    possible = [int(line.split()[2]) for line in lines_out if " possible place" in line]
    assert possible == sorted(possible, reverse=True) and possible[0] > possible[-1] == 1
    did = [line.split()[2] for line in lines_out if line.split()[1:2] == ["s"] and line.split()[2].isupper()]
    assert did[:2] == ["STANDING", "ELEVATOR_DOWN"] and "WALKING" in did and "ELEVATOR_UP" in did
    assert float(lines_out[-1].split()[-4]) < 3.0


def test_an_app_of_a_thread_and_a_queue_loses_nothing_unsaid_and_ends():
    lines_out = run("thread_and_queue").splitlines()
    for foot in Foot:
        strides = [line for line in lines_out if f" {foot.value} stride of " in line]
        assert len(strides) >= 7 and "with a gap" not in strides[0], "a walk of 16 m, in spite of it all"
        assert any(f"{foot.value}_foot: nothing comes" in line for line in lines_out)
        assert any(f"{foot.value}_foot: samples again" in line for line in lines_out)
    dropped = [int(line.split()[3]) for line in lines_out if "packets dropped, the screen was too slow" in line]
    assert 100 <= sum(dropped) <= 140, "1.6 s in which 200 packets a second come, and 200 of them can wait"
    assert sum("paused" in line for line in lines_out) == 1
    assert lines_out[-1].endswith("closed")


def test_an_app_of_a_thread_and_a_queue_plays_a_recording(tmp_path):
    walk = recorded(tmp_path / "walk.jsonl", emulate(ROUTE, seed=2).packets)
    lines_out = run("thread_and_queue", walk, "inf")
    assert "left stride of" in lines_out and "right stride of" in lines_out
