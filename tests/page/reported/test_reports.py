"""Tests what a page shows of positions that a person reports: the revised track, sentences and marks."""

from __future__ import annotations

import json
from functools import cache
from math import hypot, pi
from typing import Any

import pytest
from shown import frame, scene_after, walked

from solepath import Event, Foot, Packet, Session, Site
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.events import PositionRejected, PositionReported, TrackRevised
from solepath.show.page.messages import encode
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.scene.saved_scene import restore_scene, save_scene
from solepath.show.page.scene.scene import Scene
from solepath.wire.receiver import PositionFrame, build_position

HALF_ROUND = Route().stand(1.0).walk(8.0, 1.3).turn(pi, radius=1.5).walk(8.0, 1.3).stop(3.0)
"""A walk of about 20 s, there and back."""
REPORT_TIMES = (9.0, 18.9)
"""Times at which the wearer reports a position, s; at the second the wearer has stood for a while."""


def position_packet(t: float, position: tuple[float, float] | None, sigma: float = 0.1) -> Packet:
    return Packet(t, Site.LEFT_FOOT, "receiver/position", build_position(PositionFrame(position, sigma)))


@cache
def reported_walk(off: tuple[float, float] = (0.3, -0.2)) -> tuple[Packet, ...]:
    """Return a walk with reports at REPORT_TIMES of positions that are `off`, m, from where the track then is."""
    session, due = Session(poses=True), list(REPORT_TIMES)
    packets: list[Packet] = []
    for packet in walked(HALF_ROUND, cells=8):
        if due and packet.t > due[0]:
            due.pop(0)
            assert session.position is not None
            x, y, _ = session.position.position
            packets.append(position_packet(packet.t, (x + off[0], y + off[1])))
            session.feed(packets[-1])
        packets.append(packet)
        session.feed(packet)
    return tuple(packets)


def show_until(packets: tuple[Packet, ...], report: int) -> tuple[Session, Scene, Scene, list[Event]]:
    """Return the session after this report, the scenes before and after it, and the events of the report."""
    session, scene = Session(poses=True, pressures=True), Scene("a walk", "default")
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


def moved(before: Scene, after: Scene) -> list[tuple[float, float]]:
    """Return time, s, and distance, m, by which each point of the wearer's track was moved."""
    pairs = zip(before.wearer.track.points, after.wearer.track.points, strict=False)
    return [(a[0] or 0.0, hypot((b[1] or 0.0) - (a[1] or 0.0), (b[2] or 0.0) - (a[2] or 0.0))) for a, b in pairs]


def lines_here(scene: Scene) -> list[str]:
    return [text for _, kind, text in scene.log.lines.items if kind == "here"]


def whole(player: Player) -> Any:
    """Return what a new watcher gets, without the state of the playback."""
    message = json.loads(encode(player.scene.whole_message()[0]))
    message["frame"]["playback"] = None
    return message


@pytest.mark.parametrize("report", [0, 1])
def test_the_drawn_track_ends_where_the_session_is_after_a_revision(report: int) -> None:
    session, before, scene, events = show_until(reported_walk(), report)
    assert isinstance(events[1], TrackRevised) and hypot(*events[1].by) > 0.08
    assert session.position is not None
    x, y, _ = session.position.position
    last = scene.wearer.track.points[-1]
    assert last[1:3] == pytest.approx((x, y), abs=0.02)
    wearer = frame(scene)["wearer"]
    assert wearer["position"][:2] == pytest.approx((x, y), abs=0.001)
    assert wearer["covariance"] is None, "it is not known before the next stride"
    for foot in Foot:
        was, now = before.feet[foot].track.points[-1], scene.feet[foot].track.points[-1]
        assert (now[1] or 0.0) - (was[1] or 0.0) == pytest.approx(events[1].by[0], abs=0.06)


def test_a_foot_is_drawn_with_the_correction_although_it_has_it_only_after_its_next_stride() -> None:
    session, before, scene, events = show_until(reported_walk(), 0)
    (revised,) = [event for event in events if isinstance(event, TrackRevised)]
    after = [packet for packet in reported_walk() if packet.t > revised.t]
    for foot in Foot:
        assert scene.feet[foot].lag == revised.by
        was, now = before.feet[foot].position, scene.feet[foot].position
        assert was is not None and now == pytest.approx((was[0] + revised.by[0], was[1] + revised.by[1], was[2]))
    for packet in after:
        places = {foot: one.position for foot, one in scene.feet.items()}
        scene.take(packet, session.feed(packet))
        for foot, one in scene.feet.items():
            was, now = places[foot], one.position
            assert was is not None and now is not None and hypot(now[0] - was[0], now[1] - was[1]) < 0.08
        if packet.t > REPORT_TIMES[0] + 2.0:
            break
    assert {one.lag for one in scene.feet.values()} == {(0.0, 0.0)}
    for foot, tracker in session.feet.items():
        assert scene.feet[foot].position == tracker.position


def test_the_track_is_bent_more_and_more_from_the_position_that_was_reported_before() -> None:
    _, before, scene, events = show_until(reported_walk(), 1)
    revised = events[1]
    assert isinstance(revised, TrackRevised)
    since = revised.nodes[0].t
    bent = moved(before, scene)
    assert since > 8.0 and all(distance == 0.0 for t, distance in bent if t < since)
    later = [distance for t, distance in bent if t >= since]
    assert later[0] < 0.05 and later[-1] == pytest.approx(hypot(*revised.by), abs=0.06)
    assert max(abs(b - a) for a, b in zip(later, later[1:], strict=False)) < 0.15
    for node in revised.nodes[:-1]:
        nearest = min(hypot((p[1] or 0.0) - node.x, (p[2] or 0.0) - node.y) for p in scene.wearer.track.points)
        assert nearest < 0.5, "the drawn track passes the nodes"


