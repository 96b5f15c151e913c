"""Comparison of events of the demonstration, as multisets of rows."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, get_args

import pyarrow as pa
from pyarrow import parquet

from ...events import Event
from ...events.fleet import FleetEvent
from ...recording import printable
from ..rows import event_row
from ..spark_files import committed
from ..step.sent import NumberedEvent
from .wearers import DemoWearer

MAX_REPORTED = 3
"""Largest number of differences that are reported."""
Row = dict[str, Any]
_FLEET_EVENTS = {kind.__name__ for kind in get_args(FleetEvent)}


class UnreadableEvents(Exception):
    """Raised with one sentence when events cannot be read."""


def read_events(directory: Path) -> list[Row]:
    """Return the events in the finished files of a run, by wearer and number. Raises UnreadableEvents."""
    rows: list[Row] = []
    for path in committed(directory):
        try:
            rows += parquet.read_table(path, partitioning=None).to_pylist()
        except (pa.ArrowInvalid, OSError) as error:
            raise UnreadableEvents(f"{printable(str(path))} cannot be read: {printable(str(error))}") from None
    return sorted(rows, key=lambda row: (row["wearer"], row["number"]))


def differences(expected: Iterable[Row], found: Iterable[Row]) -> list[str]:
    """Return the first few differences between two lists of rows, a sentence each; [] for equal multisets."""
    wanted, there = (Counter(tuple(row.values()) for row in rows) for rows in (expected, found))
    changes = [(row, "is missing") for row in (wanted - there).elements()]
    changes += [
        (row, "is there too often" if row in wanted else "is there, and should not be") for row in there - wanted
    ]
    lines = [
        f"{wearer}, event {number} ({event} at {t} s) {fault}" for (wearer, number, event, t, *_), fault in changes
    ]
    lines.sort()
    remainder = [f"and {len(lines) - MAX_REPORTED} more"] if len(lines) > MAX_REPORTED else []
    return [*map(printable, lines[:MAX_REPORTED]), *remainder]


def compare_sessions(
    wearers: Iterable[DemoWearer], sessions: Mapping[str, Iterable[Event]], found: Iterable[Row]
) -> list[str]:
    """Return how events of the fleet differ from those of sessions and from what the fleet itself must emit."""
    expected = list[Row]()
    counts = Counter[str]()
    lines = list[str]()
    for wearer in wearers:
        events = sessions[wearer.name]
        expected += [event_row(NumberedEvent(wearer.name, number, event)) for number, event in enumerate(events)]
        for event, run, number, why in wearer.sending.remarks:
            expected.append(_remark(wearer.name, event, None if run is None else wearer.run + run, number, why))
    session_counts, actual = Counter[str](), list[Row]()
    for row in found:
        name = row["wearer"]
        if row["number"] != counts[name] and not lines:
            lines.append(f"{printable(name)} has event {row['number']} where event {counts[name]} is due")
        counts[name] += 1
        if row["event"] not in _FLEET_EVENTS:
            actual.append({**row, "number": session_counts[name]})
            session_counts[name] += 1
            continue
        fields = json.loads(row["fields"])
        number = fields.get("first", fields.get("number"))
        why = fields["count"] if "first" in fields else fields.get("reason", fields.get("detail", ""))
        actual.append(_remark(name, row["event"], fields.get("run"), number, why))
    return [*lines, *differences(expected, actual)]


def _remark(wearer: str, event: str, run: int | None, number: int | None, why: str | int) -> Row:
    """Return an event of the fleet about a row with this run and number, as a row for `differences`."""
    return {"wearer": wearer, "number": number, "event": event, "t": None, "run": run, "why": why}
