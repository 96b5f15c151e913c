"""A session against the truth of an emulated walk, as a table."""

from __future__ import annotations

from collections.abc import Sequence

from ..evaluate.emulated import FootComparison
from .table import milliseconds, number, percent, table

EVENTS = {"heel_strike": "heel-strike", "foot_flat": "foot-flat", "heel_off": "heel-off", "toe_off": "toe-off"}


def comparison_table(comparisons: Sequence[FootComparison]) -> str:
    rows = [
        ["steps walked", *(str(c.steps_true) for c in comparisons)],
        ["steps found", *(str(c.steps_found) for c in comparisons)],
        ["steps invented", *(str(c.steps_invented) for c in comparisons)],
        ["stride length, mean error %", *(percent(c.length_error) for c in comparisons)],
        ["end position, error m", *(number(c.end_error) for c in comparisons)],
    ]
    for kind, name in EVENTS.items():
        of = [c.events[kind] for c in comparisons]
        rows.append([f"{name}s found", *(f"{len(m.offsets)} of {m.n_true}" for m in of)])
        rows.append([f"{name}, median offset ms", *(milliseconds(m.bias) for m in of)])
    return table(["against the truth", *(c.foot.value for c in comparisons)], rows)
