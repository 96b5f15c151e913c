"""Comparison of the events in two directories, as multisets."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, get_args

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import parquet

from ...recording import printable
from ..events import FleetEvent
from ..parquet import SCHEMA
from .sending import Remark

MAX_REPORTED = 3
"""Largest number of differences that are reported."""
SORT_KEYS = [(name, "ascending") for name in SCHEMA.names]


class UnreadableEvents(Exception):
    """Raised with one sentence when events cannot be read."""


def files(directory: Path) -> list[Path]:
    """Return the finished Parquet files of a directory; hidden files are left out."""
    return sorted(directory.glob("[!._]*.parquet"))


def read_events(directory: Path) -> pa.Table:
    """Return all events of a directory, sorted by every column. Raises UnreadableEvents."""
    tables = [SCHEMA.empty_table()]
    for path in files(directory):
        try:
            tables.append(parquet.read_table(path, partitioning=None).cast(SCHEMA))
        except (pa.ArrowInvalid, OSError) as error:
            raise UnreadableEvents(f"{printable(str(path))} cannot be read: {printable(str(error))}") from None
    return pa.concat_tables(tables).combine_chunks().sort_by(SORT_KEYS)


def differences(expected: pa.Table, found: pa.Table) -> list[str]:
    """Return the first few differences between two tables of `read_events`, a sentence each; [] for equal tables."""
    if expected.equals(found):
        return []
    expected_rows, found_rows = (
        Counter(tuple(row.values()) for row in table.to_pylist()) for table in (expected, found)
    )
    changes = [(row, "is missing") for row in (expected_rows - found_rows).elements()]
    changes += [
        (row, "is there, and should not be" if row not in expected_rows else "is there too often")
        for row in found_rows - expected_rows
    ]
    changes.sort(key=lambda change: (change[0][:2], change[1]))
    lines = [
        f"{wearer}, event {number} ({event} at {t} s) {fault}" for (wearer, number, event, t, *_), fault in changes
    ]
    return _shorten(lines)


def _shorten(lines: list[str]) -> list[str]:
    """Return the first few lines, and a line with the number of the others."""
    remainder = [f"and {len(lines) - MAX_REPORTED} more"] if len(lines) > MAX_REPORTED else []
    return [*map(printable, lines[:MAX_REPORTED]), *remainder]


def session_events(events: pa.Table) -> pa.Table:
    """Return the events without those that the fleet itself emits (FleetEvent), each wearer's numbered again from 0."""
    session_rows = events.filter(pc.invert(_is_fleet_event(events)))
    numbers: list[int] = []
    last_wearer, number = None, 0
    for wearer in session_rows["wearer"].to_pylist():
        number = number + 1 if wearer == last_wearer else 0
        last_wearer = wearer
        numbers.append(number)
    return session_rows.set_column(
        SCHEMA.get_field_index("number"), SCHEMA.field("number"), pa.array(numbers, pa.int64())
    )


def compare_remarks(expected: Mapping[str, Iterable[Remark]], events: pa.Table) -> list[str]:
    """Return the first few events of the fleet (FleetEvent) that are missing or were not expected, a sentence each."""
    expected_rows = Counter((wearer, remark) for wearer, remarks in expected.items() for remark in remarks)
    found_rows = Counter((row["wearer"], _remark(row)) for row in events.filter(_is_fleet_event(events)).to_pylist())
    wrong = [(*one, "is missing") for one in (expected_rows - found_rows).elements()]
    wrong += [(*one, "was not expected") for one in (found_rows - expected_rows).elements()]
    lines = sorted(
        f"{wearer}, {one.event} ({one.why}) of row {one.number} of run {one.run} {fault}"
        for wearer, one, fault in wrong
    )
    return _shorten(lines)


def _remark(row: dict[str, Any]) -> Remark:
    """Return the Remark of an event: a SentRejected has a reason; one about no row has a detail, no run and number."""
    fields = json.loads(row["fields"])
    if row["event"] == "NumbersMissing":
        return Remark(row["event"], fields["run"], fields["first"], fields["count"])
    return Remark(row["event"], fields.get("run"), fields.get("number"), fields.get("reason", fields.get("detail", "")))


def _is_fleet_event(events: pa.Table) -> Any:
    """Return a mask of the events that the fleet itself emits, not a session."""
    return pc.is_in(events["event"], pa.array([kind.__name__ for kind in get_args(FleetEvent)]))


def find_number_gaps(events: pa.Table) -> list[str]:
    """Return the first few wearers with a number missing between 0 and their last number, a sentence each."""
    counts = events.group_by("wearer").aggregate([("number", "min"), ("number", "max"), ("number", "count_distinct")])
    faulty = [
        row
        for row in counts.to_pylist()
        if row["number_min"] != 0 or row["number_max"] != row["number_count_distinct"] - 1
    ]
    return [
        f"{printable(row['wearer'])} has {row['number_count_distinct']} different event numbers from "
        f"{row['number_min']} to {row['number_max']}"
        for row in faulty[:MAX_REPORTED]
    ]
