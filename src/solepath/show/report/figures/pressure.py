"""Draws the load of the soles: maps with the path of the centre of pressure, and the force over a contact.

A contact is the time from heel-strike to toe-off."""

from __future__ import annotations

from collections.abc import Mapping
from math import dist, fsum
from statistics import median_high
from xml.etree.ElementTree import Element

from attrs import evolve

from ....types import Foot, Layout
from ....walk.soles import STATIONS, SoleLoads
from ...tables.svg import View, add, blend, colour_bar, line
from ..markup import figure, table, whole_sentences
from .axes import MARGIN_SHARE, Chart, write

SHADES = ("#fff7e0", "#fee0a0", "#fdbb6b", "#f98b4a", "#e8562f", "#c0241f", "#7d0b1e")
"""Colours from no load to the highest; a higher load is darker, also on a black-and-white printer."""
SOLE_WIDTH, SOLE_HEIGHT, SOLE_TOP = 150.0, 240.0, 31.0
"""Largest size of the drawing of a sole, and its place on the map, px."""
THIRDS = ("heel", "midfoot", "forefoot")
PATHS = "Line: mean path of the centre of pressure, from heel-strike (ring) on; thin: single strides."
STOOD = "No whole stride was walked: the loads are means over the whole recording."

Loads = dict[Foot, list[float]]
"""Load of each cell by foot."""


def pressure_figures(parent: Element, soles: Mapping[Foot, SoleLoads]) -> None:
    """Draw the maps and curves for which there is data."""
    pressed = {foot: soles[foot] for foot in Foot if foot in soles and soles[foot].samples}
    walked = {foot: sole for foot, sole in pressed.items() if sole.contacts}
    drawn = {foot: sole for foot, sole in (walked or pressed).items() if sole.drawable_layout}

    def means(sums: str, counts: str = "contacts") -> Loads:
        return {foot: [v / getattr(sole, counts) for v in getattr(sole, sums)] for foot, sole in drawn.items()}

    if walked:
        loads = means("mean_sums")
        _map(parent, "mean", "Mean load of a contact", drawn, loads, paths=True)
        _map(parent, "peak", "Peak load of a contact", drawn, means("peak_sums"))
        _forces(parent, walked)
    else:
        loads = means("cell_sums", "samples")
        _map(parent, "standing", "Mean load of the whole recording", drawn, loads)
        add(parent, "p", STOOD)
    _thirds(parent, drawn, loads)
    unknown = [foot.value for foot in walked or pressed if foot not in drawn]
    if unknown:
        words = f"{' and '.join(unknown)} sole{'s' * (len(unknown) > 1)}"
        add(parent, "p", f"Where the cells of the {words} lie is not known, so that no map can be drawn.")
    for foot in pressed:
        if walked and foot not in walked:
            add(parent, "p", f"No whole stride of the {foot} foot was measured with its pressure.")


def _unit(soles: Mapping[Foot, SoleLoads]) -> str:
    return " and ".join(sorted({sole.unit for sole in soles.values()}))


def _layout(sole: SoleLoads) -> Layout:
    assert sole.layout is not None, "only soles with a layout are drawn"
    return sole.layout


def radius(layout: Layout) -> float:
    """Return the radius of a drawn cell, m: most cells just touch; it is 2 to 20 mm."""
    places = [(cell.x, cell.y) for cell in layout.cells]
    nearest = [min([dist(a, b) for b in places if b is not a], default=0.02) for a in places]
    return min(max(0.55 * median_high(nearest), 0.002), 0.02)


