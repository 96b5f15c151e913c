"""Draws the load of the soles: maps with the path of the centre of pressure, and the force over a contact.

A contact is the time from heel-strike to toe-off."""

from __future__ import annotations

from math import fsum, hypot
from xml.etree.ElementTree import Element

from ....types import Foot, Layout
from ....walk.soles import STATIONS, SoleLoads
from ...tables.plan import blend
from ...tables.svg import px
from ..markup import add, figure, table
from .axes import Chart, drawing, line, padded_range, write
from .stride import legend

SHADES = ("#fff7e0", "#fee0a0", "#fdbb6b", "#f98b4a", "#e8562f", "#c0241f", "#7d0b1e")
"""Colours from no load to the highest; a higher load is darker, also on a black-and-white printer."""
SOLE_HEIGHT = 250.0
"""Height of the drawing of a sole, px."""
THIRDS = ("heel", "midfoot", "forefoot")


def pressure_figures(parent: Element, soles: dict[Foot, SoleLoads]) -> bool:
    """Draw the maps and curves for which there is data; return False when there is no pressure."""
    pressed = {foot: soles[foot] for foot in Foot if foot in soles and soles[foot].samples}
    if not pressed:
        return False
    walked = {foot: sole for foot, sole in pressed.items() if sole.contacts}
    if walked:
        maps = {foot: layout for foot, sole in walked.items() if (layout := sole.drawable_layout)}
        means = {foot: [v / walked[foot].contacts for v in walked[foot].mean_sums] for foot in maps}
        peaks = {foot: [v / walked[foot].contacts for v in walked[foot].peak_sums] for foot in maps}
        _map(parent, "mean", "Mean load of a contact", walked, maps, means, paths=True)
        _map(parent, "peak", "Peak load of a contact", walked, maps, peaks, paths=False)
        _forces(parent, walked)
    else:
        maps = {foot: layout for foot, sole in pressed.items() if (layout := sole.drawable_layout)}
        means = {foot: [v / pressed[foot].samples for v in pressed[foot].cell_sums] for foot in maps}
        _map(parent, "standing", "Mean load of the whole recording", pressed, maps, means, paths=False)
        add(parent, "p", "No whole stride was walked: the loads are means over the whole recording.")
    if maps:
        _thirds(parent, maps, means)
    unknown = [foot.value for foot in pressed if foot not in maps and (not walked or foot in walked)]
    if unknown:
        words = f"{' and '.join(unknown)} sole{'s' * (len(unknown) > 1)}"
        add(parent, "p", f"Where the cells of the {words} lie is not known, so that no map can be drawn.")
    for foot in pressed:
        if walked and foot not in walked:
            add(parent, "p", f"No whole stride of the {foot} foot was measured with its pressure.")
    return True


def _unit(soles: dict[Foot, SoleLoads]) -> str:
    return " and ".join(sorted({sole.unit for sole in soles.values()}))


