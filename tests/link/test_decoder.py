"""Packets to samples: what a decoder accepts, what it refuses, and that refusing changes nothing."""

from __future__ import annotations

import json
from math import inf, isfinite, nan, radians
from random import Random
from typing import Any

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.events import (
    BatteryLevel,
    ClockReset,
    KeysChanged,
    LayoutKnown,
    Limitation,
    PacketRejected,
    PacketsLost,
    Rejection,
    ScaleSuspect,
    StreamResumed,
    StreamStale,
)
from solepath.link.catalogue import PROFILES
from solepath.link.decoder import SET_BACK, Decoder
from solepath.link.devices import cc2541, cc2650
from solepath.link.devices.cc2541 import counts_per_g
from solepath.recipes import part_class
from solepath.saving import codec as machine
from solepath.types import Cell, Foot, Packet, Sample, Site
from solepath.types.vector import GRAVITY
from solepath.wire.device import build_battery, build_firmware
from solepath.wire.fields import build_whole
from solepath.wire.fragment import split
from solepath.wire.insole import InsoleFrame, InsoleSample, build_frame
from solepath.wire.insole_info import InsoleInfo, build_info

LEFT = Site.LEFT_FOOT
STEP = 328 / 32768
CHANNELS = sorted({channel.name for profile in PROFILES for channel in profile.channels})


def insole_frame(k: int, *, acc: int = 2048, cells: tuple[int, ...] = (100, 200), **changes: Any) -> bytes:
    sample = InsoleSample(cells, (0, 0, acc, 0, 0, 0))
    frame = InsoleFrame(Foot.LEFT, 1, k & 0xFFFF, 328 * k & 0xFFFFFFFF, 328, (sample,))
    return build_frame(evolve(frame, **changes))


def info(**changes: Any) -> bytes:
    cells = (Cell(0.05, 0.0, 1e-4), Cell(0.2, 0.01, 1e-4))
    base = InsoleInfo(Foot.LEFT, 1, 7, 32768, 328, 8 * GRAVITY / 32768, radians(500) / 32768, 0.05, 0.26, cells, "1.0")
    return build_info(evolve(base, **changes))


def packet(t: float, channel: str, data: bytes, site: Site = LEFT) -> Packet:
    return Packet(t, site, channel, data)


def frame_packet(k: int, **changes: Any) -> Packet:
    return packet(10.0 + k * STEP, "insole/frame", insole_frame(k, **changes))


def new_tag(what: str, **fields: Any) -> bytes:
    """What a CC2650 says, or is told."""
    return cc2650.DRIVER.write(f"cc2650/{what}", fields)


def config(full_scale: int, **changes: Any) -> Packet:
    everything = {"gyro_axes": (True,) * 3, "acc_axes": (True,) * 3, "mag": True, "wake_on_motion": False}
    fields = {**everything, "range": full_scale, **changes}
    return packet(1.05, "cc2650/movement-config", new_tag("movement-config", **fields))


def old_tag(t: float, sensor: str, **fields: Any) -> Packet:
    """What a sensor of a CC2541 says."""
    return packet(t, f"cc2541/{sensor}", build_whole(cc2541.FORMATS[f"cc2541/{sensor}"], fields))


def movement(k: int, *, acc: tuple[int, int, int] = (0, 0, 4096), gyro: tuple[int, int, int] = (0, 0, 0)) -> Packet:
    return packet(10.0 + 0.1 * k, "cc2650/movement", new_tag("movement", gyro=gyro, acc=acc, mag=(0, 0, 0)))


def feed(decoder: Decoder, *packets: Packet) -> list[Any]:
    return [output for one in packets for output in decoder.feed(one)]


def of(kind: type, outputs: list[Any]) -> list[Any]:
    return [output for output in outputs if isinstance(output, kind)]


def walked(count: int = 5) -> Decoder:
    """A decoder that knows its insole and has had some frames."""
    decoder = Decoder(site=LEFT)
    feed(decoder, packet(9.0, "insole/info", info()), *[frame_packet(k) for k in range(count)])
    return decoder


