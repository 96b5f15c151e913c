"""Replacement of whole files that another program records into, replaces or makes at the same time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from solepath.recording import PacketWriter
from solepath.saving.files import write_whole

WRITER = """
import sys
from solepath.saving.files import write_whole
for k in range(300):
    write_whole(sys.argv[1], sys.argv[2] * 1000)
"""


def test_a_recording_is_not_replaced_while_it_is_written(tmp_path: Path) -> None:
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path):
        before = path.read_bytes()
        with pytest.raises(OSError, match=r"another program is recording into it: .*walk\.jsonl"):
            write_whole(path, "text")
        assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]
    path.chmod(0o640)
    write_whole(path, "text")
    assert path.read_text() == "text" and path.stat().st_mode & 0o777 == 0o640


def test_programs_that_replace_one_file_at_once_wait_for_each_other(tmp_path: Path) -> None:
    path = tmp_path / "session.json"
    writers = [subprocess.Popen([sys.executable, "-c", WRITER, str(path), letter]) for letter in "ab"]
    assert [writer.wait(60) for writer in writers] == [0, 0]
    assert path.read_text() in ("a" * 1000, "b" * 1000) and list(tmp_path.iterdir()) == [path]


def test_a_file_that_another_program_makes_just_now_is_checked_before_it_is_replaced(tmp_path: Path) -> None:
    path, contents = tmp_path / "me.json", list[str]()

    def check(path: Path) -> None:
        contents.append(path.read_text() if path.exists() else "")
        path.write_text("other")

    write_whole(path, "text", check)
    assert contents == ["", "other"] and path.read_text() == "text"
    assert list(tmp_path.iterdir()) == [path]
