"""Draws the load of the soles: maps with the path of the centre of pressure, and the force over a contact.

A contact is the time from heel-strike to toe-off."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import dist
from statistics import median_high
from xml.etree.ElementTree import Element

from attrs import evolve

from ....types import Foot, Layout
from ....walk.soles import STATIONS, SoleLoads
from ...tables.svg import View, add, colour_bar, line, shade, write
from ..markup import figure, paragraph, whole_sentences
from .axes import HEAD, MARGIN_SHARE, PATH, Chart

SHADES = ("#fff7e0", "#fee0a0", "#fdbb6b", "#f98b4a", "#e8562f", "#c0241f", "#7d0b1e")
"""Colours from no load to the highest; a higher load is darker, also on a black-and-white printer."""
SOLE_WIDTH, SOLE_HEIGHT, SOLE_TOP = 150.0, 240.0, 31.0
"""Largest size of the drawing of a sole, and its place on the map, px."""
PATHS = "Line: mean path of the centre of pressure, from heel-strike (ring) on; thin: single strides."
STOOD = "No whole stride was walked: the loads are means over the whole recording."

Loads = Mapping[Foot, Sequence[float]]
"""Load of each cell by foot."""
Drawn = Mapping[Foot, tuple[SoleLoads, Layout]]
"""Soles of which the places of the cells are known."""


def pressure_figures(parent: Element, soles: Mapping[Foot, SoleLoads]) -> None:
    """Draw the maps and curves for which there is data."""
    pressed = {foot: soles[foot] for foot in Foot if foot in soles and soles[foot].samples}
    walked = {foot: sole for foot, sole in pressed.items() if sole.contacts}
    shown = walked or pressed
    drawn = {foot: (sole, layout) for foot, sole in shown.items() if (layout := sole.drawable_layout) is not None}

    def means(sums: str, count: str) -> Loads:
        found = {foot: (getattr(sole, sums), getattr(sole, count)) for foot, (sole, _) in drawn.items()}
        return {foot: [load / n for load in loads] for foot, (loads, n) in found.items()}

    if walked:
        _map(parent, "mean", "Mean load of a contact", drawn, means("mean_sums", "contacts"), paths=True)
        _map(parent, "peak", "Peak load of a contact", drawn, means("peak_sums", "contacts"))
        _forces(parent, walked)
    else:
        _map(parent, "standing", "Mean load of the whole recording", drawn, means("cell_sums", "samples"))
        paragraph(parent, STOOD)
    for foot in pressed:
        if foot not in shown:
            paragraph(parent, f"No whole stride of the {foot} foot was measured with its pressure.")
        elif foot not in drawn:
            paragraph(parent, f"Where the cells of the {foot} sole lie is not known, so that no map can be drawn.")


def _unit(soles: Iterable[SoleLoads]) -> str:
    return " and ".join(sorted({sole.unit for sole in soles}))


def radius(layout: Layout) -> float:
    """Return the radius of a drawn cell, m: most cells just touch; it is 2 to 20 mm."""
    places = [(cell.x, cell.y) for cell in layout.cells]
    nearest = [min([dist(a, b) for b in places if b is not a], default=0.02) for a in places]
    return min(max(0.55 * median_high(nearest), 0.002), 0.02)


def _map(parent: Element, name: str, title: str, drawn: Drawn, loads: Loads, *, paths: bool = False) -> None:
    texts = []
    for foot, (sole, layout) in drawn.items():
        most = max(loads[foot])
        share = layout.cells[loads[foot].index(most)].x / max(layout.length, 1e-6)
        place = f"at {100.0 * share:.0f} % of the length from the heel"
        texts.append(f"{foot}: highest {most:.3g} {sole.unit} a cell, {place}")
    if not texts:
        return
    notes = [*whole_sentences(texts), *([PATHS] if paths else [])]
    svg = figure(parent, f"pressure-{name}", title, f"{'; '.join(texts)}.", 316.0, *notes)
    highest = max([max(values) for values in loads.values()])
    for foot, (sole, layout) in drawn.items():
        r = radius(layout)
        view = View.fit([(-cell.y, cell.x) for cell in layout.cells], SOLE_WIDTH, SOLE_HEIGHT, margin=r)
        middle = 110.0 if foot is Foot.LEFT else 290.0
        top = SOLE_TOP + 0.5 * (SOLE_HEIGHT - view.height)
        view = evolve(view, left=middle - 0.5 * view.width, top=top)
        write(svg, middle, HEAD, foot.value, "label")
        for cell, load in zip(layout.cells, loads[foot], strict=True):
            disc = "<circle cx='{}' cy='{}' r='{}' fill='{}' class='cells'/>"
            add(svg, disc, *view.at((-cell.y, cell.x)), r * view.scale, shade(SHADES, load / (highest or 1.0)))
        if paths:
            _draw_paths(svg, sole, view)
    colour_bar(svg, SHADES, 50.0, 290.0, 180.0)
    write(svg, 44.0, 300.0, "0", "tick", "end")
    unit = _unit([sole for sole, _ in drawn.values()])
    write(svg, 238.0, 300.0, f"{highest:.3g} {unit} a cell", "tick", "start")


def _draw_paths(svg: Element, sole: SoleLoads, view: View) -> None:
    """Draw the paths of the centre of pressure."""
    mean = [sole.mean_path]
    for kind, found in (("single", sole.paths), ("under", mean), ("centre", mean)):
        for path in found:
            if len(path) > 1:
                add(svg, PATH, line([view.at((-y, x)) for x, y in path], ""), kind)
    for x, y in sole.mean_path[:1]:
        add(svg, "<circle cx='{}' cy='{}' r='4' class='path-start'/>", *view.at((-y, x)))


def _forces(parent: Element, soles: Mapping[Foot, SoleLoads]) -> None:
    curves, texts = {}, []
    for foot, sole in soles.items():
        forces = [force / sole.contacts for force in sole.force_sums]
        curves[foot] = [(100.0 * k / (STATIONS - 1), force) for k, force in enumerate(forces)]
        texts.append(f"{foot}: at most {max(forces):.0f} {sole.unit}")
    highest = max([force for curve in curves.values() for _, force in curve])
    y = 0.0, (1.0 + MARGIN_SHARE) * max(highest, 1.0)
    labels = ("% of stance, heel-strike to toe-off", f"sum of the cells, {_unit(soles.values())}")
    note = f"Contacts: {', '.join([f'{foot} {sole.contacts}' for foot, sole in soles.items()])}."
    what = f"{'; '.join(texts)}."
    Chart.of(parent, "force", "Mean force over a contact", what, (0.0, 100.0), y, labels, note).curves(curves)
