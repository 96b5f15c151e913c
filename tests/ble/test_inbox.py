"""The queue between Bluetooth's callbacks and an app that takes packets at its own pace."""

from __future__ import annotations

from hypothesis import example, given
from hypothesis import strategies as st

from solepath.ble.inbox import Inbox  # an app sees it through Devices, which offer no such crowd of arrivals
from solepath.types import Packet, Site
from solepath.wire.receiver import parse_dropped

LEFT, RIGHT, PELVIS = Site.LEFT_FOOT, Site.RIGHT_FOOT, Site.PELVIS
DROPPED = "receiver/dropped"
Life = list[tuple[Site, bool] | None]
"""(site, whether it is a notification) of what comes; None stands for taking a packet."""

puts = st.tuples(st.sampled_from([LEFT, RIGHT, PELVIS]), st.booleans())


def lived(capacity: int, life: Life) -> tuple[list[Packet], list[Packet]]:
    """Return the packets that were put, and all that were taken, with those that were left at the end."""
    inbox, put, taken = Inbox(capacity), list[Packet](), list[Packet | None]()
    for moment, one in enumerate(life):
        if one is None:
            taken.append(inbox.take())
        else:
            put.append(Packet(float(moment), one[0], "stream" if one[1] else "setup", b"", "F0:01"))
            inbox.put(put[-1], one[1])
        assert len(inbox) <= 2 * capacity + 3
    while len(inbox):
        taken.append(inbox.take())
    return put, [packet for packet in taken if packet is not None]


@given(st.integers(1, 6), st.lists(st.one_of(puts, puts, st.none()), max_size=60))
@example(3, [(LEFT, True), (RIGHT, True), (LEFT, False), (RIGHT, True), (RIGHT, True), (RIGHT, True), (RIGHT, True)])
@example(1, [(LEFT, False), (LEFT, False), (LEFT, True), (LEFT, False), (LEFT, True), (LEFT, False), (LEFT, True)])
def test_every_packet_is_taken_in_its_order_or_counted_as_dropped(capacity: int, life: Life) -> None:
    put, taken = lived(capacity, life)
    for site in (LEFT, RIGHT, PELVIS):
        mine = [packet for packet in taken if packet.site is site]
        assert [packet.t for packet in mine] == sorted(packet.t for packet in mine)
        came = [packet for packet in mine if packet.channel != DROPPED]
        dropped = sum(parse_dropped(packet.data) for packet in mine if packet.channel == DROPPED)
        assert len(came) + dropped == sum(packet.site is site for packet in put)
    for channel in ("stream", "setup"):
        found = [packet for packet in taken if packet.channel == channel]
        assert found == [packet for packet in put if packet in found]


def test_the_newest_notifications_are_kept_behind_a_count_and_what_was_read_outlives_any_flood() -> None:
    _, taken = lived(3, [*[(LEFT, False)] * 3, *[(LEFT, True)] * 10])
    assert [packet.channel for packet in taken] == ["setup"] * 3 + [DROPPED] + ["stream"] * 3
    assert (parse_dropped(taken[3].data), taken[3].t, taken[3].device) == (7, 9.0, "F0:01")
    assert [packet.t for packet in taken[4:]] == [10.0, 11.0, 12.0]
