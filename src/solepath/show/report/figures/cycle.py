"""Draws the mean gait cycle: the stance of each foot, from 0 to 100 % of the cycle.

A span is (start, end) as shares of the cycle. Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....body.gait.means import GaitParameters
from ....types import Foot
from ...tables.svg import px
from ..markup import add, figure
from .axes import AxisScale, drawing, write

BAR_TOPS = (30.0, 66.0)
"""Upper edges of the bars, px."""
BAR_HEIGHT = 24.0
MIN_SHARE = 0.005
"""Share of the cycle below which a span is left out."""
MIN_LETTER_SHARE, MIN_WORD_SHARE, MIN_SWING_SHARE = 0.05, 0.09, 0.16
"""Shares of the cycle above which a span has room for the first letter of its name, for the name, and for a swing."""


def spans(start: float, share: float) -> list[tuple[float, float]]:
    """Return the spans within [0, 1] of a stance that starts at `start` and lasts for `share` of the cycle.

    A stance that goes beyond the end of the cycle continues at its start."""
    start %= 1.0
    end = start + min(max(share, 0.0), 1.0)
    return [(start, end)] if end <= 1.0 else [(0.0, end - 1.0), (start, 1.0)]


def stance_spans(parameters: GaitParameters) -> dict[Foot, list[tuple[float, float]]]:
    """Return the spans of stance of each foot whose stance is known.

    The cycle starts with the heel-strike of the left foot, or of the right one if that is the only foot."""
    stance = {foot: figures.share("stance_time") for foot, figures in parameters.feet.items()}
    starts = {foot: 0.0 for foot in stance}
    left, right = parameters.feet.get(Foot.LEFT), parameters.feet.get(Foot.RIGHT)
    if left is not None and right is not None:
        if left.phase is not None:
            starts[Foot.RIGHT] = left.phase.mean
        elif right.phase is not None:
            starts[Foot.RIGHT] = 1.0 - right.phase.mean
        else:
            del stance[Foot.RIGHT]  # the time of its heel-strike relative to the left foot is not known
    return {foot: spans(starts[foot], share) for foot, share in stance.items() if share is not None}


def overlaps(left: list[tuple[float, float]], right: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the spans in which both feet are on the ground."""
    common = [(max(a, c), min(b, d)) for a, b in left for c, d in right]
    return sorted([(a, b) for a, b in common if b - a > MIN_SHARE])


def gaps(left: list[tuple[float, float]], right: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the spans in which both feet are in the air."""
    in_air, last_end = [], 0.0
    for start, end in [*sorted(left + right), (1.0, 1.0)]:
        if start > last_end:
            in_air.append((last_end, start))
        last_end = max(last_end, end)
    return [(start, end) for start, end in in_air if end - start > MIN_SHARE]


def cycle_figure(parent: Element, parameters: GaitParameters) -> bool:
    """Draw a bar for each foot, double support and flight; return False when no stance is known."""
    stances = stance_spans(parameters)
    if not stances:
        return False
    gait = "running" if parameters.running else "walking"
    feet = [foot for foot in Foot if foot in stances]
    texts = [f"{foot} stance {100.0 * sum([b - a for a, b in stances[foot]]):.0f} %" for foot in feet]
    double = overlaps(*[stances[foot] for foot in feet]) if len(feet) == 2 else []
    flights = gaps(*[stances[foot] for foot in feet]) if len(feet) == 2 else []
    texts += [f"double support {100.0 * sum([b - a for a, b in double]):.0f} %"] if len(feet) == 2 and double else []
    texts += [f"flight {100.0 * sum([b - a for a, b in flights]):.0f} %"] if flights else []
    bars = dict(zip(feet, BAR_TOPS, strict=False))
    x = AxisScale(0.0, 1.0, 50.0, 384.0)
    top, bottom = bars[feet[0]] - 8.0, bars[feet[-1]] + BAR_HEIGHT + 8.0
    description = f"Shares of the cycle: {', '.join(texts)}."
    svg = drawing(f"cycle-{gait}", f"Mean gait cycle, {gait}", description, bottom + 42.0)
    for shaded, kind, word in ((double, "double", "double"), (flights, "flight", "flight")):
        for a, b in shaded:
            size = {"x": px(x.at(a)), "width": px(x.at(b) - x.at(a)), "y": px(top), "height": px(bottom - top)}
            add(svg, "rect", class_=kind, **size)
            if b - a > MIN_LETTER_SHARE:
                text = word if b - a > MIN_WORD_SHARE else word[0]
                write(svg, 0.5 * (x.at(a) + x.at(b)), top - 4.0, text, "tick", "middle")
    for foot in feet:
        y = bars[foot]
        add(svg, "rect", class_="swing", x=px(x.start), y=px(y), width=px(x.end - x.start), height=px(BAR_HEIGHT))
        write(svg, x.start - 6.0, y + 16.0, foot.value, "tick", "end")
        stance = stances[foot]
        for a, b in stance:
            left, width = x.at(a), x.at(b) - x.at(a)
            add(svg, "rect", class_=f"stance {foot}", x=px(left), y=px(y), width=px(width), height=px(BAR_HEIGHT))
        a, b = max(stance, key=lambda span: span[1] - span[0])
        share = sum([d - c for c, d in stance])
        write(svg, 0.5 * (x.at(a) + x.at(b)), y + 16.0, f"stance {100.0 * share:.0f} %", "onbar", "middle")
        c, d = max(gaps(stance, []), key=lambda span: span[1] - span[0], default=(0.0, 0.0))
        if d - c > MIN_SWING_SHARE:
            write(svg, 0.5 * (x.at(c) + x.at(d)), y + 16.0, f"swing {100.0 * (1.0 - share):.0f} %", "tick", "middle")
    tick_lines = []
    for k in range(6):
        tick_x = x.at(0.2 * k)
        tick_lines.append(f"M{px(tick_x)} {px(bottom)}v4")
        write(svg, tick_x, bottom + 16.0, str(20 * k), "tick", "middle")
    add(svg, "path", d="".join(tick_lines), class_="axis")
    words = f"% of the gait cycle, from the {feet[0].value} contact"
    write(svg, 0.5 * (x.start + x.end), bottom + 36.0, words, "label", "middle")
    notes = [", ".join(texts).capitalize() + "."]
    if len(parameters.feet) == 2 and len(feet) == 1:
        notes.append("The right foot is not shown: when it comes down against the left one is not known.")
    figure(parent, svg, f"Mean gait cycle, {gait}", *notes)
    return True