# --- what is refused ----------------------------------------------------------------------------------------------


def refused() -> dict[str, tuple[Packet, Rejection]]:
    good = insole_frame(5)
    flipped = good[:-4] + bytes([good[-4] ^ 1]) + good[-3:]
    t = 10.1
    return {
        "cut short": (packet(t, "insole/frame", good[:-1]), Rejection.TRUNCATED),
        "empty": (packet(t, "insole/frame", b""), Rejection.TRUNCATED),
        "too long": (packet(t, "insole/frame", good + b"\0"), Rejection.OVERSIZED),
        "flipped bit": (packet(t, "insole/frame", flipped), Rejection.CHECKSUM),
        "another version": (packet(t, "insole/frame", b"\xf5\x20" + good[2:]), Rejection.MALFORMED),
        "unknown channel": (packet(t, "insole/frames", good), Rejection.UNKNOWN_CHANNEL),
        "unknown device": (packet(t, "toaster/frame", good), Rejection.UNKNOWN_CHANNEL),
        "no channel": (packet(t, "", good), Rejection.UNKNOWN_CHANNEL),
        "another device's channel": (
            packet(t, "cc2650/movement", bytes(18)),
            Rejection.UNKNOWN_CHANNEL,
        ),
        "unknown standard value": (packet(t, "device/colour", b"\x01"), Rejection.UNKNOWN_CHANNEL),
        "another site": (packet(t, "insole/frame", good, Site.RIGHT_FOOT), Rejection.WRONG_SITE),
        "the other foot's frame": (frame_packet(5, foot=Foot.RIGHT), Rejection.WRONG_SITE),
        "the other foot's INFO": (packet(t, "insole/info", info(foot=Foot.RIGHT)), Rejection.WRONG_SITE),
        "another layout": (frame_packet(5, layout=2), Rejection.WRONG_LAYOUT),
        "another number of cells": (frame_packet(5, cells=(1, 2, 3)), Rejection.WRONG_LAYOUT),
        "the newest again": (packet(t, "insole/frame", insole_frame(4)), Rejection.DUPLICATE),
        "one before it again": (packet(t, "insole/frame", insole_frame(2)), Rejection.DUPLICATE),
        "sent again on request": (
            packet(t, "insole/frame", insole_frame(1, retransmitted=True)),
            Rejection.DUPLICATE,
        ),
        "the newest sent again on request": (
            packet(t, "insole/frame", insole_frame(4, retransmitted=True)),
            Rejection.DUPLICATE,
        ),
        "sent again on request, from before the first": (
            packet(t, "insole/frame", insole_frame(-1, ticks=2**32 - 328, retransmitted=True)),
            Rejection.LATE,
        ),
        "absurd acceleration": (packet(t, "insole/info", info(acc_scale=1e6)), Rejection.ABSURD),
        "absurd angular rate": (packet(t, "insole/info", info(gyro_scale=1e-9)), Rejection.ABSURD),
        "absurd pressure": (packet(t, "insole/info", info(pressure_scale=1e9)), Rejection.ABSURD),
        "absurd ticks": (packet(t, "insole/info", info(tick_rate=3)), Rejection.ABSURD),
        "arrival nan": (packet(nan, "insole/frame", good), Rejection.NOT_FINITE),
        "arrival inf": (packet(inf, "insole/frame", good), Rejection.NOT_FINITE),
        "arrival in the year 1e300": (packet(1e300, "insole/frame", good), Rejection.ABSURD),
        "battery over 100 %": (packet(t, "device/battery", b"\x65"), Rejection.MALFORMED),
        "firmware that is no text": (packet(t, "device/firmware", b"\xff"), Rejection.MALFORMED),
    }


