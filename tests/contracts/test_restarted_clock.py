"""A session goes on after `restart_clock`: after a reboot, where time.monotonic starts again, or a clock set back."""

from __future__ import annotations

import json
from functools import cache
from math import hypot, inf, nan
from typing import Any

import pytest
from attrs import evolve
from transforms import CALIBRATION, WALKING_MODES, WALKS
from walks import SAMPLE_NAMES, Item, insoles, machines, of, often

from solepath import (
    ClockReset,
    Limitation,
    PacketRejected,
    Rejection,
    Sample,
    SampleGap,
    SampleRejected,
    Session,
    Site,
    StreamResumed,
    StreamStale,
    StrideTaken,
    recipes,
)

REBOOT, SET_FORWARD = -1000.0, 5000.0
"""Changes of the clock, s."""
TIES = ("session, seven sites",)
"""Sessions at 25 Hz, in which some times are as long as a limit, so that rounding decides."""
SESSIONS = ["session, whole frames", "session, fragments", "session, four samples a frame", "session, cc2650",
            "session, cc2541", "session, orphe", "session, dot", "session, thingy", "session, kupt-dfpc",
            "session, walking-modes", "session, footstep-tracker", "session, shoe-sensing",
            *(name for name in SAMPLE_NAMES if name not in TIES)]  # fmt: skip


def shifted(item: Item, by: float) -> Item:
    """Return the item on a clock that differs by this time, s."""
    if isinstance(item, Sample) and item.known_at is not None:
        return evolve(item, t=item.t + by, known_at=item.known_at + by)
    return evolve(item, t=item.t + by)


@cache
def first_half(name: str) -> tuple[Any, float, tuple[Item, ...]]:
    """Return the state of a session in the middle of a walk, its time, and the rest of the walk."""
    machine = machines()[name]
    session = machine.start()
    middle = len(machine.items) // 2
    session.feed(machine.items[:middle])
    return machine.save(session), session.now, machine.items[middle:]


@pytest.mark.parametrize(
    "name", often(SESSIONS, ("whole frames", "cc2650", "dot", "kupt-dfpc", "shoe-sensing", "particles"))
)
def test_every_session_goes_on_the_same_whatever_the_new_clock_shows(name: str) -> None:
    saved, now, rest = first_half(name)
    found = {}
    for by in (REBOOT, SET_FORWARD):
        session = machines()[name].load(saved)
        resets = session.restart_clock(now + by)
        assert session.now == now + by
        assert of(ClockReset, resets) and {event.t for event in of(ClockReset, resets)} == {now + by}
        events = session.feed([shifted(item, by) for item in rest]) + session.finish()
        assert not [one for one in events if getattr(one, "reason", None) is Rejection.TIME_BACKWARDS]
        found[by] = [
            (type(event), getattr(event, "foot", None), round(event.t - by, 2), round(event.known_at - by, 2))
            for event in events
        ]
    assert found[REBOOT] == found[SET_FORWARD]


@pytest.mark.parametrize("recipe", often(WALKING_MODES))
def test_the_sensors_above_the_ankles_go_on_with_those_of_the_feet(recipe: str) -> None:
    walk, restarted = sorted(WALKS["suit"](), key=lambda sample: sample.t), []
    for by in (REBOOT, SET_FORWARD):
        session = Session(recipes.by_name(recipe), calibration=CALIBRATION)
        session.feed([sample for sample in walk if sample.t < 3.0])
        assert session.now is not None
        resets = session.restart_clock(session.now + by)
        assert [event.site for event in of(ClockReset, resets)] == [Site.LEFT_FOOT, Site.RIGHT_FOOT]
        events = session.feed([shifted(sample, by) for sample in walk if sample.t >= 3.0]) + session.finish()
        assert of(SampleRejected, events) == []
        restarted.append([(one.foot, round(one.t - by, 2)) for one in of(StrideTaken, events)])
        # another clock is no other world: the chain of all seven goes on
        assert not any("own inertial tracks" in one.what for one in of(Limitation, events))
    assert restarted[0] == restarted[1] and len(restarted[0]) >= 5


class App:
    """What docs/app.md says that an app does: it saves, its phone reboots, it restores and restarts the clock."""

    def __init__(self, text: str, monotonic: float) -> None:
        self.session = Session.restore(json.loads(text))
        self.events = self.session.restart_clock(monotonic)


