"""Each file that is written says how it came about, and each kind of output what is wrong with the recording."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path

import pytest
from commands import run, run_failing

from solepath import Foot, Sample, Site, recipes, to_frame
from solepath.emulate import Route, Walker, emulate
from solepath.recording import PacketWriter
from solepath.saving.provenance import provenance

ROUTE = Route().stand(2.0).walk(12.0, 1.3).stop(2.0)


def table(path: Path, damaged: int = 0) -> Path:
    """Write the samples of the left foot; of the rows from 300 on, so many have a word in place of a number."""
    rows = ["t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z"]
    for number, one in enumerate(Walker(ROUTE, seed=3).samples(Foot.LEFT, 100.0)):
        cells = [*map(repr, [one.t, *(one.acc or ()), *(one.gyro or ())])]
        rows.append(",".join(["broken", *cells[1:]] if 300 <= number < 300 + damaged else cells))
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join([*rows, ""]))
    return path


def test_run_json_report_storage_file_and_dataset_name_the_same_recipe_and_inputs(tmp_path: Path) -> None:
    walk = table(tmp_path / "left.csv")
    out, report, storage, dataset = [tmp_path / name for name in ("out", "walk.html", "walk.sto", "study")]
    run("track", walk, "--out", out, "--report", report)
    run("convert", walk, storage)
    run("convert", walk, dataset, "--subject", "01")
    made = json.loads((out / "run.json").read_text())
    assert made["inputs"] == [{"name": "left.csv", "sha256": sha256(walk.read_bytes()).hexdigest()}]
    assert made["recipe_sha256"] in report.read_text() and made["inputs"][0]["sha256"] in report.read_text()
    header = next(line for line in storage.read_text().splitlines() if line.startswith("solepath="))
    stored = json.loads(header.partition("=")[2])
    sidecar = json.loads(next(dataset.rglob("*_motion.json")).read_text())["GeneratedBy"][0]["Settings"]
    described = json.loads((dataset / "dataset_description.json").read_text())
    assert described["DatasetType"] == "derivative", "positions and events are computed"
    frame = to_frame([Sample(site=Site.LEFT_FOOT, t=0.0)], made_by=provenance(recipes.DEFAULT, [walk]))
    for one in (stored, sidecar, frame.attrs["solepath"]):
        assert {name: one[name] for name in ("solepath", "recipe", "recipe_sha256", "inputs")} == {
            name: made[name] for name in ("solepath", "recipe", "recipe_sha256", "inputs")
        }


def test_files_of_one_name_are_run_again_from_the_words_of_run_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("data.csv", "before.csv"):
        for foot in ("L", "R"):
            table(tmp_path / foot / name)
    words = ["track", "L/data.csv", "./R/data.csv", "--foot", "left,right"]
    compared = ["--compare=L/before.csv", "--report", "r.html"]
    assert "--foot: that is 2 feet for 1 file: L/before.csv" in run_failing(*words, *compared)
    words += ["--compare", "R/before.csv"]
    assert run(*words, *compared, "--out", "first").returncode == 0
    words = json.loads(Path("first", "run.json").read_text())["command_line"]
    assert words[:2] == ["track", "L/data.csv"] and "r.html" not in words
    assert run(*words, "--report", "again.html", "--out", "again").returncode == 0
    assert Path("first", "events.jsonl").read_bytes() == Path("again", "events.jsonl").read_bytes()


def test_the_words_of_run_json_give_the_same_events_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    walk = tmp_path / "here" / "left.csv"
    walk.parent.mkdir()
    text = (
        table(tmp_path / "table.csv").read_text().replace("acc_x", "AX").replace("acc_y", "AY").replace("acc_z", "AZ")
    )
    walk.write_text(text)
    columns = "t=t,acc=AX,AY,AZ,gyro=gyro_x,gyro_y,gyro_z"
    out = tmp_path / "there" / "out"
    out.parent.mkdir()
    words = [f"--compare={walk.parent / 'before.csv'}", "--report", tmp_path / "r.html", "--columns", columns]
    (walk.parent / "before.csv").write_text(text)
    done = run("track", walk, "--recipe", "shoe-sensing", *words, "--out", out)
    assert done.returncode == 0, done.stderr
    words = json.loads((out / "run.json").read_text())["command_line"]
    assert words[:2] == ["track", "left.csv"] and str(tmp_path) not in " ".join(words)
    monkeypatch.chdir(walk.parent)
    again = run(*words, "--out", "out", "--report", "r.html")
    assert again.returncode == 0, again.stderr
    assert (walk.parent / "out" / "events.jsonl").read_bytes() == (out / "events.jsonl").read_bytes()


def test_files_of_one_name_are_told_apart_by_their_folders(tmp_path: Path) -> None:
    files = [table(tmp_path / folder / "walk.csv") for folder in ("a", "b")]
    assert [one["name"] for one in provenance(inputs=files)["inputs"]] == ["a/walk.csv", "b/walk.csv"]


@pytest.mark.parametrize("damaged", [20, 600])
def test_rows_that_are_left_out_are_a_finding_of_every_output(tmp_path: Path, damaged: int) -> None:
    walk, out, report = table(tmp_path / "walk.csv", damaged), tmp_path / "out", tmp_path / "walk.html"
    tracked = run("track", walk, "--out", out, "--report", report)
    checked = run("check", walk)
    findings = {one["code"]: one["text"] for one in json.loads((out / "run.json").read_text())["findings"]}
    assert findings["rows_damaged"].startswith(f"{damaged} of ")
    assert "does not say of which foot" in findings["foot_assumed"]
    for text in (findings["rows_damaged"], findings["foot_assumed"]):
        assert text in tracked.stdout and checked.stdout.count(text) == 1
    assert findings["rows_damaged"] in report.read_text()
    assert checked.returncode == (damaged > 100)


def test_a_table_of_recipes_says_what_is_missing_and_for_how_long(tmp_path: Path) -> None:
    sent = emulate(ROUTE, seed=3).packets
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path) as writer:
        for number, packet in enumerate(sent):
            if (number < 20 or number % 7) and not 6.0 < packet.t < 9.0:
                writer.write(packet)
    text = run("track", path, "--recipe", "default", "--recipe", "shoe-sensing").stdout
    lost = [line for line in text.splitlines() if "missing" in line]
    assert [line.partition(":")[0] for line in lost] == ["left foot", "right foot"], text
    assert all(["absent for 3." in line for line in lost]), text
