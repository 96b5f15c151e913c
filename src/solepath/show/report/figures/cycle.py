"""Draws the mean gait cycle: the stance of each foot, from 0 to 100 % of the cycle.

A span is (start, end) as shares of the cycle. Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from xml.etree.ElementTree import Element

from ....body.gait.means import GaitParameters
from ....types import Foot
from ...tables.svg import AxisScale, add
from ..markup import figure
from .axes import write

TOP, ROW_HEIGHT, BAR_HEIGHT = 14.0, 36.0, 24.0
"""Upper edge of the first bar, height of the row of a foot, and of its bar, px."""
MIN_SHARE = 0.005
"""Share of the cycle below which a span is left out."""
HIDDEN = "The right foot is not shown: when it comes down against the left one is not known."
BAR = "<rect class='{}' x='{}' y='{}' width='{}' height='{}'/>"

Spans = list[tuple[float, float]]


def spans(start: float, share: float) -> Spans:
    """Return the spans within [0, 1] of what starts at `start` and lasts for `share` of the cycle.

    What goes beyond the end of the cycle continues at its start."""
    start %= 1.0
    end = start + min(max(share, 0.0), 1.0)
    return [(start, end)] if end <= 1.0 else [(0.0, end - 1.0), (start, 1.0)]


def starts(parameters: GaitParameters) -> dict[Foot, float]:
    """Return the start of the stance of each foot for which it is known, as a share of the cycle.

    The cycle starts with the heel-strike of the left foot, or of the right one if that is the only foot."""
    phases = {foot: parameters.feet[foot].phase for foot in Foot if foot in parameters.feet}
    found = dict.fromkeys(list(phases)[:1], 0.0)
    if len(phases) == len(Foot):
        left, right = phases.values()
        if left is not None:
            found[Foot.RIGHT] = left.mean
        elif right is not None:
            found[Foot.RIGHT] = 1.0 - right.mean
    return found


def overlaps(feet: Sequence[Spans]) -> Spans:
    """Return the spans that two feet have in common; none for one foot."""
    common = [(max(a, c), min(b, d)) for (a, b), (c, d) in product(*feet)] if len(feet) == len(Foot) else []
    return [(a, b) for a, b in common if b - a > MIN_SHARE]


def _percent(found: Spans) -> str:
    return f"{100.0 * sum([b - a for a, b in found]):.0f} %"


def cycle_figure(parent: Element, parameters: GaitParameters) -> None:
    """Draw a bar for each foot, double support and flight; nothing when no stance is known."""
    stances, swings = {}, {}
    for foot, start in starts(parameters).items():
        if (share := parameters.feet[foot].share("stance_time")) is not None:
            stances[foot], swings[foot] = spans(start, share), spans(start + share, 1.0 - share)
    if not stances:
        return
    both = {"double support": overlaps(list(stances.values())), "flight": overlaps(list(swings.values()))}
    texts = [f"{foot} stance {_percent(stance)}" for foot, stance in stances.items()]
    texts += [f"{words} {_percent(found)}" for words, found in both.items() if found]
    notes = [", ".join(texts).capitalize() + ".", *([HIDDEN] if len(parameters.feet) > len(stances) else [])]
    gait, bottom = "running" if parameters.running else "walking", TOP + ROW_HEIGHT * len(stances)
    what = f"Shares of the cycle: {', '.join(texts)}."
    svg = figure(parent, f"cycle-{gait}", f"Mean gait cycle, {gait}", what, bottom + 42.0, *notes)
    x = AxisScale(0.0, 1.0, 50.0, 384.0)

    def draw(kind: str, found: Spans, y: float, height: float) -> None:
        for a, b in found:
            add(svg, BAR, kind, x(a), y, x(b) - x(a), height)

    for words, found in both.items():
        draw(words.split()[0], found, TOP - 8.0, bottom - TOP + 4.0)
    for k, (foot, stance) in enumerate(stances.items()):
        y = TOP + ROW_HEIGHT * k
        draw("swing", [(0.0, 1.0)], y, BAR_HEIGHT)
        draw(f"stance {foot}", stance, y, BAR_HEIGHT)
        write(svg, x.start - 6.0, y + 16.0, foot.value, "tick", "end")
        a, b = max(stance, key=lambda span: span[1] - span[0])
        write(svg, x(0.5 * (a + b)), y + 16.0, f"stance {_percent(stance)}", "onbar")
    for k in range(6):
        add(svg, "<path d='M{} {}v4' class='axis'/>", x(0.2 * k), bottom)
        write(svg, x(0.2 * k), bottom + 16.0, str(20 * k), "tick")
    words = f"% of the gait cycle, from the {next(iter(stances))} contact"
    write(svg, x(0.5), bottom + 36.0, words, "label")
