"""The README is true: its program runs, its results are printed ones, and the pages behind it leave nothing out."""

import re
from pathlib import Path
from typing import get_args

import figures
import pytest
from commands import run
from quoted import NUMBER, PAGES, below, run_page
from recordings import recorded
from walks import insoles

from solepath import Event
from solepath.emulate import Radio, Route
from solepath.recipes import NAMES
from solepath.types import Foot


def first_cells(table: list[str]) -> list[str]:
    return [line.split("|")[1].strip() for line in table[2:]]


def test_its_loop_gets_every_stride_of_a_walk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    walk = insoles(Route().stand(2).walk(6, speed=1.3).stop(2), Radio(corrupt=0.02))
    recorded(Path("walk.jsonl"), walk.packets)
    (out,), _ = run_page("README.md")
    for foot in Foot:
        assert out.count(f"{foot.value} stride of") == len(walk.truth.strides(foot))
        assert f"s: {foot.value} heel-strike" in out
    assert "a packet was not used: checksum" in out


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
    shown, given = below("demo"), figures.compared(run("demo").stdout).splitlines()
    # figures may move a little from one release to the next; what is counted and what is measured may not
    assert [NUMBER.sub("#", " ".join(line.split())) for line in shown] == [
        NUMBER.sub("#", " ".join(line.split())) for line in given
    ]
    counted = [line for line in shown if line.startswith("strides ")]
    assert len(counted) == 3 and counted == [line for line in given if line.startswith("strides ")]


def test_its_results_are_those_of_the_long_tables():
    """How long things take is not tested; that the pages say the same twice is."""
    short = figures.in_short(below("accuracy"))
    assert below("results") == figures.headlines(short, "\n".join(below("speed")))


@pytest.mark.parametrize(
    ("mark", "ends"),
    [("try", ["'.[demo]'", "solepath demo"]), ("test", ["pytest -n auto --dist loadfile --no-loadscope-reorder"])],
)
def test_nothing_but_python_is_needed_to_try_and_to_test_it(mark, ends):
    lines = below(mark)
    assert lines[0].startswith("python3 -m venv .venv && .venv/bin/pip install ")
    for line, end in zip(lines, ends, strict=True):
        assert line.endswith(end) and ".venv/bin/" in line