@pytest.mark.parametrize("name", refused())
def test_a_refused_packet_gives_one_event_and_changes_nothing(name: str) -> None:
    bad, reason = refused()[name]
    decoder = walked()
    before = machine.save(decoder)
    outputs = decoder.feed(bad)
    assert [type(output) for output in outputs] == [PacketRejected]
    assert outputs[0].reason is reason
    assert outputs[0].channel == bad.channel
    assert isfinite(outputs[0].t) and outputs[0].known_at >= outputs[0].t
    assert machine.save(decoder) == before


@pytest.mark.parametrize("name", refused())
def test_a_refused_packet_does_not_disturb_those_around_it(name: str) -> None:
    bad, _ = refused()[name]
    clean = feed(walked(), frame_packet(20), frame_packet(21))
    decoder = walked()
    decoder.feed(bad)
    assert feed(decoder, frame_packet(20), frame_packet(21)) == clean


@pytest.mark.parametrize("channel", CHANNELS)
def test_bytes_of_no_format_are_refused_on_every_channel_and_do_not_name_the_device(channel: str) -> None:
    decoder = Decoder(site=LEFT)
    [rejected] = decoder.feed(packet(9.0, channel, b"\xff" * 9))
    assert isinstance(rejected, PacketRejected)
    assert decoder == Decoder(site=LEFT)
    assert of(Sample, feed(decoder, movement(0)))


def test_nothing_is_lost_before_the_first_good_packet_of_a_device() -> None:
    decoder = Decoder(site=LEFT)
    before = machine.save(decoder)
    for bad, _ in refused().values():
        if not bad.channel.startswith("insole/frame"):
            continue
        decoder.feed(evolve(bad, data=bad.data[:-2]))
    assert machine.save(decoder) == before


@given(st.sampled_from([*CHANNELS, "insole/nothing", "x", ""]), st.binary(max_size=80), st.floats(allow_nan=True))
@settings(max_examples=300, deadline=None)
def test_any_bytes_on_any_channel_give_events_and_rejected_ones_change_nothing(
    channel: str, data: bytes, t: float
) -> None:
    for decoder in (Decoder(site=LEFT), walked()):
        before = machine.save(decoder)
        rejected = [output for output in decoder.feed(packet(t, channel, data)) if isinstance(output, PacketRejected)]
        if rejected:
            after = machine.save(decoder)
            assert isinstance(before, dict) and isinstance(after, dict)
            # the two exceptions that the decoder documents: the count of packets from the past, and fragments
            fragment = channel == "insole/frame" and data[:1] < b"\xe0"
            backwards = rejected[0].reason is Rejection.TIME_BACKWARDS
            assert fragment or {**after, "backwards": 0} == {**before, "backwards": 0}
            assert backwards or fragment or after == before
        json.dumps(machine.save(decoder), allow_nan=False)


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
@settings(max_examples=150, deadline=None)
def test_any_sequence_of_packets_keeps_order_and_survives_being_saved_at_any_cut(
    moves: list[tuple[float, tuple[str, bytes]]], cut: int
) -> None:
    straight, t = Decoder(site=LEFT), 100.0
    restored = straight
    newest: float | None = None
    for number, (pause, (channel, data)) in enumerate(moves):
        t += pause
        if number == cut:
            saved = json.loads(json.dumps(machine.save(straight), allow_nan=False))
            restored = machine.load(Decoder, saved, part_class)
        outputs = straight.feed(packet(t, channel, data)) + straight.advance(t + 0.5)
        if number >= cut:
            assert restored.feed(packet(t, channel, data)) + restored.advance(t + 0.5) == outputs
        for output in outputs:
            assert output.known_at is not None and output.known_at >= output.t
            if isinstance(output, ClockReset):
                newest = None
            elif isinstance(output, Sample):
                assert newest is None or output.t > newest
                newest = output.t
    assert len(json.dumps(machine.save(straight), allow_nan=False)) < 20_000
    straight.finish()


# --- insole -------------------------------------------------------------------------------------------------------


