"""Tests that `track` with several recipes prints a column for each, with the figures of each recipe by itself."""

from __future__ import annotations

import re
from pathlib import Path

from commands import run

PAIR = ("--recipe", "default", "--recipe", "shoe-sensing")
FILES = ("events.jsonl", "gait_cycles.csv", "strides.csv", "track.csv")


def test_each_column_has_the_figures_of_the_recipe_alone_and_each_folder_its_files(
    recording: Path, tmp_path: Path
) -> None:
    done = run("track", recording, *PAIR, "--out", tmp_path / "both")
    assert (done.returncode, done.stderr) == (0, "")
    table = [re.split(r" {2,}", line) for line in done.stdout.splitlines()]
    names = next(cells for label, *cells in table if label.startswith("walk.jsonl, 2 recipes: "))
    assert names == ["default", "shoe-sensing"]
    strides = next(cells for label, *cells in table if label == "strides, left foot")
    for place, recipe in enumerate(names):
        alone = run("track", recording, "--recipe", recipe, "--out", tmp_path / recipe)
        assert re.search(rf"^left( +[\d.]+){{2}} +{strides[place]} ", alone.stdout, re.MULTILINE)
        for name in FILES:
            assert (tmp_path / "both" / recipe / name).read_bytes() == (tmp_path / recipe / name).read_bytes()
    assert sorted(path.name for path in (tmp_path / "both").iterdir()) == names
