"""Writes the agreement of walks with a truth: tables, and a page with a Bland-Altman picture of each parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, tostring

from ..show.output import Cell, write_table
from ..show.report.figures.axes import FOOT_MARKS, MARK, PATH, Chart, padded_range
from ..show.report.figures.stride import MAX_SINGLE_MARKS
from ..show.report.markup import notes, section, skeleton, table, terms
from ..show.report.sections.heading import add_making, making_facts
from ..show.tables.svg import add
from ..show.tables.table import counted, number
from ..types import Foot
from .agreement import AgreementRow, Pair, WalkComparison

AGREEMENT_COLUMNS = (
    "parameter", "n", "bias", "lower", "upper", "icc", "icc_lower", "icc_upper", "sd", "not_found", "extra", "degraded",
    "f1",
)  # fmt: skip
GROUP_COLUMNS = ("by", "group", *AGREEMENT_COLUMNS)
PAIR_COLUMNS = ("recording", "foot", "parameter", "true", "found", "degraded")
"""Columns of pairs.csv; the groups of the truth follow."""
HEADER = ["parameter", "pairs", "bias", "95 % limits", "ICC(2,1)", "not found", "extra", "degraded", "F1"]
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


def agreement_cells(rows: Iterable[AgreementRow]) -> list[list[str]]:
    """Return the cells of a table with HEADER."""
    return [
        [
            " ".join([row.parameter, *filter(None, (row.by, row.group))]),
            str(row.n),
            "-" if row.bias is None else f"{row.bias:+z.3f}",
            "-" if row.limits is None else "{:+z.3f} to {:+z.3f}".format(*row.limits),
            number(row.icc, 3),
            *map(str, (row.not_found, row.extra, row.degraded)),
            number(row.f1, 3),
        ]
        for row in rows
    ]


def agreement_writers(comparison: WalkComparison, made_by: Mapping[str, Any]) -> dict[str, Callable[[Path], None]]:
    """Return what writes each file of a comparison, by its name; `made_by` is as `provenance` says it."""
    groups = [*dict.fromkeys([name for pair in comparison.pairs for name in pair.groups])]
    pairs = [[*_pair_cells(pair), *map(pair.groups.get, groups)] for pair in comparison.pairs]
    in_groups = [[row.by, row.group, *_row_cells(row)] for row in comparison.group_rows]
    page = "<!DOCTYPE html>\n" + tostring(_page(comparison, made_by), encoding="unicode", method="html") + "\n"
    return {
        "agreement.csv": lambda path: write_table(path, AGREEMENT_COLUMNS, map(_row_cells, comparison.rows)),
        "agreement_groups.csv": lambda path: write_table(path, GROUP_COLUMNS, in_groups),
        "pairs.csv": lambda path: write_table(path, [*PAIR_COLUMNS, *groups], pairs),
        "agreement.html": lambda path: path.write_bytes(page.encode()) and None,
    }


def _row_cells(row: AgreementRow) -> list[Cell]:
    lower, upper = row.limits or (None, None)
    figures = (row.bias, lower, upper, row.icc, row.icc_lower, row.icc_upper, row.sd)
    return [row.parameter, row.n, *figures, row.not_found, row.extra, row.degraded, row.f1]


def _pair_cells(pair: Pair) -> list[Cell]:
    values = [None if value is None else repr(value) for value in (pair.true, pair.found)]
    return [pair.recording, pair.foot and pair.foot.value, pair.parameter, *values, int(pair.degraded)]


def _page(comparison: WalkComparison, made_by: Mapping[str, Any]) -> Element:
    """Return the page as an <html> element."""
    html, main = skeleton("Agreement with a reference system")
    walks = {pair.recording for pair in comparison.pairs}
    add(main, "<header><h1>Agreement with a reference system</h1></header>")
    add(main, "<p class='headline'>{}, compared with what was measured</p>", counted(len(walks), "recording"))
    part = section(main, "agreement", "Agreement")
    table(part, "solepath minus truth", HEADER, agreement_cells(comparison.rows), TABLE_KIND)
    notes(part, [INDEPENDENT])
    figures = add(section(main, "pictures", "Bland-Altman pictures"), "<div class='figures'/>")
    for row, pairs in zip(comparison.rows, comparison.by_parameter().values(), strict=True):
        if row.limits is not None:
            _bland_altman(figures, row, pairs)
    if comparison.group_rows:
        part = section(main, "groups", "Groups")
        table(
            part,
            "By foot, by other columns of the truth, and means",
            HEADER,
            agreement_cells(comparison.group_rows),
            TABLE_KIND,
        )
    terms(section(main, "definitions", "Definitions and sources"), DEFINITIONS, "definitions")
    facts = making_facts(made_by.get("recipe", ""), made_by["solepath"], made_by)
    add_making(section(main, "making", "How this page was made"), facts)
    return html


def _bland_altman(parent: Element, row: AgreementRow, pairs: Sequence[Pair]) -> None:
    """Draw the differences over the means of both values, or over the time of an event, with bias and limits."""
    end, (unit, small, factor) = next(one for one in UNITS.items() if row.parameter.endswith(one[0]))
    name = row.parameter.removesuffix(end).replace("_", " ")
    bias, lower, upper = [factor * value for value in (row.bias or 0.0, *(row.limits or (0.0, 0.0)))]
    found = [(pair.foot or Foot.LEFT, *pair.values) for pair in pairs if pair.values is not None]
    is_event = pairs[0].is_event
    points = [(foot, a if is_event else 0.5 * (a + b), factor * (b - a)) for foot, a, b in found]
    figures = f"bias {bias:+z.1f}, limits {lower:+z.1f} to {upper:+z.1f} {small}, {counted(row.n, 'pair')}"
    chart = Chart.of(
        parent,
        f"agreement-{row.parameter}",
        f"Agreement of {name}",
        f"Differences of {name}: {figures}.",
        padded_range([x for _, x, _ in points], LEAST_RANGE),
        padded_range([0.0, lower, upper, *[y for _, _, y in points]], LEAST_RANGE),
        (f"{'time of the truth' if is_event else 'mean of both'}, {unit}", f"solepath - truth, {small}"),
        figures,
        "Solid line: bias. Dashed lines: 95 % limits of agreement.",
    )
    chart.svg.set("class", "dense" if len(points) > MAX_SINGLE_MARKS else "")
    for foot, x, y in points:
        add(chart.svg, MARK, chart.x(x), chart.y(y), FOOT_MARKS[foot], "mark", foot.value)
    for y, kind in ((bias, "way"), (lower, "flight"), (upper, "flight")):
        add(chart.svg, PATH, [f"M{chart.x.start} {chart.y(y):.1f}H{chart.x.end}"], kind)
    chart.legend([foot for foot in Foot if foot in {pair.foot for pair in pairs}])
