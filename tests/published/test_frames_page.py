"""Data frames in docs/formats.md: the lines run one after the other, and print what the text says."""

from __future__ import annotations

from pathlib import Path

import pytest
from quoted import run_page
from recordings import recorded
from walks import insoles

from solepath.emulate import Route

for package in ("pandas", "polars", "pyarrow"):
    pytest.importorskip(package, reason=f"{package} is not installed")


def test_the_lines_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path / "walk.jsonl", insoles(Route().stand(2).walk(10).stop(2)).packets)
    (cycles, samples, arrow), names = run_page("docs/formats.md", programs=slice(1, 4))
    assert names["cycles"].attrs["solepath"]["recipe"] == "default"
    assert cycles.rstrip().endswith(" s") and "left" in cycles
    assert "gyro_y" in samples and len(names["samples"]) > 500
    assert "{b'unit': b's'}" in arrow and "GaitCycleMeasured" in arrow
