"""Writes bouts.csv and outcomes.csv: in SI units with six digits after the point, what is not known left empty."""

from __future__ import annotations

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
    "part", "outcome", "value", "unit", "low", "high", "strides", "needed", "predicted", "lower_limit_of_normal",
    "mean_of_group", "mean_low", "mean_high", "source", "smallest_change", "smallest_change_source",
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
    one, reference, change = row.interval, row.reference, row.smallest_change
    ends: list[Cell] = [None] * 4 if one is None else [one.low, one.high, one.strides, one.needed]
    known: list[Cell] = [None] * 6
    if reference is not None and reference.predicted:
        known = [reference.value, reference.lower_limit, None, None, None, reference.source]
    elif reference is not None:
        known = [None, None, reference.value, *(reference.interval or (None, None)), reference.source]
    matters: list[Cell] = [None] * 2 if change is None else [change.value, change.source]
    return [row.part, row.name, row.value, row.unit, *ends, *known, *matters]
