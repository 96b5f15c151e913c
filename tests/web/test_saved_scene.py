"""A scene that is saved and restored shows the same, and goes on as if nothing had happened."""

from __future__ import annotations

import json

import pytest
from page_events import events_of_all_kinds
from shown import packet_events, walked

from solepath.emulate import Route
from solepath.saving.codec import SnapshotError
from solepath.show.page.messages import encode
from solepath.show.page.scene.saved_scene import restore_scene, save_scene
from solepath.show.page.scene.scene import Scene


def saved_and_restored(scene: Scene) -> Scene:
    text = json.dumps(save_scene(scene), allow_nan=False)
    return restore_scene(json.loads(text), scene.plan)


def text_of(scene: Scene) -> str:
    return encode(scene.whole_message()[0])


def test_a_restored_scene_gives_the_same_message_and_goes_on_alike() -> None:
    walk = packet_events(walked(Route().stand(1.0).walk(8.0, 1.3).stop(1.0), cells=16))
    scene = Scene("a walk", "default")
    for number, (packet, events) in enumerate(walk):
        if number in (300, 1000):
            restored = saved_and_restored(scene)
            assert text_of(restored) == text_of(scene)
            assert restored == scene
            scene = restored
        scene.take(packet, events)
    other = Scene("a walk", "default")
    for packet, events in walk:
        other.take(packet, events)
    assert text_of(scene) == text_of(other)
    assert scene == other


def test_a_damaged_scene_and_one_without_anything_are_rejected() -> None:
    with pytest.raises(SnapshotError):
        save_scene(Scene("a walk", "default"))
    scene = Scene("a walk", "default")
    scene.take(None, events_of_all_kinds()[:1])
    saved = save_scene(scene)
    assert isinstance(saved, dict)
    for damaged in (None, {}, {**saved, "feet": 1}, {**saved, "observer": None}):
        with pytest.raises(SnapshotError):
            restore_scene(damaged)
