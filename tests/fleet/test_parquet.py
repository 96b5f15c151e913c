"""Part files of Parquet are complete or absent, hold each event once, and no part is lost that the engine needs."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("pyarrow", reason="pyarrow is not installed (extra: bytewax)")

from pyarrow import parquet

from solepath.events import ActivityChanged, HeelStrike
from solepath.fleet import EVENT_COLUMNS, NumberedEvent, StateRejected, event_row
from solepath.fleet.parquet import PartFiles
from solepath.types import Activity, Foot

FIRST = "part-0-00000000.parquet"
Place = tuple[int, int]
"""Run and number of a part, which an engine remembers."""


def make_events(count: int, wearers: int = 3) -> list[NumberedEvent]:
    """Return events of a few wearers in turn."""
    events = [
        HeelStrike(t=0.1, known_at=0.12, foot=Foot.LEFT),
        ActivityChanged(t=0.1 + 0.2, known_at=0.5, activity=Activity.WALKING, probability=0.9),
        StateRejected(t=0.0, known_at=0.0, detail='wearer "7" \x00 \N{FOOTPRINTS} \ud800'),
    ]
    return [NumberedEvent(f"w{n % wearers}", n // wearers, events[n % len(events)]) for n in range(count)]


def rows(directory: Path) -> list[dict[str, Any]]:
    """Return the rows that a reader finds, in the order of the files."""
    return list(parquet.read_table(directory).to_pylist())


def put(parts: PartFiles, events: list[Any]) -> Place:
    """Write some events as a part, and return the numbers that the engine saves."""
    parts.write(events)
    return parts.close()


def by_identity(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return sorted(found, key=lambda row: (row["wearer"], row["number"]))


def names(directory: Path) -> list[str]:
    """Return the names of all files, without the run in them."""
    return sorted(re.sub(r"(part-\w+)-\d+-", r"\1-", path.name) for path in directory.iterdir())


def file(directory: Path, name: str = FIRST) -> Path:
    (found,) = (path for path in directory.iterdir() if re.sub(r"(part-\w+)-\d+-", r"\1-", path.name) == name)
    return found


def test_a_part_holds_the_rows_of_its_events_wearer_by_wearer(tmp_path: Path) -> None:
    parts = PartFiles(tmp_path)
    parts.write(make_events(20))
    assert names(tmp_path) == []
    assert parts.close() == (parts.run, 1)
    assert names(tmp_path) == [FIRST]
    assert rows(tmp_path) == by_identity([event_row(one) for one in make_events(20)])
    table = parquet.read_table(file(tmp_path))
    assert table.column_names == list(EVENT_COLUMNS)
    assert [str(kind) for kind in table.schema.types] == [
        "string", "int64", "string", "double", "double", "bool", "string", "string",
    ]  # fmt: skip


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Let the system reject any longer file of this process."""
    resource = pytest.importorskip("resource", reason="this system does not limit the length of files")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_part_that_cannot_be_written_is_named_and_leaves_nothing(tmp_path: Path) -> None:
    parts = PartFiles(tmp_path)
    number = put(parts, make_events(1))
    parts.write(make_events(20)[1:])
    with files_of_at_most(1000), pytest.raises(OSError) as error:
        parts.close()
    assert error.value.errno == errno.EFBIG
    assert error.value.filename == str(tmp_path / f"part-0-{parts.run}-00000001.parquet")
    assert names(tmp_path) == [FIRST]
    put(PartFiles(tmp_path, "0", number), make_events(20)[1:])
    assert by_identity(rows(tmp_path)) == by_identity([event_row(one) for one in make_events(20)])


@given(st.lists(st.sampled_from(["write", "write many", "close", "count", "crash"]), max_size=15))
@settings(max_examples=20)
def test_however_often_it_crashes_each_event_is_there_once(steps: list[str]) -> None:
    """The engine's state is from any earlier `close`, since it may be killed before it keeps the last one."""
    all_events, at = make_events(60), 0
    with TemporaryDirectory() as name:
        parts = PartFiles(Path(name), group=5)
        counts = (parts.close(), 0)
        for step in steps:
            if step.startswith("write"):
                upto = min(len(all_events), at + (1 if step == "write" else 13))
                parts.write(all_events[at:upto])
                at = upto
            elif step == "crash":
                parts, at = PartFiles(Path(name), "0", counts[0], group=5), counts[1]
            else:
                number = parts.close()
                counts = (number, at) if step == "count" else counts
        put(parts, all_events[at:])
        assert by_identity(rows(Path(name))) == by_identity([event_row(one) for one in all_events])


STRIKE = HeelStrike(t=0.1, known_at=0.12, foot=Foot.LEFT)


def written(directory: Path, resumes: list[Place | None], number: int = 0) -> list[Place]:
    """A job of so many partitions: wearers of the same names as ever, one event each."""
    partitions = [str(n) for n in range(len(resumes))]
    parts = [PartFiles(directory, name, resumes[int(name)], partitions=partitions) for name in partitions]
    return [put(part, [NumberedEvent(f"w{part.partition}", number, STRIKE)]) for part in parts]


def listed(directory: Path) -> list[tuple[str, int]]:
    """Return the files that a reader finds."""
    rows = parquet.read_table(directory).to_pylist()
    return sorted((row["wearer"], row["number"]) for row in rows)


def test_a_restart_with_fewer_partitions_hides_the_parts_of_the_others(tmp_path: Path) -> None:
    """The events of all wearers are numbered again, so no old event may stay beside the new ones."""
    three = written(tmp_path, [None] * 3)
    assert listed(tmp_path) == [("w0", 0), ("w1", 0), ("w2", 0)]
    two = written(tmp_path, [None] * 2)
    assert listed(tmp_path) == [("w0", 0), ("w1", 0)]
    written(tmp_path, list(three), 1)
    assert listed(tmp_path) == [("w0", 0), ("w0", 1), ("w1", 0), ("w1", 1), ("w2", 0), ("w2", 1)], "the first is back"
    written(tmp_path, list(two), 1)
    assert listed(tmp_path) == [("w0", 0), ("w0", 1), ("w1", 0), ("w1", 1)], (
        "and the second, without those of the first"
    )


@pytest.mark.parametrize(
    ("wearer", "name"), [("\ud800", "\\ud800"), ("ü \udc80", "ü \\udc80"), ("ü\n\x00", "ü\n\x00"), ("", "")]
)
def test_a_wearer_of_any_name_ends_no_job(tmp_path: Path, wearer: str, name: str) -> None:
    """A key may hold an unpaired surrogate, which JSON allows; a table holds UTF-8."""
    make_events: list[Any] = [NumberedEvent(wearer, 0, STRIKE), NumberedEvent("w", 0, STRIKE)]
    put(PartFiles(tmp_path), make_events)
    assert listed(tmp_path) == sorted([(name, 0), ("w", 0)])
    assert event_row(make_events[0])["wearer"] == name