def test_samples_are_in_si_units_by_the_scales_of_info() -> None:
    decoder = Decoder(site=LEFT)
    [known] = feed(decoder, packet(9.0, "insole/info", info()))
    assert isinstance(known, LayoutKnown)
    assert known.layout.scale == pytest.approx(0.05)
    assert known.layout.full_scale == pytest.approx(4095 * 0.05)
    assert known.layout.length == 0.26
    raw = InsoleSample((100, 4095), (4096, 0, -4096, 32767, 0, -32768), (16384, 0, 0, 0))
    [sample] = feed(decoder, frame_packet(0, samples=(raw,)))
    assert sample.acc == pytest.approx((GRAVITY, 0.0, -GRAVITY), rel=1e-6)
    assert sample.gyro == pytest.approx((radians(500) * 32767 / 32768, 0.0, -radians(500)), rel=1e-6)
    assert sample.pressure == pytest.approx((5.0, 204.75), rel=1e-6)
    assert sample.quat == (1.0, 0.0, 0.0, 0.0)
    assert sample.t == sample.known_at == 10.0


def test_before_info_16_g_and_2000_degrees_per_second_are_assumed_and_said_once() -> None:
    decoder = Decoder(site=LEFT)
    raw = InsoleSample((7, 8), (2048, 0, 0, 16384, 0, 0), (0, 0, 0, 0))
    limitation, sample = feed(decoder, frame_packet(0, samples=(raw,)))
    assert isinstance(limitation, Limitation)
    assert sample.acc == pytest.approx((GRAVITY, 0.0, 0.0))
    assert sample.gyro == pytest.approx((radians(1000), 0.0, 0.0))
    assert sample.pressure == (7.0, 8.0)
    assert sample.quat is None
    assert of(Limitation, feed(decoder, frame_packet(1), frame_packet(2))) == []


def test_scales_of_zero_mean_no_such_sensor_and_pressure_in_counts() -> None:
    decoder = Decoder(site=LEFT)
    data = info(acc_scale=0.0, gyro_scale=0.0, pressure_scale=0.0)
    [known, sample] = feed(decoder, packet(9.0, "insole/info", data), frame_packet(0))
    assert known.layout.scale is None
    assert (sample.acc, sample.gyro, sample.pressure) == (None, None, (100.0, 200.0))


def test_without_info_the_first_layout_is_the_only_one() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, frame_packet(0))
    [rejected] = feed(decoder, frame_packet(1, layout=9))
    assert rejected.reason is Rejection.WRONG_LAYOUT
    feed(decoder, packet(11.0, "insole/info", info(layout=9)))
    assert len(of(Sample, feed(decoder, packet(11.1, "insole/frame", insole_frame(2, layout=9))))) == 1


def test_a_site_without_a_foot_takes_no_insole() -> None:
    decoder = Decoder(site=Site.PELVIS)
    [rejected] = decoder.feed(packet(1.0, "insole/frame", insole_frame(0), Site.PELVIS))
    assert rejected.reason is Rejection.WRONG_SITE


def test_another_tick_rate_is_another_clock() -> None:
    decoder = walked()
    feed(decoder, packet(10.06, "insole/info", info(tick_rate=1000, interval=10)))
    reset, sample = feed(decoder, packet(10.07, "insole/frame", insole_frame(5)))
    assert isinstance(reset, ClockReset) and not reset.restarted
    assert sample.t == pytest.approx(10.07, abs=1e-6)


def test_frames_lost_over_a_whole_round_of_the_sequence_are_counted_by_ticks() -> None:
    decoder = walked()
    away = 3 * 65536 + 10
    lost = of(PacketsLost, decoder.feed(frame_packet(4 + away)))
    assert [event.count for event in lost] == [away - 1]
    assert lost[0].t == pytest.approx(10.0 + 5 * STEP)


def test_a_device_that_samples_again_after_a_pause_has_lost_nothing() -> None:
    decoder = walked()
    pause = packet(20.0, "insole/frame", insole_frame(5, ticks=round(10.0 * 32768)))
    outputs = decoder.feed(pause)
    assert of(PacketsLost, outputs) == []
    assert of(Sample, outputs)[0].t == pytest.approx(20.0, abs=0.001)


