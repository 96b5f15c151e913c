"""Parts of Parquet beside what else may be in their directory, and of wearers with any name."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow", reason="pyarrow is not installed (extra: bytewax)")

from pyarrow import parquet

from solepath.events import HeelStrike
from solepath.fleet import NumberedEvent, told_row
from solepath.fleet.parquet import PartFiles
from solepath.types import Foot

STRIKE = HeelStrike(t=0.1, known_at=0.12, foot=Foot.LEFT)
Place = tuple[int, int]


def written(directory: Path, resumes: list[Place | None], number: int = 0) -> list[Place]:
    """A job of so many partitions: wearers of the same names as ever, one event each."""
    partitions = [str(n) for n in range(len(resumes))]
    parts = [PartFiles(directory, name, resumes[int(name)], partitions=partitions) for name in partitions]
    for part in parts:
        part.write([NumberedEvent(f"w{part.partition}", number, STRIKE)])
    return [part.close() for part in parts]


def found(directory: Path) -> list[tuple[str, int]]:
    """What a reader finds."""
    rows = parquet.read_table(directory).to_pylist()
    return sorted((row["wearer"], row["number"]) for row in rows)


def test_who_begins_anew_with_fewer_partitions_hides_the_parts_of_those_that_are_no_more(tmp_path: Path) -> None:
    """All wearers are numbered anew: of the old events none may stay beside the new."""
    three = written(tmp_path, [None] * 3)
    assert found(tmp_path) == [("w0", 0), ("w1", 0), ("w2", 0)]
    two = written(tmp_path, [None] * 2)
    assert found(tmp_path) == [("w0", 0), ("w1", 0)]
    written(tmp_path, list(three), 1)
    assert found(tmp_path) == [("w0", 0), ("w0", 1), ("w1", 0), ("w1", 1), ("w2", 0), ("w2", 1)], "the first is back"
    written(tmp_path, list(two), 1)
    assert found(tmp_path) == [("w0", 0), ("w0", 1), ("w1", 0), ("w1", 1)], "and the second, without those of the first"


def test_parts_of_a_partition_that_is_no_more_are_not_taken_for_ones_own_though_their_run_began_in_the_same_ms(
    tmp_path: Path,
) -> None:
    other = PartFiles(tmp_path, "1", (5, 0))
    other.write([NumberedEvent("w1", 0, STRIKE)])
    assert other.close() == (5, 1)
    PartFiles(tmp_path, "0", (5, 0), partitions=["0"])
    assert [path.name for path in tmp_path.iterdir()] == [".part-1-5-00000000.parquet.replaced"]


def test_a_job_on_bytewax_hides_the_parts_of_partitions_that_it_does_not_have(tmp_path: Path) -> None:
    pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")
    from solepath.fleet.bytewax import ParquetSink

    written(tmp_path, [None] * 2)
    part = ParquetSink(tmp_path).build_part("files", "0", None)
    part.write_batch([NumberedEvent("w0", 0, STRIKE), NumberedEvent("w1", 0, STRIKE)])
    part.snapshot()
    assert found(tmp_path) == [("w0", 0), ("w1", 0)]


def test_what_others_write_into_the_directory_stays_where_nobody_says_who_writes(tmp_path: Path) -> None:
    written(tmp_path, [None] * 2)
    again = PartFiles(tmp_path, "0")
    again.write([NumberedEvent("w0", 7, STRIKE)])
    again.close()
    assert found(tmp_path) == [("w0", 7), ("w1", 0)]


@pytest.mark.parametrize("name", ["part-0-{run}-00000001.parquet", ".part-0-{run}-00000001.parquet.writing"])
def test_a_directory_with_the_name_of_a_part_is_no_part_and_is_named_where_it_is_in_the_way(
    tmp_path: Path, name: str
) -> None:
    parts = PartFiles(tmp_path)
    parts.write([NumberedEvent("w", 0, STRIKE)])
    place = parts.close()
    strange = tmp_path / name.format(run=parts.run)
    strange.mkdir()
    parts = PartFiles(tmp_path, "0", place)
    parts.write([NumberedEvent("w", 1, STRIKE)])
    with pytest.raises(OSError) as refused:
        parts.close()
    assert refused.value.filename == str(tmp_path / f"part-0-{parts.run}-00000001.parquet")
    strange.rmdir()
    parts = PartFiles(tmp_path, "0", place)
    parts.write([NumberedEvent("w", 1, STRIKE)])
    parts.close()
    assert found(tmp_path) == [("w", 0), ("w", 1)]


@pytest.mark.parametrize(
    ("wearer", "name"), [("\ud800", "\\ud800"), ("ü \udc80", "ü \\udc80"), ("ü\n\x00", "ü\n\x00"), ("", "")]
)
def test_a_wearer_of_any_name_ends_no_job(tmp_path: Path, wearer: str, name: str) -> None:
    """A key may hold half a character, as JSON lets it; a table holds UTF-8."""
    told: list[Any] = [NumberedEvent(wearer, 0, STRIKE), NumberedEvent("w", 0, STRIKE)]
    parts = PartFiles(tmp_path)
    parts.write(told)
    parts.close()
    assert found(tmp_path) == sorted([(name, 0), ("w", 0)])
    assert told_row(told[0])["wearer"] == name
