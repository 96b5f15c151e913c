"""Contract 6: memory is bounded and does not grow with the time walked."""

from __future__ import annotations

import gc
import json
import tracemalloc
from collections.abc import Iterator
from functools import cache

import pytest
from attrs import evolve
from soak import longer, soaked
from walks import LEFT, RIGHT, insoles, of, samples

from solepath import Packet, PacketRejected, Sample, SampleGap, Session, Site, StrideTaken
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.wire.error import WireError
from solepath.wire.insole import InsoleFrame, build_frame, parse_frame

LOOP_ROUTE = Route().stand(1.0).walk(30.0, 1.3).turn(6.0, radius=2.0).walk(20.0).stop(1.0)
"""A route of about a minute, which is walked many times."""
MAX_SNAPSHOT_LENGTH = 150_000
"""Largest length of a snapshot, characters; a tenth of it is the wearer's gait, heights and the sensors' ranges."""
TICK_INTERVAL = 328
"""Number of ticks (1/32768 s) of the emulated insoles between two samples."""


@cache
def loop() -> tuple[tuple[Packet, InsoleFrame | None], ...]:
    """Return the packets of one round over a lossy radio, each with its frame if it has a whole one."""
    radio = Radio(loss=0.03, duplicate=0.005, truncate=0.005, latency=0.01, jitter=0.03)
    return tuple(
        (packet, frame_of(packet)) for packet in insoles(LOOP_ROUTE, radio, seed=4, cells=96, rate=100.0).packets
    )


def frame_of(packet: Packet) -> InsoleFrame | None:
    try:
        return parse_frame(packet.data) if packet.channel == "insole/frame" else None
    except WireError:
        return None


def rounds(count: int, first: int | None = None) -> Iterator[list[Packet]]:
    """Yield `count` rounds of the loop, in which time, sequence number and ticks continue and wrap around.

    `first` is the number of packets of each round; None for all."""
    frames = round((loop()[-1][0].t + 0.05) * 32768 / TICK_INTERVAL)
    ticks = frames * TICK_INTERVAL
    length = ticks / 32768
    for k in range(count):
        shifted_packets = []
        for packet, frame in loop()[:first]:
            data = packet.data
            if frame is not None:
                sequence, now = (frame.sequence + k * frames) % 2**16, (frame.ticks + k * ticks) % 2**32
                data = build_frame(evolve(frame, sequence=sequence, ticks=now))
            shifted_packets.append(evolve(packet, t=packet.t + k * length, data=data))
        yield shifted_packets


def size(session: Session) -> int:
    return len(json.dumps(session.snapshot(), allow_nan=False))


def walk_on(session: Session, count: int) -> tuple[list[int], list[int]]:
    """Return the size of the snapshot, characters, and the number of strides, for each round."""
    sizes, stride_counts = [], []
    for packets in rounds(count):
        emitted = session.feed(packets)
        assert all(lost.count < 40 for lost in of(SampleGap, emitted)), "the rounds do not join"
        stride_counts.append(len(of(StrideTaken, emitted)))
        sizes.append(size(session))
    return sizes, stride_counts


def check(sizes: list[int], stride_counts: list[int]) -> None:
    assert max(sizes) <= MAX_SNAPSHOT_LENGTH
    assert max(sizes[1:]) <= 1.05 * sizes[1], "the snapshot grows with the time walked"
    assert min(stride_counts) >= 0.9 * max(stride_counts) > 30, "the walk did not go on"


@pytest.mark.long
def test_a_session_of_two_insoles_is_as_large_after_three_minutes_as_after_one() -> None:
    check(*walk_on(Session(poses=True, pressures=True), 3))


@pytest.mark.long
def test_a_session_of_two_insoles_is_as_large_after_an_hour_as_after_a_minute() -> None:
    check(*walk_on(Session(), 65))


@pytest.mark.parametrize("seconds", [*soaked(600.0), *longer(3600.0)])
def test_a_long_walk_in_samples_leaves_nothing_behind(seconds: float) -> None:
    fed = [sample for sample in samples(LOOP_ROUTE, cells=0, rate=25.0) if sample.site is LEFT]
    length = fed[-1].t + 0.04
    session, sizes, stride_counts = Session(), [], []
    for k in range(int(seconds / length) + 1):
        emitted = session.feed([Sample(s.t + k * length, s.site, s.acc, s.gyro) for s in fed])
        sizes.append(size(session))
        stride_counts.append(len(of(StrideTaken, emitted)))
    check(sizes, stride_counts)


@pytest.mark.long
def test_the_interpreter_holds_no_more_after_each_round() -> None:
    all_rounds = list(rounds(4, 400))  # each with the first steps of a round, after a pause
    session = Session()
    tracemalloc.start()
    try:
        traced_sizes = []
        for packets in all_rounds:
            session.feed(packets)
            gc.collect()
            traced_sizes.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    assert traced_sizes[0] < 1_000_000
    assert max(traced_sizes[1:]) - traced_sizes[1] < 30_000, traced_sizes


@pytest.mark.soak
def test_garbage_without_end_leaves_nothing_behind() -> None:
    session = Session()
    session.feed([packet for packet, _ in loop()[:500]])
    size_before = size(session)
    for k in range(4000):
        emitted = session.feed(
            Packet(5.0 + 1e-3 * k, (LEFT, RIGHT)[k % 2], "insole/frame", bytes([k % 224, k % 251] * 9))
        )
        assert len(emitted) <= 4 or k < 2, "what was held is told where a foot was silent, once"
        session.feed(Packet(5.0, list(Site)[k % 7], f"insole/{k}", b""))
    assert size(session) < size_before + 20_000, "no more than a few kinds of trouble that are told together"
    assert of(PacketRejected, session.feed(Packet(9.0, LEFT, "x", b"")))
