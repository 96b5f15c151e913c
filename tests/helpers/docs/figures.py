"""Makes the short tables of README.md and docs/ from the long tables and the output of commands.

A row is (measure, result). Each table is made separately, so that any table whose data are present can be refreshed.
"""

from __future__ import annotations

import re

from solepath_lab.evaluate.datasets import DATASETS

Row = tuple[str, str]

BENCH = "tests/bench/bench.py"
WAY = "tests/bench/way.py"
BLUETOOTH = "tests/bench/bluetooth.py"
PAGE = "tests/bench/page.py"
PACKED = "tests/bench/packed.py"
FLEET = ["tests/bench/fleet.py", "--sizes", "100"]
QUICK = [word for data_set in DATASETS if not data_set.folds for word in ("--only", data_set.name)]
"""Options for all data sets except those with cross-validation, which takes minutes."""
ACTIVITIES = ["--only", "hugadb", "--only", "hugadb_corrected", "--recipe", "default", "--markdown"]
HEADLINE_MEASURES = {
    "pyshoe_vicon": ("length of the walk", "position error RMS, horizontal"),
    "gumushane_surveyed": ("length of the walk", "position error at the footprints", "strides", "stride length error"),
    "ipol_10m_uturn": ("heel-strikes", "toe-offs"),
}
"""Measures of the data sets of HEADLINES, without their counts."""


def in_short(table: list[str]) -> list[Row]:
    """Return a row for each data set of HEADLINES, from the lines of a table as `evaluate --markdown` prints it."""
    figures_of: dict[str, tuple[str, dict[str, str]]] = {}
    for line in table[2:]:
        title, measure, result = (cell.strip() for cell in line.split("|")[1:4])
        if title:
            figures: dict[str, str] = {}
            figures_of.setdefault(title.split("`")[1], (title, figures))
        figures[re.sub(r"^\d+ | \(\d+\)$", "", measure)] = result
    rows = []
    for name, measures in HEADLINE_MEASURES.items():
        title, figures = figures_of[name]
        rows.append((title, "; ".join(f"{measure}: {figures[measure]}" for measure in measures)))
    return rows


def compared(printed: str) -> str:
    """Return the start of the table against the truth, from the output of `solepath demo`."""
    _, title, rest = printed.partition("against the truth")
    return "\n".join((title + rest).splitlines()[:7])


HEADLINES = (
    (
        "position",
        "{} walks of {} m (mean) in a motion-capture lab, one shoe: position error {} m (RMS, mean of the walks)",
        "pyshoe_vicon",
        "stance detection and the filter",
        r"(\d+) recordings.*walk: mean ([\d.]+) m.*RMS, horizontal: mean ([\d.]+) m",
    ),
    (
        "strides",
        "{} walks of {} m (mean), every footprint surveyed, one shoe: position error {} m on average; "
        "{} strides found, {} invented; stride length error {} %",
        "gumushane_surveyed",
        "stance detection and the filter",
        r"(\d+) recordings.*walk: mean ([\d.]+) m.*footprints: mean ([\d.]+) m.*"
        r"strides: (\d+ of \d+) found, (\d+) invented; stride length error: mean ([\d.]+)",
    ),
    (
        "contacts",
        "{} walks with radio losses, both feet, contacts checked by hand: heel-strike F1 {}, median offset {} ms; "
        "toe-off F1 {}, {} ms",
        "ipol_10m_uturn",
        "contact detection",
        r"(\d+) recordings.*heel-strikes: F1 ([\d.]+), median offset (-?\d+) ms.*"
        r"toe-offs: F1 ([\d.]+), median offset (-?\d+) ms",
    ),
)
"""Rows of the README's table of results: title, sentence, data set, what was tuned on it, where figures are."""


def headlines(short: list[Row], bench: str) -> list[str]:
    """Return the README's table of results, from the rows of `in_short` and the output of BENCH."""
    table = ["| result | measured | tuned on these data? | command |", "|---|---|---|---|"]
    for title, sentence, data, tuned, pattern in HEADLINES:
        (row,) = (f"{name}: {result}" for name, result in short if f"`{data}`" in name)
        found = re.search(pattern, row)
        if found is None:
            raise ValueError(f"{data}: {row!r} has no {pattern!r}")
        command = f"`solepath-lab evaluate DIR --only {data} --recipe default`"
        table.append(f"| {title} | {sentence.format(*found.groups())} | yes: {tuned} | {command} |")
    found = re.search(r"^real-time factor.*: (.+)$", bench, re.MULTILINE)
    if found is None:
        raise ValueError("the benchmark prints no real-time factor")
    cost = f"two insoles of 96 pressure cells at 100 Hz: {found[1]} times real time on one core, in plain Python"
    return [*table, f"| cost | {cost} | no; emulated | `python {BENCH}` |"]
