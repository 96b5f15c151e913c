"""Stride length, stride time and speed of each foot over time."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from attrs import frozen

from ..events import StrideMeasured
from ..types import Foot
from .axes import TOP, Chart, around, drawing, px, write
from .clock import Clock
from .markup import add, figure

HEIGHT = 190.0
DISC, CROSS = "h0", "m-2.6-2.6l5.2 5.2m0-5.2l-5.2 5.2"
"""The left foot's mark and the right one's: told apart without colours too."""
SHAPES = {Foot.LEFT: DISC, Foot.RIGHT: CROSS}
TURNED = 0.35
"""rad: a stride that turns by more is marked as one in a turn (20 degrees)."""


@frozen
class Stride:
    """What is drawn of one. Times in s, length in m, speed in m/s."""

    t: float
    time: float
    length: float | None
    speed: float | None
    steady: bool
    degraded: bool
    turns: bool

    @classmethod
    def of(cls, event: StrideMeasured) -> Stride:
        turns = event.turning_angle is not None and abs(event.turning_angle) > TURNED
        return cls(
            event.t, event.stride_time, event.stride_length, event.speed, event.steady, event.degraded, turns
        )


PANELS = (("length", "Stride length", "m", 0.2), ("time", "Stride time", "s", 0.2), ("speed", "Speed", "m/s", 0.2))


def stride_figures(parent: Element, strides: dict[Foot, list[Stride]], clock: Clock) -> bool:
    """A chart for each of the three; False where there are no strides."""
    if not any(strides.values()):
        return False
    for name, title, unit, least in PANELS:
        known = {
            foot: [(one, getattr(one, name)) for one in some if getattr(one, name) is not None]
            for foot, some in strides.items()
        }
        if any(known.values()):
            _panel(parent, name, title, unit, least, known, clock)
    return True


def _panel(
    parent: Element,
    name: str,
    title: str,
    unit: str,
    least: float,
    known: dict[Foot, list[tuple[Stride, float]]],
    clock: Clock,
) -> None:
    values = [value for some in known.values() for _, value in some]
    what = f"{title} of every stride over time: {len(values)} strides, {min(values):.2f} to {max(values):.2f} {unit}."
    svg = drawing(f"stride-{name}", f"{title} over time", what, HEIGHT)
    chart = Chart.of(svg, clock.span, around(values, least=least), (clock.label, f"{title.lower()}, {unit}"), HEIGHT)
    for foot, some in known.items():
        for counted in (False, True):
            points = [(clock.of(one.t), value) for one, value in some if one.steady is counted]
            chart.marks(points, SHAPES[foot], f"mark {foot.value}{'' if counted else ' faint'}")
    every = [pair for some in known.values() for pair in some]
    turning = [clock.of(one.t) for one, _ in every if one.turns]
    if turning:
        bottom = chart.y.start
        add(svg, "path", class_="turn", d="".join([f"M{px(chart.x.at(t))} {px(bottom)}v-7" for t in turning]))
    degraded = [clock.of(one.t) for one, _ in every if one.degraded]
    if degraded:
        add(svg, "path", class_="missing", d="".join([f"M{px(chart.x.at(t))} {px(chart.y.end)}v5" for t in degraded]))
    legend(svg, [foot for foot in Foot if known.get(foot)], bool(turning), bool(degraded))
    notes = ["Faint: strides that do not count in the table."]
    figure(parent, svg, f"{title} over time", *notes)


def legend(svg: Element, feet: Sequence[Foot], turning: bool = False, degraded: bool = False) -> None:
    """What the marks mean, at the right above a chart."""
    x, y = 390.0, TOP - 12.0
    entries: list[tuple[str, str, str]] = []
    if turning:
        entries.append(("in a turn (below)", "m0 3.5v-7", "turn"))
    if degraded:
        entries.append(("samples missing (above)", "m0 2.5v-5", "missing"))
    entries += [(foot.value, SHAPES[foot], f"mark {foot.value}") for foot in reversed(feet)]
    for words, shape, kind in entries:
        write(svg, x, y, words, "tick", "end")
        x -= 5.6 * len(words) + 9.0
        add(svg, "path", class_=kind, d=f"M{px(x)} {px(y - 4.0)}{shape}")
        x -= 9.0
