"""The centre of the foot along the insole."""

from __future__ import annotations

from ...types import Layout


def centre(layout: Layout) -> float | None:
    """x half-way between the first and the last cell, foot frame, m; None without cells.

    "Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal
    6, 2019: of cells from 34 to 166 mm the centre is at 100 mm, and there the centre of pressure is taken to be while
    the foot is in the air."""
    xs = [cell.x for cell in layout.cells]
    return 0.5 * (min(xs) + max(xs)) if xs else None
