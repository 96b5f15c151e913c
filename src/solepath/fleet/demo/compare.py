"""Comparison of two directories of events: the same events, each as often."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, get_args

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import parquet

from ...events.fleet import FleetEvent
from ...recording import printable
from ..parquet import SCHEMA
from .sending import Remark

NAMED = 3
"""Number of differences that are reported."""
KEYS = [(name, "ascending") for name in SCHEMA.names]


class UnreadableEvents(Exception):
    """Raised with one sentence when events cannot be read."""


def files(directory: Path) -> list[Path]:
    """Return the parts that a reader sees."""
    return sorted(directory.glob("[!._]*.parquet"))


def read_events(directory: Path) -> pa.Table:
    """Return all events of a directory in an order that does not depend on their writers or on the time of writing.

    Raises UnreadableEvents."""
    tables = [SCHEMA.empty_table()]
    for path in files(directory):
        try:
            tables.append(parquet.read_table(path, partitioning=None).cast(SCHEMA))
        except (pa.ArrowInvalid, OSError) as error:
            raise UnreadableEvents(f"{printable(str(path))} cannot be read: {printable(str(error))}") from None
    return pa.concat_tables(tables).combine_chunks().sort_by(KEYS)


def differences(expected: pa.Table, found: pa.Table) -> list[str]:
    """Return the first few differences between two tables of `read_events`, a sentence each.

    The list is empty for the same events, each as often."""
    if expected.equals(found):
        return []
    expected_rows, found_rows = (
        Counter(tuple(row.values()) for row in table.to_pylist()) for table in (expected, found)
    )
    changes = [(row, "is missing") for row in (expected_rows - found_rows).elements()]
    changes += [
        (row, "is there, and should not be" if row not in expected_rows else "is there twice")
        for row in found_rows - expected_rows
    ]
    changes.sort(key=lambda one: (one[0][:2], one[1]))
    first = [f"{wearer}, event {number} ({event} at {t} s) {what}" for (wearer, number, event, t, *_), what in changes]
    return _first(first)


def _first(lines: list[str]) -> list[str]:
    """Return the first few lines, and how many more there are."""
    more = [f"and {len(lines) - NAMED} more"] if len(lines) > NAMED else []
    return [*map(printable, lines[:NAMED]), *more]


def session_events(events: pa.Table) -> pa.Table:
    """Return the events of sessions without those of the fleet, each wearer's numbered in order."""
    kept = events.filter(pc.invert(_is_fleet_event(events)))
    numbers: list[int] = []
    last, number = None, 0
    for wearer in kept["wearer"].to_pylist():
        number = number + 1 if wearer == last else 0
        last = wearer
        numbers.append(number)
    return kept.set_column(SCHEMA.get_field_index("number"), SCHEMA.field("number"), pa.array(numbers, pa.int64()))


def compare_remarks(expected: Mapping[str, Iterable[Remark]], events: pa.Table) -> list[str]:
    """Compare the events of the fleet with the expected ones, by wearer.

    Returns the first few that are missing or were not expected, a sentence each."""
    expected_rows = Counter((wearer, remark) for wearer, remarks in expected.items() for remark in remarks)
    found_rows = Counter((row["wearer"], _remark(row)) for row in events.filter(_is_fleet_event(events)).to_pylist())
    wrong = [(*one, "is missing") for one in (expected_rows - found_rows).elements()]
    wrong += [(*one, "was not expected") for one in (found_rows - expected_rows).elements()]
    lines = sorted(
        f"{wearer}, {one.event} ({one.why}) of run {one.run}, number {one.number} {what}" for wearer, one, what in wrong
    )
    return _first(lines)


def _remark(row: dict[str, Any]) -> Remark:
    fields = json.loads(row["fields"])
    if row["event"] == "NumbersMissing":
        return Remark(row["event"], fields["run"], fields["first"], fields["count"])
    return Remark(row["event"], fields.get("run"), fields.get("number"), fields.get("reason", fields.get("detail", "")))


def _is_fleet_event(events: pa.Table) -> Any:
    """Return a mask of the rows that only a fleet emits."""
    return pc.is_in(events["event"], pa.array([kind.__name__ for kind in get_args(FleetEvent)]))


def find_number_gaps(events: pa.Table) -> list[str]:
    """Return the first few wearers whose events are not numbered 0, 1, 2 and so on, a sentence each."""
    counts = events.group_by("wearer").aggregate([("number", "min"), ("number", "max"), ("number", "count_distinct")])
    wrong = [
        row
        for row in counts.to_pylist()
        if row["number_min"] != 0 or row["number_max"] != row["number_count_distinct"] - 1
    ]
    return [
        f"{printable(row['wearer'])} has {row['number_count_distinct']} events numbered from {row['number_min']} to "
        f"{row['number_max']}"
        for row in wrong[:NAMED]
    ]
