"""The packed form of a session: bit for bit what it was, at any moment, of every recipe and device."""

from __future__ import annotations

import json

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from solepath import Session
from solepath.machine import save
from walks import NAMES, gone, machines, told

SESSIONS = [name for name in NAMES if name.startswith("session")]
QUICK = settings(max_examples=2, deadline=None, phases=[Phase.generate])
"""A walk an example: few of them, and no shrinking."""


def repacked(session: Session) -> Session:
    """The same through bytes."""
    plan = {} if session._plan is None else {"floorplan": session._plan}
    return Session.unpack(session.pack(), session.recipe, **plan)


def text(session: Session) -> str:
    """All its state in order, -0.0 and 0.0 told apart."""
    return json.dumps(save(session._state))


@pytest.mark.parametrize("name", SESSIONS)
@given(st.data())
@QUICK
def test_a_session_packed_at_any_moment_goes_on_as_if_nothing_had_happened(name: str, data: st.DataObject) -> None:
    machine = machines()[name]
    cut = data.draw(st.integers(0, len(machine.items)))
    # a machine that remembers nothing yet, which is always tried, need not go all the way
    end = len(machine.items) if cut else min(100, len(machine.items))
    straight = machine.begin()
    for item in machine.items[:cut]:
        straight.feed(item)
    unpacked = repacked(straight)
    assert text(unpacked) == text(straight)
    for item, events in zip(machine.items[cut:end], told(name)[cut:end], strict=True):
        assert repr(unpacked.feed(item)) == repr([*events])
    if cut:
        assert repr(unpacked.finish()) == repr([*told(name)[-1]])
        assert machine.save(unpacked) == gone(name).ended