def test_a_restart_within_two_seconds_is_known_by_its_delay() -> None:
    decoder = walked(100)
    outputs = feed(
        decoder, packet(13.5, "insole/frame", insole_frame(0)), packet(13.51, "insole/frame", insole_frame(1))
    )
    assert [event.restarted for event in of(ClockReset, outputs)] == [True]
    assert [sample.t for sample in of(Sample, outputs)] == pytest.approx([13.5, 13.51], abs=0.001)


def test_times_keep_their_order_across_a_reset() -> None:
    decoder = walked(10)
    newest = decoder.feed(frame_packet(10))[-1].t
    many = (InsoleSample((100, 200), (0, 0, 4096, 0, 0, 0)),) * 10
    outputs = decoder.feed(packet(10.11, "insole/frame", insole_frame(0, ticks=2_000_000_000, samples=many)))
    times = [newest] + [sample.t for sample in of(Sample, outputs)]
    assert all(b > a for a, b in zip(times, times[1:], strict=False))


def fragments(k: int, frame_id: int) -> list[Packet]:
    raw = InsoleSample(tuple(range(24)), (0, 0, 2048, 0, 0, 0))
    pieces = split(insole_frame(k, samples=(raw,)), 20, frame_id)
    assert len(pieces) == 4
    return [packet(10.0 + k * STEP, "insole/frame", piece) for piece in pieces]


def test_fragments_make_the_frame_that_they_were_cut_from() -> None:
    whole, cut = Decoder(site=LEFT), Decoder(site=LEFT)
    raw = InsoleSample(tuple(range(24)), (0, 0, 2048, 0, 0, 0))
    for k in range(10):
        assert feed(cut, *fragments(k, k % 7)) == feed(whole, frame_packet(k, samples=(raw,)))


@pytest.mark.parametrize("missing", range(4))
def test_a_lost_fragment_costs_its_frame_and_no_other(missing: int) -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, *fragments(0, 0))
    broken = fragments(1, 1)
    del broken[missing]
    outputs = feed(decoder, *broken, *fragments(2, 2), *fragments(3, 3))
    assert [event.reason for event in of(PacketRejected, outputs)] == [Rejection.TRUNCATED]
    assert [event.count for event in of(PacketsLost, outputs)] == [1]
    assert len(of(Sample, outputs)) == 2


def test_a_fragment_that_comes_twice_is_a_duplicate() -> None:
    decoder = Decoder(site=LEFT)
    first, second, third, last = fragments(0, 0)
    feed(decoder, first, second)
    before = machine.save(decoder)
    [rejected] = decoder.feed(second)
    assert rejected.reason is Rejection.DUPLICATE
    assert machine.save(decoder) == before
    assert len(of(Sample, feed(decoder, third, last))) == 1


def test_the_last_fragment_that_comes_twice_is_a_duplicate() -> None:
    decoder = Decoder(site=LEFT)
    pieces = fragments(0, 0)
    feed(decoder, *pieces)
    [rejected] = decoder.feed(pieces[-1])
    assert rejected.reason is Rejection.DUPLICATE
    assert len(of(Sample, feed(decoder, *fragments(1, 1)))) == 1


def test_an_end_of_a_fragment_is_not_that_fragment() -> None:
    decoder = Decoder(site=LEFT)
    first, second, third, last = fragments(0, 0)
    feed(decoder, first, second)
    [rejected] = decoder.feed(evolve(second, data=second.data[:1] + second.data[-3:]))
    assert rejected.reason is Rejection.TRUNCATED
    assert feed(decoder, third, last) == []


def test_fragments_without_end_do_not_fill_the_memory() -> None:
    decoder = Decoder(site=LEFT)
    for k in range(3000):
        decoder.feed(packet(float(k) / 100, "insole/frame", bytes([(k % 5) << 5 | k % 16]) + bytes(400)))
        assert decoder.link is not None
        assert len(json.dumps(machine.save(decoder))) < 5000


