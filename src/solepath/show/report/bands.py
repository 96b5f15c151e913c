"""Reads bands of reference that a person gives for the figures of a report, each with its source.

JSON: {"source": TEXT, "bands": {"speed_m_per_s": [1.1, 1.5], ...}}. CSV: a first line `measure,low,high,source`, then a
band in each line. Names and units are those of measures.py; docs/clinic.md lists them."""

from __future__ import annotations

import csv
import json
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from ...recording import printable
from .measures import SPECIFICATIONS

if TYPE_CHECKING:
    from ..outcomes.references import Person

COLUMNS = ["measure", "low", "high", "source"]


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
    try:
        text = path.read_text(encoding="utf-8-sig")
        rows = _rows_of_csv(text) if path.suffix.lower() == ".csv" else _rows_of_json(text)
        bands = {name: _band(name, low, high, source) for name, low, high, source in rows}
        if not bands:
            raise ValueError("it has no band")
    except (ValueError, RecursionError, csv.Error) as error:
        raise BandError(f"{printable(str(path), 200)} is no file of bands: {printable(str(error), 300)}") from None
    return bands


def mean_bands(person: Person | None) -> dict[str, Band]:
    """Return the published mean walking speed of people like this one as a band; nothing without a person.

    It is the only figure of a report for which a published value is built in (show/outcomes/references.py)."""
    from ..outcomes.references import walking_speed_reference

    reference = None if person is None else walking_speed_reference(person)
    if reference is None:
        return {}
    source = f"{reference.words} ({reference.source})"
    return {"speed_m_per_s": Band(reference.value, reference.value, source, is_mean=True)}


def _rows_of_csv(text: str) -> list[Any]:
    first, *rows = [[cell.strip() for cell in row] for row in csv.reader(text.splitlines()) if row] or [[]]
    if first != COLUMNS:
        raise ValueError(f"its first line is not {','.join(COLUMNS)}")
    for row in rows:
        if len(row) != len(COLUMNS):
            raise ValueError(f"the line {','.join(row)} has {len(row)} cells, not {len(COLUMNS)}")
    return rows


def _rows_of_json(text: str) -> list[Any]:
    match json.loads(text):
        case {"bands": dict(bands), **others}:
            return [(name, ends, None, others.get("source")) for name, ends in bands.items()]
    raise ValueError('it has no "bands"')


def _band(name: str, low: Any, high: Any, source: object) -> Band:
    if name not in SPECIFICATIONS:
        raise ValueError(f"{name!r} is no measure; they are {', '.join(SPECIFICATIONS)}")
    if not isinstance(source, str) or not source.strip():
        raise ValueError(f"the band of {name} has no source")
    try:
        first, last = low if high is None else (low, high)
        band = Band(float(first), float(last), source.strip())
    except (ValueError, TypeError, OverflowError):
        raise ValueError(f"the ends of {name} are no numbers, low and high") from None
    if not -inf < band.low < band.high < inf:
        raise ValueError(f"the ends of {name} are not low, then high")
    return band
