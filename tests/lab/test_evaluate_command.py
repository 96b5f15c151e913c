"""Tests `solepath-lab evaluate`: tables, JSON and Markdown of a made data set, and what it needs."""

import json
import re
from math import radians
from pathlib import Path

import numpy as np
import pytest
from commands import no_control_codes, run, run_failing
from walks import columns_of

from solepath.calibration import Calibration
from solepath.calibration.file import write_calibration
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath_lab.command import main as lab
from solepath_lab.evaluate.datasets import DATASETS
from solepath_lab.evaluate.report import Result
from solepath_lab.measures.score import Scored
from solepath_lab.tables.columns import FIGURES
from solepath_lab.tables.scores import score_table, words_of


@pytest.fixture(scope="module")
def data(tmp_path_factory) -> Path:
    """Return a made data set: a closed loop around a square."""
    route = Route().stand(2.0)
    for _ in range(4):
        route = route.walk(3.0, speed=1.2).turn(radians(90), radius=1.0)
    folder = tmp_path_factory.mktemp("data")
    loops = folder / "xio_closed_walks"
    loops.mkdir()
    np.savez(loops / "loop.npz", **columns_of(Walker(route.stop(1.0)), Foot.RIGHT))
    (loops / "broken.npz").write_bytes(b"")
    about = {name: {"closed_loop": True, "path_m_about": route.length} for name in ("loop", "broken", "absent")}
    (loops / "dataset.json").write_text(json.dumps({"recordings": about | {"open": {"closed_loop": False}}}))
    return folder


@pytest.mark.soak
def test_evaluate_scores_what_there_is_in_tables_and_json(data, tmp_path, monkeypatch):
    monkeypatch.setenv("SOLEPATH_DATA", str(data))
    result = run("evaluate", "--processes", 1, "--json", tmp_path / "scores.json", program=lab)
    assert result.returncode == 0 and result.stderr == ""
    assert no_control_codes(result.stdout)
    assert "failed: " in result.stdout and "broken.npz: is empty" in result.stdout
    scores = json.loads((tmp_path / "scores.json").read_text())["default"]["xio_closed_walks"]
    assert list(scores["recordings"]) == ["loop"] and len(scores["failures"]) == 1
    figures = scores["recordings"]["loop"]
    assert figures["path"] == pytest.approx(12.0 + 2 * 3.14159, abs=0.01)
    # exact samples: the loop closes within the foot's own placement
    assert figures["end_error_2d"] < 0.5
    assert scores["summary"]["all"]["mean"]["end_error"] == figures["end_error"]
    assert f"{figures['end_error']:.3f}" in result.stdout


def test_all_tables_fit_a_terminal_and_every_column_is_explained():
    walks = tuple(Scored(f"walk {k}", figures=dict.fromkeys(FIGURES, 1234.5 * k)) for k in (1, 2))
    result = Result(next(one for one in DATASETS if one.lists_recordings), "default", walks)
    lines = [*score_table(result).splitlines(), *(words := words_of([result]).splitlines())]
    assert max(map(len, lines)) <= 120
    headers = [re.split(" {2,}", line)[1:] for line in lines if line.startswith("recording ")]
    titles = [title for header in headers for title in header]
    assert titles == [line.partition(" = ")[0] for line in words if not line.startswith(" ")]
    assert len(set(titles)) == len(FIGURES) and len(headers) > 1


def test_the_laboratory_says_its_version():
    assert re.fullmatch(r"solepath-lab \S+, (pure|compiled)\n", run("--version", program=lab).stdout)


def test_the_main_program_names_the_laboratory():
    assert "there is no command 'evaluate' here: it is one of solepath-lab" in run_failing("evaluate")


def test_evaluate_without_data_names_what_it_needs(data, tmp_path, monkeypatch):
    monkeypatch.delenv("SOLEPATH_DATA", raising=False)
    needs = "evaluate needs DIR, or the environment variable SOLEPATH_DATA, or --emulated"
    assert needs in run_failing("evaluate", program=lab)
    assert "does not hold any of the data sets" in run_failing("evaluate", tmp_path, program=lab)
    assert "--only: there is no data set 'mars'" in run_failing("evaluate", data, "--only", "mars", program=lab)


def test_evaluate_writes_over_nothing_that_it_reads_and_over_no_file_of_another_program(tmp_path):
    scores, known, truth = tmp_path / "old.json", tmp_path / "me.json", tmp_path / "openshoe_loops" / "dataset.json"
    scores.write_text("{}\n")
    write_calibration(known, Calibration())
    truth.parent.mkdir()
    truth.write_text('{"recordings": {}}')
    notes = tmp_path / "notes.json"
    notes.write_text("my own notes\n")
    before = {path: path.read_bytes() for path in (scores, known, truth, notes)}
    for arguments in (
        ("--compare", scores, "--json", scores), ("--calibration", known, "--json", known), ("--json", truth)
    ):  # fmt: skip
        line = run_failing("evaluate", tmp_path, *arguments, "--force", program=lab)
        assert line.endswith(": is what this command reads; write to another file\n"), arguments
    assert "--force replaces it" in run_failing("evaluate", tmp_path, "--json", notes, program=lab)
    assert {path: path.read_bytes() for path in before} == before
