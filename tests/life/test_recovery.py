"""docs/app.md: after each accident, its very lines continue the walk, and nothing that was recorded is lost."""

from __future__ import annotations

import json
import resource
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from quoted import PAGES, blocks
from recordings import recorded
from soak import soaked
from walks import insoles, of

from solepath import ClockReset, PacketRejected, Rejection, Session, StrideTaken
from solepath.recording import RecordingWarning, read_packets

CUT, TORN, FULL, _, REBOOTED, ZONE, _ = blocks(PAGES["docs/app.md"], "python")[10:]
"""The programs of the life of an app, in their order."""
PACKETS = insoles(cells=24).packets
HALF = len(PACKETS) // 2
Run = Callable[..., dict[str, Any]]


@cache
def state_after(count: int) -> bytes:
    session = Session()
    session.feed(PACKETS[:count])
    return session.pack()


def fed(count: int) -> Session:
    """Return a session that was fed so many packets of the walk."""
    return Session.unpack(state_after(count))


def test_a_recording_that_was_cut_gives_the_session_up_to_its_last_whole_line(run: Run) -> None:
    path = Path("walk-0001.jsonl")
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.warns(RecordingWarning, match="cut off"):
        session = run(CUT)["session"]
    undisturbed = fed(HALF - 1)
    assert session.pack() == undisturbed.pack()
    assert session.feed(PACKETS[HALF - 1 :]) == undisturbed.feed(PACKETS[HALF - 1 :])


@pytest.mark.parametrize(
    ("damage", "saved_after"),
    [
        ("torn", HALF + 200),
        *(pytest.param(damage, HALF + 200, marks=pytest.mark.soak) for damage in ("changed", "absent", "none")),
        ("none", HALF // 3),
    ],
)
def test_whatever_became_of_the_snapshot_all_that_was_recorded_is_used(run: Run, damage: str, saved_after: int) -> None:
    recorded(Path("walk-0002.jsonl"), PACKETS[HALF : HALF + 300])
    names = run(CUT, TORN)
    if saved_after > HALF:
        names["save"](fed(saved_after), "walk-0002.jsonl", saved_after - HALF)
    else:
        names["save"](fed(saved_after), "walk-0001.jsonl", saved_after)
    saved = Path("session.json")
    text = saved.read_text()
    if damage == "torn":
        saved.write_text(text[: len(text) // 2])
    elif damage == "changed":
        changed = json.loads(text)
        changed["session"]["state"]["now"] += 1.0
        saved.write_text(json.dumps(changed))
    elif damage == "absent":
        saved.unlink()
    session, undisturbed = names["resume"](), fed(HALF + 300)
    assert session.pack() == undisturbed.pack()
    rest = PACKETS[HALF + 300 :]
    assert session.feed(rest) + session.finish() == undisturbed.feed(rest) + undisturbed.finish()


@pytest.mark.parametrize("text", ["", '{"format": "solep'])
def test_a_recording_without_a_packet_and_a_state_that_is_none_stop_no_app(run: Run, text: str) -> None:
    for name in ("walk-0000.jsonl", "walk-0002.jsonl"):
        Path(name).write_text(text)
    Path("session.json").write_text("[]")
    assert run(CUT, TORN)["session"].pack() == fed(HALF).pack()


@pytest.fixture
def full_disk() -> Iterator[Callable[[int | None], None]]:
    """Return a function that limits the size of files, bytes, as a full disk does; None for space again."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (soft if size is None else size, hard))
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.soak
def test_on_a_full_disk_the_walk_goes_on_and_its_packets_are_written_when_there_is_space(
    run: Run, full_disk: Callable[[int | None], None], capsys: pytest.CaptureFixture[str]
) -> None:
    names = run(CUT, TORN, FULL)
    received, recording = names["received"], Path(names["recording"])
    assert recording == Path("walk-0002.jsonl")
    events = [event for packet in PACKETS[HALF : HALF + 50] for event in received(packet)]
    full_disk(recording.stat().st_size + 700)
    for packet in PACKETS[HALF + 50 : HALF + 150]:
        events += received(packet)
    assert 50 <= len(list(read_packets(recording))) < 60
    with pytest.raises(OSError, match="too large"):
        names["save"](names["session"], recording.name, 0)
    full_disk(None)
    assert len(names["waiting"]) > 40
    names["save"](names["session"], recording.name, names["writer"].count + len(names["waiting"]))
    for packet in PACKETS[HALF + 150 :]:
        events += received(packet)
    assert events == fed(HALF).feed(PACKETS[HALF:])
    assert names["resume"]().pack() == names["session"].pack()
    timeless = evolve(PACKETS[-1], t=float("nan"))
    assert [event.reason for event in received(timeless)] == [Rejection.NOT_FINITE]
    assert not names["waiting"] and tuple(read_packets(recording)) == PACKETS[HALF:]
    assert "safe" in capsys.readouterr().out


@pytest.mark.parametrize("shift", [-1e5, *soaked(1e5)], ids=["after a reboot", "set forward"])
def test_after_a_reboot_no_packet_is_lost_and_the_track_continues(run: Run, shift: float) -> None:
    names = run(CUT, TORN)
    position = names["session"].position
    names["save"](names["session"], "walk-0001.jsonl", HALF)
    names = run(CUT, TORN, REBOOTED)
    session = names["session"]
    assert {event.site for event in of(ClockReset, names["events"])} == {packet.site for packet in PACKETS}
    rest = [evolve(packet, t=packet.t + shift) for packet in PACKETS[HALF:]]
    session.restart_clock(rest[0].t)  # the test has no clock of its own
    events = session.feed(rest) + session.finish()
    assert not of(PacketRejected, events)
    strides = of(StrideTaken, events)
    assert len(strides) >= max(1, len(of(StrideTaken, Session().feed(PACKETS[HALF:]))))
    assert position is not None and abs(strides[0].position[0] - position.position[0]) < 3.0


def test_the_header_of_a_recording_gives_the_time_of_day_in_the_zone_of_whoever_reads_it(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TZ", "EAST-9")
    time.tzset()
    try:
        names = run(CUT, TORN, FULL, ZONE)
        names["writer"].close()
        now = names["time_of_day"](time.monotonic() + 3600.0, "today.jsonl")
    finally:
        monkeypatch.undo()
        time.tzset()
    assert now.utcoffset() == timedelta(hours=9)
    assert abs(now - datetime.now(UTC) - timedelta(hours=1)) < timedelta(seconds=5)
