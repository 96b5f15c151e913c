"""Contract 1, second half: errors of the caller raise exceptions and change nothing."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from walks import LEFT, Machine, machines

from solepath import Packet, Session, SnapshotError
from solepath.recording import PacketWriter

GOOD_PACKET = Packet(0.0, LEFT, "device/battery", b"\x20")


@pytest.mark.parametrize(
    "data",
    [None, 5, "insole/frame", b"\xf5\x10", [GOOD_PACKET, 5], [b"x"], object()],
    ids=["none", "a number", "text", "bytes", "a list with a number", "a list of bytes", "an object"],
)
def test_what_is_neither_packet_nor_sample_is_a_type_error(data: Any) -> None:
    with pytest.raises(TypeError, match="packets or samples"):
        Session().feed(data)


@pytest.mark.parametrize("change", [{"data": "text"}, {"data": None}, {"site": "left_foot"}, {"channel": None}])
def test_a_packet_of_the_wrong_types_is_a_type_error_and_changes_nothing(change: dict[str, Any]) -> None:
    session = Session()
    snapshot = session.snapshot()
    with pytest.raises(TypeError, match="packet"):
        session.feed(evolve(GOOD_PACKET, **change))
    assert session.snapshot() == snapshot


def test_a_recipe_is_a_recipe() -> None:
    with pytest.raises(TypeError, match="Recipe"):
        Session("default")  # type: ignore[arg-type]


MISTAKES: dict[str, tuple[Callable[[Path], Any], type[Exception], str]] = {
    "an address for all sites": (lambda _: Session(devices="F0:5E"), TypeError, "devices is a dict .*, not str"),  # type: ignore[arg-type]
    "a foot by its name": (lambda _: Session().phase("left"), TypeError, "phase takes a Foot, not str"),  # type: ignore[arg-type]
    "text to be recorded": (lambda path: PacketWriter(path).write("x"), TypeError, "of packets, not str"),  # type: ignore[arg-type]
    "a later release": (
        lambda _: Session.restore(Session().snapshot() | {"solepath": 99}),
        SnapshotError,
        "of version 99; this release reads version [0-9]+ alone: feed the recording again",
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_told_in_a_sentence(name: str, tmp_path: Path) -> None:
    call, error, sentence = MISTAKES[name]
    with pytest.raises(error, match=sentence):
        call(tmp_path / "walk.jsonl")


@pytest.mark.parametrize("now", [nan, inf, -inf])
def test_time_that_is_no_number_cannot_pass(now: float) -> None:
    with pytest.raises(ValueError, match="now"):
        Session().advance(now)


@pytest.mark.parametrize(
    "name", ["session, fragments", "session, cc2650", "session, walking-modes", "session, particles"]
)
def test_a_finished_session_is_read_but_not_fed(name: str) -> None:
    machine: Machine = machines()[name]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    session.finish()
    assert session.finish() == session.advance(machine.items[-1].t + 1e4) == []
    position = session.position
    with pytest.raises(ValueError, match="finished: make a new Session"):
        session.feed(machine.items[-1])
    assert session.position == position
    assert machine.load(machine.save(session)).position == position


@pytest.mark.parametrize("saved", [None, 5, "x", [], {}, {"solepath": 1}, {"state": {}}, {"solepath": 2, "state": {}}])
def test_what_is_no_snapshot_is_a_snapshot_error(saved: Any) -> None:
    with pytest.raises(SnapshotError):
        Session.restore(saved)
