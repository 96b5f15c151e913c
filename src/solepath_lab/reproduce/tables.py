"""The results of an experiment: a table with a row of five statistics for each figure, panels to draw, and notes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum
from math import inf, sqrt
from typing import Any

import attrs
import numpy as np
from attrs import field, frozen


class DrawStyle(Enum):
    """The style in which points are drawn."""

    TRUTH = "truth"
    """Dashed line in the background."""
    LINE = "line"
    DOTS = "dots"


Points = tuple[tuple[float, ...], ...]


def to_points(points: Iterable[tuple[float, ...]]) -> Points:
    """Return points as a track has them."""
    return tuple(points)


@frozen
class PictureTrack:
    """A track, a curve or a cloud of points to draw, with its name; points are (x, y), or (x, y, z) with z up."""

    name: str
    points: Points = field(converter=to_points)
    style: DrawStyle = DrawStyle.LINE


def to_numbers(values: Iterable[float]) -> tuple[float, ...]:
    """Return numbers of any kind as a claim has them."""
    return tuple([float(value) for value in values])


def to_tracks(tracks: Iterable[PictureTrack]) -> tuple[PictureTrack, ...]:
    """Return tracks as a panel has them."""
    return tuple(tracks)


@frozen
class Plot:
    """A panel with tracks on the floor, seen from above, or in space, or with curves over the x axis.

    `marks` are named places (name, x, y); `limits` are those of the y axis, None: all of the tracks."""

    title: str
    tracks: tuple[PictureTrack, ...] = field(converter=to_tracks)
    x_label: str = "x, m"
    y_label: str = "y, m"
    limits: tuple[float, float] | None = None
    marks: tuple[tuple[str, float, float], ...] = ()


@frozen
class BoxPlots:
    """A panel with box plots of `rows`, ours beside the paper's; `label` is of the y axis, `target` the true value."""

    title: str
    rows: tuple[str, ...]
    label: str
    target: float | None = None


@frozen
class Bars:
    """A panel with a group of bars for each name; a series is its title and its value for each name."""

    title: str
    names: tuple[str, ...]
    series: tuple[tuple[str, tuple[float, ...]], ...]
    label: str


Panel = Plot | BoxPlots | Bars


@frozen
class Statistics:
    """The columns of table I of Chen et al. 2019; None for one of too few values or one not in the paper."""

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

    `std` divides by n - 1, which gives the deviations that table I of Bebek et al. 2010 prints for its six walks.
    Quartiles are interpolated linearly between the ordered values, because no paper states another rule."""
    if not values:
        return Statistics()
    q1, median, q3 = (float(q) for q in np.quantile(values, [0.25, 0.5, 0.75]))
    std = float(np.std(values, ddof=1)) if len(values) > 1 else None
    return Statistics(float(np.mean(values)), std, q1, median, q3)


@frozen
class FigureRow:
    """One figure of an experiment: our `values`, one for each walk, and the statistics that the `paper` prints."""

    name: str
    values: tuple[float, ...]
    paper: Statistics
    digits: int = 2
    """Number of digits after the point, as the paper prints it."""


STUDENT = (1.589534, 2.555850, 2.822499, 2.372271, 1.959964)
"""Factors of the powers of 1 / freedom in the 97.5 % point of Student's t, the highest power first."""


@frozen
class Claim:
    """A comparing sentence of the documents, with its margin in each walk or of each wearer, positive where it is true.

    It holds if the 95 % interval of the mean margin is above zero, fails if it is below, and is open if zero is in
    it."""

    sentence: str
    """What is claimed, without a full stop: "KUPT errs less than ZUPT"."""
    margins: tuple[float, ...] = field(converter=to_numbers)
    unit: str = "m"

    @property
    def interval(self) -> tuple[float, float]:
        """Interval in which the mean margin lies with 95 %, by Student's t over independent walks or wearers."""
        count, mean = len(self.margins), float(np.mean(self.margins or (0.0,)))
        if count < 2:
            return -inf, inf
        reach = _student(count - 1) * float(np.std(self.margins, ddof=1)) / sqrt(count)
        return mean - reach, mean + reach

    @property
    def verdict(self) -> str:
        """ "holds", "fails" or "is open"."""
        low, high = self.interval
        return "holds" if low > 0.0 else "fails" if high < 0.0 else "is open"

    def __str__(self) -> str:
        low, high = self.interval
        mean = float(np.mean(self.margins or (0.0,)))
        return (
            f"{self.sentence}: by {mean:.2g} {self.unit} (95 % interval {low:.2g} to {high:.2g}, n = "
            f"{len(self.margins)}), so it {self.verdict}."
        )


def claim(sentence: str, more: Iterable[float], less: Iterable[float], unit: str = "m") -> Claim:
    """Return the claim that the figures `less` of each walk are smaller than those of the same walk in `more`."""
    return Claim(sentence, np.subtract(tuple(more), tuple(less)), unit)


def _student(freedom: int) -> float:
    """Return the 97.5 % point of Student's t, by its expansion in 1 / freedom (Abramowitz and Stegun 26.7.5)."""
    return float(np.polyval(STUDENT, 1.0 / freedom))


Values = dict[str, tuple[float, ...]]


@frozen
class WalkResults:
    """The results of one walk, or of what else is one job of an experiment."""

    values: Values = field(repr=False)
    """Values by name: of a row, or of what rows and notes are computed from."""
    panels: tuple[Plot, ...] = ()
    """Panels of the walks that are drawn."""


def pooled(walks: Iterable[WalkResults], *names: str) -> list[float]:
    """Return the values of these names of all walks, in one list; a walk may lack them."""
    return [value for name in names for one in walks for value in one.values.get(name, ())]


def row_of(paper: Table, name: str, values: Iterable[float], digits: int = 2) -> FigureRow:
    """Return the row of our `values` and of the entry with the same name in the paper's table, if there is one."""
    return FigureRow(name, tuple(values), paper.get(name, Statistics()), digits)


@frozen
class Reproduction:
    """An experiment of a paper, repeated by emulated wearers.

    `unit` is the unit of the rows. `notes` are sentences: other findings, and what the paper leaves open."""

    name: str
    paper_title: str
    emulation: str
    """Description of the emulated walks: a sentence without its full stop."""
    unit: str
    rows: tuple[FigureRow, ...]
    panels: tuple[Panel, ...] = ()
    """Panels of the paper's main figure."""
    notes: tuple[str, ...] = ()
    claims: tuple[Claim, ...] = ()
    """Comparisons that the documents make."""

    @property
    def table(self) -> Table:
        """Statistics of our values by row."""
        return {row.name: statistics(row.values) for row in self.rows}

    @property
    def paper(self) -> Table:
        """Statistics that the paper prints, by row."""
        return {row.name: row.paper for row in self.rows}


def as_json(reproduction: Reproduction) -> dict[str, Any]:
    """Return {"name", "emulated": true, "table": {row: {"mean", "std", "q1", "median", "q3"}}, "paper": ..., "claims"}.

    "paper" has the form of "table". Null stands for a statistic of too few walks, or one that is not in the paper.
    "claims" is {sentence: verdict}."""
    return {
        "name": reproduction.name,
        "emulated": True,
        "table": _table_as_json(reproduction.table),
        "paper": _table_as_json(reproduction.paper),
        "claims": {one.sentence: one.verdict for one in reproduction.claims},
    }


def _table_as_json(table: Table) -> dict[str, Any]:
    return {row: attrs.asdict(of) for row, of in table.items()}
