"""`solepath batch`: the recordings of a study in one set of tables, whatever ends the command on the way."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

import pytest
from commands import rows_in, run, run_failing
from pyarrow import parquet
from soak import soaked
from truths import both_feet, table, walker

from solepath.emulate import Route
from solepath.recording import PacketWriter

SOLEPATH = (sys.executable, "-m", "solepath")
TABLES = ("strides.csv", "gait_cycles.csv", "bouts.csv", "outcomes.csv", "failures.csv", "run.json")
ROUTE = Route().stand(1.0).walk(7.0, 1.3).stop(1.0)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the table of two walks, a file that is missing and one that is broken, as Excel writes it in Germany."""
    folder = tmp_path_factory.mktemp("study")
    rows = []
    for number in (1, 2):
        files = both_feet(folder / "data", f"P{number}", walker(number, ROUTE))
        names = ";".join([f"data/{file.name}" for file in files])
        rows.append((f'"{names}"', f"00{number}", ("alone", '"with; a dog"')[number - 1]))
    (folder / "data" / "broken.csv").write_text("nothing\nof\nuse\n")
    rows += [("data/missing.csv", "003", "slow"), ("data/broken.csv", "004", "slow")]
    return table(folder / "study.csv", "\ufefffile,participant,condition", rows, separator=";")


def hashes(out: Path) -> dict[str, str]:
    return {name: sha256((out / name).read_bytes()).hexdigest() for name in TABLES}


