"""Tests the line of progress: on a terminal after a second, away at the end, and nothing of it in a file or a pipe."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import no_control_codes
from programs import TAKES, drawn, in_terminal

from solepath.show.tables.progress import ERASE

AT_ONCE = (
    "import sys, solepath.show.tables.progress as p; p.FIRST_UPDATE = p.UPDATE_INTERVAL = 0.001; "
    "sys.setswitchinterval(1e-4); "
)
"""Code that shows progress from the start, and lets its thread run every 0.1 ms, so that a short recording has some."""


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
