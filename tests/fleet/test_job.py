"""The job of a fleet: an app's devices and calibrations, which may be wrong, and the pickling of the job."""

from __future__ import annotations

import pickle
import struct
from collections.abc import Iterator, Mapping
from typing import Any

import pytest
import toys
from attrs import evolve
from fleets import WEARER, stepped, walked
from walks import LEFT

from solepath import Calibration, recipes
from solepath.calibration import ShoeGeometry
from solepath.fleet import Fleet, Sent, WearerFailed
from solepath.link.driver import Reading
from solepath.session import Session
from solepath.types import Packet


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
