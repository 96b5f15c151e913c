"""The programs of docs/architecture.md run unchanged and do what the page describes."""

from __future__ import annotations

import io
from contextlib import redirect_stdout
from functools import cache

import pytest
from here import DOCS
from quoted import blocks

from solepath.emulate import Route, Walker, emulate
from solepath.types import Foot

PAGE = (DOCS / "architecture.md").read_text()
DETECTOR, CORRECTOR, CUES, PART, RECIPE = range(5)


@cache
def output(which: int) -> list[str]:
    """Return the output of a program of the page."""
    program = compile(blocks(PAGE, "python")[which], "docs/architecture.md", "exec")
    with redirect_stdout(io.StringIO()) as out:
        exec(program, {"__name__": "extending"})
    return out.getvalue().splitlines()


def steps(metres: float) -> int:
    return len(Walker(Route().stand(2).walk(metres).stop(2)).truth().strides(Foot.LEFT))


def test_a_detector_of_ones_own_keeps_its_promises_and_is_restored_with_the_session() -> None:
    first, last = output(DETECTOR)
    assert first == "broken promises: []"
    assert last.startswith(f"{steps(10)} strides, LowRate(limit=0.7")


def test_a_corrector_and_cues_of_ones_own_keep_their_promises_and_find_the_walk() -> None:
    for which, what in ((CORRECTOR, "strides"), (CUES, "heel-strikes")):
        first, last = output(which)
        assert first == "broken promises: []"
        assert last.startswith(f"{steps(10)} {what}")


@pytest.mark.parametrize("what", ["default", "no rolling foot", "mean of both feet"])
def test_each_recipe_of_the_page_finds_the_walk(what: str) -> None:
    truth = emulate(Route().stand(2).walk(6, speed=1.3).stop(1), seed=1).truth
    (line,) = [line for line in output(RECIPE) if line.startswith(what)]
    found, _, length, _ = line[len(what) :].split()
    assert int(found) == sum(len(truth.strides(foot)) for foot in Foot)
    assert float(length) == pytest.approx(6.0, abs=0.5)