def _map(
    parent: Element, name: str, title: str, soles: Mapping[Foot, SoleLoads], loads: Loads, *, paths: bool = False
) -> None:
    if not soles:
        return
    texts = []
    for foot, values in loads.items():
        most, layout = max(values), _layout(soles[foot])
        share = layout.cells[values.index(most)].x / max(layout.length, 1e-6)
        load = f"{most:.3g} {soles[foot].unit} a cell"
        texts.append(f"{foot}: highest {load}, at {100.0 * share:.0f} % of the length from the heel")
    notes = [*whole_sentences(texts), *([PATHS] if paths else [])]
    svg = figure(parent, f"pressure-{name}", title, f"{'; '.join(texts)}.", 316.0, *notes)
    highest = max([max(values) for values in loads.values()])
    for foot, sole in soles.items():
        _sole(svg, foot, sole, [load / highest if highest > 0.0 else 0.0 for load in loads[foot]], paths=paths)
    colour_bar(svg, SHADES, 50.0, 290.0, 180.0)
    write(svg, 44.0, 300.0, "0", "tick", "end")
    write(svg, 238.0, 300.0, f"{highest:.3g} {_unit(soles)} a cell", "tick", "start")


def _sole(svg: Element, foot: Foot, sole: SoleLoads, shares: list[float], *, paths: bool) -> None:
    """Draw a sole seen from above, with the toe up, and paths of the centre of pressure.

    `shares` are the loads relative to the highest load."""
    cells, r = _layout(sole).cells, radius(_layout(sole))
    view = View.fit([(-cell.y, cell.x) for cell in cells], SOLE_WIDTH, SOLE_HEIGHT, margin=r)
    middle = 110.0 if foot is Foot.LEFT else 290.0
    top = SOLE_TOP + 0.5 * (SOLE_HEIGHT - view.height)
    view = evolve(view, left=middle - 0.5 * view.width, top=top)
    write(svg, middle, 14.0, foot.value, "label")
    group = add(svg, "g", class_="cells")
    for cell, share in zip(cells, shares, strict=True):
        x, y = view.at((-cell.y, cell.x))
        add(group, "circle", cx=x, cy=y, r=r * view.scale, fill=blend(SHADES, share))
    if paths:
        single, mean = [[line([view.at((-y, x)) for x, y in path], "") for path in found if len(path) > 1]
                        for found in (sole.paths, [sole.mean_path])]  # fmt: skip
        for d, kind in ((single, "single"), (mean, "under"), (mean, "centre")):
            add(svg, "path", d=d, class_=kind)
        for x, y in sole.mean_path[:1]:
            a, b = view.at((-y, x))
            add(svg, "circle", cx=a, cy=b, r=4.0, class_="path-start")


def _forces(parent: Element, soles: Mapping[Foot, SoleLoads]) -> None:
    curves = {
        foot: [(100.0 * k / (STATIONS - 1), force / sole.contacts) for k, force in enumerate(sole.force_sums)]
        for foot, sole in soles.items()
    }
    highest = {foot: max([force for _, force in curve]) for foot, curve in curves.items()}
    what = "; ".join([f"{foot}: at most {most:.0f} {soles[foot].unit}" for foot, most in highest.items()])
    counts = ", ".join([f"{foot} {sole.contacts}" for foot, sole in soles.items()])
    ranges = (0.0, 100.0), (0.0, (1.0 + MARGIN_SHARE) * max(*highest.values(), 1.0))
    labels = ("% of the contact, from heel-strike to toe-off", f"sum of the cells, {_unit(soles)}")
    notes = f"Contacts: {counts}."
    Chart.of(parent, "force", "Mean force over a contact", f"{what}.", ranges, labels, notes).curves(curves)


def _thirds(parent: Element, soles: Mapping[Foot, SoleLoads], loads: Loads) -> None:
    """Add a table of the shares of the load, %, on the three thirds of the insole's length."""
    rows = []
    for foot, sole in soles.items():
        layout, sums = _layout(sole), [0.0] * len(THIRDS)
        for cell, load in zip(layout.cells, loads[foot], strict=True):
            sums[min(max(int(3.0 * cell.x / layout.length), 0), 2)] += load
        if (total := fsum(sums)) > 0.0:
            rows.append([foot.value, *[f"{100.0 * part / total:.0f} %" for part in sums]])
    if rows:
        table(parent, "Mean load by thirds of the length", ("foot", *THIRDS), rows, "numbers thirds")
