"""Tests what the page shows, from events alone, with different sensors."""

from __future__ import annotations

import base64
from math import inf, nan

from attrs import evolve
from page_events import foot_moved, rough_walk
from shown import frame, later, shown

from solepath import (
    Connected,
    Disconnected,
    Event,
    Foot,
    FootPressed,
    Site,
    StreamResumed,
    StreamStale,
    StrideTaken,
    WearerMoved,
)

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT


def test_a_page_shows_where_the_feet_and_the_wearer_are() -> None:
    session, events = rough_walk()
    content = frame(shown(events))
    for foot in Foot:
        one = content["feet"][foot.value]
        assert one["position"] == [round(v, 3) for v in session.feet[foot].position]
        assert one["phase"] == session.phase(foot).value  # type: ignore[union-attr]
        taken = [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]
        assert one["strides"] == len(taken)
        assert one["distance"] == round(sum(event.length for event in taken), 2)
    last = [event for event in events if isinstance(event, WearerMoved)][-1]
    assert content["wearer"]["position"] == [round(v, 3) for v in last.position]
    assert content["support"] == session.support.value  # type: ignore[union-attr]
    assert content["activity"]["now"] == session.activity.value


def test_cells_are_one_byte_each_of_the_highest_so_far() -> None:
    _, events = rough_walk()
    pressed = [event for event in events if isinstance(event, FootPressed) and event.foot is LEFT]
    content = frame(shown(events))["feet"]["left"]
    assert content["peak"] == round(max(max(event.values) for event in pressed), 3)
    cells = base64.b64decode(content["cells"])
    values = pressed[-1].values
    assert [round(255.0 * value / content["peak"]) for value in values] == [*cells]
    assert content["force"] == round(sum(values), 1)
    highest = max(pressed, key=lambda event: max(event.values))
    assert max(base64.b64decode(frame(shown([highest]))["feet"]["left"]["cells"])) == 255


def test_feet_that_fall_silent_show_nothing_and_come_back() -> None:
    _, events = rough_walk()
    scene = shown(events)
    end = scene.now
    scene.tick(end + 5.0)
    for one in frame(scene)["feet"].values():
        assert one["phase"] is None and one["cells"] is None and one["centre"] is None
        assert one["strides"] > 2, "what they did is still known"
    assert frame(scene)["links"]["left foot"]["state"] == "silent"
    assert 4.9 < frame(scene)["links"]["left foot"]["silent_for"] < 5.2
    shown([later(event, 20.0) for event in events], scene)
    content = frame(scene)
    assert content["links"]["left foot"]["state"] == "ok"
    assert content["feet"]["left"]["phase"] is not None and content["feet"]["left"]["cells"] is not None


def test_a_link_is_waiting_then_ok_then_lost_and_ok_again() -> None:
    site = Site.LEFT_FOOT
    connected = Connected(t=0.0, known_at=0.0, site=site, device="", name="Insole", signal=-50)
    under_way = foot_moved(1.99, known_at=2.05)  # which is no connection
    steps: list[tuple[list[Event], str]] = [
        ([connected], "waiting"),
        ([foot_moved(1.0 + 0.01 * k) for k in range(100)], "ok"),
        ([Disconnected(t=2.0, known_at=2.0, site=site), under_way], "lost"),
        ([later(connected, 7.5)], "waiting"),
        ([foot_moved(8.0)], "ok"),
        ([StreamStale(t=8.5, known_at=9.0, site=site, silent_for=1.0)], "silent"),
        ([StreamResumed(t=9.4, known_at=9.4, site=site, silent_for=1.4), foot_moved(9.4)], "ok"),
    ]
    scene = shown([])
    for events, state in steps:
        link = frame(shown(events, scene))["links"]["left foot"]
        assert link["state"] == state


def test_events_with_numbers_that_are_not_finite_are_not_shown() -> None:
    pressed = FootPressed(t=1.0, known_at=1.0, foot=LEFT, values=(0.5, 0.0, 1.0), force=1.5, centre=(0.1, 0.0))
    scene = shown([foot_moved(1.0), pressed])
    before = frame(scene)["feet"]
    odd = evolve(foot_moved(1.0), position=(nan, inf, -inf))
    for event in (odd, evolve(pressed, force=nan), evolve(pressed, values=(nan, inf, 1.0))):
        assert frame(shown([event], scene))["feet"] == before
