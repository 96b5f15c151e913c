"""The README is true: its programs run, its tables name what there is, its figures are what the commands print."""

import io
import re
import shutil
import subprocess
import sys
from argparse import ArgumentParser
from contextlib import redirect_stdout
from importlib import import_module
from typing import get_args

import pytest

import figures
from quoted import NUMBER, README, ROOT, below, in_short, nearly_the_same
from solepath import Event, LiftRidden
from solepath.body.altitude import Altitude
from solepath.cli.main import parser
from solepath.foot.pressure import Insole
from solepath.foot.tracker import AnyCorrector, AnyCues, AnyDetector
from solepath.output import STEP_COLUMNS, TRACK_COLUMNS
from solepath.recipes import BY_NAME, AnyActivity, AnyBody, AnyPlace
from solepath.recording import PacketWriter
from solepath.sim import Radio, Route, emulate
from solepath.types import Foot

PROGRAMS = re.findall(r"^```python\n(.*?)^```", README, re.DOTALL | re.MULTILINE)


def first_cells(table: list[str]) -> list[str]:
    return [line.split("|")[1].strip() for line in table[2:]]


def test_its_programs_run_one_after_the_other_and_say_what_they_promise(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "examples", "examples")
    walk = emulate(Route().stand(2).walk(6, speed=1.3).stop(2), radio=Radio(corrupt=0.02), seed=1)
    with PacketWriter("walk.jsonl") as writer:
        for packet in walk.packets:
            writer.write(packet)
    names: dict = {"__name__": "readme"}
    printed = []
    for program in PROGRAMS:
        with redirect_stdout(io.StringIO()) as out:
            exec(compile(program, "README.md", "exec"), names)
        printed.append(out.getvalue())
    loop, _, _, saved, *_ = printed
    for foot in Foot:
        assert loop.count(f"{foot.value} step of") == len(walk.truth.steps(foot))
        assert f"s: {foot.value} heel-strike" in loop
    assert "a packet was not used: checksum" in loop
    assert saved.startswith("Position(t=")
    with redirect_stdout(io.StringIO()) as out:
        names["notified"](bytearray())
        names["every_second"]()
    assert out.getvalue().startswith("PacketRejected(")
    with redirect_stdout(io.StringIO()) as out:
        names["did"](LiftRidden(t=9.0, known_at=9.5, t_start=2.0, up=False, height=-3.0))
    assert out.getvalue() == "down -3.0\n"
    names["indoors"].feed(walk.packets)
    assert names["indoors"].place.level == "0"
    # the detector of its own is a detector indeed
    steps = [event for event in names["session"].feed(walk.packets) if type(event).__name__ == "StepTaken"]
    assert len(steps) == sum(len(walk.truth.steps(foot)) for foot in Foot)
    with pytest.raises(TypeError, match="a snapshot cannot hold a Slow where Cycle or Shoe"):
        names["session"].snapshot()


def test_the_loop_has_twelve_lines():
    assert len([line for line in PROGRAMS[0].splitlines() if line.strip()]) == 12


def test_its_table_names_every_event():
    assert sorted(first_cells(below("events"))) == sorted(f"`{event.__name__}`" for event in get_args(Event))


def test_its_line_for_the_phases_prints_both_tables():
    (program,) = re.findall(r'^python -c "(.*)"$', README, re.MULTILINE)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    rows = [line.split() for line in done.stdout.splitlines()]
    assert ["SWING", "LOADING", "STATIONARY", "SWING", "SWING"] in rows
    assert ["SWING", "RIGHT", "RIGHT", "RIGHT", "FLIGHT"] in rows


def test_its_links_lead_somewhere():
    titles = re.findall(r"^#+ (.+)$", README, re.MULTILINE)
    anchors = {"#" + re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}
    for target in re.findall(r"\]\(([^)]+)\)", README):
        path, _, _ = target.partition("#")
        assert target in anchors if target.startswith("#") else (ROOT / path).exists(), target


