"""What the keyed step of a fleet promises at its edges: mistakes of a job, clocks that go back, bounds just reached."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
import toys
from attrs import evolve
from fleets import WEARER, shown, uses, walked

from solepath import SnapshotError
from solepath.fleet import End, Fleet, NumbersMissing, Once, Sent, SentRejected, StateRefused, Tick, Unreadable
from solepath.fleet.step.once import RANGES
from solepath.fleet.step.order import HELD
from solepath.fleet.step.sent import LONGEST_DATA
from solepath.fleet.step.state import Identity, OtherState, write_state
from solepath.session import Session
from solepath.types import Packet, Site

FLEET = Fleet()


# --- what is the caller's mistake -------------------------------------------------------------------------------------


@pytest.mark.parametrize("state", ["spfl", 0.5, 10**30, 41, [115, 112], {}], ids=repr)
def test_a_state_that_is_no_bytes_is_a_mistake_of_the_job_and_not_of_a_wearer(state: Any) -> None:
    """All wearers of the job would lose theirs: the job ends, and goes on when it is mended."""
    with pytest.raises(TypeError, match="state"):
        FLEET.step(WEARER, state, [])
    with pytest.raises(TypeError, match="state"):
        FLEET.open(WEARER, state)


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_a_state_may_come_as_any_kind_of_bytes(kind: Callable[[bytes], Any]) -> None:
    state, _ = FLEET.step(WEARER, None, walked().sent[:50])
    assert FLEET.open(WEARER, kind(state)).state() == state


def finished() -> Session:
    session = Session()
    session.feed([one.what for one in walked().sent[:50]])
    session.finish()
    return session


def test_a_session_that_is_finished_is_not_adopted_and_no_state_goes_on_from_it() -> None:
    with pytest.raises(SnapshotError, match="finished"):
        FLEET.adopt(finished().snapshot())
    state = write_state(Identity(-1, 0, 0, 1.0), OtherState(session=finished().pack()))
    _, (refused, *rest) = FLEET.step(WEARER, state, [shown(0)])
    assert isinstance(refused.event, StateRefused) and "finished" in refused.event.detail
    assert uses(rest) == [("used", 0, 0, None)]


# --- moments, bounds, memory ------------------------------------------------------------------------------------------


def test_the_clock_of_a_new_run_may_stand_before_that_of_the_last_and_what_is_told_does_not_go_back() -> None:
    wrong = Unreadable(WEARER, "no JSON")
    sent = [Sent(WEARER, 0, Tick(10.0)), Sent(WEARER, 1, End()), wrong, Sent(WEARER, 0, Tick(1.0), 1), wrong]
    _, told = FLEET.step(WEARER, None, [*sent, Sent(WEARER, 1, Tick(12.0), 1), wrong])
    assert [(one.event.t, one.event.known_at) for one in told] == [(10.0, 10.0), (10.0, 10.0), (12.0, 12.0)]


def test_so_many_bytes_are_held_as_the_protocol_says_and_not_one_more() -> None:
    def large(number: int, size: int) -> Sent:
        return Sent(WEARER, number, Packet(0.0, Site.PELVIS, "c", bytes(size - 4), "dev"))

    most = LONGEST_DATA
    sizes = [most] * (HELD // most)
    assert sum(sizes) == HELD == 65_536, "as the protocol has it"
    exactly = [large(number, size) for number, size in enumerate(sizes, 1)]
    assert FLEET.open(WEARER, None).feed(exactly) == []
    told = FLEET.open(WEARER, None).feed([*exactly[:-1], large(len(sizes), most + 1)])
    assert isinstance(told[0].event, NumbersMissing) and told[0].event.count == 1


def test_a_hole_that_is_split_counts_as_two_and_the_lowest_of_too_many_is_heard() -> None:
    once = Once()
    ends = [10 * n for n in range(1, RANGES + 1)]
    assert all(once.first("anna", end) for end in ends), "as many holes as are remembered"
    assert once.first("anna", 15), "one more"
    assert [once.first("anna", number) for number in (5, 12, 17)] == [False, True, True]
    assert Once.restore(json.loads(json.dumps(once.snapshot()))) == once


def runs_out(after: int, sent: Any, known: Any) -> Any:
    if sent.what > after:
        raise MemoryError
    return toys.more(sent, known)


def test_who_runs_out_of_memory_is_told_so_and_goes_on_from_the_last_state() -> None:
    """It is no fault of the wearer: with more memory the same packet is used."""

    def fleet(most: int) -> Fleet:
        return Fleet(profiles=[evolve(toys.NUMBERED, readers={"toy/more": partial(runs_out, most)})])

    battery = Sent(WEARER, 0, Packet(1.0, Site.LEFT_FOOT, "toy/more", b"\x00" + bytes(8)))
    keyed = fleet(-1).open(WEARER, None)
    state = keyed.state()
    with pytest.raises(MemoryError):
        keyed.feed([battery])
    _, told = fleet(255).step(WEARER, state, [battery])
    assert told and not any(isinstance(one.event, SentRejected) for one in told)
