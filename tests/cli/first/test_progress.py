"""Tests the line of progress: on a terminal after a second, away at the end, and nothing of it in a file or a pipe."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from commands import no_control_codes
from programs import TAKES, drawn, in_terminal, run

from solepath.show.tables import progress
from solepath.show.tables.progress import ERASE, progress_text

AT_ONCE = "import solepath.show.tables.progress as p; p.FIRST_UPDATE = p.UPDATE_INTERVAL = 0.001; "
"""Code that shows progress from the start, so that a short recording has some."""
TABLE = "t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n"


@pytest.mark.parametrize(
    ("done", "total", "elapsed", "text"),
    [
        (0, 100, 3.0, "walk.csv: 3 s"),
        (1, 100, 3.0, "walk.csv: 1 %"),
        (25, 100, 3.0, "walk.csv: 25 %, about 9 s left"),
        (120, 100, 3.0, "walk.csv: 100 %, about 0 s left"),
        (500, 0, 12.4, "walk.csv: 12 s"),
    ],
)
def test_the_line_has_the_share_and_the_remaining_time(done: int, total: int, elapsed: float, text: str) -> None:
    assert progress_text("walk.csv", done, total, elapsed) == text


@pytest.mark.parametrize("command", [("track",), ("check",), ("track", "--recipe", "default", "--recipe", "gyroscope")])
def test_on_a_terminal_progress_comes_and_goes_and_the_result_stays(recording: Path, command: tuple[str, ...]) -> None:
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "100", "LINES": "40"}
    with in_terminal(*command, recording, code=AT_ONCE, env=environment) as (terminal, process):
        text = drawn(terminal)
        assert process.wait(TAKES) in (0, 1)
    assert "walk.jsonl: " in text and " %, about " in text
    shown, _, rest = text.rpartition(ERASE)
    assert shown and " %, " not in rest and "left" in rest
    assert no_control_codes(rest.replace("\r\n", "\n"))


def test_what_is_printed_meanwhile_is_above_the_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(progress, "FIRST_UPDATE", 0.0)
    with (tmp_path / "screen").open("w+", newline="") as screen:
        line = progress._ProgressLine(screen, "walk.csv", 100)
        while not line._is_drawn:
            time.sleep(0.001)
        line.print_above(screen, "a result\n")
        line.stop()
        screen.seek(0)
        drawn, printed, rest = screen.read().partition(f"{ERASE}a result\n")
    assert drawn.startswith(f"{ERASE}walk.csv: ") and printed
    assert rest == "" or rest.endswith(ERASE)


def test_without_a_terminal_there_is_no_progress(recording: Path) -> None:
    done = run("track", recording)
    assert done.stderr == "" and no_control_codes(done.stdout)
