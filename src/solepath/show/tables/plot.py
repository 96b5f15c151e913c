"""Draws a track with characters, for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from attrs import evolve

from ...types import Foot, Vec2
from .svg import View

CHARACTER_ASPECT = 2.0
"""Approximate height of a character over its width."""
MARGIN = 1.0
"""Margin around the track, m, so that standing still is not magnified."""


def plot(tracks: Mapping[Foot, Iterable[Vec2]], width: int, height: int) -> list[str]:
    """Return a picture of the tracks of both feet, m, as `height` lines of `width` characters.

    They are seen from above, x to the right and y up, both with the same scale. Dots are positions, S is the start, and
    L or R is the last position of each foot."""
    cells = [[" "] * width for _ in range(height)]
    feet = {foot: [(x, y / CHARACTER_ASPECT) for x, y in track] for foot, track in tracks.items()}
    points = [point for track in feet.values() for point in track]
    if points:
        columns, rows = width - 1.0, height - 1.0
        view = evolve(View.fit(points, columns, rows, margin=MARGIN), width=columns, height=rows)
        ends = [(foot.value[0].upper(), track[-1]) for foot, track in feet.items() if track]
        for letter, point in [*[(".", point) for point in points], ("S", points[0]), *ends]:
            column, row = view.at(point)
            cells[round(row)][round(column)] = letter
    return ["".join(row) for row in cells]
