"""Checks of a driver, and restoring a session with the drivers that it had."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from math import inf
from typing import Any

import pytest
from attrs import evolve
from toys import BASE, BOTH, FORMATS, LEFT, NUMBERED, PROFILE, TICKING, data
from walks import of

from solepath import Packet, Session, SnapshotError
from solepath.events import Limitation
from solepath.link.catalogue import PROFILES
from solepath.link.devices import orphe
from solepath.link.driver import Driver
from solepath.link.kinds import BUILT_IN_KINDS, make_kinds
from solepath.link.profile import Write


def test_a_driver_that_does_not_fit_together_is_rejected() -> None:
    other_driver = (evolve(PROFILE.channels[0], name="other/data"), *PROFILE.channels[1:])
    elsewhere = evolve(PROFILE, channels=other_driver, streams=("other/data",))
    for changes in (
        {"formats": {"toy/data": FORMATS["toy/data"]}},
        {"readers": {"toy/nothing": data}},
        {"profile": elsewhere, "formats": {**FORMATS, "other/data": FORMATS["toy/data"]}},
        {"profile": evolve(PROFILE, streams=())},
        {"profile": evolve(PROFILE, setup=(Write("toy/start", b"\x01\x02"),))},
        {"tick_rate": 100.0},
        {"tick_rate": inf, "tick_modulus": 256},
        {"tick_rate": 100.0, "tick_modulus": 1 << 65},
        {"sequence": -1},
        {"sequence": 1},
    ):
        with pytest.raises(ValueError, match="toy: "):
            evolve(BASE, **changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"name": ""},
        {"streams": ("toy/typo",)},
        {"streams": ("toy/start",)},
        {"setup": (Write("toy/nothing", b"\x01"),)},
        {"setup": (Write("toy/start", b"\x01", then_read=("toy/nothing",)),)},
        {"reads": ("toy/nothing",)},
        {"channels": (PROFILE.channels[0], *PROFILE.channels)},
        {"stale_after": 0.0},
        {"nominal_rate": 0.0},
        {"nominal_rate": inf},
    ],
    ids=str,
)
def test_a_profile_that_does_not_fit_together_is_rejected(changes: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="^a profile|^toy: "):
        evolve(PROFILE, **changes)


def test_an_app_adds_devices_and_may_replace_declared_ones_but_not_ours() -> None:
    for profile in PROFILES:
        kind = BUILT_IN_KINDS.get(profile.name.removesuffix("-20hz"))
        assert kind is not None and kind.profile in PROFILES
    assert BUILT_IN_KINDS.get("toy") is None and make_kinds([NUMBERED]).get("toy") is not None
    other_driver = evolve(orphe.DRIVER, limitation="")
    assert not of(Limitation, Session(profiles=[other_driver]).feed(mode_4_packet()))
    assert of(Limitation, Session().feed(mode_4_packet()))
    first = (evolve(PROFILE.channels[0], name="insole/data"),)
    named = evolve(PROFILE, name="insole", channels=first, streams=("insole/data",), setup=())
    own_driver = Driver(named, {"insole/data": FORMATS["toy/data"]}, {"insole/data": data})
    for drivers in ([own_driver], [NUMBERED, TICKING]):
        with pytest.raises(ValueError, match="already"):
            Session(profiles=drivers)
    with pytest.raises(TypeError, match="Driver"):
        Session(profiles=[PROFILE])  # type: ignore[list-item]


def mode_4_packet() -> Packet:
    value = bytes([56]) + bytes(103)
    return Packet(1.0, LEFT, "orphe/values", value)


def toy_packets(first: int, last: int) -> list[Packet]:
    fields: dict[str, Any] = {"ticks": 0, "count": 1, "up": [9.80665]}
    return [
        Packet(1.0 + 0.01 * k, LEFT, "toy/data", NUMBERED.write("toy/data", {"number": k, **fields}))
        for k in range(first, last)
    ]


def restorers(session: Session) -> list[Callable[..., Session]]:
    """Return functions that restore the session from its snapshot and from its packed state."""
    saved = json.loads(json.dumps(session.snapshot(), allow_nan=False))
    return [partial(Session.restore, saved), partial(Session.unpack, session.pack())]


def test_a_session_with_a_device_of_its_own_is_restored_with_it_and_not_without() -> None:
    session = Session(poses=True, profiles=[NUMBERED])
    session.feed(toy_packets(0, 100))
    restore_functions = restorers(session)
    events = [session.feed(toy_packets(103, 150)), session.advance(9.0)]
    assert [] not in events
    for restore in restore_functions:
        restored = restore(profiles=[NUMBERED])
        assert [restored.feed(toy_packets(103, 150)), restored.advance(9.0)] == events
        assert json.dumps(restored.snapshot()) == json.dumps(session.snapshot())
        with pytest.raises(SnapshotError, match="toy"):
            restore()


@pytest.mark.parametrize(
    "other_driver",
    [evolve(NUMBERED, sequence=0), BOTH, evolve(NUMBERED, profile=evolve(PROFILE, nominal_rate=50.0))],
    ids=["no numbers", "ticks", "another rate"],
)
def test_a_session_is_not_restored_with_a_driver_of_the_same_name_that_counts_otherwise(other_driver: Driver) -> None:
    session = Session(profiles=[NUMBERED])
    session.feed(toy_packets(1, 2))
    for restore in restorers(session):
        with pytest.raises(SnapshotError, match="toy.*another driver"):
            restore(profiles=[other_driver])
        restored = restore(profiles=[evolve(NUMBERED, limitation="it is a toy")])
        assert restored.snapshot() == session.snapshot()
