"""States that are refused: what goes on all the same, and what no state can hold."""

from __future__ import annotations

import json
from binascii import crc32
from typing import Any

import pytest
from fleets import WEARER, shown, uses, walked
from here import PROTOCOL

from solepath.fleet import End, Fleet, StateRefused, Tick
from solepath.fleet.step.sent import MOST
from solepath.fleet.step.state import Identity, OtherState, read_rest, write_state

STATES = json.loads((PROTOCOL / "fleet" / "states.json").read_text())["states"]
FLEET = Fleet()


@pytest.mark.parametrize("vector", [one for one in STATES if "kept" in one], ids=lambda vector: vector["id"])
def test_where_only_the_session_cannot_go_on_what_is_held_does(vector: dict[str, Any]) -> None:
    after, (told,) = FLEET.step(WEARER, bytes.fromhex(vector["hex"]), [])
    rest, expected = read_rest(after), vector["kept"]
    assert isinstance(told.event, StateRefused) and told.number == vector["identity"]["told"]
    assert (rest.ended, rest.session) == (expected["ended"], None)
    assert [[span.run, span.first, span.end] for span in rest.left.spans] == expected["spans"]
    assert [list(place) for place in rest.held] == expected["held"]


def test_rows_that_were_held_when_a_session_was_lost_are_used_in_their_turn() -> None:
    state, told = Fleet(window=4).step(WEARER, None, [*walked().sent[:100], shown(102), shown(103)])
    damaged = state[:-1] + bytes([state[-1] ^ 1])
    _, (refused, *rest) = Fleet(window=4).step(WEARER, damaged, [shown(100), shown(101)])
    assert isinstance(refused.event, StateRefused) and refused.number == len(told)
    assert uses(rest) == [("used", 0, number, None) for number in (100, 101, 102, 103)]


IN_ORDER = OtherState(held={(6, 300): Tick(1.0), (6, 302): Tick(2.0), (7, 0): End()})


@pytest.mark.parametrize(
    "held",
    [[(6, 298)], [(5, 900)], [(6, 301), (6, 200)], [(6, MOST + 1)], [(MOST + 1, 0)]],
    ids=["used", "older run", "one of two", "number", "run"],
)
def test_a_state_that_holds_what_cannot_be_held_is_refused(held: list[tuple[int, int]]) -> None:
    """Its checksum holds: whoever wrote it was wrong, or it was damaged before."""
    identity = Identity(6, 299, 1200, 12.25)
    assert read_rest(write_state(identity, IN_ORDER)) == IN_ORDER
    state = write_state(identity, OtherState(held={place: Tick(1.0) for place in held}))
    after, told = Fleet(window=0).step(WEARER, state, [shown(305, 6), shown(306, 6)])
    assert isinstance(told[0].event, StateRefused)
    assert uses(told[1:]) == [("missing", 6, 299, 6), ("used", 6, 305, None), ("used", 6, 306, None)]
    assert FLEET.open(WEARER, after).state() == after


def test_what_is_held_twice_cannot_be_held() -> None:
    twice = write_state(Identity(6, 299, 0, 0.0), OtherState(held={(6, 300): End(), (6, 301): End()}))
    rest = twice[41:-4].replace(bytes.fromhex("06ad0202"), bytes.fromhex("06ac0202"))
    assert rest.count(bytes.fromhex("06ac0202")) == 2
    (told,) = FLEET.step(WEARER, twice[:41] + rest + crc32(rest).to_bytes(4, "little"), [])[1]
    assert isinstance(told.event, StateRefused)
