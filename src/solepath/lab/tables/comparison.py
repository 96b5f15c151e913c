"""Comparison tables: a session against the truth of an emulated walk, a reproduction against the paper."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from ...show.tables.table import milliseconds, number, percent, table
from ..emulated.compare import FootComparison
from ..emulated.place import PlaceScore
from ..reproduce.tables import STATISTICS, FigureRow, Reproduction, Statistics, statistics

EVENTS = {"heel_strike": "heel-strike", "foot_flat": "foot-flat", "heel_off": "heel-off", "toe_off": "toe-off"}


def comparison_table(comparisons: Sequence[FootComparison]) -> str:
    """Return the table that compares the strides and events of both feet with the truth."""
    rows = [
        ["strides walked", *(str(c.strides_true) for c in comparisons)],
        ["strides found", *(str(c.strides_found) for c in comparisons)],
        ["strides invented", *(str(c.strides_invented) for c in comparisons)],
        ["stride length, mean error %", *(percent(c.length_errors.mean) for c in comparisons)],
        ["end position, error m", *(number(c.end_error) for c in comparisons)],
    ]
    for kind, name in EVENTS.items():
        matchings = [c.events[kind] for c in comparisons]
        rows.append([f"{name}s found", *(f"{len(m.offsets)} of {m.n_true}" for m in matchings)])
        rows.append([f"{name}, median offset ms", *(milliseconds(m.bias) for m in matchings)])
    return table(["against the truth", *(c.foot.value for c in comparisons)], rows)


def place_table(score: PlaceScore) -> str:
    """Return the table of the score of positions on the floor plan."""
    rows = [
        ["strides placed", str(score.strides)],
        ["one candidate, the true one, after strides", "-" if score.decided is None else str(score.decided)],
        ["strides with one candidate, a wrong one", str(score.wrong)],
        ["strides without the true candidate", str(score.dropped)],
        ["from the second turn on, median error m", number(median(score.off)) if score.off else "-"],
    ]
    return table(["place against the truth", "wearer"], rows)


def comparison_with_paper(reproduction: Reproduction) -> str:
    """Return the table of our figures beside the paper's, with the notes on lines below it."""
    first, *others = STATISTICS
    header = [reproduction.unit, f"ours: {first}", *others, f"paper: {first}", *others]
    rows = [[row.name, *_cells(statistics(row.values), row), *_cells(row.paper, row)] for row in reproduction.rows]
    title = (
        f"{reproduction.name}: ours is emulated ({reproduction.emulation}), "
        f"theirs was walked ({reproduction.paper_title})."
    )
    seeds = [] if not reproduction.by_seed else ["", _seeds_table(reproduction)]
    notes = [] if not reproduction.notes else ["", *reproduction.notes]
    return "\n".join([title, "", table(header, rows), *seeds, *notes])


def _seeds_table(reproduction: Reproduction) -> str:
    """Return the table of the mean of each row by seed."""
    header = ["mean by seed", *(str(seed) for seed, _ in reproduction.by_seed)]
    rows = [
        [row.name, *(number(by_row[row.name].mean, row.digits) for _, by_row in reproduction.by_seed)]
        for row in reproduction.rows
    ]
    return table(header, rows)


def _cells(shown: Statistics, row: FigureRow) -> list[str]:
    return [number(getattr(shown, key), row.digits) for key in STATISTICS]
