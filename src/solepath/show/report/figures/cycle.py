"""Draws the mean gait cycle: the stance of each foot, from 0 to 100 % of the cycle. Sizes were chosen by hand."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....body.gait.means import GaitParameters
from ....types import Foot
from ...tables.svg import AxisScale, add, ticks
from ..markup import figure
from .axes import grid, write

TOP, ROW_HEIGHT, BAR_HEIGHT = 8.0, 36.0, 24.0
"""Upper edge of the first bar, height of the row of a foot, and of its bar, px."""
HIDDEN = "The right foot is not shown: when it comes down against the left one is not known."
BAR = "<rect class='{}' x='{}' y='{}' width='{}' height='{}'/>"


def stances(parameters: GaitParameters) -> dict[Foot, tuple[float, float]]:
    """Return start and duration of the stance of each foot for which they are known, in percent of the cycle.

    The cycle starts with the heel-strike of the left foot, or of the right one if that is the only foot."""
    found = {}
    for foot in [foot for foot in Foot if foot in parameters.feet]:
        figures, start = parameters.feet[foot], 0.0
        share = figures.share("stance_time")
        if foot is Foot.RIGHT and (left := parameters.feet.get(Foot.LEFT)) is not None:
            if left.phase is not None:
                start = left.phase.mean
            elif figures.phase is not None:
                start = -figures.phase.mean
            else:
                continue
        if share is not None:
            found[foot] = 100.0 * (start % 1.0), 100.0 * share
    return found


def cycle_figure(parent: Element, parameters: GaitParameters) -> None:
    """Draw a bar for each foot; nothing when no stance is known."""
    known = stances(parameters)
    if not known:
        return
    gait, bottom = "running" if parameters.running else "walking", TOP + ROW_HEIGHT * len(known)
    words = ", ".join([f"{foot} stance {share:.0f} %" for foot, (_, share) in known.items()])
    notes = [f"{words.capitalize()}.", *([HIDDEN] if len(parameters.feet) > len(known) else [])]
    what = f"Shares of the cycle: {words}."
    svg = figure(parent, f"cycle-{gait}", f"Mean gait cycle, {gait}", what, bottom + 42.0, *notes)
    x = AxisScale(0.0, 100.0, 50.0, 384.0)
    grid(svg, x, AxisScale(0.0, 1.0, bottom, TOP), ticks(0.0, 100.0), {})
    for k, (foot, (start, share)) in enumerate(known.items()):
        y = TOP + ROW_HEIGHT * k
        add(svg, BAR, "swing", x.start, y, x.end - x.start, BAR_HEIGHT)
        # what goes beyond the end of the cycle continues at its start
        pieces = [(start, min(start + share, 100.0)), (0.0, max(start + share - 100.0, 0.0))]
        for left, right in pieces:
            add(svg, BAR, f"stance {foot}", x(left), y, x(right) - x(left), BAR_HEIGHT)
        left, right = max(pieces, key=lambda piece: piece[1] - piece[0])
        write(svg, x(0.5 * (left + right)), y + 16.0, f"stance {share:.0f} %", "onbar")
        write(svg, x.start - 6.0, y + 16.0, foot.value, "tick", "end")
    write(svg, x(50.0), bottom + 36.0, f"% of the gait cycle, from the {next(iter(known))} contact", "label")
