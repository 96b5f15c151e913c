"""Tests the options of `solepath track` for the report."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import run
from pages import read_page
from recordings import recorded
from walks import insoles

from solepath.emulate.routes.route import Route


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    walk = insoles(Route().stand(1.5).walk(15.0, 1.3).stop(1.0), cells=24)
    return recorded(tmp_path_factory.mktemp("walk") / "walk.jsonl", walk.packets)


@pytest.mark.soak
def test_the_options_are_shown_in_the_report(recording: Path, tmp_path: Path) -> None:
    bands, report = tmp_path / "bands.csv", tmp_path / "r.html"
    bands.write_text("measure,low,high,source\ncadence_steps_per_min,100,125,A laboratory\n")
    given = ("--title", "A test", "--subject", "P 1", "--date", "2026-01-02", "--device", "insoles")
    options = (*given, "--reference", "72,female", "--reference", bands, "--compare", recording)
    done = run("track", recording, "--report", report, *options)
    assert done.returncode == 0, done.stderr
    page = read_page(report)
    assert page.first("h1").text == "A test"
    head = page.first("header").text
    assert "P 1" in head and "2 January 2026" in head and "insoles" in head
    assert "A laboratory" in page.text and "Bohannon and Andrews 2011" in page.text
    rows = [row for row in page.named("comparison").all("tr") if row.first("th").text == "speed, m/s"]
    assert [cell.text for cell in rows[0].all("td")][2].startswith("+0.00")
