"""What is missing of a stream, and how long it was absent, whatever was lost, for the devices of all profiles."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import pytest
from attrs import evolve, frozen
from decoded import acc_packet, gyro_packet, insole_frame, movement_packet
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from soak import longer

from solepath import Event, Packet, SampleGap, Session, Site
from solepath.link.catalogue import DECLARED, PROFILES
from solepath.walk import Walk
from solepath.wire.insole import InsoleSample
from solepath.wire.receiver import ConnectionFrame, build_connected

LEFT, PELVIS = Site.LEFT_FOOT, Site.PELVIS
DELAY = 0.004
"""Time from the last sample of a packet to its arrival, s."""
BY_NAME = {driver.name: driver for driver in DECLARED}


def written(channel: str, **fields: Any) -> tuple[str, bytes]:
    return channel, BY_NAME[channel.partition("/")[0]].write(channel, fields)


@frozen
class Sender:
    """A device: its packets of the samples number k since it started, and how it counts them."""

    rate: float
    """Packets a second."""
    values: Callable[[int], list[tuple[str, bytes]]]
    samples: int = 1
    """Samples in a packet."""
    counts: bool = True
    """True if its packets have counters."""
    stale_after: float = 1.0
    partial: bool = False
    """True if a sample may lack a value that was lost.

    A foot does not use such a sample: it is not counted as one that came, and gaps before and after it are one."""
    sites: tuple[Site, ...] = (LEFT, PELVIS)


RAW = InsoleSample((100, 200), (0, 0, 2048, 0, 0, 0))
ORPHE_SAMPLE = {"quat": (16384, 0, 0, 0), "gyro": (0, 0, 0), "acc": (0, 0, 2048), "pressure": (7,) * 6}


def orphe(k: int) -> list[tuple[str, bytes]]:
    ms = round(1000 * k * 2 / 100.4)
    time = {"hour": 1, "minute": ms // 60000, "second": ms // 1000 % 60, "millisecond": ms % 1000}
    samples = [ORPHE_SAMPLE] * 2
    return [written("orphe/values", header=56, serial=k, **time, samples=samples, unused="00" * 32)]


SENDERS = {
    "insole": Sender(32768 / 328, lambda k: [("insole/frame", insole_frame(k))], sites=(LEFT,)),
    "insole, four samples a frame": Sender(
        32768 / 1312,
        lambda k: [("insole/frame", insole_frame(k, ticks=1312 * k, samples=(RAW,) * 4))],
        samples=4,
        sites=(LEFT,),
    ),
    "orphe": Sender(100.4 / 2, orphe, samples=2),
    "dot": Sender(60.0, lambda k: [written("dot/rates", ticks=round(1e6 * k / 60), acc=(0, 0, 9.8), gyro=(0, 0, 0))]),
    "dot-orientation": Sender(
        60.0, lambda k: [written("dot-orientation/quaternion", ticks=round(1e6 * k / 60), quat=(1, 0, 0, 0))]
    ),
    "cc2650": Sender(10.0, lambda k: [("cc2650/movement", movement_packet(k).data)], counts=False, stale_after=2.0),
    "cc2541": Sender(
        10.0,
        lambda k: [(one.channel, one.data) for one in (acc_packet(0.0), gyro_packet(0.0))],
        counts=False,
        stale_after=2.0,
        partial=True,
    ),
}
"""Devices whose counters, or whose period that is longer than a radio's delay, show each loss."""


THINGY = Sender(
    100.0, lambda k: [written("thingy/motion", acc=(0, 0, -1024), gyro=(0, 0, 0), mag=(0, 0, 0))], counts=False
)


def test_there_is_a_sender_for_every_profile() -> None:
    names = {name.partition(",")[0] for name in SENDERS} | {"thingy"}
    assert names == {profile.name.removesuffix("-20hz") for profile in PROFILES}


@frozen
class Course:
    """What happens to the packets of a device."""

    lost: tuple[tuple[float, float], ...]
    """Spans of time in which packets are lost: start and duration, s."""
    cut: tuple[tuple[float, float], ...]
    """Spans of time without a connection."""
    restart: tuple[float, float]
    """Time at which the device restarts, and time until it measures again, s."""
    duration: float


def spans(most: int, duration: float, longest: float) -> Any:
    return st.lists(st.tuples(st.floats(0.5, duration), st.floats(0.01, longest)), max_size=most).map(tuple)


def courses(duration: float) -> Any:
    """Return the strategy of courses (protocol/clock.md).

    The device restarts no sooner than its counters show it, and loses none before its first packets show its period."""
    restarts = st.tuples(st.integers(30, int(10.0 * duration)), st.integers(1, 25)).map(
        lambda n: (n[0] / 10, n[1] / 10)
    )
    return st.builds(Course, spans(8, duration, 0.6), spans(2, duration, 4.0), restarts, st.just(duration))


def within(t: float, some: tuple[tuple[float, float], ...]) -> bool:
    return any(start <= t < start + duration for start, duration in some)


@frozen
class Received:
    """What a session was fed on a course, and what it made of it."""

    walk: Walk
    events: list[Event]
    taken: int
    """Samples between two that arrived, of one connection and one start of the device, without a longer silence."""
    arrived: int
    absent: float
    """Time between two samples that arrived, with a new connection, a restart or a longer silence in between, s."""
    absences: int
    hidden: bool
    """True if the counters are farther after the restart than before it, so that they do not show it."""


