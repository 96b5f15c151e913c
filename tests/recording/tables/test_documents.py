"""Tables of samples in docs/formats.md: the program runs, the mapping is one, options can be parsed, tables whole."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from quoted import PAGES, blocks, run_page

from solepath.cli.common.tables import mapping_of
from solepath.cli.main import parser
from solepath.recording import read_mapping
from solepath.recording.exports import EXPORTS
from solepath.recording.mapping.units import UNITS

PAGE = PAGES["docs/formats.md"].split("\n## Data frames\n", 1)[0]


def test_the_program_prints_samples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (out,), _ = run_page("docs/formats.md", programs=slice(1))
    first, second = out.splitlines()
    assert first.startswith("0.0 ") and second.startswith("0.01 ") and "9.80665" in second


def test_the_mapping_is_one(tmp_path: Path) -> None:
    (text,) = blocks(PAGE, "toml")
    (tmp_path / "lab.toml").write_text(text)
    mapping = read_mapping(tmp_path / "lab.toml")
    assert mapping.columns["gyro"] == ("Gyro X", "-Gyro Y", "Gyro Z") and mapping.feet["right"] == "*_re.csv"


def test_the_commands_can_be_typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lab.toml").write_text(blocks(PAGE, "toml")[0])
    commands = re.findall(r"`solepath (track .+?)`", PAGE)
    assert len(commands) > 4
    for command in commands:
        mapping_of(parser().parse_args(shlex.split(command)))
    for option in re.findall(r"`(--columns .+?|--units .+?)`", PAGE):
        mapping_of(parser().parse_args(["track", "x.csv", *shlex.split(option)]))


def test_units_and_formats_are_all_there() -> None:
    for quantity in ("t", "acc", "gyro"):
        assert all(f"`{unit}`" in PAGE for unit in UNITS[quantity])
    assert re.findall(r"^\| `([a-z][a-z-]+)` \| ", PAGE, re.MULTILINE) == list(EXPORTS)
