"""States of older versions go on: tests/states/N holds walks, and what version N remembered in the middle of them."""

from __future__ import annotations

import gzip
import json
from collections import Counter
from functools import cache
from math import dist
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from encoded import other
from signed import signed
from solepath import Packet, Session, Site, SnapshotError, StepTaken
from solepath.saving import pin
from solepath.saving.codec import save
from solepath.saving.older import pinned
from solepath.saving.records import shape, snapshot_shape
from solepath.saving.upgrades import UPGRADES
from solepath.session.state import VERSION
from walks import of

STATES = Path(__file__).parent / "states"
KEPT = [(version, name) for version in range(1, VERSION) for name in ("insoles", "tags")]
"""What is in the folder: two insoles of 16 cells, and two CC2650, over a radio that loses some."""


def held(version: int, name: str, what: str) -> bytes:
    return gzip.decompress((STATES / str(version) / f"{name}.{what}.gz").read_bytes())


def walked(version: int, name: str) -> list[Packet]:
    rows = json.loads(held(version, name, "packets.json"))
    return [Packet(t, Site(site), channel, bytes.fromhex(data)) for t, site, channel, data in rows]


def taken_up(version: int, name: str, form: str) -> Session:
    """The session as it was in the middle of the walk."""
    if form == "packed":
        return Session.unpack(held(version, name, form))
    return Session.restore(json.loads(held(version, name, form)))


@cache
def halves(version: int, name: str) -> tuple[list[Packet], list[Packet]]:
    """What came before the state was taken, and after."""
    now = json.loads(held(version, name, "snapshot.json"))["state"]["now"]
    packets = walked(version, name)
    return [packet for packet in packets if packet.t <= now], [packet for packet in packets if packet.t > now]


@cache
def uninterrupted(version: int, name: str) -> list[Any]:
    """The events of the rest of the walk, of a session of this version that was there from its beginning."""
    before, after = halves(version, name)
    session = Session()
    session.feed(before)
    return session.feed(after) + session.finish()


@pytest.mark.parametrize("form", ["packed", "snapshot.json"])
@pytest.mark.parametrize(("version", "name"), KEPT)
def test_a_state_of_an_older_version_goes_on_within_centimetres_and_loses_no_event(
    version: int, name: str, form: str
) -> None:
    session = taken_up(version, name, form)
    events = session.feed(halves(version, name)[1]) + session.finish()
    usual = uninterrupted(version, name)
    assert Counter(type(event) for event in events) == Counter(type(event) for event in usual)
    steps, expected = of(StepTaken, events), of(StepTaken, usual)
    assert len(steps) >= 4
    for step, same in zip(steps, expected, strict=True):
        assert (step.foot, step.number) == (same.foot, same.number)
        assert abs(step.t - same.t) < 0.03
        assert dist(step.position, same.position) < 0.03
        assert abs(step.stride_length - same.stride_length) < 0.03


@pytest.mark.parametrize("form", ["packed", "snapshot.json"])
@pytest.mark.parametrize(("version", "name"), KEPT)
def test_a_state_of_an_older_version_is_one_of_this_version_once_it_was_read(
    version: int, name: str, form: str
) -> None:
    session = taken_up(version, name, form)
    again = Session.unpack(session.pack())
    assert json.dumps(save(again._state)) == json.dumps(save(session._state))
    assert json.dumps(Session.restore(session.snapshot()).snapshot()) == json.dumps(session.snapshot())


@pytest.mark.parametrize(("version", "name"), KEPT)
def test_both_forms_of_one_moment_are_one_state(version: int, name: str) -> None:
    packed, snapshot = (taken_up(version, name, form) for form in ("packed", "snapshot.json"))
    assert save(packed._state) == save(snapshot._state)


@pytest.mark.parametrize(("version", "name"), KEPT)
def test_an_older_snapshot_that_another_encoder_wrote_is_read_and_a_damaged_one_is_refused(
    version: int, name: str
) -> None:
    saved = json.loads(held(version, name, "snapshot.json"))
    assert Session.restore(other(saved)).gait == Session.restore(saved).gait
    wearer = saved["state"]["wearer"]
    for spot, key, value in (
        (wearer["feet"]["left"], "t", 1.0),
        (wearer["feet"]["left"], "t", "soon"),
        (wearer["feet"]["left"], "t", 10**400),
        (wearer["feet"], "left", None),
        (wearer["recipe"]["detector"], "kind", "CrystalBall"),
        (wearer["recipe"]["detector"], "kind", []),
        (wearer, "recipe", {}),
        (wearer, "more", 5),
        (saved, "state", [[[]]]),
        (saved, "check", None),
    ):
        before = spot.get(key)
        spot[key] = value
        with pytest.raises(SnapshotError):
            Session.restore(saved)
        spot[key] = before
        if before is None and key == "more":
            del spot[key]
    assert Session.restore(saved).gait is not None or name == "tags"


@given(st.data())
@settings(max_examples=40, deadline=None)
def test_damage_to_an_older_packed_state_never_does_worse_than_be_refused(data: st.DataObject) -> None:
    saved = bytearray(held(1, "tags", "packed"))
    at = data.draw(st.integers(0, len(saved) - 1))
    saved[at] ^= 1 << data.draw(st.integers(0, 7))
    with pytest.raises(SnapshotError):
        Session.unpack(bytes(saved))
    try:
        Session.unpack(signed(bytes(saved))).pack()
    except SnapshotError:
        return


# --- shapes -----------------------------------------------------------------------------------------------------------


def test_what_a_session_remembers_has_the_shape_that_was_pinned_for_its_version() -> None:
    why_not = pin.changed(pin.as_text())
    assert why_not is None, why_not


def test_a_shape_that_changed_without_its_version_is_told_with_what_to_do() -> None:
    why_not = str(pin.changed(pin.as_text().replace('"rows": "bytes"', '"lines": "bytes"', 1)))
    assert f"raise VERSION in state.py to {VERSION + 1}, add the step from {VERSION}" in why_not


def test_there_is_a_step_from_every_version_to_the_next_and_a_shape_of_each() -> None:
    assert [*UPGRADES] == [*range(1, VERSION)]
    for version in range(1, VERSION + 1):
        packed, snapshot = pinned(version)
        assert len(packed.records) > 100 and len(snapshot.records) > 100
    assert pinned(VERSION) == (shape(), snapshot_shape())
    assert pinned(VERSION)[0].check == shape().check