def follow(sender: Sender, course: Course, site: Site) -> Received:
    session, walk, events = Session(poses=True, losses=True), Walk(), list[Event]()

    def receive(packet: Packet) -> None:
        found = session.feed(packet)
        events.extend(found)
        walk.take(packet, found)

    arrived = taken = absences = 0
    absent, last, connected, hidden = 0.0, None, True, False
    start, down = course.restart
    for number in range(int(course.duration * sender.rate)):
        t = number / sender.rate
        restarted = t >= start
        if restarted and t < start + down:
            continue
        if within(t, course.cut) is connected:
            connected = not connected
            data = build_connected(ConnectionFrame("", None)) if connected else b""
            receive(Packet(100.0 + t, site, f"receiver/{'connected' if connected else 'disconnected'}", data))
            if connected and last is not None:
                last = (*last[:2], True)
        if not connected or within(t, course.lost):
            continue
        since_start = number - round((start + down) * sender.rate) if restarted and sender.counts else number
        arrival = 100.0 + t + DELAY
        for channel, data in sender.values(max(0, since_start)):
            receive(Packet(arrival, site, channel, data))
        if last is not None:
            since, boot, is_new = arrival - last[0], last[1], last[2]
            hidden = hidden or (sender.counts and boot < restarted and since_start > (last[0] - 100.0) * sender.rate)
            if is_new or since > sender.stale_after or (sender.counts and boot is not restarted):
                absent, absences = absent + since, absences + 1
            else:
                taken += sender.samples * (round(since * sender.rate) - 1)
        last, arrived = (arrival, restarted, False), arrived + sender.samples
    walk.take(None, session.finish())
    return Received(walk, events, taken + arrived, arrived, absent, absences, hidden)


@pytest.mark.parametrize("name", SENDERS)
@settings(max_examples=12, phases=[Phase.generate], derandomize=True)
@given(data=st.data())
def test_samples_that_were_taken_came_or_are_missing_and_an_absence_is_neither(name: str, data: st.DataObject) -> None:
    sender = SENDERS[name]
    course = data.draw(courses(9.0 if sender.rate > 20.0 else 40.0))
    site = data.draw(st.sampled_from(sender.sites))
    received = follow(sender, course, site)
    assume(not received.hidden)
    (link,) = received.walk.links.values()
    gaps = [event for event in received.events if isinstance(event, SampleGap)]
    merges = sender.partial and site is LEFT
    # a frame whose samples lie on both sides of a restart is one of either
    within = 4 * len(gaps) if merges else len(gaps) if sender.partial else sender.samples if sender.samples > 1 else 0
    assert link.samples + link.missing == pytest.approx(received.taken, abs=within)
    assert link.samples == pytest.approx(received.arrived, abs=within)
    assert link.missing_time + link.absent_time(received.walk.now) <= course.duration
    if merges:
        return
    absent = pytest.approx(received.absent, abs=(received.absences + 1) / sender.rate)
    assert link.ended_absences == absent
    absences = [gap for gap in gaps if gap.count == 0]
    assert len(absences) == received.absences
    for absence in absences:
        for gap in gaps:
            apart = gap.t >= absence.t + absence.duration - 1e-9 or absence.t >= gap.t + gap.duration - 1e-9
            assert gap is absence or apart, "what is missing was not taken in an absence"


@pytest.mark.parametrize("site", [LEFT, PELVIS])
@pytest.mark.parametrize("name", [*SENDERS, "thingy"])
@pytest.mark.parametrize("duration", [1.2, *longer(3.0, 4.9)])
def test_the_time_without_a_connection_is_absent_once_and_none_of_it_is_missing(
    duration: float, name: str, site: Site
) -> None:
    sender = {**SENDERS, "thingy": THINGY}[name]
    if site in sender.sites:
        received = follow(sender, Course((), ((4.05, duration),), (20.0, 0.1), 12.0), site)
        link = received.walk.links[site]
        assert (link.missing, link.samples) == (0, pytest.approx(received.arrived, abs=2 * sender.partial))
        assert link.ended_absences == pytest.approx(duration, abs=(2.1 if sender.partial else 1.1) / sender.rate + 0.02)


@pytest.mark.parametrize("site", [LEFT, PELVIS])
@pytest.mark.parametrize("period", [0.07, 0.1, 0.13, 0.2, *longer(0.085, 0.095, 0.11, 0.12, 0.15, 0.17)])
def test_what_is_missing_of_a_cc2541_that_loses_one_packet_in_five_is_right_whatever_its_period(
    period: float, site: Site
) -> None:
    session, walk, random, lost = Session(poses=True, losses=True), Walk(), Random(1), 0
    for k in range(int(60.0 / period)):
        arrival = 100.0 + k * period + random.uniform(0.0, 0.02)
        for made in (acc_packet(0.0, (k % 3, 0, 16)), gyro_packet(0.0, (k % 250, 0, 0))):
            if random.random() < 0.2:
                lost += 1
                continue
            packet = evolve(made, t=arrival, site=site)
            walk.take(packet, session.feed(packet))
    walk.take(None, session.finish())
    (link,) = walk.links.values()
    assert 0.85 < link.missing_time / (0.5 * lost * period) < 1.1


@pytest.mark.parametrize("site", [LEFT, PELVIS])
def test_a_silence_that_is_longer_than_the_profile_allows_is_no_loss_without_counters_either(site: Site) -> None:
    received = follow(THINGY, Course(((4.0, 1.5),), (), (20.0, 0.1), 12.0), site)
    link = received.walk.links[site]
    assert (link.missing, link.ended_absences) == (0, pytest.approx(1.5, abs=0.02))
