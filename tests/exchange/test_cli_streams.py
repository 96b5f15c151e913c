"""`live` with streams of LSL and foot pods, as processes that talk to each other in real time."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import uuid
from pathlib import Path

import pytest
from programs import emulator, run, started

pytest.importorskip("pylsl", reason="the extra lsl is not installed")

PROBE = """
import pylsl
outlet = pylsl.StreamOutlet(pylsl.StreamInfo("probe", "Test", 1, 0.0, pylsl.cf_double64, "probe"))
print(len(pylsl.resolve_byprop("name", "probe", timeout=5.0)))
"""


@pytest.fixture(autouse=True)
def layer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the streams to this machine and apart from others; skip where no stream is found."""
    config = tmp_path / "lsl_api.cfg"
    session = uuid.uuid4().hex
    config.write_text(
        f"[multicast]\nResolveScope = machine\n[lab]\nKnownPeers = {{127.0.0.1}}\nSessionID = {session}\n"
    )
    monkeypatch.setenv("LSLAPICFG", str(config))
    found = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, env=os.environ)
    if found.stdout != "1\n":
        pytest.skip("streams of this machine are not found: neither multicast nor loopback works here")


def line_of(process: subprocess.Popen[str], start: str) -> str:
    """Return the first line of a program that starts so."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith(start):
            return line
    raise AssertionError(f"no line starts with {start!r}")


@pytest.mark.long
def test_what_live_publishes_is_run_by_lsl_and_published_again(tmp_path: Path) -> None:
    names = ["--left", "solepath L", "--right", "solepath R"]
    with (
        emulator("--distance", 120) as (_, address),
        started("live", "--via", address, *names, "--lsl", "lab", "--duration", 300) as live,
    ):
        line_of(live, "   ")  # the streams are there since the first sample
        streams = run("scan", "--lsl").stdout.splitlines()
        assert {f"lab {foot}_foot {content}" for foot in ("left", "right") for content in ("samples", "pose")} <= set(
            streams
        )
        given = ["--left", "lsl:lab left_foot samples", "--right", "lsl:lab right_foot samples"]
        done = run("live", *given, "--lsl", "--duration", 8, "--out", tmp_path / "out")
    assert re.search(r"^left +\d{3,} +\d+\.\d +[3-9] ", done.stdout, re.MULTILINE)
    assert re.search(r"published: \d+ in solepath markers, \d+ in solepath events, ", done.stdout)
    events = [json.loads(line) for line in (tmp_path / "out" / "events.jsonl").read_text().splitlines()]
    strikes = [event for event in events if event["event"] == "HeelStrike"]
    assert len(strikes) > 6 and all(-0.5 < event["t"] < 9.0 for event in strikes)


@pytest.mark.long
def test_a_stream_that_is_not_there_is_one_sentence() -> None:
    done = run("live", "--left", "lsl:none of these", expect=2)
    assert "there is no stream 'none of these'; there are: none" in done.stderr


def test_a_stream_without_a_name_or_with_other_units_is_one_sentence() -> None:
    assert "lsl: names no stream" in run("live", "--left", "lsl:", expect=2).stderr
    assert "not ACC,GYRO" in run("live", "--left", "lsl:x", "--units", "g", expect=2).stderr
