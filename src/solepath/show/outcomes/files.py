"""Writes bouts.csv and outcomes.csv: in SI units with six digits after the point, what is not known left empty."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..output import Cell, write_table
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
    write_table(path, BOUT_COLUMNS, map(_bout_cells, results.bouts))


def write_outcomes(results: ClinicalResults, path: Path) -> None:
    """Write outcomes.csv; raise OSError when it cannot be written."""
    write_table(path, OUTCOME_COLUMNS, map(_outcome_cells, results.rows))


def _bout_cells(bout: WalkingBout) -> list[Cell]:
    times: list[Cell] = [repr(bout.t_start), repr(bout.t_end), bout.duration]
    means = [bout.stride_duration, bout.cadence, bout.stride_length, bout.walking_speed]
    return [
        bout.number,
        *times,
        bout.strides,
        bout.steps,
        bout.turns,
        *means,
        bout.degraded,
        " ".join(implausible(bout)),
    ]


def _outcome_cells(row: OutcomeRow) -> list[Cell]:
    one, band, empty = row.interval, row.reference, ("",) * 4
    ends: Sequence[Cell] = empty if one is None else (one.low, one.high, one.strides, one.needed)
    reference: Sequence[Cell] = empty if band is None else (band.value, band.low, band.high, band.source)
    return [row.part, row.name, row.value, row.unit, *ends, *reference]
