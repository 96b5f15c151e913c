"""Packets to samples: a decoder accepts or rejects a packet, and a rejected one changes nothing."""

from __future__ import annotations

import json
from math import inf, isfinite, nan

import pytest
from decoded import (
    LEFT,
    SAMPLE_INTERVAL,
    fed_decoder,
    feed,
    frame_packet,
    info_value,
    insole_frame,
    movement_packet,
    packet,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import of

from solepath.events import BatteryLevel, ClockReset, PacketRejected, Rejection, StreamResumed, StreamStale
from solepath.link.catalogue import PROFILES
from solepath.link.decoder import SET_BACK_PACKETS, Decoder
from solepath.recipes import part_class
from solepath.saving import codec
from solepath.types import Foot, Packet, Sample, Site
from solepath.wire.insole import InsoleFrame, InsoleSample, build_frame

CHANNELS = sorted({channel.name for profile in PROFILES for channel in profile.channels})


def rejected_packets() -> dict[str, tuple[Packet, Rejection]]:
    good = insole_frame(5)
    flipped = good[:-4] + bytes([good[-4] ^ 1]) + good[-3:]
    t = 10.1
    return {
        "flipped bit": (packet(t, "insole/frame", flipped), Rejection.CHECKSUM),
        "unknown channel": (packet(t, "insole/frames", good), Rejection.UNKNOWN_CHANNEL),
        "another device's channel": (packet(t, "cc2650/movement", bytes(18)), Rejection.UNKNOWN_CHANNEL),
        "unknown standard value": (packet(t, "device/colour", b"\x01"), Rejection.UNKNOWN_CHANNEL),
        "another site": (packet(t, "insole/frame", good, Site.RIGHT_FOOT), Rejection.WRONG_SITE),
        "the other foot's frame": (frame_packet(5, foot=Foot.RIGHT), Rejection.WRONG_SITE),
        "the other foot's INFO": (packet(t, "insole/info", info_value(foot=Foot.RIGHT)), Rejection.WRONG_SITE),
        "another layout": (frame_packet(5, layout=2), Rejection.WRONG_LAYOUT),
        "another number of cells": (frame_packet(5, cells=(1, 2, 3)), Rejection.WRONG_LAYOUT),
        "the newest again": (packet(t, "insole/frame", insole_frame(4)), Rejection.DUPLICATE),
        "one before it again": (packet(t, "insole/frame", insole_frame(2)), Rejection.DUPLICATE),
        "sent again on request": (packet(t, "insole/frame", insole_frame(1, retransmitted=True)), Rejection.DUPLICATE),
        "the newest sent again on request": (
            packet(t, "insole/frame", insole_frame(4, retransmitted=True)),
            Rejection.DUPLICATE,
        ),
        "sent again on request, from before the first": (
            packet(t, "insole/frame", insole_frame(-1, ticks=2**32 - 328, retransmitted=True)),
            Rejection.LATE,
        ),
        "absurd ticks": (packet(t, "insole/info", info_value(tick_rate=3)), Rejection.ABSURD),
        "arrival nan": (packet(nan, "insole/frame", good), Rejection.NOT_FINITE),
        "arrival inf": (packet(inf, "insole/frame", good), Rejection.NOT_FINITE),
        "arrival in the year 1e300": (packet(1e300, "insole/frame", good), Rejection.ABSURD),
    }


@pytest.mark.parametrize("name", rejected_packets())
def test_a_rejected_packet_gives_one_event_and_changes_nothing(name: str) -> None:
    bad, reason = rejected_packets()[name]
    decoder = fed_decoder()
    before = codec.save(decoder)
    outputs = decoder.feed(bad)
    assert [type(output) for output in outputs] == [PacketRejected]
    assert outputs[0].reason is reason
    assert outputs[0].channel == bad.channel
    assert isfinite(outputs[0].t) and outputs[0].known_at >= outputs[0].t
    assert codec.save(decoder) == before


@pytest.mark.parametrize("channel", CHANNELS)
def test_bytes_of_no_format_are_rejected_on_every_channel_and_do_not_bind_the_device(channel: str) -> None:
    decoder = Decoder(site=LEFT)
    [rejected] = decoder.feed(packet(9.0, channel, b"\xff" * 9))
    assert isinstance(rejected, PacketRejected)
    assert decoder == Decoder(site=LEFT)
    assert of(Sample, feed(decoder, movement_packet(0)))


_FRAMES = st.builds(
    lambda q, k, i, n, retransmitted: build_frame(
        InsoleFrame(Foot.LEFT, 1, q, k, i, (InsoleSample((1, 2), (0, 0, 2048, 0, 0, 0)),) * n, False, retransmitted)
    ),
    st.integers(0, 0xFFFF),
    st.integers(0, 0xFFFFFFFF),
    st.integers(1, 0xFFFF),
    st.integers(1, 12),
    st.booleans(),
)
_PACKETS = st.one_of(
    st.tuples(st.just("insole/frame"), _FRAMES),
    st.tuples(st.just("insole/frame"), st.binary(max_size=30)),
    st.tuples(st.sampled_from(CHANNELS), st.binary(max_size=18)),
    st.tuples(st.just("cc2650/movement"), st.binary(min_size=18, max_size=18)),
    st.tuples(st.just("cc2541/accelerometer"), st.binary(min_size=3, max_size=3)),
    st.tuples(st.just("cc2541/gyroscope"), st.binary(min_size=6, max_size=6)),
    st.tuples(st.just("cc2541/barometer"), st.binary(min_size=4, max_size=4)),
    st.tuples(st.just("cc2650/barometer"), st.binary(min_size=6, max_size=6)),
)


@given(st.lists(st.tuples(st.floats(-3.0, 60.0), _PACKETS), max_size=60), st.integers(0, 60))
@settings(max_examples=60)
def test_any_sequence_of_packets_keeps_order_and_survives_being_saved_at_any_cut(
    moves: list[tuple[float, tuple[str, bytes]]], cut: int
) -> None:
    unsaved, t = Decoder(site=LEFT), 100.0
    restored = unsaved
    newest: float | None = None
    for number, (pause, (channel, data)) in enumerate(moves):
        t += pause
        if number == cut:
            saved = json.loads(json.dumps(codec.save(unsaved), allow_nan=False))
            restored = codec.load(Decoder, saved, part_class)
        outputs = unsaved.feed(packet(t, channel, data)) + unsaved.advance(t + 0.5)
        if number >= cut:
            assert restored.feed(packet(t, channel, data)) + restored.advance(t + 0.5) == outputs
        for output in outputs:
            assert output.known_at is not None and output.known_at >= output.t
            if isinstance(output, ClockReset):
                newest = None
            elif isinstance(output, Sample):
                assert newest is None or output.t > newest
                newest = output.t
    assert len(json.dumps(codec.save(unsaved), allow_nan=False)) < 20_000
    unsaved.finish()


def test_one_wild_arrival_time_is_survived() -> None:
    decoder = fed_decoder()
    decoder.feed(packet(1e9, "device/battery", b"\x32"))
    outputs = feed(decoder, *[frame_packet(k) for k in range(5, 60)])
    assert len(of(Sample, outputs)) == 55 - SET_BACK_PACKETS + 1
    assert of(Sample, outputs)[-1].t == pytest.approx(10.0 + 59 * SAMPLE_INTERVAL, abs=1e-3)


def test_silence_is_reported_once_and_ended_by_the_next_frame() -> None:
    decoder = fed_decoder()
    last = 10.0 + 4 * SAMPLE_INTERVAL
    assert decoder.advance(last + 0.9) == []
    [stale] = decoder.advance(last + 1.5)
    assert isinstance(stale, StreamStale)
    assert (stale.t, stale.known_at, stale.silent_for) == pytest.approx((last + 1.0, last + 1.5, 1.5))
    assert decoder.advance(last + 3.0) == []
    assert decoder.advance(nan) == []
    outputs = decoder.feed(frame_packet(1000))
    assert [event.silent_for for event in of(StreamResumed, outputs)] == pytest.approx([996 * SAMPLE_INTERVAL])


def test_silence_is_noticed_by_other_packets_of_the_site() -> None:
    decoder = fed_decoder()
    outputs = feed(decoder, packet(20.0, "device/battery", b"\x32"), packet(21.0, "device/battery", b"\x31"))
    assert [type(output) for output in outputs] == [StreamStale, BatteryLevel, BatteryLevel]


def test_nothing_is_stale_before_it_started() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, packet(1.0, "insole/info", info_value()))
    assert decoder.advance(1000.0) == []
