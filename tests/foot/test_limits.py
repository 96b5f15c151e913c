"""What a session does at the edges of what it was made for."""

from __future__ import annotations

import json
from math import hypot, isfinite, radians

import pytest

from solepath import (
    ClockReset,
    Foot,
    FootFlat,
    FootMoved,
    Packet,
    PacketRejected,
    Sample,
    SampleGap,
    Session,
    Site,
    StreamStale,
    StrideTaken,
    recipes,
)
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import Track
from solepath.emulate import CC2650, Route, emulate

LEFT = Site.LEFT_FOOT


def still(t: float, rate: float = 0.0) -> Sample:
    return Sample(t, LEFT, (0.0, 0.0, 9.81), (0.0, rate, 0.0))


@pytest.mark.parametrize(("rate", "wait"), [(18.0, 0.5), (35.0, 0.2), (35.0, 0.3), (80.0, 0.1), (95.0, 0.24)])
def test_however_far_a_foot_turns_between_two_samples_its_position_is_a_number(rate: float, wait: float) -> None:
    session = Session(poses=True)
    events = session.feed([still(0.01 * k) for k in range(100)])
    events += session.feed([still(1.0 + 0.01 * k, rate) for k in range(5)])
    events += session.feed(still(1.04 + wait, rate))
    events += session.feed([still(1.05 + wait + 0.01 * k) for k in range(300)])
    moved = [event for event in events if isinstance(event, FootMoved)]
    assert all(isfinite(x) for event in moved for x in (*event.position, *event.velocity))
    json.dumps(session.snapshot(), allow_nan=False)


def test_a_first_wait_of_seconds_does_not_hide_the_gaps_after_it() -> None:
    session = Session()
    events = session.feed([still(0.0), *(still(2.0 + 0.01 * k) for k in range(60)), still(4.1)])
    assert [round(event.duration, 2) for event in events if isinstance(event, SampleGap)] == [2.0, 1.51]


def test_who_was_heard_first_does_not_matter_to_a_snapshot() -> None:
    walk = emulate(Route().stand(1).walk(4, 1.2).stop(1), seed=3)
    session = Session()
    session.feed([packet for packet in walk.packets[:400] if packet.site is Site.RIGHT_FOOT])
    session.feed([packet for packet in walk.packets[:400] if packet.site is LEFT])
    text = json.dumps(session.snapshot(), sort_keys=True)
    restored = Session.restore(json.loads(text))
    stale, other = session.advance(1e4), restored.advance(1e4)
    assert stale == other and len([event for event in stale if isinstance(event, StreamStale)]) == 2
    assert restored.position == session.position


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("first", [Route().stand(2).turn(radians(90)), Route().stand(2).turn(radians(90), radius=2.0)])
def test_final_steps_are_all_seen_from_one_frame(first: Route, seed: int) -> None:
    walk = emulate(first.walk(6, 1.2).stop(2), seed=seed)
    session = Session(recipes.DEFAULT.exchanged(Track, MeanOfFeet()))  # no foot is moved by the other
    steps = [event for event in session.feed(walk.packets) if isinstance(event, StrideTaken)]
    for foot in Foot:
        own = [step for step in steps if step.foot is foot]
        assert len(own) >= 5
        for before, after in zip(own, own[1:], strict=False):
            (x, y, _), (u, v, _), (dx, dy, _) = after.position, before.position, after.displacement
            assert hypot(x - u - dx, y - v - dy) < 0.06  # what the foot shifts while it stands


def test_a_session_has_its_own_copy_of_the_recipe() -> None:
    session = Session()
    session.recipe.detector.sigma = 7.0
    assert session.recipe.detector.sigma != 7.0
    assert recipes.DEFAULT.detector.sigma != 7.0


def test_after_finish_time_brings_nothing() -> None:
    walk = emulate(Route().stand(1).walk(2, 1.2).stop(1), seed=3)
    session = Session()
    session.feed(walk.packets)
    session.finish()
    assert session.advance(1e4) == [] and session.finish() == []


@pytest.mark.parametrize(
    "item",
    [
        Sample(0.0, LEFT, (10**400, 0.0, 0.0), (0.0, 0.0, 0.0)),
        Sample(10**400, LEFT, (0.0, 0.0, 9.8), (0.0, 0.0, 0.0)),
        Packet(10**400, LEFT, "cc2650/movement", bytes(18)),
    ],
    ids=["acc", "sample time", "arrival"],
)
def test_integers_too_large_for_a_float_are_rejected(item: Packet | Sample) -> None:
    (event,) = Session().feed(item)
    assert type(event).__name__ in ("SampleRejected", "PacketRejected")


def test_what_the_caller_got_wrong_raises_type_error() -> None:
    session = Session()
    with pytest.raises(TypeError):
        session.feed(Sample(0.0, "left_foot", (0.0, 0.0, 9.8), (0.0, 0.0, 0.0)))  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        session.feed(Packet("now", LEFT, "cc2650/movement", bytes(18)))  # type: ignore[arg-type]
    with pytest.raises(ValueError):
        session.advance(10**400)


def test_a_foot_that_stands_for_a_minute_takes_no_step_and_stays() -> None:
    walk = emulate(Route().stand(60), seed=4)
    session = Session()
    events = session.feed(walk.packets)
    assert [event for event in events if isinstance(event, StrideTaken | FootFlat)] == []
    assert session.position is not None and max(map(abs, session.position.position)) < 0.01


def test_a_packet_that_cannot_be_used_does_not_set_the_clock_back() -> None:
    walk = emulate(Route().stand(3), devices={LEFT: CC2650()}, seed=1)
    session = Session()
    session.feed(walk.packets)
    late = Packet(0.5, LEFT, "cc2650/movement", bytes(18))
    for _ in range(19):
        session.feed(late)
    before = session.snapshot()
    (event,) = session.feed(Packet(0.5, LEFT, "toaster/crumbs", b""))
    assert isinstance(event, PacketRejected) and session.snapshot() == before
    assert any(isinstance(event, ClockReset) for event in session.feed(late))
