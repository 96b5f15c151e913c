"""Tests the line of progress: on a terminal after a second, away at the end, and nothing of it in a file or a pipe."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import no_control_codes
from programs import TAKES, drawn, in_terminal

from solepath.show.tables.progress import ERASE, progress_text

AT_ONCE = "import solepath.show.tables.progress as p; p.FIRST_UPDATE = p.UPDATE_INTERVAL = 0.001; "
"""Code that shows progress from the start, so that a short recording has some."""


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


@pytest.mark.soak
@pytest.mark.parametrize("command", [("check",), ("track", "--recipe", "default", "--recipe", "gyroscope")])
def test_on_a_terminal_progress_comes_and_goes_and_the_result_stays(recording: Path, command: tuple[str, ...]) -> None:
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "100", "LINES": "40"}
    with in_terminal(*command, recording, code=AT_ONCE, env=environment) as (terminal, process):
        text = drawn(terminal)
        assert process.wait(TAKES) in (0, 1)
    assert "walk.jsonl: " in text and " %, about " in text
    shown, _, rest = text.rpartition(ERASE)
    assert shown and " %, " not in rest and "left" in rest
    assert no_control_codes(rest.replace("\r\n", "\n"))
