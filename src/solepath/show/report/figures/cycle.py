"""Draws the mean gait cycle: when each foot is on the ground, from 0 to 100 % of the cycle."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....body.gait.means import GaitParameters
from ....types import Foot
from ...tables.plan import px
from ..markup import add, figure
from .axes import AxisScale, drawing, write

BAR_TOPS = (30.0, 66.0)
"""Upper edges of the bars, px."""
BAR_HEIGHT = 24.0
MIN_SHARE = 0.005
"""Share of the cycle below which a span is left out."""


def spans(start: float, share: float) -> list[tuple[float, float]]:
    """Return where within [0, 1] a contact is, wrapped round.

    It starts at `start` and lasts for `share` of the cycle."""
    start %= 1.0
    end = start + min(max(share, 0.0), 1.0)
    return [(start, end)] if end <= 1.0 else [(0.0, end - 1.0), (start, 1.0)]


def contacts(parameters: GaitParameters) -> dict[Foot, list[tuple[float, float]]]:
    """Return the contacts of each foot whose stance is known, as shares of the cycle.

    The cycle starts with the left foot's contact, or with the right one's when that is the only one."""
    stance = {foot: one.share("stance_time") for foot, one in parameters.feet.items()}
    starts = {foot: 0.0 for foot in stance}
    left, right = parameters.feet.get(Foot.LEFT), parameters.feet.get(Foot.RIGHT)
    if left is not None and right is not None:
        if left.phase is not None:
            starts[Foot.RIGHT] = left.phase.mean
        elif right.phase is not None:
            starts[Foot.RIGHT] = 1.0 - right.phase.mean
        else:
            del stance[Foot.RIGHT]  # its contact time relative to the left foot is not known
    return {foot: spans(starts[foot], share) for foot, share in stance.items() if share is not None}


def overlaps(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the spans that both have in common."""
    both = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return sorted([(a, b) for a, b in both if b - a > MIN_SHARE])


def neither(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the spans that neither has: both feet are in the air."""
    free, last = [], 0.0
    for a, b in [*sorted(one + other), (1.0, 1.0)]:
        if a > last:
            free.append((last, a))
        last = max(last, b)
    return [(a, b) for a, b in free if b - a > MIN_SHARE]


def cycle_figure(parent: Element, parameters: GaitParameters) -> bool:
    """Draw bars of both feet; return False when no stance is known."""
    known = contacts(parameters)
    if not known:
        return False
    how = "running" if parameters.running else "walking"
    feet = [foot for foot in Foot if foot in known]
    parts = [f"{foot} stance {100.0 * sum([b - a for a, b in known[foot]]):.0f} %" for foot in feet]
    both = overlaps(*[known[foot] for foot in feet]) if len(feet) == 2 else []
    flights = neither(*[known[foot] for foot in feet]) if len(feet) == 2 else []
    parts += [f"double support {100.0 * sum([b - a for a, b in both]):.0f} %"] if len(feet) == 2 and both else []
    parts += [f"flight {100.0 * sum([b - a for a, b in flights]):.0f} %"] if flights else []
    bars = dict(zip(feet, BAR_TOPS, strict=False))
    x = AxisScale(0.0, 1.0, 44.0, 388.0)
    top, bottom = bars[feet[0]] - 8.0, bars[feet[-1]] + BAR_HEIGHT + 8.0
    what = f"Shares of the cycle: {', '.join(parts)}."
    svg = drawing(f"cycle-{how}", f"Mean gait cycle, {how}", what, bottom + 38.0)
    for shaded, kind, word in ((both, "double", "double"), (flights, "flight", "flight")):
        for a, b in shaded:
            size = {"x": px(x.at(a)), "width": px(x.at(b) - x.at(a)), "y": px(top), "height": px(bottom - top)}
            add(svg, "rect", class_=kind, **size)
            if b - a > 0.05:
                write(svg, 0.5 * (x.at(a) + x.at(b)), top - 4.0, word if b - a > 0.09 else word[0], "tick", "middle")
    for foot in feet:
        y = bars[foot]
        add(svg, "rect", class_="swing", x=px(x.start), y=px(y), width=px(x.end - x.start), height=px(BAR_HEIGHT))
        write(svg, x.start - 6.0, y + 16.0, foot.value, "tick", "end")
        stood = known[foot]
        for a, b in stood:
            left, wide = x.at(a), x.at(b) - x.at(a)
            add(svg, "rect", class_=f"stance {foot}", x=px(left), y=px(y), width=px(wide), height=px(BAR_HEIGHT))
        a, b = max(stood, key=lambda span: span[1] - span[0])
        share = sum([d - c for c, d in stood])
        write(svg, 0.5 * (x.at(a) + x.at(b)), y + 16.0, f"stance {100.0 * share:.0f} %", "onbar", "middle")
        c, d = max(neither(stood, []), key=lambda span: span[1] - span[0], default=(0.0, 0.0))
        if d - c > 0.16:
            write(svg, 0.5 * (x.at(c) + x.at(d)), y + 16.0, f"swing {100.0 * (1.0 - share):.0f} %", "tick", "middle")
    grid = []
    for k in range(6):
        at = x.at(0.2 * k)
        grid.append(f"M{px(at)} {px(bottom)}v4")
        write(svg, at, bottom + 16.0, str(20 * k), "tick", "middle")
    add(svg, "path", d="".join(grid), class_="axis")
    words = f"% of the gait cycle, from the {feet[0].value} contact"
    write(svg, 0.5 * (x.start + x.end), bottom + 31.0, words, "label", "middle")
    notes = [", ".join(parts).capitalize() + "."]
    if len(parameters.feet) == 2 and len(feet) == 1:
        notes.append("The right foot is not shown: when it comes down against the left one is not known.")
    figure(parent, svg, f"Mean gait cycle, {how}", *notes)
    return True
