"""The packed form of a session: small, exact to the bit, and anything else is rejected.

tests/relations/test_streams.py checks that a session packed at any moment continues unchanged.
"""

from __future__ import annotations

import json
from functools import cache
from math import inf
from typing import Any

import pytest
from attrs import define, evolve
from own import StillDetector
from walks import LEFT, RIGHT, ROUGH, SHORT, machines, samples

from solepath import Foot, Session, SnapshotError, recipes
from solepath.body.altitude import Altitude
from solepath.body.part import TrackPart
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.emulate.walk import emulate
from solepath.foot.stance.shoe import ShoeDetector
from solepath.papers.kupt_dfpc.fusion import DoubleFoot


def exact(session: Session) -> str:
    """Return the whole state, in order, with -0.0 distinguished from 0.0."""
    return json.dumps(session.snapshot())


@cache
def packed(name: str = "session, whole frames") -> bytes:
    """In the middle of a walk."""
    machine = machines()[name]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    return bytes(session.pack())


@pytest.mark.parametrize(
    "device", [Insole(cells=48), Insole(cells=96), CC2650()], ids=["48 cells", "96 cells", "SensorTags"]
)
def test_the_state_of_two_devices_is_below_30_kB_at_any_moment_of_a_walk(device: Any) -> None:
    session, largest = Session(), 0
    for i, packet in enumerate(emulate(SHORT, devices={LEFT: device, RIGHT: evolve(device)}, radio=ROUGH).packets):
        session.feed(packet)
        if i % 40 == 0:
            largest = max(largest, len(session.pack()))
    assert 5000 < largest < 30_000


def test_what_was_unpacked_twice_shares_nothing_that_changes() -> None:
    machine = machines()["session, particles"]
    session = machine.start()
    session.feed(machine.items[:400])
    saved = session.pack()
    one, other = (Session.unpack(saved, session.recipe, floorplan=session._plan) for _ in range(2))
    events = session.feed(machine.items[400:])
    assert one.feed(machine.items[400:]) == other.feed(machine.items[400:]) == events
    assert Session.unpack(saved, session.recipe, floorplan=session._plan).pack() == saved


def test_a_session_is_not_unpacked_with_another_recipe_or_other_parts() -> None:
    with pytest.raises(SnapshotError, match="packed with the recipe 'default', and this is 'kupt'"):
        Session.unpack(packed(), recipes.by_name("kupt"))
    for other, what in (
        (evolve(recipes.DEFAULT, detector=ShoeDetector()), "packed with Cycle, and this recipe has Shoe"),
        (recipes.DEFAULT.replace_part(TrackPart, DoubleFoot()), "packed with BothFeet, and this recipe has DoubleFoot"),
        (recipes.DEFAULT.replace_part(Altitude, None), "packed with 11 parts, and this recipe has 10"),
        (evolve(OWN, name="default"), "packed with Cycle, and this recipe has StillDetector"),
    ):
        with pytest.raises(SnapshotError, match=what):
            Session.unpack(packed(), other)
    with pytest.raises(TypeError, match="must be a Recipe, not str: recipes.by_name"):
        Session.unpack(packed(), "default")  # type: ignore[arg-type]


OWN = evolve(recipes.DEFAULT, name="quiet", detector=StillDetector())
Other = define(
    type("StillDetector", (), {"__annotations__": {"limit": "float"}, "limit": 0.8, "update": StillDetector.update})
)


def test_a_detector_that_has_other_fields_now_is_named() -> None:
    session = Session(OWN)
    session.feed(samples()[:50])
    with pytest.raises(SnapshotError, match="'StillDetector' that had other fields"):
        Session.unpack(session.pack(), evolve(OWN, detector=Other()))
    with pytest.raises(ValueError, match="one name"):
        Session.unpack(session.pack(), OWN, parts=[StillDetector, Other])
    with pytest.raises(TypeError, match="attrs class"):
        Session.unpack(session.pack(), OWN, parts=[int])


def test_an_unpackable_part_raises_when_it_is_packed() -> None:
    for value in (inf, 10**400):
        session = Session(OWN)
        session.feed(samples(cells=0)[:50])
        detector = session.feet[Foot.LEFT].detector
        assert isinstance(detector, StillDetector)
        detector.since = value
        with pytest.raises(SnapshotError):
            session.pack()