def test_commands_and_options_are_those_of_the_command_line():
    table = README.split("| command | what it does |\n", 1)[1].split("\n\n", 1)[0]
    (subparsers,) = (a for a in parser()._actions if isinstance(a.choices, dict))
    told = {re.split(r"[ `]", line)[3]: set(re.findall(r"--[a-z]+", line)) for line in table.splitlines()[1:]}
    assert told.keys() == subparsers.choices.keys()
    for name, options in told.items():
        command: ArgumentParser = subparsers.choices[name]
        assert options <= command._option_string_actions.keys()


def test_columns_parts_and_recipes_are_those_of_the_library():
    assert f"`{','.join(TRACK_COLUMNS)}`" in README
    assert f"`{','.join(STEP_COLUMNS)}`" in README
    parts = re.findall(r"^\| (`[A-Z].*?) \| `(solepath[\w.]+)` \|", README, re.MULTILINE)
    told = {getattr(import_module(module), name) for names, module in parts for name in re.findall(r"`(\w+)`", names)}
    kinds = (AnyDetector, AnyCorrector, AnyCues, AnyBody, AnyActivity, AnyPlace)
    assert told == {Insole, Altitude, *(part for kind in kinds for part in get_args(kind))}
    table = README.split("| recipe | what it is |", 1)[1].split("\n\n", 1)[0]
    names = [name for line in table.splitlines()[2:] for name in re.findall(r"`([\w-]+)`", line.split("|")[1])]
    assert names == list(BY_NAME)


def test_its_demonstration_is_the_one_that_the_command_gives():
    done = subprocess.run(
        [sys.executable, "-m", "solepath", "demo"], capture_output=True, stdin=subprocess.DEVNULL, text=True, check=True
    )
    # figures may move a little from one release to the next; what is counted and what is measured may not
    shown, given = (
        [NUMBER.sub("#", " ".join(line.split())) for line in lines if re.match(r"[^ .].*[a-z]", line)]
        for lines in (below("demo"), done.stdout.splitlines())
    )
    assert shown == given
    counted = [line for line in below("demo") if line.startswith("steps ")]
    assert counted == [line for line in done.stdout.splitlines() if line.startswith("steps ")]


def test_its_short_table_quotes_the_demonstration_of_100_m():
    done = subprocess.run(
        [sys.executable, "-m", "solepath", *figures.LONG_DEMO],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        text=True,
        check=True,
    )
    fresh = figures.lines(figures.walked(done.stdout))[2:]
    *quoted, end = in_short("solepath demo")
    nearly_the_same(quoted, fresh[:-1])
    # rounding that differs from one machine to the next is turned into heading, and 100 m makes metres of it
    assert NUMBER.sub("#", end) == NUMBER.sub("#", fresh[-1])


def test_its_short_table_quotes_the_benchmark_below():
    """How long things take is not tested; that the README says the same twice is."""
    assert in_short("python") == figures.lines(figures.measured("\n".join(below("speed"))))[2:]


def test_it_tells_what_bluetooth_adds_on_both_tiers():
    """The figures are those of some machine; that there are any is tested."""
    told = "\n".join(below("bluetooth"))
    assert re.search(r"the adapter's own +\d+\.\d us", told)
    for tier in ("memory", "bumble"):
        assert re.search(rf"{tier}: from notification to event +median +\d+\.\d+ ms, p99 +\d+\.\d+ ms", told)


def test_its_short_table_has_no_other_rows():
    table = below("figures")
    commands = ("solepath evaluate", "solepath demo", "python")
    assert table == [*figures.HEADER, *(line for command in commands for line in in_short(command))]
    assert [len(in_short(command)) for command in commands] == [5, 4, 4]


@pytest.mark.parametrize(
    ("mark", "ends"), [("try", "solepath demo"), ("test", "pytest -n auto --dist loadfile --no-loadscope-reorder")]
)
def test_each_of_its_two_lines_is_one_line(mark, ends):
    (line,) = below(mark)
    assert line.startswith("python3 -m venv .venv && ") and line.endswith(ends)