def test_a_wearer_who_has_stood_still_is_drawn_in_one_place() -> None:
    """The correction belongs to the way there, however long the wearer stands before the report."""
    session, scene = Session(poses=True, pressures=True), Scene("a walk", "default")
    for packet in walked(Route().stand(1.0).walk(9.0, 1.3).stop(20.0), cells=8):
        scene.take(packet, session.feed(packet))
    assert session.position is not None and session.now is not None
    x, y, _ = session.position.position
    drawn = scene.wearer.track.points[-1]
    scene.take(None, session.feed(position_packet(session.now, (x + 0.3, y + 0.3))))
    at_the_stop = next(point for point in scene.wearer.track.points if point[0] == drawn[0])
    end = scene.wearer.track.points[-1]
    assert (drawn[0] or 0.0) < session.now - 15.0
    moved_by = [(now or 0.0) - (was or 0.0) for was, now in zip(drawn, at_the_stop, strict=True)]
    assert moved_by[1:3] == pytest.approx([(end[1] or 0.0) - x, (end[2] or 0.0) - y], abs=0.02)


def test_a_revision_is_a_sentence_and_a_mark() -> None:
    _, _, scene, events = show_until(reported_walk(), 0)
    reported, revised = events
    assert isinstance(reported, PositionReported) and isinstance(revised, TrackRevised)
    first, second = lines_here(scene)
    assert first.startswith("reported: at x ")
    assert second == f"track revised: moved by {hypot(*revised.by):.1f} m, turned by 0 degrees"
    assert reported.position is not None
    x, y = (round(value, 3) for value in reported.position)
    assert [*scene.reports.marks.items] == [(round(reported.t, 3), None, x, y, True)]


def test_a_position_that_contradicts_the_track_is_shown_and_nothing_is_moved() -> None:
    _, before, scene, events = show_until(reported_walk((30.0, 0.0)), 0)
    rejected = events[1]
    assert isinstance(rejected, PositionRejected)
    assert lines_here(scene)[-1] == f"position rejected: {rejected.what}"
    assert scene.reports.marks.items[-1][4] is False
    was, now = (json.loads(encode(one.whole_message()[0])) for one in (before, scene))
    assert was["tracks"] == now["tracks"] and was["frame"]["wearer"] == now["frame"]["wearer"]


def test_a_watcher_gets_the_whole_scene_when_the_track_is_revised_and_then_changes_again() -> None:
    packets = reported_walk()
    session, scene = Session(poses=True, pressures=True), Scene("a walk", "default")
    kinds: list[str] = []
    _, cursor = scene.whole_message()
    for packet in packets:
        scene.take(packet, session.feed(packet))
        message, cursor = scene.message_since(cursor)
        if packet.channel == "receiver/position":
            assert message is not None
            kinds.append(message["type"])
        elif kinds and message is not None:
            assert message["type"] == "frame" or packet.t > REPORT_TIMES[1]
    assert kinds == ["scene", "scene"]


@pytest.mark.parametrize("off", [(0.3, -0.2), (30.0, 0.0)])
def test_a_seek_over_reports_shows_the_same_as_playing(off: tuple[float, float]) -> None:
    packets = PackedItems(reported_walk(off))
    times = [REPORT_TIMES[0] - 1.0, REPORT_TIMES[0] + 0.5, REPORT_TIMES[1] - 1.0, packets.end]

    def player() -> Player:
        return Player(
            packets, Session(poses=True, pressures=True), Scene("a walk", "default", "recording"), spacing=3.0
        )

    played = player()
    straight = []
    for t in times:
        while played.playback.t < t:
            played.advance(min(0.2, t - played.playback.t))
            played.feed_due(lambda: False)
        straight.append(whole(played))
    assert [len(one["reports"]) for one in straight] == [0, 1, 1, 2]
    sought = player()
    for k in (3, 0, 1, 3, 2, 0, 3):
        sought.seek(times[k])
        sought.feed_due(lambda: False)
        assert whole(sought) == straight[k]


def test_a_scene_with_reports_is_saved_and_restored() -> None:
    _, _, scene, _ = show_until(reported_walk(), 1)
    restored = restore_scene(json.loads(json.dumps(save_scene(scene))))
    assert encode(restored.whole_message()[0]) == encode(scene.whole_message()[0])


def test_back_at_the_start_and_a_named_place_are_marked_where_they_are() -> None:
    scene = scene_after(12.0)
    moved_to = scene.wearer.moved
    assert moved_to is not None
    start = PositionReported(t=12.0, known_at=12.0, site=Site.LEFT_FOOT, position=None, sigma=1.0)
    door = PositionReported(t=12.5, known_at=12.5, site=Site.LEFT_FOOT, position=None, place="door\x1b", sigma=1.0)
    scene.take(None, [start, door])
    x, y, _ = (round(value, 3) for value in moved_to.position)
    assert [mark[1:] for mark in scene.reports.marks.items] == [(None, 0.0, 0.0, None), (None, x, y, None)]
    first, second = lines_here(scene)
    assert first == "reported: back where the walk started"
    assert second.startswith("reported: at door") and second.isprintable()


def test_a_position_on_the_plan_is_marked_and_named_on_its_level() -> None:
    scene = Scene("a walk", "default", plan=BUILDING)
    level = BUILDING.levels[1]
    report = PositionReported(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, position=(12.0, 3.0), level=level.id, sigma=1.0)
    scene.take(None, [report])
    assert [mark[1:] for mark in scene.reports.marks.items] == [(level.id, 12.0, 3.0, None)]
    assert lines_here(scene) == [f"reported: {level.name or f'level {level.id}'}, at x 12.0 m, y 3.0 m"]
