"""Makes the table that compares several recipes on one recording, in plain text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot

from attrs import define, field

from ...body.gait.means import GaitParameters
from ...events import Event, FootMoved
from ...recording import printable
from ...types import Foot, Vec3
from ..observer import FootCounts, Observer
from .gait import PARAMETERS
from .table import number, percent, table

NO_GAIT = "-"
"""Cell of a figure that is not known."""


@define
class RecipeWalk:
    """The counts and the computing time of one recipe on a recording."""

    recipe: str
    observer: Observer
    seconds: float = 0.0
    """Wall time that computing took, s."""
    starts: dict[Foot, Vec3] = field(factory=dict)
    """First position of each foot, world frame, m."""

    def add(self, events: Sequence[Event], seconds: float) -> None:
        """Add the events of one item, and the wall time that it took, s; the observer gets the item by itself."""
        self.seconds += seconds
        if len(self.starts) < len(Foot):
            for event in events:
                if isinstance(event, FootMoved):
                    self.starts.setdefault(event.foot, event.position)

    @property
    def gait(self) -> GaitParameters | None:
        """Means of walking, or of running where nobody walked."""
        return self.observer.gait.of(False) or self.observer.gait.of(True)

    @property
    def displacement(self) -> Vec3 | None:
        """Way from the start to the end, the mean of the feet, world frame, m; None without a position."""
        ends = {foot: counts.position for foot, counts in self.observer.feet.items()}
        ways = [
            (end[0] - self.starts[foot][0], end[1] - self.starts[foot][1], end[2] - self.starts[foot][2])
            for foot, end in ends.items()
            if end is not None and foot in self.starts
        ]
        if not ways:
            return None
        x, y, z = (sum([way[axis] for way in ways]) / len(ways) for axis in range(3))
        return x, y, z


def recipe_lines(title: str, walks: Sequence[RecipeWalk]) -> list[str]:
    """Return the table of the recipes, a column each, and below it what each of them reports about the data."""
    duration = max(walk.observer.covered_time.total for walk in walks)
    header = [f"{title}: {duration:.1f} s", *(walk.recipe for walk in walks)]
    rows: list[list[str]] = []

    def add(label: str, cell: Callable[[RecipeWalk], str]) -> None:
        cells = [cell(walk) for walk in walks]
        if any(one != NO_GAIT for one in cells):
            rows.append([label, *cells])

    for foot in Foot:
        add(f"strides, {foot} foot", lambda walk, foot=foot: _count(walk, foot, "strides"))  # type: ignore[misc]
    for foot in Foot:
        add(f"distance m, {foot} foot", lambda walk, foot=foot: _distance(walk, foot))  # type: ignore[misc]
    add("distance m, both feet fused", _fused)
    add("from start to end m", lambda walk: _way(walk, lambda way: hypot(way[0], way[1])))
    add("end above start m", lambda walk: _way(walk, lambda way: way[2]))
    add("cadence steps/min", lambda walk: number(None if walk.gait is None else walk.gait.cadence, 1))
    for name, label, unit, digits, scale in PARAMETERS:
        add(f"{label} {unit}", lambda walk, row=(name, digits, scale): _mean(walk, *row))  # type: ignore[misc]
    add("stance %", lambda walk: percent(None if walk.gait is None else walk.gait.both.share("stance_time")))
    for foot in Foot:
        add(f"degraded strides, {foot} foot", lambda walk, foot=foot: _count(walk, foot, "degraded"))  # type: ignore[misc]
    add("defects of the data", lambda walk: str(len(walk.observer.defects)))
    add("limitations", lambda walk: str(len(walk.observer.limitations)))
    add("us a sample", _pace)
    lines = table(header, rows).splitlines()
    for walk in walks:
        lines += [f"{walk.recipe}: DEFECT, {printable(what)}" for what in walk.observer.defects]
        lines += [f"{walk.recipe}: limitation, {printable(what)}" for what in walk.observer.limitations]
    return lines


def _count(walk: RecipeWalk, foot: Foot, name: str) -> str:
    if foot not in walk.observer.known_feet:
        return NO_GAIT
    return str(getattr(walk.observer.feet.get(foot, FootCounts()), name))


def _distance(walk: RecipeWalk, foot: Foot) -> str:
    return number(walk.observer.feet[foot].distance) if foot in walk.observer.feet else NO_GAIT


def _fused(walk: RecipeWalk) -> str:
    return number(None if walk.observer.fused is None else walk.observer.fused.distance)


def _way(walk: RecipeWalk, length: Callable[[Vec3], float]) -> str:
    way = walk.displacement
    return number(None if way is None else round(length(way), 2) + 0.0)  # no -0.00


def _mean(walk: RecipeWalk, name: str, digits: int, scale: float) -> str:
    figure = None if walk.gait is None else getattr(walk.gait.both, name)
    return number(None if figure is None else scale * figure.mean, digits)


def _pace(walk: RecipeWalk) -> str:
    samples = sum([walk.observer.samples(foot) for foot in Foot])  # whole numbers
    return number(1e6 * walk.seconds / samples if samples else None, 0)
