"""What became known of the place on a floor plan, in words."""

from __future__ import annotations

from ...events import Placed
from ...recording import printable
from ..places import MOST, PlaceCounts
from .table import number


def place_lines(counts: PlaceCounts) -> list[str]:
    """A line for each thing that is to be said of a whole recording."""
    lines = []
    if counts.found is not None:
        strides, t = counts.found
        share = f"; one place for {counts.decided} of {counts.places} steps"
        lines.append(f"place: found after {strides} step{'s' * (strides != 1)}, at {number(t, 1)} s{share}")
    else:
        lines.append(f"place: not found; {counts.places} steps with several candidates")
    if counts.last is not None:
        x, y, _ = counts.last.position
        at = f"({number(x, 1)}, {number(y, 1)}) m"
        several = len(counts.last.candidates)
        doubt = f", one of {several} candidates" if several > 1 else f", within {number(counts.last.spread, 1)} m"
        lines.append(f"at the end: level {printable(counts.last.level)}, {at}{doubt}")
    if counts.levels:
        levels = ", ".join([f"{printable(name)} from {number(t, 1)} s" for t, name in counts.levels])
        more = counts.changes - MOST
        lines.append(f"levels: {levels}{f' and {more} more' if more > 0 else ''}")
    lines += [f"from {number(t, 1)} s without a place: {printable(what)}" for t, what in counts.lost]
    if counts.losses > MOST:
        lines.append(f"and {counts.losses - MOST} times more")
    return lines


def here(place: Placed) -> str:
    """Where the wearer is now, in a line."""
    x, y, _ = place.position
    several = len(place.candidates)
    at = f"place: level {printable(place.level)}, ({number(x, 1)}, {number(y, 1)}) m"
    if several == 1:
        return f"{at}, within {number(place.spread, 1)} m"
    return f"{at}, {100.0 * place.candidates[0].weight:.0f} % sure, one of {several} candidates"
