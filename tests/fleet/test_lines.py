"""Files of lines that phones sent, as a bytewax job reads them: byte for byte, in order, each line once."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

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


def test_a_line_that_is_too_long_is_rejected_and_the_next_is_read(put: Put, tmp_path: Path) -> None:
    longest = b"x" * MAX_LINE_LENGTH
    put("a.jsonl", longest + b"\n" + longest + b"y\n" + b"z" * 5 * MAX_LINE_LENGTH + b"\n{}\n" + longest + b"abc")
    lines, state = read(LineSource(tmp_path))
    assert lines[0] == longest and lines[3] == b"{}"
    assert [len(line) - MAX_LINE_LENGTH for line in lines[1:3] + lines[4:]] == [1, 2, 2]
    reasons = [one.what for one in map(read_line, lines) if isinstance(one, Unreadable)]
    assert ["are the most" in what for what in reasons] == [False, True, True, False, True]
    assert state == {"a.jsonl": (tmp_path / "a.jsonl").stat().st_size}
