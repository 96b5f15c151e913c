"""The state of a wearer: protocol/fleet/states.json, and any other bytes."""

from __future__ import annotations

import json
from functools import cache
from itertools import count
from math import inf
from typing import Any

import pytest
from attrs import astuple, evolve
from fleets import WEARER, shown, walked
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath import recipes
from solepath.emulate.routes.building import BUILDING
from solepath.fleet import End, Fleet, Sent, StateRejected, Tick, Unreadable
from solepath.fleet.step.keyed import first_event_number
from solepath.fleet.step.order import RejectedItem
from solepath.fleet.step.state import StateHead, read_head, read_rest, write_state
from solepath.recipes import DEFAULT
from solepath.session import Session
from solepath.types import Packet, Site

STATES = json.loads((PROTOCOL / "fleet" / "states.json").read_text())
FLEET = Fleet()
MIDDLE = 350
"""Number of rows after which the walk has started."""


@cache
def halfway() -> tuple[bytes, int]:
    """Return a state in the middle of a walk, and the number of events before it."""
    state, emitted = FLEET.step(WEARER, None, walked().sent[:MIDDLE])
    return state, len(emitted)


def held_as_fields(place: tuple[int, int], what: Any) -> dict[str, Any]:
    match what:
        case Packet(t, site, channel, data, device):
            packet = {"t": t, "site": site.value, "channel": channel, "data": data.hex(), "device": device}
            return {"run": place[0], "number": place[1], "packet": packet}
        case Tick(t):
            return {"run": place[0], "number": place[1], "tick": t}
        case RejectedItem(reason, detail):
            return {"run": place[0], "number": place[1], "reason": reason.value, "detail": detail}
    raise AssertionError(what)


@pytest.mark.parametrize("vector", STATES["states"], ids=lambda vector: vector["id"])
def test_a_state_is_as_in_the_protocol(vector: dict[str, Any]) -> None:
    state = bytes.fromhex(vector["hex"])
    head = read_head(state)
    if vector["result"] == "refused":
        known = vector["identity"]
        assert head == (None if known is None else StateHead(**known))
        (first, *_) = FLEET.step(WEARER, state, [shown(300, 7)])[1]
        assert isinstance(first.event, StateRejected)
        assert first.number == (first_event_number(7, 300) if known is None else known["next_event"])
        return
    fields = vector["fields"]
    rest = read_rest(state)
    assert head == StateHead(*[fields[name] for name in ("run", "next", "next_event", "known")])
    assert (rest.ended, rest.failure, rest.session) == (fields["ended"], fields["failure"], None)
    assert [[span.run, span.first, span.end] for span in rest.unused.spans] == fields["spans"]
    assert [[*runs] for runs in rest.unused.forgotten] == fields["forgotten"]
    assert [*astuple(rest.strays)] == fields["strays"]
    assert [held_as_fields(place, what) for place, what in rest.held_rows.items()] == fields["held"]
    assert write_state(head, rest) == state
    assert FLEET.open(WEARER, state).state() == state


@settings(max_examples=40)
@given(place=st.integers(0, 1 << 20), bit=st.integers(0, 7))
def test_a_bit_that_fell_over_anywhere_is_noticed_and_no_identity_is_used_again(place: int, bit: int) -> None:
    state, before = halfway()
    damaged = bytearray(state)
    damaged[place % len(state)] ^= 1 << bit
    _, emitted = FLEET.step(WEARER, bytes(damaged), walked().sent[MIDDLE : MIDDLE + 5])
    assert isinstance(emitted[0].event, StateRejected)
    assert emitted[0].number >= before


def test_a_session_of_another_recipe_or_of_a_building_is_rejected_and_the_numbers_go_on() -> None:
    state, before = halfway()
    for fleet in (Fleet(recipes.by_name("kupt-dfpc")), Fleet(evolve(DEFAULT, name="mine")), Fleet(floorplan=BUILDING)):
        after, emitted = fleet.step(WEARER, state, walked().sent[MIDDLE : MIDDLE + 50])
        assert isinstance(emitted[0].event, StateRejected) and emitted[0].event.detail
        assert [one.number for one in emitted] == list(range(before, before + len(emitted)))
        assert emitted[0].event.t == read_head(state).known
        assert fleet.step(WEARER, after, walked().sent[MIDDLE + 50 : MIDDLE + 150])[1], (
            "and the wearer is followed again"
        )


def test_after_the_end_a_tombstone_is_left_which_every_job_can_read() -> None:
    state, emitted = FLEET.step(WEARER, None, walked().sent)
    assert len(state) == 54 and FLEET.open(WEARER, state).ended
    other = Fleet(recipes.by_name("kupt-dfpc"))
    assert other.step(WEARER, state, walked().sent) == (state, [])
    again, more = other.step(WEARER, state, [evolve(one, run=1) for one in walked().sent[:MIDDLE]])
    assert more[0].number == len(emitted) and not other.open(WEARER, again).ended


def test_a_state_keeps_what_is_held_whatever_it_is() -> None:
    odd = [
        Sent(WEARER, 2, Packet(inf, Site.LEFT_SHANK, "\ud83d", b"\x00\xff", "ü")),
        Sent(WEARER, 3, Tick(-2.5)),
        Sent(WEARER, 4, Tick(inf)),
        Unreadable(WEARER, "x" * 1000, 0, 5),
        Sent(WEARER, 1, End(), 7),
    ]
    whole = FLEET.open(WEARER, None)
    cut = FLEET.open(WEARER, None)
    for item in odd:
        assert cut.feed([item]) == []
        cut = FLEET.open(WEARER, cut.state())
    whole.feed(odd)
    assert cut.state() == whole.state() and len(whole.state()) < 1000
    rest = [shown(0), shown(1), shown(0, 7)]
    assert cut.feed(rest) == whole.feed(rest)
    assert cut.ended and whole.ended and cut.state() == whole.state()


def test_a_phone_hands_its_wearer_over() -> None:
    sent, whole = walked().sent, Session()
    first = [event for one in sent[:MIDDLE] for event in whole.feed(one.what)]
    state = FLEET.adopt(json.loads(json.dumps(whole.snapshot())))
    assert read_head(state).known == whole.now
    numbers = count()
    rest = [evolve(one, number=next(numbers), run=3) for one in sent[MIDDLE:]]
    _, emitted = FLEET.step(WEARER, state, rest)
    assert (*first, *[one.event for one in emitted]) == walked().events
    assert [one.number for one in emitted] == list(range(len(emitted)))
