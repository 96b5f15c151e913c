"""The detector of docs/architecture.md and the parts of examples/own_parts.py run and do what is said there."""

from __future__ import annotations

import io
import runpy
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import partial

import pytest
from here import DOCS, EXAMPLES
from quoted import blocks

from solepath.emulate import Route, Walker, emulate
from solepath.types import Foot

PAGE = (DOCS / "architecture.md").read_text()


def lines_of(run: Callable[[], object]) -> list[str]:
    with redirect_stdout(io.StringIO()) as out:
        run()
    return out.getvalue().splitlines()


def test_a_detector_of_ones_own_keeps_its_promises_and_is_restored_with_the_session() -> None:
    program = compile(blocks(PAGE, "python")[0], "docs/architecture.md", "exec")
    first, last = lines_of(partial(exec, program, {"__name__": "extending"}))
    steps = len(Walker(Route().stand(2).walk(10).stop(2)).truth().strides(Foot.LEFT))
    assert first == "broken promises: []"
    assert last.startswith(f"{steps} strides, LowRate(limit=0.7")


def test_a_corrector_cues_and_recipes_of_ones_own_keep_their_promises_and_find_the_walk() -> None:
    promises, *recipes = lines_of(partial(runpy.run_path, str(EXAMPLES / "own_parts.py"), run_name="__main__"))
    assert promises == "broken promises: []" and len(recipes) == 5
    truth = emulate(Route().stand(2).walk(6).stop(2), seed=1).truth
    for line in recipes:
        found, _, length, _ = line.split()[-4:]
        assert int(found) == sum(len(truth.strides(foot)) for foot in Foot), line
        assert float(length) == pytest.approx(6.0, abs=0.5), line
