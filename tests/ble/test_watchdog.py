"""Distinction of a frozen stream from one that has nothing to send."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from solepath.link.setup.watchdog import MAX_TRIES, Remedy, Watchdog

STREAMS = ("acc", "gyro")
PATIENCE = 2.0

moments = st.lists(
    st.tuples(st.floats(0.0, 3.0), st.sampled_from(["acc", "gyro", "battery", None])), min_size=1, max_size=60
)
"""(time since the previous action, s; channel of the notification, or None for a check)."""


def test_where_silence_is_legal_there_is_nothing_to_watch() -> None:
    dog = Watchdog((), PATIENCE, t_start=0.0)
    assert dog.next_check_at() is None
    assert dog.check(1e6) is None


@given(moments)
def test_only_a_stream_that_was_silent_too_long_is_ever_named(moments: list[tuple[float, str | None]]) -> None:
    dog, now, last = Watchdog(STREAMS, PATIENCE, t_start=0.0), 0.0, dict.fromkeys(STREAMS, 0.0)
    for wait, channel in moments:
        now += wait
        if channel is not None:
            dog.add_notification(channel, now)
            last[channel] = now
            continue
        frozen = dog.check(now)
        silent = [stream for stream in STREAMS if now >= last[stream] + PATIENCE]
        if frozen is None:
            assert not silent
        else:
            assert frozen[0] in silent
            if frozen[1] is Remedy.RECONNECT:
                return
            last = dict.fromkeys(last, now)  # the time for the remedy begins


@given(moments)
def test_a_device_is_reconnected_only_after_every_try_failed_in_a_row(moments: list[tuple[float, str | None]]) -> None:
    dog, now, remedied, tries = Watchdog(("acc",), PATIENCE, t_start=0.0), 0.0, 0.0, 0
    for wait, channel in moments:
        now += wait
        if channel is not None:
            dog.add_notification(channel, now)
            tries = 0 if channel == "acc" and now > remedied else tries
        frozen = dog.check(now)
        if frozen is None:
            continue
        assert frozen == ("acc", Remedy.SET_UP if tries < MAX_TRIES else Remedy.RECONNECT)
        if tries == MAX_TRIES:
            return
        tries, remedied = tries + 1, now
