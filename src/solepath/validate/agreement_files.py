"""Writes the agreement of walks with a truth: tables, and a page with a Bland-Altman picture of each parameter."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, tostring

from ..show.output import write_table
from ..show.report.figures.axes import FOOT_MARKS, MARK, PATH, Chart, padded_range
from ..show.report.figures.stride import MAX_SINGLE_MARKS
from ..show.report.markup import notes, section, skeleton, table, terms
from ..show.report.sections.heading import add_making, making_facts
from ..show.tables.svg import add
from ..show.tables.table import counted
from ..types import Foot
from .agreement import EVENT_PARAMETERS, PAIR_COLUMNS, WalkComparison, usable

HEADER = ["parameter", "pairs", "bias", "95 % limits", "not found", "extra", "degraded", "F1", "ICC(2,1)"]
UNITS = {
    "_m_per_s": ("m/s", "cm/s", 100.0),
    "_steps_per_min": ("steps/min", "steps/min", 1.0),
    "_s": ("s", "ms", 1000.0),
    "_m": ("m", "cm", 100.0),
    "_deg": ("deg", "deg", 1.0),
    "": ("of 1", "%", 100.0),
}
"""Unit of a parameter by the end of its name, that of its differences in a picture, and what they are multiplied by."""
TABLE_KIND = "numbers comparison"
"""Classes of a table: on a phone its columns have the widths of a comparison."""
LEAST_RANGE = 1e-3
"""Least range of an axis, in the unit of its parameter; chosen by hand."""
DEFINITIONS = (
    ("Bias", "mean of the differences, solepath minus truth."),
    ("95 % limits", "bias +- 1.96 standard deviations of the differences (Bland & Altman 1986, Lancet 327)."),
    (
        "ICC(2,1)",
        "intraclass correlation, two-way random effects, absolute agreement, single measurement (Shrout & Fleiss 1979, "
        "Psychol. Bull. 86; ICC(A,1) of McGraw & Wong 1996, Psychol. Methods 1), by pingouin.",
    ),
    ("Not found", "only in the truth."),
    ("Extra", "only found by solepath, within the time that the truth covers."),
    ("Degraded", "matched, but solepath says that the stride is wrong: in no figure."),
    ("F1", "2 x matched / (true + found)."),
)
INDEPENDENT = (
    "Limits and ICC take all values as independent. Strides of one person are alike: the means of recordings say more "
    "about other people (Bland & Altman 1999, Stat. Methods Med. Res. 8)."
)


def agreement_cells(frame: Any) -> list[list[str]]:
    """Return the cells of a table with HEADER, from a frame of WalkComparison."""
    return [
        [
            " ".join(filter(None, (row["parameter"], row.get("by"), row.get("group")))),
            f"{row['n']}",
            _cell(row["bias"], "{:+z.3f}"),
            _cell(row["lower"], "{:+z.3f} to {:+z.3f}", row["upper"]),
            *[f"{row[name]}" for name in ("not_found", "extra", "degraded")],
            *[_cell(row[name], "{:.3f}") for name in ("f1", "icc")],
        ]
        for row in frame.to_dict("records")
    ]


def _cell(value: float | None, shown: str, *others: float) -> str:
    """Return a value that is known as text, with others beside it, and "-" for one that is not."""
    return "-" if value is None or value != value else shown.format(value, *others)


def agreement_writers(comparison: WalkComparison, made_by: Mapping[str, Any]) -> dict[str, Callable[[Path], None]]:
    """Return what writes each file of a comparison, by its name; `made_by` is as `provenance` says it."""
    own = [name for name in comparison.pairs.columns if name not in PAIR_COLUMNS]
    # with all digits, so that a statistics program gets from them what is in agreement.csv
    pairs = comparison.pairs[[*PAIR_COLUMNS, *own]].astype({"degraded": int})
    frames = {
        "agreement.csv": comparison.agreement,
        "agreement_groups.csv": comparison.groups,
        "pairs.csv": pairs.assign(**{name: pairs[name].map(repr, na_action="ignore") for name in ("true", "found")}),
    }
    page = "<!DOCTYPE html>\n" + tostring(_page(comparison, made_by), encoding="unicode", method="html") + "\n"
    writers = {name: _writer(frame) for name, frame in frames.items()}
    return {**writers, "agreement.html": lambda path: path.write_bytes(page.encode()) and None}


def _writer(frame: Any) -> Callable[[Path], None]:
    cells = frame.astype(object).where(frame.notna(), None)
    return lambda path: write_table(path, [*cells.columns], cells.itertuples(index=False))


def _page(comparison: WalkComparison, made_by: Mapping[str, Any]) -> Element:
    """Return the page as an <html> element."""
    html, main = skeleton("Agreement with a reference system")
    add(main, "<header><h1>Agreement with a reference system</h1></header>")
    count = comparison.pairs.recording.nunique()
    add(main, "<p class='headline'>{}, compared with what was measured</p>", counted(count, "recording"))
    part = section(main, "agreement", "Agreement")
    table(part, "solepath minus truth", HEADER, agreement_cells(comparison.agreement), TABLE_KIND)
    notes(part, [INDEPENDENT])
    figures = add(section(main, "pictures", "Bland-Altman pictures"), "<div class='figures'/>")
    for row, (_, pairs) in zip(comparison.agreement.to_dict("records"), comparison.parts, strict=True):
        if row["n"] > 1:
            _bland_altman(figures, row, usable(pairs))
    if len(comparison.groups):
        caption = "By foot, by other columns of the truth, and means"
        part = section(main, "groups", "Groups")
        table(part, caption, HEADER, agreement_cells(comparison.groups), TABLE_KIND)
    terms(section(main, "definitions", "Definitions and sources"), DEFINITIONS, "definitions")
    facts = making_facts(made_by.get("recipe", ""), made_by["solepath"], made_by)
    add_making(section(main, "making", "How this page was made"), facts)
    return html


def _bland_altman(parent: Element, row: Mapping[str, Any], both: Any) -> None:
    """Draw the differences over the means of both values, or over the time of an event, with bias and limits."""
    parameter = row["parameter"]
    end, (unit, small, factor) = next(one for one in UNITS.items() if parameter.endswith(one[0]))
    name, is_event = parameter.removesuffix(end).replace("_", " "), parameter in EVENT_PARAMETERS.values()
    bias, lower, upper = [factor * row[name] for name in ("bias", "lower", "upper")]
    xs = both.true if is_event else 0.5 * (both.true + both.found)
    ys = factor * (both.found - both.true)
    figures = f"bias {bias:+z.1f}, limits {lower:+z.1f} to {upper:+z.1f} {small}, {counted(len(both), 'pair')}"
    chart = Chart.of(
        parent,
        f"agreement-{parameter}",
        f"Agreement of {name}",
        f"Differences of {name}: {figures}.",
        padded_range([*xs], LEAST_RANGE),
        padded_range([0.0, lower, upper, *ys], LEAST_RANGE),
        (f"{'time of the truth' if is_event else 'mean of both'}, {unit}", f"solepath - truth, {small}"),
        figures,
        "Solid line: bias. Dashed lines: 95 % limits of agreement.",
    )
    chart.svg.set("class", "dense" if len(both) > MAX_SINGLE_MARKS else "")
    feet = [Foot(foot) if foot else Foot.LEFT for foot in both.foot.fillna("")]
    for foot, x, y in zip(feet, xs, ys, strict=True):
        add(chart.svg, MARK, chart.x(x), chart.y(y), FOOT_MARKS[foot], "mark", foot.value)
    for y, kind in ((bias, "way"), (lower, "flight"), (upper, "flight")):
        add(chart.svg, PATH, [f"M{chart.x.start} {chart.y(y):.1f}H{chart.x.end}"], kind)
    chart.legend([foot for foot in Foot if foot in {*both.foot}])
