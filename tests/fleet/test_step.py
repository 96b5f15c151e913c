"""The keyed step of a fleet: its events are those of a session, and no input can stop it."""

from __future__ import annotations

from math import nan
from typing import Any

import pytest
from attrs import evolve
from fleets import WEARER, cut, shown, stepped, uses, walked
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import LEFT

from solepath import StrideTaken, recipes
from solepath.fleet import End, Fleet, Sent, SentRejected, Tick, Unreadable
from solepath.recipes import DEFAULT, Recipe
from solepath.session import Session
from solepath.types import Packet, Site

FLEET = Fleet()
TESTED_RECIPES = [DEFAULT, recipes.by_name("kupt-dfpc")]


@pytest.mark.parametrize("recipe", TESTED_RECIPES, ids=lambda recipe: recipe.name)
def test_the_events_of_a_wearer_are_those_of_a_session_with_the_same_packets(recipe: Recipe) -> None:
    sent, events = walked(recipe.name).sent, walked(recipe.name).events
    fleet = Fleet(recipe)
    pieces = cut(list(sent), range(0, len(sent), 61))
    state, emitted = stepped(fleet, pieces)
    assert tuple(one.event for one in emitted) == events
    assert sum(isinstance(event, StrideTaken) for event in events) >= 6
    assert [(one.wearer, one.number) for one in emitted] == [(WEARER, number) for number in range(len(emitted))]
    keyed = fleet.open(WEARER, None)
    assert [one for piece in pieces for one in keyed.feed(piece)] == emitted
    assert keyed.state() == state


def test_passing_time_gives_the_events_of_a_session() -> None:
    sent = walked().sent[:300]
    session, last = Session(), sent[-1].what.t
    events = session.advance(-1.0) + [event for one in sent for event in session.feed(one.what)]
    events += session.advance(last + 5.0)
    later = [evolve(one, number=one.number + 1) for one in sent]
    _, emitted = FLEET.step(WEARER, None, [Sent(WEARER, 0, Tick(-1)), *later, Sent(WEARER, 301, Tick(last + 5.0))])
    assert [one.event for one in emitted] == events
    assert events[-1].known_at == last + 5.0


def test_a_wearer_goes_on_in_a_new_run_and_restarts_after_an_end() -> None:
    sent, events = walked().sent, walked().events
    half = len(sent) // 2
    restarted = [*sent[:half], *[evolve(one, number=n, run=8) for n, one in enumerate(sent[half:])]]
    state, emitted = FLEET.step(WEARER, None, restarted)
    assert tuple(one.event for one in emitted) == events
    _, again = FLEET.step(WEARER, state, [evolve(one, run=9) for one in sent])
    assert tuple(one.event for one in again) == events
    assert [one.number for one in again] == list(range(len(emitted), 2 * len(emitted)))


ODD_PACKETS: list[Any] = [
    Packet("soon", LEFT, "c", b""),  # type: ignore[arg-type]
    Packet(1.0, "left_foot", "c", b""),  # type: ignore[arg-type]
    Packet(1.0, LEFT, "c", "00"),  # type: ignore[arg-type]
    Packet(1.0, LEFT, "c", b"", None),  # type: ignore[arg-type]
    Packet(1.0, LEFT, "c", bytes(1_000_000)),
    Tick(nan),
    Tick(10**400),
    Tick("noon"),  # type: ignore[arg-type]
    None,
]


@pytest.mark.parametrize("what", ODD_PACKETS, ids=range(len(ODD_PACKETS)))
def test_what_cannot_be_used_is_rejected_in_its_turn_and_the_next_is_used(what: Any) -> None:
    keyed = FLEET.open(WEARER, None)
    assert keyed.feed([shown(2), Sent(WEARER, 1, what)]) == []
    assert len(keyed.state()) < 1000
    emitted = keyed.feed([shown(0)])
    assert [(what, number) for what, _, number, _ in uses(emitted)] == [("used", 0), ("rejected", 1), ("used", 2)]
    rejected = emitted[1].event
    assert isinstance(rejected, SentRejected) and rejected.detail and len(rejected.detail) <= 200
    assert FLEET.step(WEARER, None, [shown(0), Sent(WEARER, 1, what), shown(2)])[1] == emitted


@pytest.mark.parametrize(
    "item",
    [
        None,
        Sent("somebody else", 0, End()),
        Sent(None, 0, End()),  # type: ignore[arg-type]
        Sent(WEARER, -1, End()),
        Sent(WEARER, 2**53, End()),
        Sent(WEARER, True, End()),
        Sent(WEARER, 0, End(), -1),
        Unreadable(WEARER, "no JSON"),
        Unreadable(WEARER, "x" * 1_000_000, -4, 3),
    ],
    ids=range(9),
)
def test_what_has_no_place_in_the_order_is_rejected_at_once(item: Any) -> None:
    state, emitted = FLEET.step(WEARER, None, [item, shown(0)])
    assert [(what, number) for what, _, number, _ in uses(emitted)] == [("rejected", None), ("used", 0)]
    assert len(emitted[0].event.detail) <= 200 and len(state) < 1000


REAL_DATA = st.deferred(lambda: st.sampled_from([one.what.data for one in walked().sent[:40]]))
CHANNELS = st.sampled_from(["insole/frame", "insole/info", "cc2650/movement", "device/battery", "receiver/tick", "x"])
POISON = st.builds(
    lambda number, t, site, channel, data: Sent(WEARER, number, Packet(t, site, channel, data)),
    st.integers(0, 40),
    st.floats() | st.floats(0.0, 10.0),
    st.sampled_from(Site),
    CHANNELS,
    st.binary(max_size=40) | REAL_DATA,
)


@settings(max_examples=30)
@given(poison=st.lists(POISON, max_size=40))
def test_a_wearer_with_random_bytes_is_reported_and_stays_small(poison: list[Sent]) -> None:
    state, emitted = FLEET.step(WEARER, None, poison)
    assert [one.number for one in emitted] == list(range(len(emitted)))
    assert len(state) < 30_000
    assert FLEET.open(WEARER, state).state() == state
