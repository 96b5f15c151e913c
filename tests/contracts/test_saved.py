"""Contracts 5 and 7: a session can be saved at any moment and restored elsewhere; equal input gives equal events."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from encoded import other
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from soak import soaked
from walks import NAMES, machines, of

from solepath import Packet, Session, SnapshotError, StrideTaken
from solepath.emulate.routes.building import BUILDING
from solepath.saving.codec import checksum
from solepath.session.state import VERSION

SESSIONS = [name for name in NAMES if name.startswith("session")]
FEW_EXAMPLES = settings(max_examples=2, phases=[Phase.generate])
"""Settings for tests whose every example is a whole walk: few examples, without shrinking."""


def test_an_encoder_may_sort_keys_and_write_whole_floats_as_integers() -> None:
    machine = machines()["session, whole frames"]
    straight = machine.start()
    straight.feed(machine.items[:900])
    restored = Session.restore(json.loads(json.dumps(other(straight.snapshot()))))
    assert restored.feed(machine.items[900:]) == straight.feed(machine.items[900:])


CHILD_PROGRAM = """
import json, sys
from solepath import Packet, Session, Site
saved, packets = json.load(open(sys.argv[1]))
session = Session.restore(saved) if saved else Session(poses=True)
for t, site, channel, data in packets:
    for event in session.feed(Packet(t, Site(site), channel, bytes.fromhex(data))):
        print(repr(event))
for event in session.finish():
    print(repr(event))
"""


def elsewhere(folder: Path, saved: Any, packets: tuple[Packet, ...], **environment: str) -> list[str]:
    """Return the printed events of another process that continues from the snapshot `saved`; None for a new session."""
    input_file = folder / "work.json"
    input_file.write_text(json.dumps([saved, [[p.t, p.site.value, p.channel, p.data.hex()] for p in packets]]))
    process = subprocess.run(
        [sys.executable, "-c", CHILD_PROGRAM, str(input_file)],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
    )
    return process.stdout.splitlines()


def test_a_session_goes_on_in_another_process(tmp_path: Path) -> None:
    machine = machines()["session, whole frames"]
    session = machine.start()
    session.feed(machine.items[:800])
    saved = machine.save(session)
    remaining = session.feed(machine.items[800:]) + session.finish()
    assert len(of(StrideTaken, remaining)) > 3
    assert elsewhere(tmp_path, saved, machine.items[800:]) == [repr(event) for event in remaining]


@pytest.mark.parametrize("name", ["session, four samples a frame", *soaked("session, cc2541 at 20 Hz")])
def test_the_same_packets_give_the_same_events_in_every_process_whatever_its_hashes(name: str, tmp_path: Path) -> None:
    machine = machines()[name]
    expected = [repr(event) for event in machine.events()]
    for seed in ("0", "12345"):
        assert elsewhere(tmp_path, None, machine.items, PYTHONHASHSEED=seed) == expected


@cache
def saved_text(name: str) -> str:
    """Return a snapshot in the middle of a walk, as text."""
    machine = machines()[name]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    return json.dumps(session.snapshot())


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of all values within a JSON value."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path] + [place for key, item in inside for place in places(item, (*path, key))]


@cache
def places_of(name: str) -> list[tuple[Any, ...]]:
    return places(json.loads(saved_text(name)))[1:]


_VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.sampled_from([10**400, -1, 0, 1e308, -1e-308, float("inf"), float("nan")]),
    st.floats(),
    st.text(max_size=5),
    st.just([]),
    st.just({}),
    st.just([[[]]]),
    st.just({"kind": "Cycle", "is": {}}),
    st.just({"kind": [], "is": 3}),
)


@pytest.mark.parametrize(
    "name", ["session, whole frames", "session, cc2650", "session, cc2541", "session, ShoeDetector"]
)
@given(st.data(), _VALUES, st.sampled_from(["replace", "remove", "add"]))
@settings(max_examples=30)
def test_a_damaged_snapshot_is_rejected_and_never_used_in_part(
    name: str, data: st.DataObject, value: Any, how: str
) -> None:
    saved = json.loads(saved_text(name))
    *keys, last_key = data.draw(st.sampled_from(places_of(name)))
    container = saved
    for key in keys:
        container = container[key]
    if how == "remove":
        del container[last_key]
    elif how == "add" and isinstance(container, dict):
        container["more"] = value
    else:
        container[last_key] = value
    try:
        session = machines()[name].load(saved)
    except SnapshotError:
        return
    # minus zero counts as zero: some encoders lose it
    is_same = checksum(session.snapshot()) == checksum(json.loads(saved_text(name)))
    assert is_same, "a changed snapshot was taken for a good one"
    session.feed(machines()[name].items[len(machines()[name].items) // 2 :])


@pytest.mark.parametrize("version", [0, VERSION + 1, 99, "1", 1.0, True, None, [], {}])
def test_a_snapshot_of_another_version_is_rejected_by_name(version: Any) -> None:
    saved = json.loads(saved_text("session, cc2650"))
    saved["solepath"] = version
    with pytest.raises(SnapshotError, match="version"):
        Session.restore(saved)


def test_a_floor_plan_is_not_in_the_snapshot_but_the_same_one_must_be_given_again() -> None:
    machine = machines()["session, particles"]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    other_plan = evolve(BUILDING, levels=BUILDING.levels[:1], connectors=())
    plain_session = Session()
    for restore, saved, plain_state in (
        (Session.restore, machine.save(session), plain_session.snapshot()),
        (Session.unpack, session.pack(), plain_session.pack()),
    ):
        for plan in (None, other_plan):
            with pytest.raises(SnapshotError, match="with the floor plan that it had"):
                restore(saved, floorplan=plan)
        assert restore(saved, floorplan=BUILDING).place == session.place is not None
        with pytest.raises(SnapshotError, match="without a floor plan"):
            restore(plain_state, floorplan=BUILDING)