def test_an_insole_of_the_wrong_scale_is_suspected_once() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, packet(9.0, "insole/info", info()))
    outputs = feed(decoder, *[frame_packet(k, acc=2048) for k in range(400)])
    [suspect] = of(ScaleSuspect, outputs)
    assert suspect.magnitude == pytest.approx(GRAVITY / 2)
    assert "16 g would fit" in suspect.suggestion


def test_a_foot_that_moves_is_not_at_rest() -> None:
    decoder, random = Decoder(site=LEFT), Random(1)
    feed(decoder, packet(9.0, "insole/info", info()))
    outputs = feed(decoder, *[frame_packet(k, acc=random.randrange(0, 4000)) for k in range(600)])
    assert of(ScaleSuspect, outputs) == []


# --- time ---------------------------------------------------------------------------------------------------------


def test_arrival_may_not_run_backwards_but_a_clock_set_back_ends_nothing() -> None:
    decoder = walked()
    outputs = feed(decoder, *[evolve(frame_packet(k), t=5.0 + k * STEP) for k in range(5, 5 + SET_BACK + 3)])
    assert [event.reason for event in of(PacketRejected, outputs)] == [Rejection.TIME_BACKWARDS] * (SET_BACK - 1)
    assert len(of(ClockReset, outputs)) == 1
    assert [sample.t for sample in of(Sample, outputs)] == pytest.approx(
        [5.0 + k * STEP for k in range(4 + SET_BACK, 8 + SET_BACK)], abs=1e-3
    )


def test_one_wild_arrival_time_is_survived() -> None:
    decoder = walked()
    decoder.feed(packet(1e9, "device/battery", b"\x32"))
    outputs = feed(decoder, *[frame_packet(k) for k in range(5, 60)])
    assert len(of(Sample, outputs)) == 55 - SET_BACK + 1
    assert of(Sample, outputs)[-1].t == pytest.approx(10.0 + 59 * STEP, abs=1e-3)


def test_silence_is_said_once_and_ended_by_the_next_frame() -> None:
    decoder = walked()
    last = 10.0 + 4 * STEP
    assert decoder.advance(last + 0.9) == []
    [stale] = decoder.advance(last + 1.5)
    assert isinstance(stale, StreamStale)
    assert (stale.t, stale.known_at, stale.silent_for) == pytest.approx((last + 1.0, last + 1.5, 1.5))
    assert decoder.advance(last + 3.0) == []
    assert decoder.advance(nan) == []
    outputs = decoder.feed(frame_packet(1000))
    assert [event.silent_for for event in of(StreamResumed, outputs)] == pytest.approx([996 * STEP])


def test_silence_is_noticed_by_other_packets_of_the_site() -> None:
    decoder = walked()
    outputs = feed(decoder, packet(20.0, "device/battery", b"\x32"), packet(21.0, "device/battery", b"\x31"))
    assert [type(output) for output in outputs] == [StreamStale, BatteryLevel, BatteryLevel]


def test_nothing_is_stale_before_it_began() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, packet(1.0, "insole/info", info()))
    assert decoder.advance(1000.0) == []


# --- CC2650 -------------------------------------------------------------------------------------------------------


def test_a_cc2650_is_scaled_by_its_configuration() -> None:
    decoder = Decoder(site=LEFT)
    raw = new_tag("movement", gyro=(131, 0, -131), acc=(0, 0, 4096), mag=(0, 32760, 0))
    [at_8g] = feed(decoder, packet(1.0, "cc2650/movement", raw))
    assert at_8g.acc == pytest.approx((0.0, 0.0, GRAVITY))
    assert at_8g.gyro == pytest.approx((radians(131 * 500 / 65536), 0.0, -radians(131 * 500 / 65536)))
    assert at_8g.mag == pytest.approx((4912e-6, 0.0, 0.0))
    told = config(16, mag=False, gyro_axes=(True, False, True))
    [at_16g] = feed(decoder, told, packet(1.1, "cc2650/movement", raw))
    assert at_16g.acc == pytest.approx((0.0, 0.0, 2 * GRAVITY))
    assert at_16g.gyro is None
    assert at_16g.mag is None


