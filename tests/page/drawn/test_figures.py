"""Tests the page's figures: colours, pace, losses and gait, from events alone and the same for all watchers."""

from __future__ import annotations

from functools import cache

import pytest
from page_events import foot_moved
from shown import frame, shown
from walks import insoles

from solepath import Activity, ActivityChanged, Event, Foot, GaitCycleMeasured, Packet, SampleGap, Session, Site
from solepath.emulate.routes.route import Route
from solepath.show.page.scene.scene import Scene

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
WALK = Route().stand(1.5).walk(14.0, 1.3).stop(6.0)


@cache
def walk() -> tuple[Event, ...]:
    return tuple(Session(poses=True, pressures=True).feed(insoles(WALK).packets))


def scene_until(t: float) -> Scene:
    return shown([event for event in walk() if event.known_at <= t])


def changed(t: float, activity: Activity) -> ActivityChanged:
    return ActivityChanged(t=t, known_at=t, activity=activity, probability=None, revises=None, final=False)


def test_the_activity_is_unknown_while_no_foot_sends() -> None:
    scene = shown([foot_moved(1.0), foot_moved(1.0, RIGHT), changed(1.0, Activity.WALKING)])
    assert frame(scene)["activity"] == {"now": "WALKING", "since": 1.0, "last": None}
    shown([foot_moved(1.0 + 0.1 * k) for k in range(60)], scene)
    assert frame(scene)["activity"]["now"] == "WALKING", "the other foot is heard"
    scene.tick(12.0)
    assert frame(scene)["activity"] == {"now": "UNKNOWN", "since": 6.9, "last": "WALKING"}
    shown([foot_moved(12.5)], scene)
    assert frame(scene)["activity"] == {"now": "WALKING", "since": 1.0, "last": None}


@pytest.mark.soak
def test_the_pace_is_that_of_the_newest_strides() -> None:
    scene = scene_until(8.0)
    strides = [event for event in walk() if isinstance(event, GaitCycleMeasured) and event.known_at <= 8.0]
    newest = [[one for one in strides if one.foot is foot][-2:] for foot in Foot]
    assert [len(some) for some in newest] == [2, 2]
    cadences = [sum(one.cadence for one in some) / 2 for some in newest]
    speeds = [sum(one.speed or 0.0 for one in some) / 2 for some in newest]
    assert frame(scene)["pace"] == {"cadence": round(sum(cadences) / 2, 1), "speed": round(sum(speeds) / 2, 2)}
    assert abs(frame(scene)["pace"]["speed"] - 1.3) < 0.1


def test_a_wearer_who_stands_or_whose_sensors_are_silent_has_no_pace() -> None:
    assert frame(scene_until(1.2))["pace"] is None
    assert frame(shown(walk()))["pace"] is None
    scene = scene_until(8.0)
    scene.tick(10.0)
    assert frame(scene)["pace"] is None
    scene = shown([changed(7.9, Activity.STANDING)], scene_until(8.0))
    assert frame(scene)["pace"] is None, "no stride came since"


def test_a_loss_is_that_of_the_last_ten_seconds() -> None:
    scene = Scene("a walk", "default")

    def loss_after(start: float, end: float) -> tuple[int, float]:
        for k in range(round(100 * (end - start))):
            t = start + 0.01 * k
            scene.take(Packet(t + 0.02, Site.LEFT_FOOT, "insole/frame", b""), [foot_moved(t, known_at=t + 0.02)])
        link = frame(scene)["links"]["left foot"]
        return link["missing"], link["recent_share"]

    loss_after(0.0, 2.0)
    shown([SampleGap(t=12.0, known_at=12.0, site=Site.LEFT_FOOT, duration=10.0, count=1000)], scene)
    lost, share = loss_after(12.0, 14.0)
    assert lost == 1000 and 0.7 < share < 0.9
    assert loss_after(14.0, 24.0) == (1000, 0.0)
    scene.tick(27.0)
    assert frame(scene)["links"]["left foot"]["recent_share"] is None, "nothing comes"
