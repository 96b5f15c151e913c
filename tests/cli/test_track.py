"""Tests `solepath track`: what it prints and writes, and what it does with unusable files."""

import json
import subprocess
from math import degrees, hypot
from pathlib import Path

import numpy as np
import pytest
from commands import no_control_codes, rows_in, run, run_failing
from recordings import recorded
from walks import columns_of, insoles, of, run_session

from solepath import Event, StrideTaken
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.events import LiveEvent
from solepath.recording import read_packets
from solepath.show.output import STRIDE_COLUMNS
from solepath.types import Foot

ROUTE = Route().stand(2.0).walk(8.0, speed=1.3).stop(1.5)


@pytest.fixture(scope="module")
def packets(folder: Path) -> Path:
    """Return 8 m in two insoles over a radio that loses some packets."""
    return recorded(folder / "walk.jsonl", insoles(ROUTE, Radio(loss=0.02, corrupt=0.01), seed=3).packets)


@pytest.fixture(scope="module")
def one_foot(folder) -> Path:
    np.savez(folder / "one.npz", **columns_of(Walker(ROUTE, seed=3), Foot.LEFT))
    return folder / "one.npz"


def events_in(directory: Path) -> list[dict]:
    def reject_constant(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    lines = (directory / "events.jsonl").read_text().splitlines()
    return [json.loads(line, parse_constant=reject_constant) for line in lines]


@pytest.fixture(scope="module")
def tracked(packets, folder) -> tuple[subprocess.CompletedProcess[str], Path]:
    out = folder / "made" / "on the way"
    return run("track", packets, "--recipe", "default", "--out", out), out


def test_track_sums_up_in_plain_text(tracked, packets):
    result, out = tracked
    assert result.returncode == 0 and result.stderr == ""
    assert no_control_codes(result.stdout)
    arrivals = [packet.t for packet in read_packets(packets)]
    assert result.stdout.startswith(f"{packets.name}, recipe default: {arrivals[-1] - arrivals[0]:.1f} s\n")
    assert "samples missing (" in result.stdout and "rejected (" in result.stdout
    assert f"written to {out}" in result.stdout


def test_events_are_strict_json_with_their_times_and_feet(tracked):
    _, out = tracked
    events = events_in(out)
    assert {"HeelStrike", "FootFlat", "HeelOff", "ToeOff", "StrideTaken", "SampleGap"} <= {e["event"] for e in events}
    for event in events:
        assert list(event)[:4] == ["event", "t", "known_at", "final"]
        assert event["known_at"] >= event["t"] and event["final"] in (True, False)
        assert event.get("foot", "left") in ("left", "right")
    assert {"FootMoved", "FootPressed", "WearerMoved"}.isdisjoint(event["event"] for event in events)


def test_steps_and_track_are_tables_of_the_same_walk(tracked):
    _, out = tracked
    steps, track = rows_in(out / "strides.csv"), rows_in(out / "track.csv")
    assert list(steps[0]) == [
        "foot", "t_start_s", "t_end_s", "x_m", "y_m", "z_m", "stride_length_m", "heading_change_deg", "height_change_m",
        "degraded", "missing", "longest_gap_s", "length_sigma_m", "flaws",
    ]  # fmt: skip
    assert list(track[0]) == ["t_s", "foot", "x_m", "y_m", "z_m", "phase"]
    assert {row["phase"] for row in track} == {"LOADING", "STATIONARY", "PUSH_OFF", "SWING"}
    for foot in ("left", "right"):
        times = [float(row["t_s"]) for row in track if row["foot"] == foot]
        assert times == sorted(times) and len(times) > 500
        last = [row for row in track if row["foot"] == foot][-1]
        assert hypot(float(last["x_m"]), float(last["y_m"])) == pytest.approx(8.0, rel=0.1)


@pytest.fixture(scope="module")
def events_of(packets) -> list[Event]:
    """Return the events of a session for the same recording."""
    return run_session(read_packets(packets), poses=True)


def test_every_column_of_strides_equals_the_events(tracked, events_of):
    taken = of(StrideTaken, events_of)
    assert len(taken) > 8 and max(abs(step.heading_change) for step in taken) > 0.01
    for row, step in zip(rows_in(tracked[1] / "strides.csv"), taken, strict=True):
        assert row["foot"] == step.foot.value and row["degraded"] == str(int(step.degraded))
        assert (float(row["t_start_s"]), float(row["t_end_s"])) == (step.t_start, step.t_end)
        x, y, z = step.position
        lengths = {"x_m": x, "y_m": y, "z_m": z, "stride_length_m": step.length, "height_change_m": step.height_change}
        lengths |= {"missing": step.missing, "longest_gap_s": step.longest_gap, "length_sigma_m": step.length_sigma}
        assert row["flaws"] == " ".join(flaw.name.lower() for flaw in step.flaws)
        for column, value in (lengths | {"heading_change_deg": degrees(step.heading_change)}).items():
            assert float(row[column]) == pytest.approx(value, abs=1e-6), column
    assert any(0.0 < step.missing < 0.5 and step.longest_gap > 0.0 for step in taken)


def test_events_of_the_link_name_the_foot_too(tracked, events_of):
    events = events_in(tracked[1])
    assert [e["event"] for e in events] == [type(e).__name__ for e in events_of if not isinstance(e, LiveEvent)]
    of_sites = [event for event in events if event.get("site") is not None]
    assert {"SampleGap", "PacketRejected"} <= {event["event"] for event in of_sites}
    for event in of_sites:
        assert event["site"] == f"{event['foot']}_foot"


def test_a_recording_of_one_foot_is_of_the_foot_that_is_named(one_foot, tmp_path):
    for arguments, foot in (((), "right"), (("--foot", "left"), "left")):
        result = run("track", one_foot, *arguments, "--out", tmp_path)
        assert result.returncode == 0
        assert {row["foot"] for row in rows_in(tmp_path / "track.csv")} == {foot}
        rows = rows_in(tmp_path / "strides.csv")
        found = {(row["foot"], row["degraded"], float(row["missing"]), row["flaws"]) for row in rows}
        assert found == {(foot, "0", 0.0, "")}


def test_the_times_written_are_the_recordings_own(one_foot, tmp_path):
    with np.load(one_foot) as archive:
        later = {key: archive[key] for key in archive.files}
    later["t"] = later["t"] + 1.7e9 + 1 / 3
    np.savez(tmp_path / "later.npz", **later)
    assert run("track", tmp_path / "later.npz", "--out", tmp_path).returncode == 0
    times = [float(row["t_s"]) for row in rows_in(tmp_path / "track.csv")]
    assert times[0] >= later["t"][0] and times[-1] == later["t"][-1]
    assert set(times) <= set(later["t"].tolist())


def test_a_recording_cut_in_the_middle_of_a_line_is_reported_and_loses_nothing_before(packets, tracked, tmp_path):
    cut = tmp_path / "cut.jsonl"
    cut.write_bytes(packets.read_bytes()[:-40])
    result = run("track", cut, "--out", tmp_path)
    assert result.returncode == 0
    lines = packets.read_bytes().count(b"\n")
    assert result.stderr == f"solepath: {cut}: line {lines}: cut off in the middle; everything before it is used\n"
    assert len(rows_in(tmp_path / "strides.csv")) == len(rows_in(tracked[1] / "strides.csv"))


BAD_FILES = {
    "other.jsonl": (b'{"t": 1.0}\n', "line 1: is not the header of a recording"),
    "keys.csv": (b"t,x,y,z\n0,0,0,9.8\n", "line 1: names no column acc_x or pressure_0"),
    "scale.csv": (b"t,acc_x,acc_y,acc_z\n0.00,0,0,1.0\n0.01,0,0,1.0\n", "this looks like g"),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_a_file_that_cannot_be_used_gets_one_line_and_status_2_and_replaces_nothing(tmp_path, name):
    (tmp_path / name).write_bytes(BAD_FILES[name][0])
    earlier = ",".join(STRIDE_COLUMNS) + "\nof an earlier run\n"
    (tmp_path / "strides.csv").write_text(earlier)
    line = run_failing("track", tmp_path / name, "--out", tmp_path)
    assert BAD_FILES[name][1] in line and name in line
    assert {path.name for path in tmp_path.iterdir()} == {name, "strides.csv"}
    assert (tmp_path / "strides.csv").read_text() == earlier


def test_a_header_alone_is_a_whole_recording_of_nothing(tmp_path):
    (tmp_path / "nothing.jsonl").write_text('{"format": "solepath-packets", "version": 1}\n')
    result = run("track", tmp_path / "nothing.jsonl", "--out", tmp_path)
    assert result.returncode == 0 and result.stderr.endswith("nothing.jsonl: holds no packets\n")
    assert "no data from either foot" in result.stdout
    assert events_in(tmp_path) == rows_in(tmp_path / "track.csv") == rows_in(tmp_path / "strides.csv") == []
