"""The queue between Bluetooth's callbacks and an app that takes packets at its own pace."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from solepath.ble.inbox import Inbox
from solepath.types import Packet, Site
from solepath.wire.receiver import parse_dropped

LEFT, RIGHT, PELVIS = Site.LEFT_FOOT, Site.RIGHT_FOOT, Site.PELVIS
DROPPED = "receiver/dropped"

takes = st.just(None)
puts = st.tuples(st.sampled_from([LEFT, RIGHT, PELVIS]), st.booleans())
"""(site, whether it is a notification)."""
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
