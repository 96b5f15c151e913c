"""Tests the commands as a person or a script runs them: in processes of their own, with their output piped."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from commands import no_control_codes, rows_in, run
from programs import TAKES, drawn, in_terminal
from soak import soaked

from solepath.types.extras import install_hint


def test_help_names_every_command_and_loads_nothing_heavy():
    code = (
        "import sys\nfrom solepath.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit as stop: status = stop.code\n"
        "print(status, sorted({'numpy', 'rich', 'asyncio', 'bleak'} & set(sys.modules)))"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    *text, last = result.stdout.splitlines()
    assert last == "0 []"
    assert all(any(line.split()[:1] == [command] for line in text) for command in ("demo", "track", "check"))


def test_no_command_prints_the_help_and_version_prints_the_version():
    assert "COMMAND" in run().stdout
    assert run("--version").stdout.startswith("solepath 0.")


WITHOUT_NUMPY = "import sys; sys.modules['numpy'] = None; from {} import main; sys.exit(main(sys.argv[1:]))"


def without_numpy(*arguments: object, program: str = "solepath.cli") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", WITHOUT_NUMPY.format(program), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_packets_need_no_numpy_and_the_commands_that_do_give_the_line_that_installs_it(demo, folder):
    done = without_numpy("track", folder / "demo.jsonl", "--out", folder / "bare", "--report", folder / "bare.html")
    assert done.returncode == 0 and "strides" in done.stdout and (folder / "bare.html").exists(), done.stderr
    for arguments in (["demo"], ["track", folder / "walk.npz"]):
        done = without_numpy(*arguments)
        assert (done.returncode, done.stderr) == (2, f"solepath: this needs numpy: {install_hint('arrays')}\n")


def test_the_laboratory_says_its_version_and_its_commands_without_numpy_and_else_what_installs_it():
    done = without_numpy("--version", program="solepath_lab.command")
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("solepath-lab 0.")
    for arguments, named in ((["--help"], "evaluate"), (["emulated", "--help"], "evidence")):
        done = without_numpy(*arguments, program="solepath_lab.command")
        assert (done.returncode, done.stderr) == (0, "") and named in done.stdout
    for arguments in (["evaluate", "--emulated"], ["emulated", "runs", "--help"], ["train", "turns"]):
        done = without_numpy(*arguments, program="solepath_lab.command")
        assert (done.returncode, done.stderr) == (2, f"solepath: this needs numpy: {install_hint('arrays')}\n")


@pytest.fixture(scope="module")
def demo(folder: Path) -> subprocess.CompletedProcess[str]:
    return run("demo", "--seed", "5", "--distance", "15", "--record", folder / "demo.jsonl")


def test_the_demo_ends_with_a_table_against_the_truth_in_plain_text(demo):
    assert demo.returncode == 0 and demo.stderr == ""
    assert no_control_codes(demo.stdout)
    table = {line[:30].strip(): line[30:].split() for line in demo.stdout.splitlines()[-15:]}
    assert table["strides found"] == table["strides walked"]
    assert table["strides invented"] == ["0", "0"]
    assert all(float(error) < 5.0 for error in table["stride length, mean error %"])


PAPERS = ("kupt-dfpc", "pressure-contour", "walking-modes", "footstep-tracker", "shoe-sensing")


@pytest.mark.parametrize(
    "recipe", ["walking-modes", *soaked(*PAPERS[:2], *PAPERS[3:], *[f"{one}-printed" for one in PAPERS])]
)
def test_the_demo_of_a_paper_ends_with_what_the_paper_reports_beside_it(recipe):
    done = run("demo", "--recipe", recipe, "--distance", "8")
    assert done.returncode == 0 and done.stderr == "" and no_control_codes(done.stdout)
    sensors = {"walking-modes": "seven sensors", "footstep-tracker": "a SensorTag"}
    assert sensors.get(recipe.removesuffix("-printed"), "an insole") in done.stdout.splitlines()[0]
    (row,) = [line for line in done.stdout.splitlines() if line.startswith("end of the wearer's track, error")]
    assert " m, " in row and row.count("%") + row.count("20 m") >= 2, "ours, and the paper's"


def test_the_recording_of_the_demo_gives_track_the_same_steps(demo, folder):
    result = run("track", folder / "demo.jsonl", "--out", folder / "demo")
    assert result.returncode == 0 and result.stderr == ""
    found = next(line for line in demo.stdout.splitlines() if line.startswith("strides found")).split()[2:]
    feet = [row["foot"] for row in rows_in(folder / "demo" / "strides.csv")]
    assert [str(feet.count("left")), str(feet.count("right"))] == found


@pytest.mark.soak
def test_in_a_terminal_the_demo_is_drawn_as_it_goes_and_ends_with_the_same_table():
    pytest.importorskip("rich")
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "100", "LINES": "60"}
    with in_terminal("demo", "--terminal", "--speed", "200", env=environment) as (terminal, process):
        pictures, table = drawn(terminal).split("against the truth")
        assert process.wait(TAKES) == 0
    assert pictures.count("200 times real time") > 1 and "\x1b[" in pictures
    assert "strides invented" in table
