"""Makes the table that compares several recipes on one recording, in plain text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot

from attrs import define

from ...body.gait.means import GaitParameters
from ...recording import printable
from ...types import Foot, Vec3
from ...walk.walk import FootCounts, Walk
from .gait import PARAMETERS
from .table import number, percent, table

NO_GAIT = "-"
"""Cell of a figure that is not known."""


@define
class RecipeRun:
    """The walk and the computing time of one recipe on a recording."""

    recipe: str
    walk: Walk
    seconds: float = 0.0
    """Wall time that computing took, s."""

    @property
    def gait(self) -> GaitParameters | None:
        """Means of walking, or of running where nobody walked."""
        return self.walk.gait.of(False) or self.walk.gait.of(True)

    @property
    def displacement(self) -> Vec3 | None:
        """Way from the start to the end, the mean of the feet, world frame, m; None without a position."""
        ways = [
            (end[0] - start[0], end[1] - start[1], end[2] - start[2])
            for start, end in [(counts.start, counts.position) for counts in self.walk.feet.values()]
            if start is not None and end is not None
        ]
        if not ways:
            return None
        x, y, z = (sum([way[axis] for way in ways]) / len(ways) for axis in range(3))
        return x, y, z


def recipe_lines(title: str, runs: Sequence[RecipeRun]) -> list[str]:
    """Return the table of the recipes, a column each, and below it what each of them reports about the data."""
    duration = max(run.walk.covered_time.total for run in runs)
    header = [f"{title}: {duration:.1f} s", *(run.recipe for run in runs)]
    rows: list[list[str]] = []

    def add(label: str, cell: Callable[[RecipeRun], str]) -> None:
        cells = [cell(run) for run in runs]
        if any(one != NO_GAIT for one in cells):
            rows.append([label, *cells])

    for foot in Foot:
        add(f"strides, {foot} foot", lambda run, foot=foot: _count(run, foot, "strides"))  # type: ignore[misc]
    for foot in Foot:
        add(f"distance m, {foot} foot", lambda run, foot=foot: _distance(run, foot))  # type: ignore[misc]
    add("distance m, both feet fused", _fused)
    add("from start to end m", lambda run: _way(run, lambda way: hypot(way[0], way[1])))
    add("end above start m", lambda run: _way(run, lambda way: way[2]))
    add("cadence steps/min", lambda run: number(None if run.gait is None else run.gait.cadence, 1))
    for name, label, unit, digits, scale in PARAMETERS:
        add(f"{label} {unit}", lambda run, row=(name, digits, scale): _mean(run, *row))  # type: ignore[misc]
    add("stance %", lambda run: percent(None if run.gait is None else run.gait.both.share("stance_time")))
    for foot in Foot:
        add(f"degraded strides, {foot} foot", lambda run, foot=foot: _count(run, foot, "degraded"))  # type: ignore[misc]
    add("defects of the data", lambda run: str(len(run.walk.defects)))
    add("limitations", lambda run: str(len(run.walk.limitations)))
    add("us a sample", _pace)
    lines = table(header, rows).splitlines()
    for run in runs:
        lines += [f"{run.recipe}: DEFECT, {printable(what)}" for what in run.walk.defects]
        lines += [f"{run.recipe}: limitation, {printable(what)}" for what in run.walk.limitations]
    return lines


def _count(run: RecipeRun, foot: Foot, name: str) -> str:
    if foot not in run.walk.known_feet:
        return NO_GAIT
    return str(getattr(run.walk.feet.get(foot, FootCounts()), name))


def _distance(run: RecipeRun, foot: Foot) -> str:
    return number(run.walk.feet[foot].distance) if foot in run.walk.feet else NO_GAIT


def _fused(run: RecipeRun) -> str:
    return number(None if run.walk.fused is None else run.walk.fused.distance)


def _way(run: RecipeRun, length: Callable[[Vec3], float]) -> str:
    way = run.displacement
    return number(None if way is None else round(length(way), 2) + 0.0)  # no -0.00


def _mean(run: RecipeRun, name: str, digits: int, scale: float) -> str:
    figure = None if run.gait is None else getattr(run.gait.both, name)
    return number(None if figure is None else scale * figure.mean, digits)


def _pace(run: RecipeRun) -> str:
    samples = sum([run.walk.samples(foot) for foot in Foot])  # whole numbers
    return number(1e6 * run.seconds / samples if samples else None, 0)
