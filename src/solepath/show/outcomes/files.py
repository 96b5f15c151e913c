"""Writes bouts.csv and outcomes.csv: in SI units with six digits after the point, what is not known left empty."""

from __future__ import annotations

import csv
from pathlib import Path

from .bouts import WalkingBout
from .clinic import ClinicalResults
from .mobility import implausible
from .rows import OutcomeRow

BOUTS_FILE, OUTCOMES_FILE = "bouts.csv", "outcomes.csv"
BOUT_COLUMNS = (
    "number", "t_start_s", "t_end_s", "duration_s", "strides", "steps", "turns", "stride_duration_s",
    "cadence_steps_per_min", "stride_length_m", "walking_speed_m_per_s", "degraded_strides", "implausible",
)  # fmt: skip
"""Columns of bouts.csv; `implausible` names the means that are out of their limits and count in no outcome."""
OUTCOME_COLUMNS = (
    "part", "outcome", "value", "unit", "low", "high", "strides", "needed", "reference", "reference_low",
    "reference_high", "source",
)  # fmt: skip
"""Columns of outcomes.csv; `low` and `high` are the ends of a 95 % confidence interval, shares have no unit."""


def write_bouts(results: ClinicalResults, path: Path) -> None:
    """Write bouts.csv; raise OSError when it cannot be written."""
    _write(path, BOUT_COLUMNS, [_bout_cells(bout) for bout in results.bouts])


def write_outcomes(results: ClinicalResults, path: Path) -> None:
    """Write outcomes.csv; raise OSError when it cannot be written."""
    _write(path, OUTCOME_COLUMNS, [_outcome_cells(row) for row in results.rows])


def _write(path: Path, columns: tuple[str, ...], rows: list[list[str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(rows)


def _bout_cells(bout: WalkingBout) -> list[str]:
    counts = [str(count) for count in (bout.strides, bout.steps, bout.turns)]
    means = [bout.stride_duration, bout.cadence, bout.stride_length, bout.walking_speed]
    times = [repr(bout.t_start), repr(bout.t_end), _digits(bout.duration)]
    cells = [str(bout.number), *times, *counts, *map(_digits, means), str(bout.degraded)]
    return [*cells, " ".join(implausible(bout))]


def _outcome_cells(row: OutcomeRow) -> list[str]:
    one, band = row.interval, row.reference
    ends = (None, None) if one is None else (one.low, one.high)
    counts = ("", "") if one is None else (str(one.strides), str(one.needed))
    reference = (None, None, None) if band is None else (band.value, band.low, band.high)
    cells = [row.part, row.name, _digits(row.value), row.unit, *map(_digits, ends), *counts, *map(_digits, reference)]
    return [*cells, "" if band is None else band.source]


def _digits(value: float | int | None) -> str:
    return "" if value is None else str(value) if isinstance(value, int) else f"{value:.6f}"
