"""Tests playing a recording with pauses, seeks and other speeds: it shows what a straight run shows."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import count

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from toys import NUMBERED

from solepath import Event, Packet, Sample, Session, Site
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.show.page.messages import Command
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.scene.scene import Scene

ROUTE = Route().stand(0.5).walk(2.0, speed=1.3).stop(0.5)
BAD_RADIO = Radio(loss=0.05, duplicate=0.01, corrupt=0.01, jitter=0.03)
INSOLES = dict.fromkeys((Site.LEFT_FOOT, Site.RIGHT_FOOT), Insole(cells=24, rate=40.0))
SILENT_SPAN = (1.0, 2.9)
"""Time from and to which the left foot sends nothing, s."""
PACKETS = tuple(
    packet
    for packet in emulate(ROUTE, devices=INSOLES, radio=BAD_RADIO, seed=5).packets
    if packet.site is Site.RIGHT_FOOT or not SILENT_SPAN[0] < packet.t < SILENT_SPAN[1]
)
TOY_VALUE = {"ticks": 0, "count": 1, "up": [9.80665]}
CLOCK_INTERVAL = 0.05
"""Time between two reads of the clock, s."""


def slices(items: int) -> Callable[[], bool]:
    """Return a function that returns True from its call number `items` on."""
    counter = count(1)
    return lambda: next(counter) >= items


def never() -> bool:
    return False


def make_player(items: PackedItems | None = None, **given: object) -> Player:
    session = Session(poses=True, pressures=True, losses=True)
    return Player(
        PackedItems(PACKETS) if items is None else items, session, Scene("a walk", "default", "recording"), **given
    )


def play_until(player: Player, t: float) -> None:
    """Play in real time, and end exactly at the time `t`, s."""
    player.play()
    while player.playback.t + CLOCK_INTERVAL * player.playback.speed < t:
        pass_by(player, CLOCK_INTERVAL)
    pass_by(player, (t - player.playback.t) / player.playback.speed)


def settle(player: Player, items: int = 100) -> None:
    while player.feed_due(slices(items)):
        pass


def pass_by(player: Player, seconds: float) -> None:
    """Let wall time pass, s; the player keeps up."""
    player.advance(seconds)
    player.feed_due(never)


def stop_at(player: Player, t: float, items: int = 100) -> None:
    player.pause()
    player.seek(t)
    settle(player, items)


def shown(player: Player) -> dict:
    """Return the message that a new watcher gets, without the state and the speed of the playback."""
    message = player.scene.whole_message()
    message["frame"]["playback"] = (player.playback.t, player.playback.seeking)
    return message


def test_a_recording_of_a_device_of_an_app_is_played_again_from_any_time() -> None:
    toys = [
        Packet(0.1 * k, Site.LEFT_FOOT, "toy/data", NUMBERED.write("toy/data", TOY_VALUE | {"number": k}))
        for k in range(300)
    ]
    session = Session(poses=True, pressures=True, losses=True, profiles=[NUMBERED])
    player = Player(PackedItems(toys), session, Scene("a toy", "default", "recording"), profiles=[NUMBERED])
    for t in (25.0, 15.0, 25.0):
        stop_at(player, t)
        assert player.session.now == pytest.approx(t, abs=0.1)


END = PackedItems(PACKETS).end
START = PackedItems(PACKETS).start


@cache
def state_without_commands(t: float) -> tuple[dict, dict]:
    """Return scene and snapshot at `t` of a run without commands."""
    player = make_player()
    if t > START:
        player.playback.speed = 8.0
        play_until(player, t)
    else:
        player.feed_due(never)
    assert player.playback.t == pytest.approx(t, abs=1e-9)
    return shown(player), player.session.snapshot()


TIMES = st.sampled_from([START, *(round(START + share * (END - START), 3) for share in (0.1, 0.3, 0.5, 0.7, 0.9)), END])
ACTIONS = st.one_of(
    st.just(Command("play")),
    st.just(Command("pause")),
    st.builds(Command, st.just("speed"), st.sampled_from([0.5, 1.0, 4.0, 32.0])),
    st.builds(Command, st.just("seek"), TIMES),
    st.floats(0.01, 0.2),
    st.integers(1, 150),
)
"""A command, an amount of wall time in s, or a number of items to feed."""


@settings(max_examples=10)
@given(actions=st.lists(ACTIONS, max_size=8), end=TIMES)
@pytest.mark.soak
def test_what_is_shown_at_a_time_is_the_same_whatever_was_played_before(actions, end):
    player = make_player(spacing=0.7)  # a walk of four seconds has one moment otherwise
    for action in actions:
        if isinstance(action, Command):
            player.command(action)
        elif isinstance(action, float):
            player.advance(action)
            settle(player)
        else:
            player.feed_due(slices(action))
        player.scene.whole_message()  # somebody watches
    stop_at(player, end)
    assert player.playback.t == end and player.playback.seeking is None
    assert (shown(player), player.session.snapshot()) == state_without_commands(end)


@settings(max_examples=5)
@given(actions=st.lists(ACTIONS, max_size=6))
def test_items_are_passed_on_once_and_in_order_whatever_is_done_on_the_page(actions):
    passed_on: list[tuple[Packet | Sample | None, list[Event]]] = []
    player = make_player(spacing=0.7, on_events=lambda item, events: passed_on.append((item, events)))
    for action in actions:
        if isinstance(action, Command):
            player.command(action)
        else:
            player.advance(5.0 * action)
            player.feed_due(slices(80))
    while player.run_through(slices(500)):
        assert player.delivered_count < len(PACKETS) or player.playback.state != "ended"
    assert player.delivered_count == len(PACKETS)
    assert [item for item, _ in passed_on] == [*PACKETS, None]
    session = Session(poses=True, pressures=True, losses=True)
    assert [events for _, events in passed_on] == [*(session.feed(packet) for packet in PACKETS), session.finish()]


def test_a_recording_plays_at_the_requested_speed_and_stops_at_its_end():
    player = make_player()
    assert (player.playback.state, player.playback.speed, player.playback.t) == ("playing", 1.0, START)
    player.feed_due(never)
    pass_by(player, 0.1)
    assert player.playback.t == pytest.approx(START + 0.1)
    player.playback.speed = 10.0
    pass_by(player, 0.1)
    assert player.playback.t == pytest.approx(START + 1.1)
    player.pause()
    player.advance(0.1)
    assert not player.feed_due(never) and player.playback.t == pytest.approx(START + 1.1)
    player.play()
    for _ in range(100):
        pass_by(player, 0.1)
    assert (player.playback.state, player.playback.t) == ("ended", END)
    player.play()
    assert player.playback.state == "playing" and player.playback.t == START
    player.advance(0.1)
    settle(player)
    assert player.playback.t == pytest.approx(START + 1.0)
