"""Tests that an early watcher and a late one see the same, and that neither's state grows with the walk."""

from __future__ import annotations

import json
import pickle
from functools import cache
from typing import Any

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from page_events import events_of_all_kinds, rough_walk
from shown import later

from solepath import Event, Foot, FootMoved, FootPressed, PacketRejected, Placed, SampleGap, StrideTaken, WearerMoved
from solepath.emulate.routes.building import BUILDING
from solepath.show.page.messages import encode
from solepath.show.page.scene.lists import MAX_POINTS
from solepath.show.page.scene.log import MAX_LINES
from solepath.show.page.scene.scene import Follower, Scene

LISTS = ("phases", "tracks", "places", "log")


def step(t: float, x: float, foot: Foot = Foot.LEFT) -> StrideTaken:
    """Return a stride that ends at `x`, m, at time `t`, s."""
    first = next(event for event in rough_walk()[1] if isinstance(event, StrideTaken))
    return evolve(first, foot=foot, t=t, known_at=t, t_start=t - 1.0, t_end=t, position=(x, 0.0, 0.0))


class Reader:
    """A page as protocol/page.md describes it, without any drawing."""

    def __init__(self) -> None:
        self.scene: dict[str, Any] = {}
        self.scene_count = 0

    def take(self, text: str) -> None:
        message = json.loads(text)
        if message["type"] == "scene":
            self.scene = message
            self.scene_count += 1
            return
        now = self.scene["frame"]
        for key, value in message.items():
            if key not in LISTS:
                now[key] = value
        for name, points in message.get("tracks", {}).items():
            for point in points:
                self.scene["tracks"][name] = self._longer(self.scene["tracks"][name], point)
        for point in message.get("places", []):
            self.scene["places"] = self._longer(self.scene["places"], point)
        for foot, started in message.get("phases", {}).items():
            kept = self.scene["phases"][foot]
            for one in started:
                kept.append(one)
                while len(kept) > 1 and (kept[1][0] <= one[0] - 20.0 or len(kept) > 500):
                    kept.pop(0)
        for line in message.get("log", []):
            self.scene["log"] = [*self.scene["log"], line][-50:]

    def _longer(self, points: list[Any], point: Any) -> list[Any]:
        points = [*points, point]
        return points[::2] if len(points) > 2000 else points


@cache
def long_track() -> list[Event]:
    return [step(1.0 + k, 0.7 * k) for k in range(2 * MAX_POINTS)]


def agree(events: list[Event], read_indices: list[int], scene: Scene | None = None) -> Reader:
    """Check that a watcher who reads after each of these events ends with the scene of a watcher who comes last."""
    scene = Scene("a walk", "default", plan=BUILDING) if scene is None else scene
    reader = Reader()
    follower = Follower()

    def read() -> None:
        news = follower.message(scene)
        if news is not None:
            reader.take(encode(news))

    read()
    for index, event in enumerate(events):
        scene.take(None, [event])
        for _ in range(read_indices.count(index)):
            read()
    read()
    late = json.loads(encode(scene.whole_message()))
    for one in (late, reader.scene):
        for key in LISTS:
            one["frame"].pop(key, None)
        one["frame"].pop("type", None)
    assert reader.scene == late
    return reader


@settings(max_examples=8)
@given(st.data())
@pytest.mark.soak
def test_the_changes_add_up_to_the_scene_of_a_late_watcher(data: st.DataObject) -> None:
    events = events_of_all_kinds()
    read_indices = data.draw(st.lists(st.integers(0, len(events) - 1), max_size=40))
    agree(events, read_indices)


@settings(max_examples=8)
@given(st.lists(st.integers(0, 2 * MAX_POINTS), max_size=30))
@pytest.mark.soak
def test_a_long_track_is_thinned_alike_on_both_sides(read_indices: list[int]) -> None:
    agree(long_track(), read_indices)


def test_a_page_that_is_too_far_behind_to_thin_its_track_gets_the_whole_scene_again() -> None:
    events = long_track()[: MAX_POINTS + 10]
    assert agree(events[:MAX_POINTS], []).scene_count == 1
    assert agree(events, []).scene_count == 2
    assert agree(events, [MAX_POINTS - 1, MAX_POINTS]).scene_count == 1


@pytest.mark.long
def test_hours_of_walking_do_not_make_a_scene_larger() -> None:
    many = FootMoved | FootPressed | SampleGap | PacketRejected
    once = [event for event in events_of_all_kinds() if not isinstance(event, many)]
    length = once[-1].known_at + 1.0
    scene, sizes = Scene("hours", "default", plan=BUILDING), []
    for lap in range(500):
        for event in events_of_all_kinds() if lap % 125 == 124 else once:
            event = later(event, lap * length)
            if isinstance(event, StrideTaken | WearerMoved | Placed):
                x, y, z = event.position
                event = evolve(event, position=(x + lap, y, z))
            scene.take(None, [event])
        if lap % 125 == 124:
            message = scene.whole_message()
            assert all(len(track) <= MAX_POINTS for track in message["tracks"].values())
            assert len(message["places"]) <= MAX_POINTS
            assert len(message["log"]) == MAX_LINES
            assert all(len(phases) < 100 for phases in message["phases"].values())
            sizes.append(len(pickle.dumps(scene)))
    assert max(sizes[2:]) < 1.3 * max(sizes[:2])
    assert max(sizes) < 1_000_000
