"""Decoding of frames and fragments of an insole to samples in SI units, with losses, duplicates and restarts."""

from __future__ import annotations

import pytest
from attrs import evolve
from decoded import (
    LEFT,
    SAMPLE_INTERVAL,
    fed_decoder,
    feed,
    fragment_packets,
    frame_packet,
    info_value,
    insole_frame,
    packet,
)
from walks import of

from solepath.events import ClockReset, Limitation, PacketRejected, Rejection, SampleGap
from solepath.link.decoder import Decoder
from solepath.link.devices.insole import _TABLES, MOST_TABLES, InsoleLink
from solepath.saving import codec
from solepath.types import Sample, Site
from solepath.wire.fragment import split
from solepath.wire.insole import InsoleSample


def test_before_info_16_g_and_2000_degrees_per_second_are_assumed_and_reported_once() -> None:
    decoder = Decoder(site=LEFT)
    raw = InsoleSample((7, 8), (2048, 0, 0, 16384, 0, 0), (0, 0, 0, 0))
    limitation, sample, *others = feed(decoder, *[frame_packet(k, samples=(raw,)) for k in range(3)])
    assert isinstance(limitation, Limitation) and sample.quat is None and len(of(Sample, others)) == len(others) == 2


def test_insoles_with_more_scales_than_there_are_tables_have_forces_too() -> None:
    for k in range(2 * MOST_TABLES):
        decoder, scale = Decoder(site=LEFT), 0.25 + 0.0625 * k
        [_, sample] = feed(decoder, packet(9.0, "insole/info", info_value(pressure_scale=scale)), frame_packet(0))
        assert sample.pressure == (100 * scale, 200 * scale)
    assert len(_TABLES) == MOST_TABLES


def test_without_info_the_first_layout_is_the_only_one() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, frame_packet(0))
    [rejected] = feed(decoder, frame_packet(1, layout=9))
    assert rejected.reason is Rejection.WRONG_LAYOUT
    feed(decoder, packet(11.0, "insole/info", info_value(layout=9)))
    assert len(of(Sample, feed(decoder, packet(11.1, "insole/frame", insole_frame(2, layout=9))))) == 1


def test_a_site_without_a_foot_takes_no_insole() -> None:
    decoder = Decoder(site=Site.PELVIS)
    [rejected] = decoder.feed(packet(1.0, "insole/frame", insole_frame(0), Site.PELVIS))
    assert rejected.reason is Rejection.WRONG_SITE


def test_another_tick_rate_is_another_clock() -> None:
    decoder = fed_decoder()
    feed(decoder, packet(10.06, "insole/info", info_value(tick_rate=1000, interval=10)))
    reset, sample = feed(decoder, packet(10.07, "insole/frame", insole_frame(5)))
    assert isinstance(reset, ClockReset) and not reset.restarted
    assert sample.t == pytest.approx(10.07, abs=1e-6)


def test_frames_lost_over_a_whole_round_of_the_sequence_are_counted_by_ticks_and_are_an_absence() -> None:
    decoder, other = fed_decoder(), fed_decoder()
    lost_frames = 3 * 65536 + 10
    late = frame_packet(4 + lost_frames)
    assert isinstance(other.link, InsoleLink)
    (counted,) = of(SampleGap, other.link.feed(late.channel, late.data, late.t))
    assert counted.count == lost_frames - 1
    (gap,) = of(SampleGap, decoder.feed(frame_packet(4 + lost_frames)))
    assert gap.t == pytest.approx(10.0 + 4 * SAMPLE_INTERVAL)
    assert gap.duration == pytest.approx(lost_frames * SAMPLE_INTERVAL)
    assert gap.count == 0, "half an hour of silence is an absence"


def test_a_loss_after_the_receivers_clock_was_set_back_is_no_absence_of_before() -> None:
    decoder = fed_decoder()
    decoder.feed(frame_packet(1000))  # after a silence
    decoder.restart_clock(3.0)
    frames = [packet(3.0 + SAMPLE_INTERVAL * k, "insole/frame", insole_frame(1100 + k)) for k in range(6) if k != 4]
    assert [gap.count for gap in of(SampleGap, feed(decoder, *frames))] == [1]


