"""Contracts 5 and 7: a session can be saved at any moment and restored elsewhere; equal input gives equal events."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from attrs import asdict, evolve
from encoded import other
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from walks import NAMES, PACKET_NAMES, machine_events, machines, of, run_machine

from solepath import Packet, Session, SnapshotError, StrideTaken
from solepath.emulate.routes.building import BUILDING
from solepath.saving.codec import checksum
from solepath.session.state import VERSION

SESSIONS = [name for name in NAMES if name.startswith("session")]
FEW_EXAMPLES = settings(max_examples=2, phases=[Phase.generate])
"""Settings for tests whose every example is a whole walk: few examples, without shrinking."""


@pytest.mark.parametrize("name", NAMES)
@given(st.data())
@FEW_EXAMPLES
def test_a_machine_saved_at_any_moment_goes_on_as_if_nothing_had_happened(name: str, data: st.DataObject) -> None:
    machine = machines()[name]
    cut = data.draw(st.integers(0, len(machine.items)))
    # cut = 0 is always tried; the machine has no state there yet, so 100 items are enough
    end = len(machine.items) if cut else min(100, len(machine.items))
    straight = machine.start()
    for item in machine.items[:cut]:
        straight.feed(item)
    restored = machine.load(machine.save(straight))
    assert machine.save(restored) == machine.save(straight)
    if isinstance(straight, Session):
        repacked = machine.repacked(straight)
        assert repacked._state == restored._state
        assert json.dumps(repacked.snapshot()) == json.dumps(straight.snapshot()), "-0.0 is not 0.0"
    for item, events in zip(machine.items[cut:end], machine_events(name)[cut:end], strict=True):
        assert repr(restored.feed(item)) == repr([*events])
    if cut:
        assert repr(restored.finish()) == repr([*machine_events(name)[-1]])
        assert machine.save(restored) == run_machine(name).ended


@pytest.mark.parametrize("name", ["session, whole frames", "session, cc2541", "session, cc2650", "decoder, fragments"])
def test_a_machine_saved_before_every_thirtieth_item_is_the_same_machine(name: str) -> None:
    machine = machines()[name]
    session, events = machine.start(), []
    for k, item in enumerate(machine.items):
        if k % 30 == 0:
            session = machine.load(machine.save(session)) if k % 60 else machine.repacked(session)
        events += session.feed(item)
    assert events + session.finish() == machine.events()


def test_an_encoder_may_sort_keys_and_write_whole_floats_as_integers() -> None:
    machine = machines()["session, whole frames"]
    straight = machine.start()
    straight.feed(machine.items[:900])
    restored = Session.restore(json.loads(json.dumps(other(straight.snapshot()))))
    assert restored.feed(machine.items[900:]) == straight.feed(machine.items[900:])


def test_a_snapshot_is_a_copy_and_saving_changes_nothing() -> None:
    machine = machines()["session, samples with pressure"]
    session = machine.start()
    session.feed(machine.items[:700])
    saved = session.snapshot()
    text = json.dumps(saved, allow_nan=False)
    events = session.feed(machine.items[700:])
    assert json.dumps(saved) == text
    twice = [Session.restore(saved) for _ in range(2)]
    assert twice[0].feed(machine.items[700:]) == twice[1].feed(machine.items[700:]) == events
    assert json.dumps(saved) == text


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


@pytest.mark.parametrize("name", ["session, four samples a frame", "session, cc2541 at 20 Hz"])
def test_the_same_packets_give_the_same_events_in_every_process_whatever_its_hashes(name: str, tmp_path: Path) -> None:
    machine = machines()[name]
    expected = [repr(event) for event in machine.events()]
    for seed in ("0", "12345"):
        assert elsewhere(tmp_path, None, machine.items, PYTHONHASHSEED=seed) == expected


@pytest.mark.parametrize("name", SESSIONS)
def test_two_sessions_of_one_recipe_share_nothing(name: str) -> None:
    machine = machines()[name]
    session, second_session = machine.start(), machine.start()
    first_items = machine.items[: len(machine.items) // 3]
    events = [event for item in first_items for event in session.feed(item)]
    assert [event for item in first_items for event in second_session.feed(item)] == events
    assert asdict(machine.start().recipe) == asdict(session.recipe)


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


@pytest.mark.parametrize("name", ["session, whole frames", "session, cc2650", "session, cc2541", "session, Graph"])
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


@pytest.mark.parametrize("name", [name for name in PACKET_NAMES if name.startswith("session")])
def test_a_flipped_digit_is_noticed(name: str) -> None:
    text = saved_text(name)
    match = re.search(r'"newest_arrival": (\d)', text)
    assert match is not None
    index = match.start(1)
    digit = str((int(text[index]) + 1) % 10)
    with pytest.raises(SnapshotError, match="damaged"):
        Session.restore(json.loads(text[:index] + digit + text[index + 1 :]))


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