@pytest.mark.parametrize("uptime", [4.0, 90_000.0])
def test_no_packet_is_lost_after_a_reboot_and_the_track_goes_on(uptime: float) -> None:
    walk = insoles().packets
    before, after = [packet for packet in walk if packet.t < 5.0], [packet for packet in walk if packet.t >= 5.0]
    session = Session()
    session.feed(before)
    app = App(json.dumps(session.snapshot()), uptime)
    assert [(event.site, event.t) for event in of(ClockReset, app.events)] == [
        (Site.LEFT_FOOT, uptime), (Site.RIGHT_FOOT, uptime)
    ]  # fmt: skip
    events = app.session.feed([shifted(packet, uptime - 5.0) for packet in after[:4]])
    place, kept = session.position, app.session.position
    assert place is not None and kept is not None
    assert hypot(kept.position[0] - place.position[0], kept.position[1] - place.position[1]) < 0.1
    assert kept.covariance[0] > place.covariance[0] + 1.0, "where the wearer went meanwhile is not known"
    events += app.session.feed([shifted(packet, uptime - 5.0) for packet in after[4:]])
    assert not of(PacketRejected, events) and not of(SampleGap, events)
    strides = of(StrideTaken, events)
    assert len(strides) >= 2 and all(0.0 < one.t_end - one.t_start < 2.0 and one.t_start >= uptime for one in strides)
    moved, end = Session(), app.session.position
    moved.feed(walk)
    assert end is not None and moved.position is not None
    assert hypot(end.position[0] - place.position[0], end.position[1] - place.position[1]) > 0.5
    assert hypot(end.position[0] - moved.position.position[0], end.position[1] - moved.position.position[1]) < 1.0


def test_restarting_the_clock_again_without_data_adds_no_uncertainty() -> None:
    session = Session()
    session.feed([packet for packet in insoles().packets if packet.t < 5.0])
    session.restart_clock(4.0)
    once = session.position
    for t in (1.0, 2.0, 3.0):
        session.restart_clock(t)
    assert session.position == once


def test_without_the_call_packets_are_rejected_until_twenty_in_a_row_have_shown_it() -> None:
    session = Session()
    session.feed([packet for packet in insoles().packets if packet.t < 5.0])
    events = session.feed([shifted(packet, -5.0) for packet in insoles().packets if packet.t >= 5.0])
    assert sum(event.count for event in of(PacketRejected, events)) == 2 * 19 and len(of(ClockReset, events)) == 2


def test_what_waited_for_other_data_is_given_out_before_the_clock_restarts() -> None:
    """A CC2541 holds back a sample until the gyroscope's next value has come."""
    machine = machines()["decoder, cc2541"]
    for count in range(60, 80):
        decoder, finished = machine.start(), machine.start()
        for item in machine.items[:count]:
            decoder.feed(item)
            finished.feed(item)
        waiting = finished.finish()
        assert decoder.restart_clock(0.0)[:-1] == waiting
        if waiting:
            return
    raise AssertionError("nothing ever waited")


def test_silence_after_a_restart_is_reported() -> None:
    session = Session()
    walk = insoles().packets
    session.feed(walk)
    session.restart_clock(3.0)
    assert not session.advance(4.0)
    assert len(of(StreamStale, session.advance(10.0))) == 2
    assert len(of(ClockReset, session.restart_clock(1.0))) == 2
    events = session.feed([shifted(packet, 1.5) for packet in walk[:10]])
    assert len(of(StreamResumed, events)) == 2


def test_a_session_without_data_or_finished_has_no_clock_to_restart() -> None:
    session = Session()
    assert session.restart_clock(7.0) == [] and session.now == 7.0
    session.finish()
    assert session.restart_clock(9.0) == [] and session.now == 7.0


@pytest.mark.parametrize(("now", "error"), [(nan, ValueError), (inf, ValueError), ("5", TypeError), (None, TypeError)])
def test_a_time_that_is_none_is_the_callers_mistake(now: Any, error: type[Exception]) -> None:
    session = Session()
    with pytest.raises(error, match="now is"):
        session.restart_clock(now)
    assert session.now is None
