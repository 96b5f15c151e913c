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

from solepath import Packet, Session, Site, StepTaken
from solepath.machine import save
from solepath.state import VERSION
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
