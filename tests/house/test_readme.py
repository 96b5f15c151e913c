"""The README is true: its program runs, its results are printed ones, and the pages behind it leave nothing out."""

import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import get_args

import figures
import pytest
from commands import solepath
from here import ROOT
from quoted import NUMBER, PAGES, README, below, blocks, run_page
from recordings import recorded

from solepath import Event
from solepath.emulate import Radio, Route, emulate
from solepath.recipes import NAMES
from solepath.types import Foot


def first_cells(table: list[str]) -> list[str]:
    return [line.split("|")[1].strip() for line in table[2:]]


@cache
def demonstration() -> str:
    return solepath("demo").stdout


def test_it_is_short():
    assert len(README.splitlines()) < 120


def test_its_loop_gets_every_stride_of_a_walk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    walk = emulate(Route().stand(2).walk(6, speed=1.3).stop(2), radio=Radio(corrupt=0.02), seed=1)
    recorded(Path("walk.jsonl"), walk.packets)
    (out,), _ = run_page("README.md")
    for foot in Foot:
        assert out.count(f"{foot.value} stride of") == len(walk.truth.strides(foot))
        assert f"s: {foot.value} heel-strike" in out
    assert "a packet was not used: checksum" in out


def test_the_loop_has_twelve_lines():
    (program,) = blocks(README, "python")
    assert len([line for line in program.splitlines() if line.strip()]) == 12


def test_the_table_of_events_names_them_all():
    assert sorted(first_cells(below("events"))) == sorted(f"`{event.__name__}`" for event in get_args(Event))


def test_the_table_of_recipes_names_them_all():
    table = PAGES["docs/recipes.md"].split("| recipe | what it is |", 1)[1].split("\n\n", 1)[0]
    names = [name for line in table.splitlines()[2:] for name in re.findall(r"`([\w-]+)`", line.split("|")[1])]
    assert names == list(NAMES)


def test_the_index_of_the_docs_names_every_page():
    index = PAGES["docs/start.md"].split("\n## All pages\n", 1)[1]
    named = re.findall(r"\]\((\w[\w-]*\.md)\)", index)
    assert sorted([*named, "start.md"]) == sorted(page.removeprefix("docs/") for page in PAGES if page != "README.md")


def test_the_demonstration_is_the_one_that_the_command_gives():
    shown, given = below("demo"), figures.compared(demonstration()).splitlines()
    # figures may move a little from one release to the next; what is counted and what is measured may not
    assert [NUMBER.sub("#", " ".join(line.split())) for line in shown] == [
        NUMBER.sub("#", " ".join(line.split())) for line in given
    ]
    counted = [line for line in shown if line.startswith("strides ")]
    assert len(counted) == 3 and counted == [line for line in given if line.startswith("strides ")]


def short() -> list[figures.Row]:
    return figures.in_short(*(below(mark) for mark in ("accuracy", "activities", "emulated")))


def test_tables_that_share_figures_agree():
    known: dict[tuple[str, str], str] = {}
    for mark in ("accuracy", "activities", "insoles"):  # the first column of each is the recipe `default`
        data = ""
        for line in below(mark)[2:]:
            first, measure, result = (cell.strip() for cell in line.split("|")[1:4])
            data = first or data
            assert known.setdefault((data, measure), result) == result, f"{mark}: {data}, {measure}"


def test_the_short_table_of_accuracy_is_the_long_ones_in_short():
    assert below("figures") == figures.lines("data", short())


def test_its_results_are_those_of_the_long_tables():
    """How long things take is not tested; that the pages say the same twice is."""
    assert below("results") == figures.headlines(short(), "\n".join(below("speed")))


@pytest.mark.parametrize("name", figures.EXPERIMENTS)
def test_the_output_of_an_experiment_has_its_place_in_the_docs(name):
    assert below(name)[0].startswith(f"{name}: ours is emulated (")


def test_the_quick_tests_are_all_there():
    command = [sys.executable, "-m", "pytest", "--collect-only", "@tests/quick.txt"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("mark", "ends"),
    [("try", ["'.[demo]'", "solepath demo"]), ("test", ["pytest -n auto --dist loadfile --no-loadscope-reorder"])],
)
def test_nothing_but_python_is_needed_to_try_and_to_test_it(mark, ends):
    lines = below(mark)
    assert lines[0].startswith("python3 -m venv .venv && .venv/bin/pip install ")
    for line, end in zip(lines, ends, strict=True):
        assert line.endswith(end) and ".venv/bin/" in line
