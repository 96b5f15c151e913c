"""Draws a track with characters."""

from __future__ import annotations

from collections.abc import Sequence

from ...types import Foot

TALL = 2.0
"""Height of a character cell over its width, about."""
SMALLEST = 4.0
"""Length that the longer side of the picture shows at least, m, so that standing still is not magnified."""


def plot(track: Sequence[tuple[Foot, float, float]], width: int, height: int) -> list[str]:
    """Return `height` lines of `width` characters that show where the feet (foot, x, y) went.

    The track is seen from above, x to the right and y up, with the same scale both ways. Dots are positions, S is the
    start, and L or R is the last position of each foot."""
    cells = [[" "] * width for _ in range(height)]
    if track:
        xs, ys = [x for _, x, _ in track], [y for _, _, y in track]
        # metres per column, as the wider side needs
        scale = max((max(xs) - min(xs)) / (width - 1), (max(ys) - min(ys)) / (TALL * (height - 1)), SMALLEST / width)
        left = 0.5 * (min(xs) + max(xs)) - 0.5 * scale * (width - 1)
        top = 0.5 * (min(ys) + max(ys)) + 0.5 * TALL * scale * (height - 1)
        last: dict[Foot, tuple[int, int]] = {}
        for foot, x, y in track:
            row, column = round((top - y) / (TALL * scale)), round((x - left) / scale)
            last[foot] = (row, column)
            cells[row][column] = "."
        _, x, y = track[0]
        cells[round((top - y) / (TALL * scale))][round((x - left) / scale)] = "S"
        for foot, (row, column) in last.items():
            cells[row][column] = foot.value[0].upper()
    return ["".join(row) for row in cells]
