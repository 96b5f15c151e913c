"""The table of an experiment: a row of five statistics for each figure that was measured walk by walk."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum
from typing import Any

import attrs
import numpy as np
from attrs import frozen


class Drawn(Enum):
    """How points are drawn."""

    TRUTH = "truth"  # a dashed line in the background
    LINE = "line"
    DOTS = "dots"


@frozen
class PictureTrack:
    """Places on a floor, `points` (x, y) in m, in the order in which they were walked."""

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
    """A box for each of these rows of the table, the paper's beside ours where it has quartiles; `target` is what they
    should be."""

    title: str
    rows: tuple[str, ...]
    label: str
    target: float | None = None


Panel = Floor | Boxes


@frozen
class Statistics:
    """As table I of Chen et al. 2019 has them; None where there are too few values, or a paper does not say."""

    mean: float | None = None
    std: float | None = None
    q1: float | None = None
    median: float | None = None
    q3: float | None = None


STATISTICS = tuple(a.name for a in attrs.fields(Statistics))

Table = dict[str, Statistics]
"""Row -> its statistics, in the order in which they are shown."""


def statistics(values: Sequence[float]) -> Statistics:
    """Of one figure over walks. `std` has n - 1 below the line: that is how table I of Bebek et al. 2010 goes from its
    six walks to its own mean and deviation. Quartiles are linear between the ordered values; no paper says how."""
    if not values:
        return Statistics()
    q1, median, q3 = (float(q) for q in np.quantile(values, [0.25, 0.5, 0.75]))
    std = float(np.std(values, ddof=1)) if len(values) > 1 else None
    return Statistics(float(np.mean(values)), std, q1, median, q3)


@frozen
class FigureRow:
    """One figure of an experiment: `values` of ours, one for each walk, and `paper`, what the paper printed of its."""

    name: str
    values: tuple[float, ...]
    paper: Statistics
    digits: int = 2
    """After the point, as the paper prints it."""


def row_of(paper: Table, name: str, values: Iterable[float], digits: int = 2) -> FigureRow:
    """The row of `values` beside what the paper's table says under the same name, if anything."""
    return FigureRow(name, tuple(values), paper.get(name, Statistics()), digits)


@frozen
class Reproduction:
    """An experiment of a paper, walked again by emulated wearers.

    `unit` is that of the rows; `notes` are sentences for people: what else was found, and what the paper leaves open.
    """

    name: str
    paper_title: str
    walked: str
    """What was emulated, in a sentence without its full stop."""
    unit: str
    rows: tuple[FigureRow, ...]
    panels: tuple[Panel, ...] = ()
    """The paper's main figure."""
    notes: tuple[str, ...] = ()

    @property
    def table(self) -> Table:
        return {row.name: statistics(row.values) for row in self.rows}

    @property
    def paper(self) -> Table:
        return {row.name: row.paper for row in self.rows}


def as_json(done: Reproduction) -> dict[str, Any]:
    """{"name", "emulated": true, "table": {row: {"mean", "std", "q1", "median", "q3"}}, "paper": the same}; null for
    what cannot be said of so few walks, or is not in the paper."""
    return {
        "name": done.name,
        "emulated": True,
        "table": {row: attrs.asdict(of) for row, of in done.table.items()},
        "paper": {row: attrs.asdict(of) for row, of in done.paper.items()},
    }
