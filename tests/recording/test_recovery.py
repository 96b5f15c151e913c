"""docs/recovery.md: after each accident, its very lines continue the walk, and nothing that was recorded is lost."""

from __future__ import annotations

import json
import resource
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from quoted import PAGES, blocks
from walks import insoles, of

from solepath import ClockReset, PacketRejected, Session, StrideTaken
from solepath.recording import PacketWriter, RecordingWarning, read_packets

CUT, TORN, FULL, REBOOTED = blocks(PAGES["docs/recovery.md"], "python")
"""The programs of the page, in their order."""
PACKETS = insoles().packets
HALF = len(PACKETS) // 2

Run = Callable[..., dict[str, Any]]
"""Function that runs programs of the page one after the other, and returns their names."""


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Return a function that runs programs of the page in a folder with the recording of half a walk."""
    monkeypatch.chdir(tmp_path)
    with PacketWriter("walk.jsonl") as writer:
        for packet in PACKETS[:HALF]:
            writer.write(packet)

    def run_programs(*programs: str) -> dict[str, Any]:
        names: dict[str, Any] = {"__name__": "page"}
        for program in programs:
            exec(compile(program, "docs/recovery.md", "exec"), names)
        return names

    return run_programs


def test_a_recording_that_was_cut_gives_the_session_up_to_its_last_whole_line(run: Run) -> None:
    whole = Path("walk.jsonl").read_bytes()
    Path("walk.jsonl").write_bytes(whole[:-30])
    with pytest.warns(RecordingWarning, match="cut off"):
        session = run(CUT)["session"]
    undisturbed = Session()
    undisturbed.feed(PACKETS[: HALF - 1])
    assert session.pack() == undisturbed.pack()
    assert session.feed(PACKETS[HALF - 1 :]) == undisturbed.feed(PACKETS[HALF - 1 :])


@pytest.mark.parametrize("damage", ["torn", "changed", "absent", "none"])
def test_a_snapshot_that_was_torn_is_found_out_and_the_recording_replayed(run: Run, damage: str) -> None:
    names = run(CUT, TORN)
    saved = Path("session.json")
    text = saved.read_text()
    if damage == "torn":
        saved.write_text(text[: len(text) // 2])
    elif damage == "changed":
        changed = json.loads(text)
        changed["state"]["now"] += 1.0
        saved.write_text(json.dumps(changed))
    elif damage == "absent":
        saved.unlink()
    session = names["resume"]()
    undisturbed = Session()
    undisturbed.feed(PACKETS[:HALF])
    assert session.feed(PACKETS[HALF:]) + session.finish() == undisturbed.feed(PACKETS[HALF:]) + undisturbed.finish()


@pytest.fixture
def full_disk() -> Iterator[Callable[[int | None], None]]:
    """Return a function that limits the size of files, bytes, as a full disk does; None for space again."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (soft if size is None else size, hard))
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_on_a_full_disk_the_walk_goes_on_and_its_packets_are_written_when_there_is_space(
    run: Run, full_disk: Callable[[int | None], None], capsys: pytest.CaptureFixture[str]
) -> None:
    names = run(CUT, FULL)
    events = [event for packet in PACKETS[HALF : HALF + 50] for event in names["received"](packet)]
    full_disk(Path("next.jsonl").stat().st_size + 700)
    for packet in PACKETS[HALF + 50 : HALF + 150]:
        events += names["received"](packet)
    assert 50 <= len(list(read_packets("next.jsonl"))) < 60
    full_disk(None)
    for packet in PACKETS[HALF + 150 :]:
        events += names["received"](packet)
    assert tuple(read_packets("next.jsonl")) == PACKETS[HALF:]
    undisturbed = Session()
    undisturbed.feed(PACKETS[:HALF])
    assert events == undisturbed.feed(PACKETS[HALF:])
    assert "safe" in capsys.readouterr().out


@pytest.mark.parametrize("shift", [-1e5, -3.0, 1e5], ids=["after a reboot", "set back by 3 s", "set forward"])
def test_after_a_reboot_no_packet_is_lost_and_the_track_continues(run: Run, shift: float) -> None:
    position = run(CUT, TORN)["session"].position
    names = run(CUT, TORN, REBOOTED)
    session = names["session"]
    assert {event.site for event in of(ClockReset, names["events"])} == {packet.site for packet in PACKETS}
    rest = [evolve(packet, t=packet.t + shift) for packet in PACKETS[HALF:]]
    session.restart_clock(rest[0].t)  # the test has no clock of its own
    events = session.feed(rest) + session.finish()
    assert not of(PacketRejected, events)
    strides = of(StrideTaken, events)
    assert len(strides) >= len(of(StrideTaken, Session().feed(PACKETS[HALF:]))) > 0
    assert position is not None and abs(strides[0].position[0] - position.position[0]) < 3.0
