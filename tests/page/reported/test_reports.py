"""Tests what a page shows of positions that a person reports: the revised track, also after a seek."""

from __future__ import annotations

import json
from functools import cache
from math import hypot, pi
from typing import Any

import pytest
from shown import frame, walked

from solepath import Event, Foot, Packet, Session, Site
from solepath.emulate.routes.route import Route
from solepath.events import TrackRevised
from solepath.show.page.messages import encode
from solepath.show.page.player.player import Player
from solepath.show.page.scene.saved_scene import restore_scene, save_scene
from solepath.show.page.scene.scene import Scene
from solepath.wire.receiver import PositionFrame, build_position

HALF_ROUND = Route().stand(1.0).walk(8.0, 1.3).turn(pi, radius=1.5).walk(8.0, 1.3).stop(3.0)
"""A walk of about 20 s, there and back."""
REPORT_TIMES = (9.0, 18.9)
"""Times at which the wearer reports a position, s; at the second the wearer has stood for a while."""


def position_packet(t: float, position: tuple[float, float]) -> Packet:
    return Packet(t, Site.LEFT_FOOT, "receiver/position", build_position(PositionFrame(position, 0.1)))


@cache
def reported_walk() -> tuple[Packet, ...]:
    """Return a walk with reports at REPORT_TIMES of positions 0.36 m from where the track then is."""
    session, due = Session(poses=True), list(REPORT_TIMES)
    packets: list[Packet] = []
    for packet in walked(HALF_ROUND, cells=8):
        if due and packet.t > due[0]:
            due.pop(0)
            assert session.position is not None
            x, y, _ = session.position.position
            packets.append(position_packet(packet.t, (x + 0.3, y - 0.2)))
            session.feed(packets[-1])
        packets.append(packet)
        session.feed(packet)
    return tuple(packets)


def show_until(packets: tuple[Packet, ...], report: int) -> tuple[Session, Scene, Scene, list[Event]]:
    """Return the session after this report, the scenes before and after it, and the events of the report."""
    session, scene = Session(poses=True, pressures=True, losses=True), Scene("a walk", "default")
    for packet in packets:
        is_report = packet.channel == "receiver/position"
        if is_report and report == 0:
            before = restore_scene(save_scene(scene))
            events = session.feed(packet)
            scene.take(packet, events)
            return session, before, scene, events
        report -= is_report
        scene.take(packet, session.feed(packet))
    raise AssertionError("there is no such report")


def whole(player: Player) -> Any:
    """Return what a new watcher gets, without the state of the playback."""
    message = json.loads(encode(player.scene.whole_message()))
    message["frame"]["playback"] = None
    return message


@pytest.mark.parametrize("report", [0, 1])
@pytest.mark.soak
def test_the_drawn_track_ends_where_the_session_is_after_a_revision(report: int) -> None:
    session, before, scene, events = show_until(reported_walk(), report)
    assert isinstance(events[1], TrackRevised) and hypot(*events[1].by) > 0.08
    assert session.position is not None
    x, y, _ = session.position.position
    last = scene.wearer.track.items[-1]
    assert last[1:3] == pytest.approx((x, y), abs=0.02)
    wearer = frame(scene)["wearer"]
    assert wearer["position"][:2] == pytest.approx((x, y), abs=0.001)
    assert wearer["covariance"] is None, "it is not known before the next stride"
    for foot in Foot:
        was, now = before.feet[foot].track.items[-1], scene.feet[foot].track.items[-1]
        assert (now[1] or 0.0) - (was[1] or 0.0) == pytest.approx(events[1].by[0], abs=0.06)
