"""The programs of docs/app.md, run in a folder with the recording of half a walk."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from recordings import recorded
from walks import insoles


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., dict[str, Any]]:
    """Return a function that runs programs of the page one after the other, and returns their names."""
    monkeypatch.chdir(tmp_path)
    packets = insoles(cells=24).packets
    recorded(Path("walk-0001.jsonl"), packets[: len(packets) // 2])

    def run_programs(*programs: str) -> dict[str, Any]:
        names: dict[str, Any] = {"__name__": "page"}
        for program in programs:
            exec(compile(program, "docs/app.md", "exec"), names)
        return names

    return run_programs
