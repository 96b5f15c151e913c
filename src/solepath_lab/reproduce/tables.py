"""The results of an experiment: named values of each walk, from which its rows and claims follow, and panels to draw.

`published.toml` has what each paper prints, `claims.toml` the comparisons that the documents make.

Chen et al. 2019: D. Chen and others, "Smart Insole-Based Indoor Localization System for Internet of Things
Applications", IEEE Internet of Things Journal. Bebek et al. 2010: O. Bebek and others, "Personal Navigation via
High-Resolution Gait-Corrected Inertial Measurement Units", IEEE Transactions on Instrumentation and Measurement. Gong
et al. 2023: "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm
against Walking Modes", Sensors. Liu et al. 2015: C. Liu and others, "Track Your Foot Step: Anchor-free Indoor
Localization based on Sensing Users' Foot Steps", IEEE MASS. Li et al. 2016: F. Li and others, "3D Tracking via Shoe
Sensing", Sensors 16, 1809."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from math import floor, inf, isnan, log10, sqrt
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs import field, frozen

from solepath.types import Floats


class DrawStyle(Enum):
    """The style in which points are drawn."""

    TRUTH = "truth"
    """Dashed line in the background."""
    LINE = "line"
    DOTS = "dots"


Points = tuple[Floats, ...]


def to_points(points: Iterable[Floats]) -> Points:
    """Return points as a track has them."""
    return tuple(points)


@frozen
class PictureTrack:
    """A track, a curve or a cloud of points to draw, with its name; points are (x, y), or (x, y, z) with z up."""

    name: str
    points: Points = field(converter=to_points)
    style: DrawStyle = DrawStyle.LINE


def to_numbers(values: Iterable[float]) -> Floats:
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
    series: tuple[tuple[str, Floats], ...]
    label: str


Panel = Plot | BoxPlots | Bars


def _read(name: str) -> dict[str, Any]:
    return tomllib.loads(Path(__file__).with_name(name).read_text(encoding="utf-8"))


PUBLISHED, CLAIMS = _read("published.toml"), _read("claims.toml")
"""What each paper prints, and what the documents compare, by the name of its experiment."""


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


SIGNIFICANT, MOST_DIGITS = 4, 4
"""Number of digits of a row's mean, and largest number of digits after the point."""


@frozen
class FigureRow:
    """One figure of an experiment: our `values`, of all walks, and the statistics that the `paper` prints."""

    name: str
    values: Floats = field(converter=to_numbers)
    paper: Statistics = Statistics()

    @property
    def digits(self) -> int:
        """Number of digits after the point."""
        mean = abs(statistics(self.values).mean or 0.0)
        return min(max(SIGNIFICANT - 1 - floor(log10(mean)), 0), MOST_DIGITS) if mean > 0.0 else 1


STUDENT = (1.589534, 2.555850, 2.822499, 2.372271, 1.959964)
"""Factors of the powers of 1 / freedom in the 97.5 % point of Student's t, the highest power first."""


@frozen
class Claim:
    """A comparing sentence of the documents, with its margin in each walk or of each wearer, positive where it is true.

    It holds if the 95 % interval of the mean margin is above zero, fails if it is below, and is open if zero is in
    it."""

    sentence: str
    """What is claimed, without a full stop: "KUPT errs less than ZUPT"."""
    margins: Floats = field(converter=to_numbers)
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


def _student(freedom: int) -> float:
    """Return the 97.5 % point of Student's t, by its expansion in 1 / freedom (Abramowitz and Stegun 26.7.5)."""
    return float(np.polyval(STUDENT, 1.0 / freedom))


Values = dict[str, Floats]
"""Values by name. A name with a bracket is that of no row: claims or panels are made from such values."""


@frozen
class WalkResults:
    """The results of one walk, or of what else is one job of an experiment."""

    values: Values = field(repr=False)
    panels: tuple[Plot, ...] = ()
    """Panels of the walks that are drawn."""


Blocks = Mapping[str, Sequence[WalkResults]]
"""Results of walks by what is said before the names of their values."""


def gathered(blocks: Blocks) -> tuple[Values, ...]:
    """Return the values of the first walk, or wearer, of all blocks, those of the second, and so on.

    The title of the block stands before each name."""
    found = [Values() for _ in range(max(map(len, blocks.values())))]
    for title, walks in blocks.items():
        for values, one in zip(found, walks, strict=False):
            values |= {f"{title}{name}": of for name, of in one.values.items()}
    return tuple(found)


def pooled(walks: Iterable[Values], *names: str) -> list[float]:
    """Return the values of these names of all walks, in one list; a walk may lack them."""
    return [value for name in names for one in walks for value in one.get(name, ())]


def mean(values: Sequence[float]) -> float:
    """Return the mean; 0 of nothing."""
    return float(np.mean(values)) if values else 0.0


@frozen
class Reproduction:
    """An experiment of a paper, repeated by emulated wearers.

    `unit` is the unit of the rows."""

    name: str
    emulation: str
    """Description of the emulated walks: a sentence without its full stop."""
    unit: str
    results: tuple[Values, ...]
    """Values of each walk or wearer, which are independent of each other."""
    panels: tuple[Panel, ...] = ()
    """Panels of the paper's main figure."""

    @property
    def published(self) -> dict[str, Any]:
        """What the paper prints, with its title, and `notes`: sentences about the table."""
        found: dict[str, Any] = PUBLISHED[self.name]
        return found

    @property
    def rows(self) -> tuple[FigureRow, ...]:
        """One row for each name."""
        names = dict.fromkeys([name for one in self.results for name in one if "(" not in name])
        return tuple(
            [FigureRow(name, pooled(self.results, name), self.paper.get(name, Statistics())) for name in names]
        )

    @property
    def claims(self) -> tuple[Claim, ...]:
        """The comparisons that the documents make, as far as there are walks for them."""
        claims = [
            Claim(f"{title}{of['claim']}", self._margins(title, of["more"], of["less"]), of.get("unit", "m"))
            for of in CLAIMS[self.name]
            for title in of.get("of", [""])
        ]
        return tuple([one for one in claims if one.margins])

    def _margins(self, title: str, more: Sequence[str] | float, less: Sequence[str] | float) -> list[float]:
        """Return by how much the mean size of the figures `more` exceeds that of `less` in each walk that has both.

        A number stands for itself."""
        margins = []
        for values in self.results:
            sides = [
                [side] if isinstance(side, float) else pooled([values], *[title + name for name in side])
                for side in (more, less)
            ]
            if all(sides):
                larger, smaller = (float(np.mean(np.abs(side))) for side in sides)
                margins.append(larger - smaller)
        return margins

    @property
    def table(self) -> Table:
        """Statistics of our values by row."""
        return {row.name: statistics(row.values) for row in self.rows}

    @property
    def paper(self) -> Table:
        """Statistics that the paper prints, by row."""
        return {
            name: Statistics(*[None if isnan(value) else value for value in values])
            for name, values in self.published["rows"].items()
        }


def as_json(reproduction: Reproduction) -> dict[str, Any]:
    """Return {"name", "emulated": true, "table": {row: {"mean", "std", "q1", "median", "q3"}}, "paper": ..., "claims"}.

    "paper" has the form of "table". Null stands for a statistic of too few walks, or one that is not in the paper.
    "claims" is {sentence: verdict}."""
    rows = reproduction.rows
    return {
        "name": reproduction.name,
        "emulated": True,
        "table": {row.name: attrs.asdict(statistics(row.values)) for row in rows},
        "paper": {row.name: attrs.asdict(row.paper) for row in rows},
        "claims": {one.sentence: one.verdict for one in reproduction.claims},
    }
