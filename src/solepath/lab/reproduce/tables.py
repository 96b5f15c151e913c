"""Tables of an experiment: a row of five statistics for each figure that was measured walk by walk."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum
from typing import Any

import attrs
import numpy as np
from attrs import frozen


class Drawn(Enum):
    """Style in which points are drawn."""

    TRUTH = "truth"  # a dashed line in the background
    LINE = "line"
    DOTS = "dots"


@frozen
class PictureTrack:
    """Named places on a floor, `points` (x, y) in m, in the order in which they were walked."""

    name: str
    points: tuple[tuple[float, float], ...]
    drawn: Drawn = Drawn.LINE


@frozen
class Floor:
    """Tracks or clouds of points seen from above. `marks`: named places (name, x, y)."""

    title: str
    tracks: tuple[PictureTrack, ...]
    marks: tuple[tuple[str, float, float], ...] = ()


@frozen
class Boxes:
    """Box plots of table rows, with the paper's box beside ours where it has quartiles; `target` is the true value."""

    title: str
    rows: tuple[str, ...]
    label: str
    target: float | None = None


Panel = Floor | Boxes


@frozen
class Statistics:
    """The columns of table I of Chen et al. 2019; None for too few values, or where a paper has none."""

    mean: float | None = None
    std: float | None = None
    q1: float | None = None
    median: float | None = None
    q3: float | None = None


STATISTICS = tuple(a.name for a in attrs.fields(Statistics))

Table = dict[str, Statistics]
"""Statistics by row name, in the order of the rows."""


def statistics(values: Sequence[float]) -> Statistics:
    """Return the statistics of one figure over walks.

    `std` divides by n - 1: so table I of Bebek et al. 2010 gets its mean and deviation from its six walks. Quartiles
    are interpolated linearly between the ordered values; no paper states its rule."""
    if not values:
        return Statistics()
    q1, median, q3 = (float(q) for q in np.quantile(values, [0.25, 0.5, 0.75]))
    std = float(np.std(values, ddof=1)) if len(values) > 1 else None
    return Statistics(float(np.mean(values)), std, q1, median, q3)


@frozen
class FigureRow:
    """One figure of an experiment: `values` of ours, one for each walk, and `paper`, the printed statistics."""

    name: str
    values: tuple[float, ...]
    paper: Statistics
    digits: int = 2
    """Number of digits after the point, as the paper prints it."""


def row_of(paper: Table, name: str, values: Iterable[float], digits: int = 2) -> FigureRow:
    """Return the row of `values` beside the entry of the paper's table under the same name, if any."""
    return FigureRow(name, tuple(values), paper.get(name, Statistics()), digits)


@frozen
class Reproduction:
    """An experiment of a paper, repeated by emulated wearers.

    `unit` is the unit of the rows. `notes` are sentences for readers: other findings, and what the paper leaves open.
    """

    name: str
    paper_title: str
    walked: str
    """Description of what was emulated, a sentence without its full stop."""
    unit: str
    rows: tuple[FigureRow, ...]
    panels: tuple[Panel, ...] = ()
    """Panels of the paper's main figure."""
    notes: tuple[str, ...] = ()

    @property
    def table(self) -> Table:
        return {row.name: statistics(row.values) for row in self.rows}

    @property
    def paper(self) -> Table:
        return {row.name: row.paper for row in self.rows}


def as_json(done: Reproduction) -> dict[str, Any]:
    """Return {"name", "emulated": true, "table": {row: {"mean", "std", "q1", "median", "q3"}}, "paper": ...}.

    "paper" has the form of "table". Null stands for a statistic of too few walks, or one that is not in the paper."""
    return {
        "name": done.name,
        "emulated": True,
        "table": {row: attrs.asdict(of) for row, of in done.table.items()},
        "paper": {row: attrs.asdict(of) for row, of in done.paper.items()},
    }