def test_air_pressure_rides_on_the_next_movement_sample_once() -> None:
    decoder = Decoder(site=LEFT)
    air = new_tag("barometer", temperature=20.0, pressure=101325.0)
    outputs = feed(decoder, movement(0), packet(10.05, "cc2650/barometer", air), movement(1), movement(2))
    assert [sample.air_pressure for sample in outputs] == [None, 101325.0, None]


def test_air_pressure_alone_makes_samples_of_its_own() -> None:
    decoder = Decoder(site=LEFT)
    air = new_tag("barometer", temperature=20.0, pressure=101325.0)
    outputs = feed(decoder, packet(1.0, "cc2650/barometer", air), packet(2.0, "cc2650/barometer", air))
    assert outputs == [
        Sample(1.0, LEFT, air_pressure=101325.0, known_at=1.0),
        Sample(2.0, LEFT, air_pressure=101325.0, known_at=2.0),
    ]


def test_wake_on_motion_makes_silence_legal() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, config(8, wake_on_motion=True), movement(0), movement(1))
    assert decoder.advance(60.0) == []
    outputs = decoder.feed(movement(600))
    assert [type(output) for output in outputs] == [Sample]
    assert outputs[0].t == pytest.approx(70.0)


def test_without_wake_on_motion_the_same_silence_is_loss() -> None:
    decoder = Decoder(site=LEFT)
    outputs = feed(decoder, movement(0), movement(1), movement(600))
    assert [type(output) for output in outputs[2:]] == [StreamStale, StreamResumed, PacketsLost, Sample]
    assert outputs[4].count == 598


def test_keys_are_named_and_differ_between_the_tags() -> None:
    new, old = Decoder(site=LEFT), Decoder(site=LEFT)
    [pressed] = new.feed(packet(1.0, "cc2650/keys", b"\x01"))
    assert pressed == KeysChanged(t=1.0, known_at=1.0, site=LEFT, down=("left",))
    [pressed] = old.feed(packet(1.0, "cc2541/keys", b"\x05"))
    assert pressed.down == ("right", "side")


def test_battery_is_a_fraction() -> None:
    [battery] = Decoder(site=LEFT).feed(packet(1.0, "device/battery", build_battery(83)))
    assert battery == BatteryLevel(t=1.0, known_at=1.0, site=LEFT, level=0.83)


# --- CC2541 -------------------------------------------------------------------------------------------------------


def acc_packet(t: float, counts: tuple[int, int, int] = (0, 0, 16)) -> Packet:
    return old_tag(t, "accelerometer", acc=counts)


def gyro_packet(t: float, counts: tuple[int, int, int] = (0, 0, 0)) -> Packet:
    return old_tag(t, "gyroscope", gyro=counts)


@pytest.mark.parametrize(
    ("firmware", "code", "expected"),
    [
        ("1.5 (Oct 23 2013)", 1, 64),
        ("1.5 (Oct 23 2013)", 2, 32),
        ("1.5 (Oct 23 2013)", 3, 16),
        ("1.4 (Jul 12 2013)", 3, 64),
        ("", 3, 16),
        ("", 1, 64),
    ],
)
def test_the_scale_goes_by_firmware_and_range(firmware: str, code: int, expected: int) -> None:
    assert counts_per_g(firmware, code) == expected
    decoder = Decoder(site=LEFT)
    if firmware:
        feed(decoder, packet(0.0, "device/firmware", build_firmware(firmware)))
    feed(decoder, packet(0.0, "cc2541/accelerometer-config", bytes([code])))
    outputs = feed(decoder, acc_packet(1.0, (0, 0, expected)), gyro_packet(1.05))
    assert outputs[0].acc == pytest.approx((0.0, 0.0, GRAVITY))


