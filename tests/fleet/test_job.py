"""The job of a fleet: an app's devices and calibrations, which may be wrong, and the pickling of the job."""

from __future__ import annotations

import pickle
import struct
from collections.abc import Callable, Iterator, Mapping
from copy import copy, deepcopy
from typing import Any

import pytest
import toys
from attrs import astuple, evolve, frozen
from fleets import WEARER, stepped, walked
from walks import LEFT

from solepath import Calibration, CalibrationError, recipes
from solepath.calibration import ShoeGeometry
from solepath.fleet import End, Fleet, NumberedEvent, Sent, Tick, Unreadable, WearerFailed
from solepath.link.driver import Reading
from solepath.session import Session
from solepath.types import Packet

FLEET = Fleet()


def raises(sent: Any, known: Any) -> Reading:
    if sent.what > 200:
        raise RuntimeError(f"a reader that is wrong about {sent.what}")
    return toys.more(sent, known)


WRONG_DRIVER = evolve(toys.NUMBERED, readers={"toy/data": toys.data, "toy/more": raises})


def make_sent(number: int, k: int, what: int | None = None) -> Sent:
    """Return the k-th packet of data of the toy device."""
    if what is None:
        data, channel = struct.pack(">HIBf", k, 0, 1, 9.80665), "toy/data"
    else:
        data, channel = struct.pack(">Bd", what, 1.0), "toy/more"
    return Sent(WEARER, number, Packet(0.01 * k, LEFT, channel, data))


def test_a_reader_of_an_apps_own_that_raises_costs_its_wearer_a_fresh_start_and_nobody_else_anything() -> None:
    fleet = Fleet(profiles=[WRONG_DRIVER], poses=True)
    walk = [make_sent(k, k) for k in range(20)]
    bare = Session(profiles=[WRONG_DRIVER], poses=True)
    events = [event for one in walk for event in bare.feed(one.what)]
    wrong = [*walk, make_sent(20, 20, 201), *[make_sent(21 + k, k) for k in range(20)]]
    _, emitted = fleet.step(WEARER, None, wrong)
    failed = emitted[len(events)].event
    expected_detail = "RuntimeError: a reader that is wrong about 201"
    assert failed == WearerFailed(t=bare.now, known_at=bare.now, detail=expected_detail)
    assert [one.event for one in emitted if one.event is not failed] == events + events
    assert [one.number for one in emitted] == list(range(len(emitted)))
    assert stepped(fleet, [[one] for one in wrong])[1] == emitted
    assert [one.event for one in fleet.step(WEARER, None, walk)[1]] == events


class Registry(Mapping[str, Calibration]):
    """A mapping of calibrations by wearer; some are wrong, and some look-ups fail."""

    def __getitem__(self, wearer: str) -> Calibration:
        if wearer == "lost":
            raise ConnectionError("the registry does not answer")
        if wearer == "odd":
            return Calibration(shoe=ShoeGeometry(height=-7.0))
        if wearer == "known":
            return Calibration(shoe=ShoeGeometry(height=0.05))
        raise KeyError(wearer)

    def __iter__(self) -> Iterator[str]:
        raise AssertionError("a registry is not read as a whole")

    def __len__(self) -> int:
        return 3


def test_a_calibration_is_read_when_a_session_starts_and_its_faults_are_reported() -> None:
    fleet = Fleet(recipes.by_name("kupt-dfpc"), calibrations=Registry())
    plain = [one.event for one in Fleet(recipes.by_name("kupt-dfpc")).step(WEARER, None, walked().sent[:500])[1]]
    for wearer, failures in (("unknown", 0), ("lost", 1), ("odd", 1), ("known", 0)):
        sent = [evolve(one, wearer=wearer) for one in walked().sent[:500]]
        events = [one.event for one in fleet.step(wearer, None, sent)[1]]
        assert [isinstance(event, WearerFailed) for event in events[: failures + 1]] == [True] * failures + [False]
        assert (events[failures:] == plain) is (wearer != "known")


def test_a_job_that_is_wrong_for_every_wearer_is_rejected_when_it_is_made() -> None:
    with pytest.raises(TypeError, match="Recipe"):
        Fleet("default")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="mapping"):
        Fleet(calibrations=Calibration())  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="window"):
        Fleet(window=-1)
    with pytest.raises(TypeError, match="FloorPlan"):
        Fleet(floorplan="house")  # type: ignore[arg-type]
    with pytest.raises(CalibrationError):
        Session(calibration=Registry()["odd"])


class Ours(Fleet):
    """A job with a device of an app's own, whose constructs cannot be pickled."""

    def __init__(self) -> None:
        super().__init__(profiles=[WRONG_DRIVER])

    def __reduce__(self) -> tuple[type, tuple[()]]:
        return Ours, ()


def test_a_job_with_devices_of_its_own_goes_to_its_workers_by_name() -> None:
    with pytest.raises((TypeError, AttributeError)):
        pickle.dumps(Fleet(profiles=[WRONG_DRIVER]))
    walk = [make_sent(k, k) for k in range(40)]
    assert pickle.loads(pickle.dumps(Ours())).step(WEARER, None, walk) == Ours().step(WEARER, None, walk)


def test_input_and_events_can_be_sent_between_workers() -> None:
    _, emitted = FLEET.step(WEARER, None, walked().sent[:350])
    both: list[Sent | NumberedEvent | Unreadable] = [*walked().sent[:10], *emitted, Unreadable(WEARER, "no JSON", 1, 2)]
    assert pickle.loads(pickle.dumps(both)) == both


@frozen
class Located(Packet):
    """A packet with further fields."""

    where: str = "gym"


@frozen
class Ward(Sent):
    bed: int = 7


class Pause(Tick):
    """A tick of another name."""


class Off(End):
    """An end of another name."""


@pytest.mark.parametrize("again", [copy, deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_copy_of_what_an_app_made_of_a_packet_is_what_the_app_made(again: Callable[[Any], Any]) -> None:
    packet = walked().sent[0].what
    located = Located(packet.t, packet.site, packet.channel, packet.data, where="hall")
    for one in (packet, located, Sent(WEARER, 0, packet), Ward(WEARER, 0, located, bed=3)):
        assert again(one) == one and type(again(one)) is type(one)
        assert again(one) is not one


def test_packets_ticks_and_ends_of_classes_of_an_apps_own_are_used_as_what_they_are() -> None:
    sent = [*walked().sent[:200], Sent(WEARER, 200, Tick(90.0)), Sent(WEARER, 201, End())]
    own: list[Any] = [Located(*astuple(one.what, recurse=False)) for one in sent[:200]]
    own = [Ward(WEARER, number, what) for number, what in enumerate([*own, Pause(90.0), Off()])]
    fleet = Fleet()
    expected = fleet.step(WEARER, None, sent)
    assert fleet.step(WEARER, None, own) == expected
    state, emitted = fleet.step(WEARER, None, own[1:])  # held, for want of the first
    after, rest = fleet.step(WEARER, state, own[:1])
    assert (after, [*emitted, *rest]) == expected
