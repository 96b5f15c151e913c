"""Draws a track with characters, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from ...types import Foot

CHARACTER_ASPECT = 2.0
"""Approximate height of a character over its width."""
MIN_EXTENT = 4.0
"""Least length that the longer side of the picture shows, m, so that standing still is not magnified."""


def plot(track: Sequence[tuple[Foot, float, float]], width: int, height: int) -> list[str]:
    """Return a picture of the track of both feet, (foot, x, y) in m, as `height` lines of `width` characters.

    The track is seen from above, x to the right and y up, both with the same scale. Dots are positions, S is the start,
    and L or R is the last position of each foot."""
    cells = [[" "] * width for _ in range(height)]
    if track:
        xs, ys = [x for _, x, _ in track], [y for _, _, y in track]
        # m a column; the larger of the two extents decides
        scale = max(
            (max(xs) - min(xs)) / (width - 1),
            (max(ys) - min(ys)) / (CHARACTER_ASPECT * (height - 1)),
            MIN_EXTENT / width,
        )
        left = 0.5 * (min(xs) + max(xs)) - 0.5 * scale * (width - 1)
        top = 0.5 * (min(ys) + max(ys)) + 0.5 * CHARACTER_ASPECT * scale * (height - 1)
        last: dict[Foot, tuple[int, int]] = {}
        for foot, x, y in track:
            row, column = round((top - y) / (CHARACTER_ASPECT * scale)), round((x - left) / scale)
            last[foot] = (row, column)
            cells[row][column] = "."
        _, x, y = track[0]
        cells[round((top - y) / (CHARACTER_ASPECT * scale))][round((x - left) / scale)] = "S"
        for foot, (row, column) in last.items():
            cells[row][column] = foot.value[0].upper()
    return ["".join(row) for row in cells]
