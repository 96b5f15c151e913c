"""Draws a track with characters, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import evolve

from ...types import Foot
from .svg import View

CHARACTER_ASPECT = 2.0
"""Approximate height of a character over its width."""
MARGIN = 1.0
"""Margin around the track, m, so that standing still is not magnified."""


def plot(track: Sequence[tuple[Foot, float, float]], width: int, height: int) -> list[str]:
    """Return a picture of the track of both feet, (foot, x, y) in m, as `height` lines of `width` characters.

    The track is seen from above, x to the right and y up, both with the same scale. Dots are positions, S is the start,
    and L or R is the last position of each foot."""
    cells = [[" "] * width for _ in range(height)]
    points = [(x, y / CHARACTER_ASPECT) for _, x, y in track]
    if points:
        columns, rows = width - 1.0, height - 1.0
        view = evolve(View.fit(points, columns, rows, margin=MARGIN), width=columns, height=rows)
        ends = {foot: (foot.value[0].upper(), point) for (foot, _, _), point in zip(track, points, strict=True)}
        for letter, point in [*[(".", point) for point in points], ("S", points[0]), *ends.values()]:
            column, row = view.at(point)
            cells[round(row)][round(column)] = letter
    return ["".join(row) for row in cells]
