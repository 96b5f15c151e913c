"""Names that others wrote are text in every table, also in programs that run what looks like a formula."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest

from solepath.events import Candidate, Placed
from solepath.show.outcomes.clinic import ClinicalResults
from solepath.show.outcomes.files import OUTCOMES_FILE, write_outcomes
from solepath.show.outcomes.references import Reference
from solepath.show.outcomes.rows import OutcomeRow
from solepath.show.output import PLACES_FILE, TrackFiles

WIDE = "\uff1d\uff0b\uff0d\uff20"
"""The signs = + - @ in full width, which programs in East Asia take for the same."""
FORMULAS = [
    '=HYPERLINK("http://x","y")', "+1+1", "-2+3", "@SUM(A1)", "\t=1+1", " =1+1", "-cmd|' /C calc'!A0", "\r=1",
    *[f"{sign}1+1" for sign in WIDE],
]  # fmt: skip
NAMES = ["Room 1", "-1", "+1", "1e3", "-2.5e-3", "-10 %", "+5deg", "O'Neill", "a=b", ""]


def is_amount(text: str) -> bool:
    """Return whether a text is a number, with a unit or without one: nothing in it can be run."""
    return re.fullmatch(r"[+-]\d[^-+=@(!|]*(e-\d)?", text) is not None


@pytest.mark.parametrize("name", [*FORMULAS, *NAMES])
def test_the_names_of_a_floor_plan_are_text(tmp_path: Path, name: str) -> None:
    """A level below the ground has a number for its name, which is no formula."""
    candidate = Candidate(name, (1.0, 2.0, 0.0), None, 1.0, name)
    with_files = TrackFiles(tmp_path, places=True)
    with_files.write(
        Placed(t=1.0, known_at=1.0, level=name, position=(-1.0, 2.0, 0.0), room=name, door=name, spread=0.5,
               candidates=(candidate,))
    )  # fmt: skip
    with_files.close()
    with (tmp_path / PLACES_FILE).open(newline="", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    for column in ("level", "room", "door"):
        assert not re.match(rf"\s*[=+\-@\t\r{WIDE}]", row[column]) or is_amount(row[column])
    is_control = not name[:1].isprintable()
    assert row["level"].lstrip("'\ufffd") == name.lstrip("\t\r")
    assert row["level"].startswith("'") == (name in FORMULAS and not is_control)
    assert row["x_m"] == "-1.000"


@pytest.mark.parametrize("source", FORMULAS)
def test_the_source_of_a_reference_is_text(tmp_path: Path, source: str) -> None:
    row = OutcomeRow("walk", "speed", "speed", "m/s", -1.0, None, Reference(value=1.0, words="mean", source=source))
    write_outcomes(ClinicalResults([], [row]), tmp_path / OUTCOMES_FILE)
    with (tmp_path / OUTCOMES_FILE).open(newline="", encoding="utf-8") as file:
        (read,) = csv.DictReader(file)
    assert (
        not re.match(rf"\s*[=+\-@\t\r{WIDE}]", read["source"])
        and read["source"].endswith(source[1:])
        and read["value"] == "-1.000000"
    )
