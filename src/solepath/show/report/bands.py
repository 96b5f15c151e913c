"""Reads bands of reference that a person gives for the figures of a report, each with its source.

JSON: {"source": TEXT, "bands": {"speed_m_per_s": [1.1, 1.5], ...}}. CSV: a first line `measure,low,high,source`, then a
band in each line. Names and units are those of measures.py; docs/report.md lists them."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from attrs import frozen

from ...recording import printable
from .measures import SPECIFICATIONS

if TYPE_CHECKING:
    from ..outcomes.references import Person

MAX_SIZE = 100_000
"""Largest size of a file of bands, bytes; chosen by hand."""
MAX_END = 1e6
"""Largest size of an end of a band, in the unit of its measure: far beyond all of them; chosen by hand."""
COLUMNS = ("measure", "low", "high", "source")


@frozen
class Band:
    """A range of reference of one measure, in its unit, and the text that says whose it is."""

    low: float
    high: float
    source: str
    is_mean: bool = False
    """True if the source gives only a mean, which is then `low` and `high`."""


class BandError(Exception):
    """Raised when a file of bands cannot be read; its one line names the file and the fault."""


def read_bands(path: Path) -> dict[str, Band]:
    """Return the bands of a JSON or CSV file by the names of their measures.

    Raises BandError when the file is not as above, OSError when it cannot be read."""
    shown = printable(str(path), 200)
    with path.open("rb") as file:
        content = file.read(MAX_SIZE + 1)
    try:
        if len(content) > MAX_SIZE:
            raise ValueError(f"it has more than {MAX_SIZE} bytes")
        text = content.decode("utf-8-sig")
        rows = list(_rows_of_csv(text) if path.suffix.lower() == ".csv" else _rows_of_json(text))
        bands = {name: _band(name, low, high, source) for name, low, high, source in rows}
        if not bands:
            raise ValueError("it has no band")
    except (ValueError, RecursionError) as error:
        raise BandError(f"{shown} is no file of bands: {printable(str(error), 300)}") from None
    return bands


def mean_bands(person: Person | None) -> dict[str, Band]:
    """Return the published mean walking speed of people like this one as a band; nothing without a person.

    It is the only figure of a report for which a published value is built in (show/outcomes/references.py)."""
    if person is None:
        return {}
    from ..outcomes.references import walking_speed_reference

    reference = walking_speed_reference(person)
    if reference is None:
        return {}
    source = f"{reference.words} ({reference.source})"
    return {"speed_m_per_s": Band(reference.value, reference.value, source, is_mean=True)}


def _rows_of_csv(text: str) -> Iterator[tuple[str, object, object, object]]:
    try:
        first, *rows = [row for row in csv.reader(io.StringIO(text)) if row] or [[]]
    except csv.Error as error:
        raise ValueError(str(error)) from None
    if tuple(cell.strip() for cell in first) != COLUMNS:
        raise ValueError(f"its first line is not {','.join(COLUMNS)}")
    for number, row in enumerate(rows, start=2):
        if len(row) != len(COLUMNS):
            raise ValueError(f"line {number} has {len(row)} cells, not {len(COLUMNS)}")
        yield row[0].strip(), row[1], row[2], row[3]


def _rows_of_json(text: str) -> Iterator[tuple[str, object, object, object]]:
    content = json.loads(text)
    bands = content.get("bands") if isinstance(content, dict) else None
    if not isinstance(bands, dict):
        raise ValueError('it has no "bands"')
    for name, ends in bands.items():
        if not isinstance(ends, list) or len(ends) != 2 or any(type(end) not in (int, float) for end in ends):
            raise ValueError(f"{name} is not [low, high]")
        yield name, ends[0], ends[1], content.get("source")


def _band(name: str, low: object, high: object, source: object) -> Band:
    if name not in SPECIFICATIONS:
        raise ValueError(f"{name!r} is no measure; they are {', '.join(SPECIFICATIONS)}")
    if not isinstance(source, str) or not source.strip():
        raise ValueError(f"the band of {name} has no source")
    try:
        ends = [float(end) for end in (low, high) if isinstance(end, str | int | float)]
    except (ValueError, OverflowError):
        raise ValueError(f"the ends of {name} are no numbers") from None
    if len(ends) == 2 and max(map(abs, ends)) > MAX_END:
        raise ValueError(f"an end of {name} is beyond {MAX_END:,.0f}")
    if len(ends) != 2 or not all(map(isfinite, ends)) or not ends[0] < ends[1]:
        raise ValueError(f"the ends of {name} are not low, then high")
    return Band(ends[0], ends[1], source.strip())
