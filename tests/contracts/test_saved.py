"""Contracts 5 and 7: any moment can be saved and restored elsewhere; equal input gives equal events everywhere."""

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
QUICK = settings(max_examples=2, phases=[Phase.generate])
"""A walk an example: few of them, and no shrinking."""


@pytest.mark.parametrize("name", NAMES)
@given(st.data())
@QUICK
def test_a_machine_saved_at_any_moment_goes_on_as_if_nothing_had_happened(name: str, data: st.DataObject) -> None:
    machine = machines()[name]
    cut = data.draw(st.integers(0, len(machine.items)))
    # a machine that remembers nothing yet, which is always tried, need not go all the way
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
    one, events = machine.start(), []
    for k, item in enumerate(machine.items):
        if k % 30 == 0:
            one = machine.load(machine.save(one)) if k % 60 else machine.repacked(one)
        events += one.feed(item)
    assert events + one.finish() == machine.events()


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


CHILD = """
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
    """The events of another process that goes on from `saved`, as it prints them."""
    file = folder / "work.json"
    file.write_text(json.dumps([saved, [[p.t, p.site.value, p.channel, p.data.hex()] for p in packets]]))
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(file)],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
    )
    return done.stdout.splitlines()


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
    here = [repr(event) for event in machine.events()]
    for seed in ("0", "12345"):
        assert elsewhere(tmp_path, None, machine.items, PYTHONHASHSEED=seed) == here


@pytest.mark.parametrize("name", SESSIONS)
def test_two_sessions_of_one_recipe_share_nothing(name: str) -> None:
    machine = machines()[name]
    one, other = machine.start(), machine.start()
    some = machine.items[: len(machine.items) // 3]
    events = [event for item in some for event in one.feed(item)]
    assert [event for item in some for event in other.feed(item)] == events
    assert asdict(machine.start().recipe) == asdict(one.recipe)


@cache
def taken(name: str) -> str:
    """A snapshot in the middle of a walk, as text."""
    machine = machines()[name]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    return json.dumps(session.snapshot())


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths of everything within a JSON value."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path] + [place for key, item in inside for place in places(item, (*path, key))]


@cache
def places_of(name: str) -> list[tuple[Any, ...]]:
    return places(json.loads(taken(name)))[1:]


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
    saved = json.loads(taken(name))
    *way, last = data.draw(st.sampled_from(places_of(name)))
    spot = saved
    for key in way:
        spot = spot[key]
    if how == "remove":
        del spot[last]
    elif how == "add" and isinstance(spot, dict):
        spot["more"] = value
    else:
        spot[last] = value
    try:
        session = machines()[name].load(saved)
    except SnapshotError:
        return
    # minus zero counts as zero: some encoders lose it
    same = checksum(session.snapshot()) == checksum(json.loads(taken(name)))
    assert same, "a changed snapshot was taken for a good one"
    session.feed(machines()[name].items[len(machines()[name].items) // 2 :])


@pytest.mark.parametrize("version", [0, VERSION + 1, 99, "1", 1.0, True, None, [], {}])
def test_a_snapshot_of_another_version_is_rejected_by_name(version: Any) -> None:
    saved = json.loads(taken("session, cc2650"))
    saved["solepath"] = version
    with pytest.raises(SnapshotError, match="version"):
        Session.restore(saved)


@pytest.mark.parametrize("name", [name for name in PACKET_NAMES if name.startswith("session")])
def test_a_flipped_digit_is_noticed(name: str) -> None:
    text = taken(name)
    found = re.search(r'"arrived": (\d)', text)
    assert found is not None
    at = found.start(1)
    digit = str((int(text[at]) + 1) % 10)
    with pytest.raises(SnapshotError, match="damaged"):
        Session.restore(json.loads(text[:at] + digit + text[at + 1 :]))


def test_a_floor_plan_is_not_in_the_snapshot_but_the_same_one_must_be_given_again() -> None:
    one = machines()["session, particles"]
    session = one.start()
    session.feed(one.items[: len(one.items) // 2])
    other = evolve(BUILDING, levels=BUILDING.levels[:1], connectors=())
    bare = Session()
    for taken_up, saved, without in (
        (Session.restore, one.save(session), bare.snapshot()),
        (Session.unpack, session.pack(), bare.pack()),
    ):
        for plan in (None, other):
            with pytest.raises(SnapshotError, match="with the floor plan that it had"):
                taken_up(saved, floorplan=plan)
        assert taken_up(saved, floorplan=BUILDING).place == session.place is not None
        with pytest.raises(SnapshotError, match="without a floor plan"):
            taken_up(without, floorplan=BUILDING)
