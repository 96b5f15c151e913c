"""Comparison of events of the demonstration, as multisets of rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import Any, get_args

from pyarrow import parquet

from ...events import Event
from ...recording import printable
from ..events import FleetEvent
from ..rows import event_row
from ..spark_files import committed
from ..step.sent import NumberedEvent
from .wearers import DemoWearer

MAX_REPORTED = 3
"""Largest number of differences that are reported."""
Row = dict[str, Any]
_FLEET_EVENTS = {kind.__name__ for kind in get_args(FleetEvent)}


def read_events(directory: Path) -> list[Row]:
    """Return the events in the finished files of a run, by wearer and number."""
    rows = [row for path in committed(directory) for row in parquet.read_table(path, partitioning=None).to_pylist()]
    return sorted(rows, key=itemgetter("wearer", "number"))


def differences(expected: Iterable[Row], found: Iterable[Row]) -> list[str]:
    """Return the first few differences between two lists of rows, a sentence each; [] for equal multisets."""
    expected_counts, found_counts = (Counter(tuple(row.values()) for row in rows) for rows in (expected, found))
    changes = [(row, "is missing") for row in (expected_counts - found_counts).elements()]
    changes += [
        (row, "is there too often" if row in expected_counts else "is there, and should not be")
        for row in found_counts - expected_counts
    ]
    lines = sorted(
        f"{wearer}, event {number} ({event} at {t} s) {fault}" for (wearer, number, event, t, *_), fault in changes
    )
    remainder = [f"and {len(lines) - MAX_REPORTED} more"] if len(lines) > MAX_REPORTED else []
    return [*map(printable, lines[:MAX_REPORTED]), *remainder]


def compare_sessions(
    wearers: Iterable[DemoWearer], sessions: Mapping[str, Iterable[Event]], found: Iterable[Row]
) -> list[str]:
    """Return how events of the fleet differ from those of sessions and from what the fleet itself must emit.

    The events of the sessions are numbered again without those of the fleet."""
    expected, actual, counts = list[Row](), list[Row](), Counter[str]()
    for wearer in wearers:
        events = enumerate(sessions[wearer.name])
        expected += [event_row(NumberedEvent(wearer.name, number, event)) for number, event in events]
        expected += [_remark(wearer.name, event) for event in wearer.sending.remarks]
    for name, rows in groupby(found, key=itemgetter("wearer")):
        for number, row in enumerate(rows):
            if row["number"] != number:
                return [f"{printable(name)} has event {row['number']} where event {number} is due"]
            if row["event"] in _FLEET_EVENTS:
                actual.append(_remark(name, row["event"]))
            else:
                actual.append({**row, "number": counts[name]})
                counts[name] += 1
    return differences(expected, actual)


def _remark(wearer: str, event: str) -> Row:
    """Return an event of the fleet itself as a row for `differences`."""
    return {"wearer": wearer, "number": None, "event": event, "t": None}
