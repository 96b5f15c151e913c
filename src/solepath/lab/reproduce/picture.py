"""What a paper's main figure shows, as plain data for whoever draws it."""

from __future__ import annotations

from enum import Enum

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