def test_firmware_may_be_read_after_the_tag_began() -> None:
    decoder = Decoder(site=LEFT)
    feed(decoder, acc_packet(1.0), gyro_packet(1.05), packet(1.06, "device/firmware", build_firmware("1.4 (Jul 2013)")))
    [sample] = feed(decoder, acc_packet(1.1, (0, 0, 64)), gyro_packet(1.15))
    assert sample.acc == pytest.approx((0.0, 0.0, GRAVITY))


def test_a_wrong_range_shows_at_rest() -> None:
    decoder = Decoder(site=LEFT)
    outputs = feed(decoder, *[acc_packet(1.0 + 0.1 * k, (0, 0, 64)) for k in range(40)])
    [suspect] = of(ScaleSuspect, outputs)
    assert suspect.magnitude == pytest.approx(4 * GRAVITY)
    assert "2 g would fit" in suspect.suggestion


def test_a_gyroscope_that_stops_does_not_stop_the_samples() -> None:
    decoder = Decoder(site=LEFT)
    outputs = []
    for k in range(30):
        outputs += feed(decoder, acc_packet(1.0 + 0.1 * k))
        if k < 10:
            outputs += feed(decoder, gyro_packet(1.04 + 0.1 * k))
    samples = of(Sample, outputs)
    assert len(samples) == 30
    assert [sample.gyro is None for sample in samples] == [False] * 11 + [True] * 19
    assert max(sample.known_at - sample.t for sample in samples) < 0.31
    assert samples[-1].known_at == samples[-1].t


def test_an_accelerometer_that_stops_leaves_the_gyroscope() -> None:
    decoder = Decoder(site=LEFT)
    outputs = feed(decoder, acc_packet(1.0), *[gyro_packet(1.04 + 0.1 * k) for k in range(20)])
    samples = of(Sample, outputs)
    assert samples[0].acc is not None
    assert all(sample.acc is None and sample.gyro is not None for sample in samples[1:])
    assert len(samples) == 18


def test_what_waits_for_the_gyroscope_comes_out_at_the_end() -> None:
    decoder = Decoder(site=LEFT)
    assert feed(decoder, acc_packet(1.0)) == []
    [sample] = decoder.finish()
    assert (sample.t, sample.gyro) == (1.0, None)
    assert decoder.finish() == []


def test_a_barometer_without_calibration_is_said_once() -> None:
    decoder = Decoder(site=LEFT)
    raw = bytes.fromhex("b2eec584")
    [limitation] = feed(decoder, packet(1.0, "cc2541/barometer", raw), packet(2.0, "cc2541/barometer", raw))
    assert isinstance(limitation, Limitation)
    calibration = bytes.fromhex("81b2f863febe4e8d591bc607c4f66ddb")
    feed(decoder, packet(3.0, "cc2541/barometer-calibration", calibration))
    [sample] = feed(decoder, packet(4.0, "cc2541/barometer", raw))
    assert sample.air_pressure == pytest.approx(100960.5, abs=0.1)


def test_a_cc2541_keeps_the_axes_as_they_were_sent() -> None:
    decoder = Decoder(site=LEFT)
    mag = old_tag(0.9, "magnetometer", mag=(1, 2, 3))
    [sample] = feed(decoder, mag, acc_packet(1.0, (16, 32, -16)), gyro_packet(1.05, (1000, 2000, 3000)))
    scale = radians(500 / 65536)
    assert sample.acc == pytest.approx((GRAVITY, 2 * GRAVITY, -GRAVITY))
    assert sample.gyro == pytest.approx((1000 * scale, 2000 * scale, 3000 * scale))
    assert sample.mag == pytest.approx(tuple(n * 2000e-6 / 65536 for n in (1, 2, 3)))
    with pytest.raises(TypeError):
        Decoder(LEFT, axes="ti-app")  # type: ignore[call-arg]