def radius(layout: Layout) -> float:
    """Return the radius of a drawn cell, m: most cells just touch; it is 2 to 20 mm."""
    places = [(cell.x, cell.y) for cell in layout.cells]
    if len(places) < 2:
        return 0.01
    nearest = sorted([
        min([hypot(x - a, y - b) for k, (a, b) in enumerate(places) if k != i]) for i, (x, y) in enumerate(places)
    ])  # fmt: skip
    return min(max(0.55 * nearest[len(nearest) // 2], 0.002), 0.02)


def _map(
    parent: Element,
    name: str,
    title: str,
    soles: dict[Foot, SoleLoads],
    maps: dict[Foot, Layout],
    loads: dict[Foot, list[float]],
    *,
    paths: bool,
) -> None:
    if not maps:
        return
    highest = max([max(values) for values in loads.values()])
    unit = _unit({foot: soles[foot] for foot in maps})
    texts = []
    for foot, values in loads.items():
        k = max(range(len(values)), key=values.__getitem__)
        x = maps[foot].cells[k].x / max(maps[foot].length, 1e-6)
        load = f"{values[k]:.3g} {soles[foot].unit} a cell"
        texts.append(f"{foot}: highest {load}, at {100.0 * x:.0f} % of the length from the heel")
    svg = drawing(f"pressure-{name}", title, f"{'; '.join(texts)}.", SOLE_HEIGHT + 66.0)
    for foot, layout in maps.items():
        shares = [load / highest if highest > 0.0 else 0.0 for load in loads[foot]]
        _sole(svg, foot, layout, shares, soles[foot] if paths else None)
    y = SOLE_HEIGHT + 40.0
    for k in range(30):
        add(svg, "rect", x=px(50.0 + 6.0 * k), y=px(y), width="6.4", height="9", fill=blend(SHADES, k / 29.0))
    write(svg, 44.0, y + 10.0, "0", "tick", "end")
    write(svg, 238.0, y + 10.0, f"{highest:.3g} {unit} a cell", "tick")
    notes = [f"{text[0].upper()}{text[1:]}." for text in texts]
    if paths:
        notes.append("Line: mean path of the centre of pressure, from heel-strike (ring) on; thin: single strides.")
    figure(parent, svg, title, *notes)


def _sole(svg: Element, foot: Foot, layout: Layout, shares: list[float], walked: SoleLoads | None) -> None:
    """Draw a sole seen from above, with the toe up.

    `shares` are the loads relative to the highest load. `walked` is the sole whose paths are drawn; None for none."""
    middle = 110.0 if foot is Foot.LEFT else 290.0
    xs, ys = [cell.x for cell in layout.cells], [cell.y for cell in layout.cells]
    r = radius(layout)
    scale = min(
        (SOLE_HEIGHT - 10.0) / max(max(xs) - min(xs) + 2.0 * r, 1e-3), 150.0 / max(max(ys) - min(ys) + 2.0 * r, 1e-3)
    )
    centre_x, centre_y = 0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))

    def at(x: float, y: float) -> tuple[float, float]:
        return middle - (y - centre_y) * scale, 26.0 + 0.5 * SOLE_HEIGHT - (x - centre_x) * scale

    write(svg, middle, 14.0, foot.value, "label", "middle")
    cells = add(svg, "g", class_="cells")
    for cell, share in zip(layout.cells, shares, strict=True):
        x, y = at(cell.x, cell.y)
        add(cells, "circle", cx=px(x), cy=px(y), r=px(r * scale), fill=blend(SHADES, share))
    if walked is not None:
        single = "".join([line([at(*one) for one in path]) for path in walked.paths if len(path) > 1])
        if single:
            add(svg, "path", d=single, class_="single")
        mean = [at(*one) for one in walked.mean_path]
        if len(mean) > 1:
            add(svg, "path", d=line(mean), class_="under")
            add(svg, "path", d=line(mean), class_="centre")
            add(svg, "circle", cx=px(mean[0][0]), cy=px(mean[0][1]), r="4", class_="path-start")


def _forces(parent: Element, soles: dict[Foot, SoleLoads]) -> None:
    curves = {foot: [force / sole.contacts for force in sole.force_sums] for foot, sole in soles.items()}
    unit = _unit(soles)
    texts = [f"{foot}: at most {max(curve):.0f} {soles[foot].unit}" for foot, curve in curves.items()]
    svg = drawing("force", "Mean force over a contact", f"{'; '.join(texts)}.", 190.0)
    values = [value for curve in curves.values() for value in curve]
    labels = ("% of the contact, from heel-strike to toe-off", f"sum of the cells, {unit}")
    chart = Chart.of(svg, (0.0, 100.0), padded_range(values, least=1.0, zero=True), labels, 190.0)
    for foot, curve in curves.items():
        chart.path([(100.0 * k / (STATIONS - 1), value) for k, value in enumerate(curve)], f"line {foot}")
    legend(svg, list(curves), lines=True)
    counted = ", ".join([f"{foot} {sole.contacts}" for foot, sole in soles.items()])
    figure(parent, svg, "Mean force over a contact", f"Contacts: {counted}.")


def _thirds(parent: Element, maps: dict[Foot, Layout], loads: dict[Foot, list[float]]) -> None:
    """Add a table of the shares of the load, %, on the three thirds of the insole's length."""
    rows = []
    for foot, layout in maps.items():
        total = fsum(loads[foot])
        if total <= 0.0:
            continue
        shares = []
        for k in range(len(THIRDS)):
            pairs = zip(layout.cells, loads[foot], strict=True)
            inside = [load for cell, load in pairs if min(max(int(3.0 * cell.x / layout.length), 0), 2) == k]
            shares.append(f"{100.0 * fsum(inside) / total:.0f} %")
        rows.append([foot.value, *shares])
    if rows:
        table(parent, "Mean load by thirds of the length", ("foot", *THIRDS), rows, "numbers thirds")
