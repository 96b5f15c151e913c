"""Files of lines that phones sent, as a bytewax job reads them: byte for byte, in order, each line once."""

from __future__ import annotations

import errno
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")

from solepath.fleet import Unreadable, read_line
from solepath.fleet.lines import LineSource
from solepath.fleet.rows import MAX_LINE_LENGTH

State = dict[str, int]


def read(source: LineSource, part: str = ".", state: State | None = None) -> tuple[list[bytes], State]:
    """Return the lines up to the end, and the state there."""
    partition, lines = source.build_part("phones", part, state), []
    with suppress(StopIteration):
        while True:
            lines += partition.next_batch()
    return lines, partition.snapshot()


@pytest.fixture
def put(tmp_path: Path) -> Callable[[str, bytes], None]:
    """Append data to a file."""

    def write(name: str, data: bytes) -> None:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        with path.open("ab") as file:
            file.write(data)

    return write


Put = Callable[[str, bytes], None]


def test_files_are_read_one_after_the_other_in_the_order_of_their_names(put: Put, tmp_path: Path) -> None:
    for name in ("hour-11.jsonl", "hour-09.jsonl", "hour-10.jsonl", ".hour-12.jsonl", "notes.txt"):
        put(name, b"".join(b"%s %d\n" % (name.encode(), n) for n in range(5)))
    names = [b"hour-09.jsonl", b"hour-10.jsonl", b"hour-11.jsonl"]
    assert read(LineSource(tmp_path, batch=3))[0] == [b"%s %d" % (name, n) for name in names for n in range(5)]
    assert read(LineSource(tmp_path, "*.txt"))[0][0] == b"notes.txt 0"


def test_any_bytes_are_lines_and_empty_ones_are_none(put: Put, tmp_path: Path) -> None:
    put("a.jsonl", b"\xff\xfe\n\n\x00\r\n  \n\xe2\x28\x0b\x0c\x1c\xa1\n")
    assert read(LineSource(tmp_path))[0] == [b"\xff\xfe", b"\x00\r", b"\xe2\x28\x0b\x0c\x1c\xa1"]


@given(st.lists(st.binary(max_size=9).map(lambda line: line.replace(b"\n", b"x")), max_size=20), st.integers(1, 4))
def test_a_job_that_goes_on_from_any_moment_reads_what_comes_behind_it(
    tmp_path_factory: pytest.TempPathFactory, lines: list[bytes], batch: int
) -> None:
    place = tmp_path_factory.mktemp("sent")
    for name, part in (("a", lines[:7]), ("b", lines[7:])):
        (place / f"{name}.jsonl").write_bytes(b"".join(line + b"\n" for line in part))
    source = LineSource(place, batch=batch)
    partition, before = source.build_part("phones", ".", None), []
    expected = [line for line in lines if line.strip()]
    for _ in range(0, len(expected) + 1, batch):
        assert before + read(source, ".", partition.snapshot())[0] == expected
        if len(before) < len(expected):
            before += partition.next_batch()
    assert before == expected


def test_what_is_new_is_read_at_the_next_start_whatever_the_names_and_lines_that_are_half_there_wait(
    put: Put, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    put("w-2.jsonl", b"a\nb\nhalf ")
    lines, state = read(LineSource(tmp_path))
    assert lines == [b"a", b"b"]
    assert caplog.messages == [f"{tmp_path / 'w-2.jsonl'}: the last 5 bytes wait for their line feed"]
    put("w-2.jsonl", b"a line\nc\n")
    put("w-1.jsonl", b"late\n")
    put("w-3.jsonl", b"new\n")
    lines, state = read(LineSource(tmp_path), ".", state)
    assert lines == [b"late", b"half a line", b"c", b"new"]
    (tmp_path / "w-2.jsonl").unlink()
    (tmp_path / "w-3.jsonl").write_bytes(b"!\n")
    assert read(LineSource(tmp_path), ".", state) == ([b"!"], {"w-1.jsonl": 5, "w-3.jsonl": 2})


def test_a_line_that_is_too_long_is_rejected_and_the_next_is_read(put: Put, tmp_path: Path) -> None:
    longest = b"x" * MAX_LINE_LENGTH
    put("a.jsonl", longest + b"\n" + longest + b"y\n" + b"z" * 5 * MAX_LINE_LENGTH + b"\n{}\n" + longest + b"abc")
    lines, state = read(LineSource(tmp_path))
    assert lines[0] == longest and lines[3] == b"{}"
    assert [len(line) - MAX_LINE_LENGTH for line in lines[1:3] + lines[4:]] == [1, 2, 2]
    reasons = [one.what for one in map(read_line, lines) if isinstance(one, Unreadable)]
    assert ["are the most" in what for what in reasons] == [False, True, True, False, True]
    assert state == {"a.jsonl": (tmp_path / "a.jsonl").stat().st_size}


def test_a_directory_in_the_directory_is_read_beside_it(put: Put, tmp_path: Path) -> None:
    for name in ("w-1/a.jsonl", "w-2/a.jsonl", ".trash/a.jsonl", "a.jsonl"):
        put(name, name.encode() + b"\n")
    source = LineSource(tmp_path)
    assert {part: read(source, part)[0] for part in source.list_parts()} == {
        ".": [b"a.jsonl"],
        "w-1": [b"w-1/a.jsonl"],
        "w-2": [b"w-2/a.jsonl"],
    }


def test_who_follows_reads_what_is_written_later_and_does_not_end(put: Put, tmp_path: Path) -> None:
    partition = LineSource(tmp_path, follow=timedelta(hours=1)).build_part("phones", ".", None)
    assert partition.next_awake() is None
    read = []
    for name, data in (("b.jsonl", b"1\n2"), ("b.jsonl", b"2\n"), ("a.jsonl", b"3\n")):
        put(name, data)
        read.append([*partition.next_batch()])
        assert partition.next_awake() is None
        assert partition.next_batch() == []
        assert partition.next_awake() is not None
    assert read == [[b"1"], [b"22"], [b"3"]]


def test_a_directory_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(NotADirectoryError) as error:
        LineSource(tmp_path / "sent")
    assert (error.value.errno, error.value.filename) == (errno.ENOTDIR, str(tmp_path / "sent"))
