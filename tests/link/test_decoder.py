"""Packets to samples: a decoder accepts or rejects a packet, and a rejected one changes nothing."""

from __future__ import annotations

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
from walks import of

from solepath.events import BatteryLevel, PacketRejected, Rejection, StreamResumed, StreamStale
from solepath.link.catalogue import PROFILES
from solepath.link.decoder import SET_BACK_PACKETS, Decoder
from solepath.saving import codec
from solepath.types import Foot, Packet, Sample, Site

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


def test_silence_is_reported_once_and_ended_by_the_next_frame() -> None:
    decoder = fed_decoder()
    last = 10.0 + 4 * SAMPLE_INTERVAL
    assert decoder.advance(last + 0.9) == []
    [stale] = decoder.advance(last + 1.5)
    assert isinstance(stale, StreamStale)
    assert (stale.t, stale.known_at, stale.silent_for) == pytest.approx((last + 1.0, last + 1.5, 1.5))
    assert decoder.advance(last + 3.0) == []
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


def test_a_clock_that_restarts_forgets_what_arrived_by_the_old_one() -> None:
    decoder, other = fed_decoder(), fed_decoder()
    for _ in range(SET_BACK_PACKETS - 1):
        assert of(PacketRejected, decoder.feed(packet(1.0, "insole/frame", insole_frame(9))))
    assert decoder.restart_clock(5.0) == other.restart_clock(5.0) and decoder == other
    feed(decoder, frame_packet(5))
    before = decoder.feed(packet(9.0, "insole/frame", insole_frame(6)))
    assert of(PacketRejected, before) and not of(Sample, before)