@pytest.fixture(scope="module")
def out(study: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("out")
    done = run("batch", study, "--out", folder, "--processes", 1)
    assert done.returncode == 1, "two recordings failed"
    assert done.stdout.startswith("4 recordings: 2 done (4 run now), 2 failed; written to ")
    yield folder


def test_own_columns_come_first_and_the_rest_is_what_track_writes(study: Path, out: Path, tmp_path: Path) -> None:
    run("track", *sorted((study.parent / "data").glob("P2_*")), "--outcomes", "--out", tmp_path)
    for name in ("strides.csv", "gait_cycles.csv", "bouts.csv"):
        header, *rows = csv.reader((out / name).read_text().splitlines())
        alone = [*csv.reader((tmp_path / name).read_text().splitlines())]
        assert header == ["file", "participant", "condition", *alone[0]]
        assert [row[3:] for row in rows if row[1] == "002"] == alone[1:] != []
        assert {tuple(row[1:3]) for row in rows} == {("001", "alone"), ("002", "with; a dog")}


def test_a_recording_is_one_line_of_outcomes(study: Path, out: Path, tmp_path: Path) -> None:
    run("track", *sorted((study.parent / "data").glob("P1_*")), "--outcomes", "--out", tmp_path)
    alone = {(row["part"], row["outcome"]): row["value"] for row in rows_in(tmp_path / "outcomes.csv")}
    first, second = rows_in(out / "outcomes.csv")
    assert [first["participant"], second["participant"]] == ["001", "002"]
    assert first["steady_speed_m_per_s"] == alone["mobility", "steady_speed"] != ""
    assert first["wbsteps_all_sum"] == alone["mobility", "wbsteps_all_sum"]
    assert first["variability_stride_time"] == alone["variability", "stride_time"]


def test_a_file_that_cannot_be_used_is_one_line_with_its_reason(out: Path) -> None:
    failed = rows_in(out / "failures.csv")
    assert [(row["participant"], row["condition"]) for row in failed] == [("003", "slow"), ("004", "slow")]
    assert failed[0]["reason"].endswith("missing.csv: there is no such file")
    assert "broken.csv" in failed[1]["reason"]
    assert {row["participant"] for row in rows_in(out / "strides.csv")} == {"001", "002"}


def test_every_table_says_how_it_came_about(study: Path, out: Path) -> None:
    made = json.loads((out / "run.json").read_text())
    files = {one["name"]: one["sha256"] for one in made["inputs"]}
    assert files["study.csv"] == sha256(study.read_bytes()).hexdigest() and len(files) == 6
    assert (made["recipe"], made["recordings"], made["failed"]) == ("default", 4, 2)
    of_one = [json.loads(path.read_text()) for path in sorted((out / "recordings").glob("P1*/run.json"))]
    assert [len(one["inputs"]) for one in of_one] == [2]


def test_done_recordings_are_not_run_again_unless_something_is_different(study: Path, out: Path) -> None:
    before = hashes(out)
    again = run("batch", study, "--out", out)
    assert "2 done (2 run now), 2 failed" in again.stdout, "failed ones are tried again"
    assert hashes(out) == before
    other = run("batch", study, "--out", out, "--recipe", "shoe-sensing")
    assert "2 done (4 run now)" in other.stdout and hashes(out) != before
    back = run("batch", study, "--out", out)
    assert "2 done (2 run now)" in back.stdout and hashes(out) == before


@pytest.mark.parametrize("processes", [*soaked(1), 3])
def test_a_kill_in_the_middle_changes_nothing(study: Path, out: Path, tmp_path: Path, processes: int) -> None:
    """After kill -9 what was half done is made again, and the tables are the same to the byte."""
    asked = ["batch", str(study), "--out", str(tmp_path), "--processes", str(processes)]
    parts = tmp_path / "recordings"
    with subprocess.Popen([*SOLEPATH, *asked], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None and not [*parts.glob(".part-*")]:
            time.sleep(0.01)
        os.kill(process.pid, signal.SIGKILL)
    assert not (tmp_path / "strides.csv").exists()
    (parts / ".part-left").mkdir(parents=True, exist_ok=True)
    done = run(*asked)
    assert done.returncode == 1 and "2 done" in done.stdout, done.stderr
    assert hashes(tmp_path) == hashes(out)
    assert not [*parts.glob(".part-*")]


def test_recordings_with_other_outcomes_share_one_table_which_the_next_run_replaces(tmp_path: Path) -> None:
    """Of a short walk some outcomes are not known, and they have their columns all the same, in one order."""
    rows = []
    for number, metres in ((1, 4.0), (2, 40.0), (3, 12.0)):
        files = both_feet(
            tmp_path / "data", f"P{number}", walker(number, Route().stand(1.0).walk(metres, 1.3).stop(1.0))
        )
        rows.append((";".join([f"data/{file.name}" for file in files]), "-10 %"))
    for order in (rows, rows[::-1]):
        study = table(tmp_path / "study.csv", "file,condition", order)
        done = run("batch", study, "--out", tmp_path / "out")
        assert done.returncode == 0 and run("batch", study, "--out", tmp_path / "out").returncode == 0, done.stderr
        header = (tmp_path / "out" / "outcomes.csv").read_text().partition("\n")[0].split(",")
        assert header[:2] == ["file", "condition"] and header[-1] == "findings"
        assert header.index("variability_stride_time") < header.index("asymmetry_stance_time")
        assert {row["condition"] for row in rows_in(tmp_path / "out" / "strides.csv")} == {"-10 %"}
    table(study, "file,wbsteps_all_sum", [rows[0]])
    assert "has a column wbsteps_all_sum, as the results have" in run_failing("batch", study, "--out", tmp_path / "out")


def test_parquet_has_the_same_values_with_numbers_as_numbers_and_names_as_texts(
    study: Path, out: Path, tmp_path: Path
) -> None:
    own = table(tmp_path / "study.csv", "file,participant,condition", [], separator=";")
    own.write_text(study.read_text("utf-8-sig").replace("slow", "=1+1").replace("data/", f"{study.parent}/data/"))
    assert run("batch", own, "--out", tmp_path).returncode == 1 and (tmp_path / "strides.csv").exists()
    run("batch", own, "--out", tmp_path, "--parquet")
    assert not (tmp_path / "strides.csv").exists(), "the tables of run.json are the only ones"
    assert parquet.read_table(tmp_path / "failures.parquet")["condition"].to_pylist() == ["=1+1"] * 2
    for name in ("strides", "gait_cycles", "bouts", "outcomes", "failures"):
        read = parquet.read_table(tmp_path / f"{name}.parquet")
        rows = rows_in(out / f"{name}.csv")
        assert read.column_names == [*rows[0]] and read.num_rows == len(rows)
        assert read["participant"].to_pylist() == [row["participant"] for row in rows]
        assert json.loads(read.schema.metadata[b"solepath"])["recipe"] == "default"
    lengths = parquet.read_table(tmp_path / "strides.parquet")["stride_length_m"].to_pylist()
    assert lengths == [float(row["stride_length_m"]) for row in rows_in(out / "strides.csv")]
    assert run("batch", own, "--out", tmp_path, "--parquet").returncode == 1, "its own files are replaced"


def test_a_table_that_is_no_study_gets_one_line(tmp_path: Path) -> None:
    path, out = tmp_path / "study.csv", tmp_path / "out"
    for text, said in (
        ("name\nP1.csv\n", "line 1: needs one column file"),
        ("file,foot\nP1.csv,left\n", "has a column foot, as the results have"),
        ("file,file\nP1.csv,left\n", "line 1: needs one column file"),
        ("file,condition\nP1.csv,with, a dog\n", "line 2: 3 values, and the header has 2"),
        ("", "line 1: needs one column file"),
        ("file,condition\n", "has no line below the names"),
    ):
        path.write_text(text)
        assert said in run_failing("batch", path, "--out", out)
    assert not out.exists()


def test_a_study_without_a_usable_recording_has_tables_without_rows(tmp_path: Path) -> None:
    with PacketWriter(tmp_path / "nothing.jsonl"):
        pass
    path = table(tmp_path / "study.csv", "file,group", [("", "a"), ("nothing.jsonl", "b")])
    done = run("batch", path, "--out", tmp_path / "out")
    reasons = {row["group"]: row["reason"] for row in rows_in(tmp_path / "out" / "failures.csv")}
    assert reasons.get("a") == "the column file is empty", done.stderr
    assert done.returncode == 1
    run("batch", path, "--out", tmp_path / "out", "--parquet")
    assert parquet.read_table(tmp_path / "out" / "strides.parquet").num_rows == 0


@pytest.mark.long
def test_the_recorded_walks_of_a_data_set_killed_and_resumed_give_the_same_tables(
    data_dir: Path, tmp_path: Path
) -> None:
    """The 60 walks of ipol_10m_uturn, and a file that is broken."""
    files = sorted((data_dir / "ipol_10m_uturn").glob("*.npz"))
    if not files:
        pytest.skip(f"no ipol_10m_uturn in {data_dir}")
    broken = tmp_path / "broken.npz"
    broken.write_bytes(files[0].read_bytes()[:5000])
    rows = [(file, file.stem.partition("-")[0]) for file in [*files[:7], broken, *files[7:]]]
    study, whole, killed = table(tmp_path / "study.csv", "file,participant", rows), tmp_path / "a", tmp_path / "b"
    run("batch", study, "--out", whole)
    words = [*SOLEPATH, "batch", str(study), "--out", str(killed)]
    for count in (5, 25):
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while len([*killed.glob("recordings/*-*/run.json")]) < count:
                time.sleep(0.05)
            os.kill(process.pid, signal.SIGKILL)
    assert run("batch", study, "--out", killed).returncode == 1
    assert hashes(killed) == hashes(whole)
    assert len(rows_in(whole / "outcomes.csv")) == len(files) and len(rows_in(whole / "failures.csv")) == 1
