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

BAR_TOPS = (30.0, 66.0)
"""Upper edges of the bars, px."""
BAR_HEIGHT = 24.0
MIN_SHARE = 0.005
"""Share of the cycle below which a span is left out."""
MIN_LETTER_SHARE, MIN_WORD_SHARE, MIN_SWING_SHARE = 0.05, 0.09, 0.16
"""Shares of the cycle above which a span has room for the first letter of its name, for the name, and for a swing."""
HIDDEN = "The right foot is not shown: when it comes down against the left one is not known."

Spans = list[tuple[float, float]]


def spans(start: float, share: float) -> Spans:
    """Return the spans within [0, 1] of what starts at `start` and lasts for `share` of the cycle.

    What goes beyond the end of the cycle continues at its start."""
    start %= 1.0
    end = start + share
    return [(start, end)] if end <= 1.0 else [(0.0, end - 1.0), (start, 1.0)]


def stances(parameters: GaitParameters) -> dict[Foot, tuple[float, float]]:
    """Return start and share of the stance of each foot whose stance is known.

    The cycle starts with the heel-strike of the left foot, or of the right one if that is the only foot."""
    found = {}
    phases = {foot: figures.phase for foot, figures in parameters.feet.items()}
    for foot, figures in parameters.feet.items():
        share, start = figures.share("stance_time"), 0.0
        if foot is Foot.RIGHT and Foot.LEFT in phases:
            if (left := phases[Foot.LEFT]) is not None:
                start = left.mean
            elif (right := phases[Foot.RIGHT]) is not None:
                start = 1.0 - right.mean
            else:
                continue  # the time of its heel-strike relative to the left foot is not known
        if share is not None:
            found[foot] = start, min(max(share, 0.0), 1.0)
    return {foot: found[foot] for foot in Foot if foot in found}


def overlaps(feet: Sequence[Spans]) -> Spans:
    """Return the spans that two feet have in common; none for one foot."""
    common = [(max(a, c), min(b, d)) for (a, b), (c, d) in product(*feet)] if len(feet) == len(Foot) else []
    return sorted([(a, b) for a, b in common if b - a > MIN_SHARE])


def _percent(found: Spans) -> str:
    return f"{100.0 * sum([b - a for a, b in found]):.0f} %"


def cycle_figure(parent: Element, parameters: GaitParameters) -> None:
    """Draw a bar for each foot, double support and flight; nothing when no stance is known."""
    known = stances(parameters)
    if not known:
        return
    gait, first = "running" if parameters.running else "walking", next(iter(known))
    bars = {foot: (spans(start, share), spans(start + share, 1.0 - share)) for foot, (start, share) in known.items()}
    shaded = {
        "double": ("double support", overlaps([stance for stance, _ in bars.values()])),
        "flight": ("flight", overlaps([swing for _, swing in bars.values()])),
    }
    texts = [f"{foot} stance {_percent(stance)}" for foot, (stance, _) in bars.items()]
    texts += [f"{words} {_percent(found)}" for words, found in shaded.values() if found]
    notes = [", ".join(texts).capitalize() + ".", *([HIDDEN] if len(parameters.feet) > len(known) else [])]
    top, bottom = BAR_TOPS[0] - 8.0, BAR_TOPS[len(known) - 1] + BAR_HEIGHT + 8.0
    what = f"Shares of the cycle: {', '.join(texts)}."
    svg = figure(parent, f"cycle-{gait}", f"Mean gait cycle, {gait}", what, bottom + 42.0, *notes)
    x = AxisScale(0.0, 1.0, 50.0, 384.0)

    def draw(found: Spans, y: float, height: float, kind: str) -> None:
        for a, b in found:
            add(svg, "rect", class_=kind, x=x(a), width=x(b) - x(a), y=y, height=height)

    def label(span: tuple[float, float], y: float, words: str, kind: str = "tick") -> None:
        write(svg, x(0.5 * (span[0] + span[1])), y, words, kind)

    for kind, (_, found) in shaded.items():
        draw(found, top, bottom - top, kind)
        for a, b in found:
            if b - a > MIN_LETTER_SHARE:
                label((a, b), top - 4.0, kind if b - a > MIN_WORD_SHARE else kind[0])
    for (foot, (stance, swing)), y in zip(bars.items(), BAR_TOPS, strict=False):
        draw([(0.0, 1.0)], y, BAR_HEIGHT, "swing")
        draw(stance, y, BAR_HEIGHT, f"stance {foot}")
        write(svg, x.start - 6.0, y + 16.0, foot.value, "tick", "end")
        label(max(stance, key=_length), y + 16.0, f"stance {_percent(stance)}", "onbar")
        longest = max(swing, key=_length)
        if _length(longest) > MIN_SWING_SHARE:
            label(longest, y + 16.0, f"swing {_percent(swing)}")
    for k in range(6):
        add(svg, "path", d=("M", x(0.2 * k), bottom, "v4"), class_="axis")
        write(svg, x(0.2 * k), bottom + 16.0, str(20 * k), "tick")
    label((0.0, 1.0), bottom + 36.0, f"% of the gait cycle, from the {first} contact", "label")


def _length(span: tuple[float, float]) -> float:
    return span[1] - span[0]
