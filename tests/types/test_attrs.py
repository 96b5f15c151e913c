"""Classes made by `types.attrs` print, compare and hash as attrs itself would have them do."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import attrs
import pytest
from here import ROOT
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.types import attrs as ours

VALUES = st.one_of(st.none(), st.floats(), st.integers(), st.text(max_size=3), st.tuples(st.floats(), st.booleans()))


def made(by: Any, **options: Any) -> tuple[type[Any], type[Any]]:
    """A class with fields of every kind, and one that derives from it."""

    @by.frozen(**options)
    class Record:
        one: Any
        two: Any = attrs.field(eq=False)
        three: Any = attrs.field(repr=False)
        four: Any = attrs.field(repr=lambda value: f"<{value}>", default=4.0)

    @by.frozen(**options)
    class Longer(Record):
        five: Any = 5

    return Record, Longer


OURS, THEIRS = made(ours), made(attrs)


@settings(max_examples=30)
@given(st.lists(VALUES, min_size=4, max_size=4), st.lists(VALUES, min_size=4, max_size=4), st.integers(0, 4))
def test_a_record_prints_compares_and_hashes_as_attrs_has_it(one: list[Any], two: list[Any], alike: int) -> None:
    two[:alike] = one[:alike]
    for mine, theirs in zip(OURS, THEIRS, strict=True):
        assert repr(mine(*one)) == repr(theirs(*one))
        assert (mine(*one) == mine(*two)) == (theirs(*one) == theirs(*two))
        assert (mine(*one) != mine(*two)) == (theirs(*one) != theirs(*two))
        if mine(*one) == mine(*two):
            assert hash(mine(*one)) == hash(mine(*two))
    assert OURS[0](*one) != OURS[1](*one), "a class is part of what is compared"


CALLS = """
from solepath import Foot
from solepath.body.gait.turns import Turns
from solepath.foot.pressure.insole import Sole
from solepath.foot.settings import CycleSettings
from solepath.foot.stance.cycle import Cycle
from solepath.foot.gait import Gait

Cycle(), Cycle(CycleSettings()), Cycle(settings=CycleSettings()), Turns(), Sole(Foot.LEFT), Gait(Foot.LEFT, None, False)
Cycle(previous=None)
Turns(3)
Sole(Foot.LEFT, had_cells=True)
Gait(Foot.LEFT, heading=None, every_stride=False, stride=None)
Gait(Foot.LEFT)
"""
"""A line of calls that are right, and then one that is wrong in each line."""


def test_state_is_no_argument_for_whoever_checks_types(tmp_path: Path) -> None:
    """mypy takes settings and what has no default for arguments of a part, and nothing else, as Python does."""
    program = tmp_path / "calls.py"
    program.write_text(CALLS)
    words = ["--strict", "--no-error-summary", "--follow-imports=silent", str(program)]
    done = subprocess.run([sys.executable, "-m", "mypy", *words], capture_output=True, text=True, cwd=ROOT)
    lines = CALLS.splitlines()
    wrong = [lines[int(one.split(":")[1]) - 1] for one in done.stdout.splitlines() if "error:" in one]
    assert wrong == lines[-5:], done.stdout + done.stderr
    for call in wrong:
        with pytest.raises(TypeError):
            exec("\n".join([*lines[:7], call]), {})
