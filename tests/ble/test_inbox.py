"""The queue between Bluetooth's callbacks and an app that takes packets at its own pace."""

from __future__ import annotations

from collections import Counter

from hypothesis import example, given
from hypothesis import strategies as st

from solepath import BatteryLevel, Event, PacketRejected, PacketsDropped, Session
from solepath.ble.inbox import Inbox
from solepath.types import Packet, Site
from solepath.wire.receiver import parse_dropped

LEFT, RIGHT, PELVIS = Site.LEFT_FOOT, Site.RIGHT_FOOT, Site.PELVIS
DROPPED = "receiver/dropped"

takes = st.just(None)
puts = st.tuples(st.sampled_from([LEFT, RIGHT, PELVIS]), st.booleans())
"""(site, whether it is a notification)."""
lives = st.lists(st.one_of(puts, puts, takes), max_size=60)
capacities = st.integers(1, 6)
Puts = list[tuple[Site, bool]]
Life = list[tuple[Site, bool] | None]
"""None stands for taking a packet."""


def lived(capacity: int, life: Life) -> tuple[list[Packet], list[Packet], Inbox]:
    """Return the packets that were put, those that were taken, and the inbox."""
    inbox, put, taken = Inbox(capacity), list[Packet](), list[Packet]()
    for moment, one in enumerate(life):
        if one is None:
            packet = inbox.take()
            if packet is not None:
                taken.append(packet)
            continue
        site, notified = one
        put.append(Packet(float(moment), site, "stream" if notified else "setup", b"", "F0:01"))
        inbox.put(put[-1], notified)
    return put, taken, inbox


def emptied(inbox: Inbox) -> list[Packet]:
    found = []
    while (packet := inbox.take()) is not None:
        found.append(packet)
    return found


@given(capacities, lives)
def test_every_packet_is_either_taken_or_counted_as_dropped(capacity: int, life: Life) -> None:
    put, taken, inbox = lived(capacity, life)
    taken += emptied(inbox)
    assert len(inbox) == 0
    for site in (LEFT, RIGHT, PELVIS):
        came = Counter(packet.channel == DROPPED for packet in taken if packet.site is site)
        counts = [parse_dropped(p.data) for p in taken if p.site is site and p.channel == DROPPED]
        assert came[False] + sum(counts) == sum(packet.site is site for packet in put)


@given(capacities, lives)
@example(3, [(LEFT, True), (RIGHT, True), (LEFT, False), (RIGHT, True), (RIGHT, True), (RIGHT, True), (RIGHT, True)])
@example(1, [(LEFT, False), (LEFT, False), (LEFT, True), (LEFT, False), (LEFT, True), (LEFT, False), (LEFT, True)])
def test_the_time_of_a_site_never_falls(capacity: int, life: Life) -> None:
    _, taken, inbox = lived(capacity, life)
    taken += emptied(inbox)
    for site in (LEFT, RIGHT, PELVIS):
        times = [packet.t for packet in taken if packet.site is site]
        assert times == sorted(times)


@given(capacities, lives)
def test_notifications_are_taken_in_the_order_in_which_they_came_and_so_is_the_rest(capacity: int, life: Life) -> None:
    put, taken, inbox = lived(capacity, life)
    taken += emptied(inbox)
    for channel in ("stream", "setup"):
        found = [packet for packet in taken if packet.channel == channel]
        assert found == [packet for packet in put if packet in found]


@given(capacities, st.lists(puts, max_size=100))
def test_however_much_comes_what_is_held_is_bounded(capacity: int, life: Puts) -> None:
    inbox = Inbox(capacity)
    for moment, (site, notified) in enumerate(life):
        inbox.put(Packet(float(moment), site, "any", b""), notified)
        assert len(inbox) <= 2 * capacity + 3


def test_the_newest_notifications_are_kept_and_the_dropped_stand_before_them() -> None:
    _, _, inbox = lived(3, [(LEFT, True)] * 10)
    first, *rest = emptied(inbox)
    assert (first.channel, parse_dropped(first.data), first.t, first.device) == (DROPPED, 7, 6.0, "F0:01")
    assert [packet.t for packet in rest] == [7.0, 8.0, 9.0]


def test_what_was_read_or_written_outlives_any_flood_of_notifications() -> None:
    setup = [(LEFT, False)] * 4
    _, _, inbox = lived(4, [*setup, *[(LEFT, True)] * 100])
    assert [packet.channel for packet in emptied(inbox)] == ["setup"] * 4 + [DROPPED] + ["stream"] * 4


@given(capacities, st.lists(puts, max_size=40))
def test_a_count_stands_where_the_dropped_stood_unless_what_was_read_fills_the_room(capacity: int, life: Puts) -> None:
    put, _, inbox = lived(capacity, [*life])
    left = emptied(inbox)
    if 2 * sum(not notified for _, notified in life) > capacity:
        return
    for site in (LEFT, RIGHT, PELVIS):
        mine, came = [packet for packet in left if packet.site is site], [one for one in put if one.site is site]
        for packet in mine:
            count = parse_dropped(packet.data) if packet.channel == DROPPED else 1
            dropped_first, came = came[:count], came[count:]
            assert packet.channel != DROPPED or {one.channel for one in dropped_first} == {"stream"}
            assert packet.channel == DROPPED or dropped_first == [packet]


@given(capacities, lives)
def test_a_session_accepts_every_output_and_counts_the_dropped_packets(capacity: int, life: Life) -> None:
    inbox, session, events, put = Inbox(capacity), Session(), list[Event](), 0
    for moment, one in enumerate([*life, *[None] * 3 * len(life)]):
        if one is not None:
            inbox.put(Packet(float(moment), one[0], "device/battery", b"\x50", f"F0:{one[0].value}"), one[1])
            put += 1
        elif (packet := inbox.take()) is not None:
            events += session.feed(packet)
    assert not [event for event in events if isinstance(event, PacketRejected)]
    dropped = sum(event.count for event in events if isinstance(event, PacketsDropped))
    assert dropped + sum(isinstance(event, BatteryLevel) for event in events) == put


def test_a_slow_reader_gets_more_than_counts_of_drops() -> None:
    life: Life = [(LEFT, True)] * 3 + [*[(LEFT, True)] * 4, None] * 20
    _, taken, _ = lived(3, life)
    assert [packet.channel for packet in taken] == [DROPPED, "stream"] * 10


def test_a_waiting_reader_is_notified_of_every_arrival() -> None:
    reported_counts: list[int] = []
    inbox = Inbox(2)
    inbox.on_arrival = lambda: reported_counts.append(len(inbox))
    for moment in range(3):
        inbox.put(Packet(float(moment), LEFT, "any", b""), True)
    assert reported_counts == [1, 2, 3]
