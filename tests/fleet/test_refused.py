"""Rejected states and their consequences, errors of a job, clocks that go back, and limits."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fleets import WEARER, shown, uses, walked
from here import PROTOCOL

from solepath import SnapshotError, recipes
from solepath.fleet import Fleet, NumbersMissing, Sent, StateRejected
from solepath.fleet.step.order import MAX_HELD_BYTES
from solepath.fleet.step.sent import MAX_DATA_LENGTH
from solepath.fleet.step.state import StateHead, StateRest, read_rest, write_state
from solepath.session import Session
from solepath.types import Packet, Site

STATES = json.loads((PROTOCOL / "fleet" / "states.json").read_text())["states"]
FLEET = Fleet()


@pytest.mark.parametrize("vector", [one for one in STATES if "kept" in one], ids=lambda vector: vector["id"])
def test_where_only_the_session_cannot_go_on_what_is_held_does(vector: dict[str, Any]) -> None:
    after, (emitted,) = FLEET.step(WEARER, bytes.fromhex(vector["hex"]), [])
    rest, expected = read_rest(after), vector["kept"]
    assert isinstance(emitted.event, StateRejected) and emitted.number == vector["identity"]["next_event"]
    assert (rest.ended, rest.session) == (expected["ended"], None)
    assert [[span.run, span.first, span.end] for span in rest.unused.spans] == expected["spans"]
    assert [list(place) for place in rest.held_rows] == expected["held"]


@pytest.mark.parametrize("state", ["spfl", 0.5, 10**30, 41, [115, 112], {}], ids=repr)
def test_a_state_that_is_no_bytes_is_a_mistake_of_the_job_and_not_of_a_wearer(state: Any) -> None:
    """All wearers of the job would lose their states; so the job ends, and continues after a correction."""
    with pytest.raises(TypeError, match="state"):
        FLEET.step(WEARER, state, [])
    with pytest.raises(TypeError, match="state"):
        FLEET.open(WEARER, state)


def finished() -> Session:
    session = Session()
    session.feed([one.what for one in walked().sent[:50]])
    session.finish()
    return session


def test_a_session_that_cannot_go_on_is_not_adopted_and_no_state_goes_on_from_a_finished_one() -> None:
    for snapshot, why in (
        (finished().snapshot(), "finished"),
        (Session(recipes.by_name("zupt")).snapshot(), "zupt"),
        ({"solepath": 1}, None),
    ):
        with pytest.raises(SnapshotError, match=why):
            FLEET.adopt(snapshot)
    state = write_state(StateHead(-1, 0, 0, 1.0), StateRest(session=finished().pack()))
    _, (rejected, *rest) = FLEET.step(WEARER, state, [shown(0)])
    assert isinstance(rejected.event, StateRejected) and "finished" in rejected.event.detail
    assert uses(rest) == [("used", 0, 0, None)]


def test_the_held_bytes_are_limited_as_in_the_protocol() -> None:
    def large(number: int, size: int) -> Sent:
        return Sent(WEARER, number, Packet(0.0, Site.PELVIS, "c", bytes(size - 4), "dev"))

    most = MAX_DATA_LENGTH
    sizes = [most] * (MAX_HELD_BYTES // most)
    assert sum(sizes) == MAX_HELD_BYTES == 65_536, "as the protocol has it"
    exactly = [large(number, size) for number, size in enumerate(sizes, 1)]
    assert FLEET.open(WEARER, None).feed(exactly) == []
    emitted = FLEET.open(WEARER, None).feed([*exactly[:-1], large(len(sizes), most + 1)])
    assert isinstance(emitted[0].event, NumbersMissing) and emitted[0].event.count == 1
