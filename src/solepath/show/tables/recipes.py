"""Makes the table that compares several recipes on one recording, in plain text."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from statistics import fmean

from attrs import define

from ...types import Foot
from ...walk.walk import FootCounts, Walk
from ..findings import Concern, findings, texts
from .gait import gait_rows
from .table import number, table


@define
class RecipeRun:
    """The walk and the computing time of one recipe on a recording."""

    recipe: str
    walk: Walk
    seconds: float = 0.0
    """Wall time that computing took, s."""

    def cells(self) -> dict[str, str]:
        """Return the figures of the run as texts by their names; "-" is a figure that is not known."""
        walk, cells = self.walk, {}
        feet = {foot: walk.feet.get(foot, FootCounts()) for foot in Foot}
        for foot in filter(walk.has_strides, walk.known_feet):
            cells[f"strides, {foot} foot"] = str(feet[foot].strides)
            cells[f"degraded strides, {foot} foot"] = str(feet[foot].degraded)
            cells[f"distance m, {foot} foot"] = number(feet[foot].distance)
        cells["distance m, both feet fused"] = number(None if walk.fused is None else walk.fused.distance)
        ends = [(counts.start, counts.position) for counts in feet.values()]
        ways = [[b - a for a, b in zip(start, end, strict=True)] for start, end in ends if start and end]
        x, y, z = [fmean(axis) for axis in zip(*ways, strict=True)] if ways else (None, None, None)
        cells["from start to end m"] = number(None if x is None or y is None else hypot(x, y))
        cells["end above start m"] = "-" if z is None else f"{z:z.2f}"
        # means of walking, or of running where nobody walked
        if (gait := walk.gait.of(False) or walk.gait.of(True)) is not None:
            cells["cadence steps/min"] = number(gait.cadence, 1)
            for row in gait_rows(gait):
                means = [one for one in (row.both, row.left, row.right) if one is not None]
                cells[f"{row.label} {row.unit}"] = number(means[0], row.digits)
        cells["defects of the data"] = str(len(walk.found_defects))
        cells["limitations"] = str(len(texts(walk, Concern.LIMITATION)))
        samples = sum([walk.samples(foot) for foot in Foot])  # whole numbers
        cells["us a sample"] = number(1e6 * self.seconds / samples if samples else None, 0)
        return cells


def recipe_lines(title: str, runs: Sequence[RecipeRun]) -> list[str]:
    """Return the table of the recipes, a column each, and below it what each of them reports about the data."""
    duration = max([run.walk.covered_time.total for run in runs])
    header = [f"{title}: {duration:.1f} s", *[run.recipe for run in runs]]
    columns = [run.cells() for run in runs]
    names = dict.fromkeys([name for column in columns for name in column])
    rows = [[name, *[column.get(name, "-") for column in columns]] for name in names]
    lines = table(header, [row for row in rows if set(row[1:]) != {"-"}]).splitlines()
    found: dict[str, list[str]] = {}
    for run in runs:
        for one in findings(run.walk):
            found.setdefault(one.line, []).append(run.recipe)
    # what all recipes say is said once
    return lines + [what if len(names) == len(runs) else f"{', '.join(names)}: {what}" for what, names in found.items()]
