"""Tests that the headers of all tables, written or printed, have the units of their columns."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import rows_in, run
from recordings import recorded

from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate
from solepath.show.outcomes.files import BOUT_COLUMNS
from solepath.show.output import CYCLE_COLUMNS, PLACE_COLUMNS, STRIDE_COLUMNS, TRACK_COLUMNS

UNITS = ("_s", "_m", "_deg", "_m_per_s", "_steps_per_min")
WITHOUT_UNIT = {
    "foot", "phase", "level", "room", "door", "number", "strides", "steps", "turns", "candidates", "degraded_strides",
    "degraded", "steady", "implausible", "weight", "stance_share", "double_support_share", "missing", "flaws",
}  # fmt: skip
"""Names, counts, flags, and shares from 0 to 1; `phase` of a gait cycle is a share too."""


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a recording that is long enough for steady strides."""
    packets = emulate(Route().stand(0.5).walk(15.0, speed=1.3).stop(0.5), seed=4).packets
    return recorded(tmp_path_factory.mktemp("long") / "walk.jsonl", packets)


@pytest.mark.parametrize("columns", [TRACK_COLUMNS, STRIDE_COLUMNS, CYCLE_COLUMNS, PLACE_COLUMNS, BOUT_COLUMNS])
def test_a_column_of_a_file_has_its_unit_at_the_end_or_is_a_name_a_count_or_a_share(columns: tuple[str, ...]) -> None:
    assert [name for name in columns if not name.endswith(UNITS) and name not in WITHOUT_UNIT] == []


@pytest.mark.soak
def test_angles_of_the_files_are_in_the_degrees_of_the_summary(walk: Path, tmp_path: Path) -> None:
    done = run("track", walk, "--out", tmp_path)
    steady = [row for row in rows_in(tmp_path / "gait_cycles.csv") if row["steady"] == "1" and row["foot"] == "left"]
    mean = sum(float(row["toe_off_angle_deg"]) for row in steady) / len(steady)
    shown = next(line.split() for line in done.stdout.splitlines() if line.startswith("toe-off angle deg"))
    assert float(shown[3]) == pytest.approx(mean, rel=0.02)  # its means leave out some strides
