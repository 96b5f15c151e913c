"""Two directories of events beside each other: the same events, each as often?"""

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
"""Differences that are told."""
KEYS = [(name, "ascending") for name in SCHEMA.names]


class Torn(Exception):
    """Events cannot be read: one sentence."""


def files(directory: Path) -> list[Path]:
    """The parts that a reader sees."""
    return sorted(directory.glob("[!._]*.parquet"))


def read_events(directory: Path) -> pa.Table:
    """All events of a directory, in an order that does not depend on who wrote which when. Torn."""
    tables = [SCHEMA.empty_table()]
    for path in files(directory):
        try:
            tables.append(parquet.read_table(path, partitioning=None).cast(SCHEMA))
        except (pa.ArrowInvalid, OSError) as error:
            raise Torn(f"{printable(str(path))} cannot be read: {printable(str(error))}") from None
    return pa.concat_tables(tables).combine_chunks().sort_by(KEYS)


def differences(expected: pa.Table, found: pa.Table) -> list[str]:
    """What differs between two tables of `read_events`, the first few of it, a sentence each; [] for the same events,
    each as often."""
    if expected.equals(found):
        return []
    wanted, got = (Counter(tuple(row.values()) for row in table.to_pylist()) for table in (expected, found))
    told = [(row, "is missing") for row in (wanted - got).elements()]
    told += [(row, "is there, and should not be" if row not in wanted else "is there twice") for row in got - wanted]
    told.sort(key=lambda one: (one[0][:2], one[1]))
    first = [f"{wearer}, event {number} ({event} at {t} s) {what}" for (wearer, number, event, t, *_), what in told]
    return _first(first)


def _first(lines: list[str]) -> list[str]:
    """The first few, and how many more there are."""
    more = [f"and {len(lines) - NAMED} more"] if len(lines) > NAMED else []
    return [*map(printable, lines[:NAMED]), *more]


def of_sessions(told: pa.Table) -> pa.Table:
    """What sessions said, without what only a fleet says, each wearer's events numbered as they come."""
    kept = told.filter(pc.invert(_of_fleet(told)))
    numbers: list[int] = []
    last, number = None, 0
    for wearer in kept["wearer"].to_pylist():
        number = number + 1 if wearer == last else 0
        last = wearer
        numbers.append(number)
    return kept.set_column(SCHEMA.get_field_index("number"), SCHEMA.field("number"), pa.array(numbers, pa.int64()))


def remarked(expected: Mapping[str, Iterable[Remark]], told: pa.Table) -> list[str]:
    """What only a fleet says, beside what is expected of it, by wearer: the first few that are missing or were not
    expected, a sentence each."""
    wanted = Counter((wearer, remark) for wearer, remarks in expected.items() for remark in remarks)
    got = Counter((row["wearer"], _remark(row)) for row in told.filter(_of_fleet(told)).to_pylist())
    wrong = [(*one, "is missing") for one in (wanted - got).elements()]
    wrong += [(*one, "was not expected") for one in (got - wanted).elements()]
    lines = sorted(
        f"{wearer}, {one.event} ({one.why}) of run {one.run}, number {one.number} {what}" for wearer, one, what in wrong
    )
    return _first(lines)


def _remark(row: dict[str, Any]) -> Remark:
    fields = json.loads(row["fields"])
    if row["event"] == "NumbersMissing":
        return Remark(row["event"], fields["run"], fields["first"], fields["count"])
    return Remark(row["event"], fields.get("run"), fields.get("number"), fields.get("reason", fields.get("detail", "")))


def _of_fleet(told: pa.Table) -> Any:
    """Which of the rows only a fleet says."""
    return pc.is_in(told["event"], pa.array([kind.__name__ for kind in get_args(FleetEvent)]))


def holes(told: pa.Table) -> list[str]:
    """Wearers whose events are not numbered 0, 1, 2 and so on, the first few, a sentence each."""
    counts = told.group_by("wearer").aggregate([("number", "min"), ("number", "max"), ("number", "count_distinct")])
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
