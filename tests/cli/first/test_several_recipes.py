"""Tests that `track` with several recipes prints a column for each, with the figures of each recipe by itself."""

from __future__ import annotations

import re
from pathlib import Path

from commands import run

PAIR = ("--recipe", "default", "--recipe", "shoe-sensing")
FILES = ("events.jsonl", "gait_cycles.csv", "strides.csv", "track.csv")


def columns(text: str) -> dict[str, list[str]]:
    """Return the cells of each row of the table by the label of the row."""
    rows = [re.split(r" {2,}", line) for line in text.splitlines()]
    return {label: cells for label, *cells in rows if cells}


def test_each_column_has_the_figures_of_the_recipe_alone_and_each_folder_its_files(
    recording: Path, tmp_path: Path
) -> None:
    done = run("track", recording, *PAIR, "--out", tmp_path / "both")
    assert (done.returncode, done.stderr) == (0, "")
    table = columns(done.stdout)
    names = next(cells for label, cells in table.items() if label.startswith("walk.jsonl, 2 recipes: "))
    assert names == ["default", "shoe-sensing"]
    for place, recipe in enumerate(names):
        alone = run("track", recording, "--recipe", recipe, "--out", tmp_path / recipe)
        feet = {
            cells[0]: cells[1:] for line in alone.stdout.splitlines() if (cells := line.split()) and len(cells) == 9
        }
        for foot in ("left", "right"):
            assert table[f"strides, {foot} foot"][place] == feet[foot][2]
            assert table[f"distance m, {foot} foot"][place] == feet[foot][3]
        for name in FILES:
            assert (tmp_path / "both" / recipe / name).read_bytes() == (tmp_path / recipe / name).read_bytes()
    assert sorted(path.name for path in (tmp_path / "both").iterdir()) == names
    for label in ("from start to end m", "defects of the data", "us a sample"):
        assert len(table[label]) == 2, label
