"""Pressure insoles: cells laid out in rows over the outline of a sole.

Foot frame as in types.Cell: x to the toe, y left, m, origin at the heel's rear end on the midline. The id of a layout
is its number of cells."""

from __future__ import annotations

import numpy as np
from attrs import evolve

from ...types import Cell, Foot, Layout

FULL_COUNT = 4095
"""Largest count of a cell, of 12 bits."""
FULL_SCALE = 204.75
"""Largest load that a cell can report, N: FULL_COUNT counts of 0.05 N.

It corresponds to the range of 5 to 200 N of a published insole of 99 cells."""
LOAD_PER_COUNT = FULL_SCALE / FULL_COUNT
"""Load per count, N."""
# Half-widths of a left sole on its lateral (+y) and medial (-y) side, as shares of its width, at shares of its length.
_ALONG = (0.00, 0.03, 0.10, 0.18, 0.30, 0.42, 0.55, 0.68, 0.76, 0.86, 0.94, 1.00)
_LATERAL = (0.10, 0.24, 0.32, 0.34, 0.34, 0.38, 0.46, 0.50, 0.47, 0.36, 0.20, 0.05)
_MEDIAL = (0.10, 0.24, 0.32, 0.33, 0.27, 0.23, 0.32, 0.46, 0.48, 0.45, 0.34, 0.12)


def layout(count: int, foot: Foot, length: float = 0.285, width: float = 0.100) -> Layout:
    """Return the layout of an insole of `count` cells (24, 35, 96, 99, any number from 8 to 128).

    Cells are ordered row by row from heel to toe, and in a row from the medial to the lateral side. In a row they are
    equally wide; they cover 80 % of the sole. `length` and `width` of the sole are in m."""
    if not 8 <= count <= 128:
        raise ValueError(f"an insole has 8 to 128 cells, got {count}")
    # This makes cells about square: the mean width of a sole is 0.75 of its width.
    rows = max(4, round(float(np.sqrt(count * length / (0.75 * width)))))
    along = (np.arange(rows) + 0.5) / rows
    left = np.interp(along, _ALONG, _LATERAL) * width
    right = -np.interp(along, _ALONG, _MEDIAL) * width
    cells = []
    for x, low, high, share in zip(along * length, right, left, _shares(left - right, count), strict=True):
        step = (high - low) / share
        area = 0.8 * step * length / rows
        cells += [Cell(float(x), float(low + (k + 0.5) * step), float(area)) for k in range(share)]
    if foot is Foot.RIGHT:
        cells = [evolve(cell, y=-cell.y) for cell in cells]
    return Layout(count, foot, tuple(cells), length, LOAD_PER_COUNT, FULL_SCALE)


def _shares(widths: np.ndarray[tuple[int, ...], np.dtype[np.float64]], count: int) -> list[int]:
    """Split `count` cells over the rows in proportion to their widths, at least one each, by largest remainders."""
    exact = (count - len(widths)) * widths / widths.sum()
    shares = np.floor(exact).astype(int)
    order = np.argsort(shares - exact, kind="stable")
    shares[order[: count - len(widths) - int(shares.sum())]] += 1
    return [int(share) + 1 for share in shares]