def test_a_device_that_samples_again_after_a_pause_has_lost_nothing() -> None:
    decoder = fed_decoder()
    pause = packet(20.0, "insole/frame", insole_frame(5, ticks=round(10.0 * 32768)))
    outputs = decoder.feed(pause)
    assert [gap.count for gap in of(SampleGap, outputs)] == [0]
    assert of(Sample, outputs)[0].t == pytest.approx(20.0, abs=0.001)


def test_a_restart_within_two_seconds_is_known_by_its_delay() -> None:
    decoder = fed_decoder(100)
    outputs = feed(
        decoder, packet(13.5, "insole/frame", insole_frame(0)), packet(13.51, "insole/frame", insole_frame(1))
    )
    assert [event.restarted for event in of(ClockReset, outputs)] == [True]
    assert [sample.t for sample in of(Sample, outputs)] == pytest.approx([13.5, 13.51], abs=0.001)


def test_times_keep_their_order_across_a_reset() -> None:
    decoder = fed_decoder(10)
    newest = decoder.feed(frame_packet(10))[-1].t
    ten_samples = (InsoleSample((100, 200), (0, 0, 4096, 0, 0, 0)),) * 10
    outputs = decoder.feed(packet(10.11, "insole/frame", insole_frame(0, ticks=2_000_000_000, samples=ten_samples)))
    times = [newest] + [sample.t for sample in of(Sample, outputs)]
    assert all(b > a for a, b in zip(times, times[1:], strict=False))


@pytest.mark.parametrize("missing", range(4))
def test_a_lost_fragment_costs_its_frame_and_no_other(missing: int) -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, *fragment_packets(0, 0))
    incomplete_frame = fragment_packets(1, 1)
    del incomplete_frame[missing]
    outputs = feed(decoder, *incomplete_frame, *fragment_packets(2, 2), *fragment_packets(3, 3))
    assert [event.reason for event in of(PacketRejected, outputs)] == [Rejection.TRUNCATED]
    assert [event.count for event in of(SampleGap, outputs)] == [1]
    assert len(of(Sample, outputs)) == 2


def test_an_end_of_a_fragment_is_not_that_fragment() -> None:
    decoder = Decoder(site=LEFT)
    first, second, third, last = fragment_packets(0, 0)
    feed(decoder, first, second)
    [rejected] = decoder.feed(evolve(second, data=second.data[:1] + second.data[-3:]))
    assert rejected.reason is Rejection.TRUNCATED
    assert feed(decoder, third, last) == []


def test_a_frame_in_fragments_that_is_rejected_changes_nothing_but_its_fragments() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, *fragment_packets(0, 0))
    other_layout = insole_frame(1, samples=(InsoleSample(tuple(range(25)), (0, 0, 2048, 0, 0, 0)),))
    *first, last = [packet(11.0 + k, "insole/frame", piece) for k, piece in enumerate(split(other_layout, 20, 1))]
    feed(decoder, *first)
    before = codec.save(decoder)
    assert isinstance(decoder.link, InsoleLink)
    [rejected] = decoder.feed(last)
    assert rejected.reason is Rejection.WRONG_LAYOUT
    decoder.link.reassembly = codec.load(type(decoder.link.reassembly), before["link"]["is"]["reassembly"])
    assert codec.save(decoder) == before


def test_of_the_newest_64_packets_it_is_known_whether_they_came() -> None:
    decoder = fed_decoder(100)
    again = [packet(11.0, "insole/frame", insole_frame(99 - k, retransmitted=True)) for k in (1, 63, 64, 90)]
    reasons = [event.reason for event in of(PacketRejected, feed(decoder, *again))]
    assert reasons == [Rejection.DUPLICATE, Rejection.DUPLICATE, Rejection.LATE, Rejection.LATE]
    assert isinstance(decoder.link, InsoleLink) and decoder.link.packet_run.accepted_bits == 2**64 - 1
