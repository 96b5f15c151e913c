"""One device that misbehaves, or falls silent: what it did is no loss, no stride and no activity."""

from __future__ import annotations

from functools import cache
from math import fsum

import pytest
from attrs import evolve, field, frozen
from construct import Int32ul, Struct
from soak import longer, soaked
from uncounted import ACC, GYRO, SITE, board
from walks import of

from solepath import (
    Activity,
    ActivityChanged,
    CellsFailed,
    ClockReset,
    DefectFound,
    Event,
    Foot,
    Limitation,
    Packet,
    PacketRejected,
    SampleGap,
    Session,
    StrideTaken,
)
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.events import CellFault
from solepath.link.driver import Driver, Measured, Reading
from solepath.wire.fields import Fields
from solepath.wire.receiver import ConnectionFrame, build_connected

RATE = 100.0


def counting(sequence: int, tick_rate: float = 0.0, tick_modulus: int = 0) -> Driver:
    """Return a board with these counters; 0 for none."""

    def motion(sent: object, known: object) -> Reading:
        acc, gyro = tuple([v * ACC for v in sent.acc]), tuple([v * GYRO for v in sent.gyro])  # type: ignore[attr-defined]
        number, ticks = (sent.number if sequence else None), (sent.ticks if tick_rate else None)  # type: ignore[attr-defined]
        return Reading((Measured(acc, gyro),), sequence=number, ticks=ticks)

    layout = Struct("number" / Int32ul, "ticks" / Int32ul, "acc" / Fields("<3h"), "gyro" / Fields("<3h"))
    counters = {"sequence": sequence, "tick_rate": tick_rate, "tick_modulus": tick_modulus}
    return evolve(board(RATE), formats={"board/motion": layout}, readers={"board/motion": motion}, **counters)


DRIVERS = {
    "no counter": counting(0),
    "8 bits": counting(256),
    "16 bits": counting(1 << 16),
    "a clock of 16 bits": counting(0, 1000.0, 1 << 16),
    "a fine clock": counting(0, 1e6, 1 << 32),
    "8 bits and a clock of 65.5 s": counting(256, 1000.0, 1 << 16),
}


@cache
def counts(distance: float) -> tuple[tuple[float, list[int], list[int]], ...]:
    found = []
    for one in Walker(Route().stand(2.0).walk(distance).stop(2.0)).samples(Foot.LEFT, RATE, LSM6DSOX):
        found.append((one.t, [round(v / ACC) for v in one.acc or ()], [round(v / GYRO) for v in one.gyro or ()]))
    return tuple(found)


@frozen
class Course:
    """What a device does on a walk."""

    silent: tuple[float, float] = (0.0, 0.0)
    """Time in which it sends nothing, s."""
    restarts: bool = False
    """True if it starts to count again after the silence."""
    reconnects: bool = False
    repeats: bool = False
    """True if it sends its last packet again after the silence."""
    reset_at: float = 1e9
    """Time at which its counters start again without a silence, s."""
    back: int = 0
    """Number of packets by which its count goes back then, in place of to 0."""
    zeros: int = 0
    """Number of samples from the start that are all zero."""
    distance: float = field(default=40.0)


def walk(driver: Driver, course: Course) -> tuple[Session, list[Event]]:
    session, events, since, last, was_silent = Session(profiles=[driver]), list[Event](), (0, 0.0), b"", False
    for k, (t, acc, gyro) in enumerate(counts(course.distance)):
        now = 100.0 + t + 0.005
        if course.silent[0] <= t < course.silent[1]:
            if not was_silent and course.reconnects:
                events += session.feed(Packet(now, SITE, "receiver/disconnected", b""))
            was_silent = True
            events += session.advance(now) if k % 25 == 0 else []
            continue
        if was_silent:
            was_silent = False
            since = (k, t) if course.restarts else since
            if course.reconnects:
                events += session.feed(Packet(now, SITE, "receiver/connected", build_connected(ConnectionFrame("", 0))))
            if course.repeats:
                events += session.feed(Packet(now, SITE, "board/motion", last))
        if course.reset_at <= t < course.reset_at + 1.0 / RATE:
            since = (course.back or k, t)
        number, ticks = k - since[0], int((t - since[1]) * (driver.tick_rate or 1.0))
        values = {"acc": [0] * 3 if k < course.zeros else acc, "gyro": [0] * 3 if k < course.zeros else gyro}
        fields = {"number": number % (driver.sequence or 2**32), "ticks": ticks % (driver.tick_modulus or 2**32)}
        last = driver.write("board/motion", {**fields, **values})
        events += session.feed(Packet(now, SITE, "board/motion", last))
    return session, events + session.finish()


def lost(events: list[Event]) -> int:
    return sum(gap.count for gap in of(SampleGap, events))


@cache
def plain(name: str) -> tuple[int, float]:
    """Return the strides of the device that does nothing wrong, and how far it comes, m."""
    session, events = walk(DRIVERS[name], Course())
    assert session.position is not None
    return len(of(StrideTaken, events)), session.position.position[0]


@pytest.mark.parametrize("name", DRIVERS)
@pytest.mark.parametrize("zeros", [20, *soaked(1, 150)])
def test_zeros_until_the_first_measurement_are_no_strides_and_no_motion(name: str, zeros: int) -> None:
    session, events = walk(DRIVERS[name], Course(zeros=zeros))
    strides, distance = plain(name)
    assert (lost(events), len(of(StrideTaken, events)), len(of(DefectFound, events))) == (0, strides, 0)
    assert session.position is not None and session.position.position[0] == pytest.approx(distance, abs=0.05)


@pytest.mark.parametrize("name", ["8 bits", *soaked("16 bits", "8 bits and a clock of 65.5 s")])
@pytest.mark.parametrize("declared", [75.0, 110.0, *soaked(60.0, 90.0, 140.0, 190.0)])
def test_a_device_that_counts_goes_by_the_rate_that_arrives(name: str, declared: float) -> None:
    driver = evolve(DRIVERS[name], profile=evolve(DRIVERS[name].profile, nominal_rate=declared))
    session, events = walk(driver, Course(distance=60.0))
    assert lost(events) == 0 and session.position is not None
    assert session.position.position[0] == pytest.approx(60.0, abs=4.0), "but for two strides until the rate is known"
    (said,) = [event.what for event in of(Limitation, events) if "arrive" in event.what]
    assert f"not the {declared:g} that were set" in said


@pytest.mark.parametrize("declared", [50.0, 200.0, *soaked(66.0, 130.0, 400.0)])
@pytest.mark.parametrize("lose", [0, 37])
def test_a_device_with_a_number_and_a_fine_clock_goes_by_the_rate_that_arrives(declared: float, lose: int) -> None:
    driver = counting(1 << 16, 1e6, 1 << 32)
    driver = evolve(driver, profile=evolve(driver.profile, nominal_rate=declared))
    session, events, dropped = Session(profiles=[driver]), list[Event](), 0
    for k, (t, acc, gyro) in enumerate(counts(40.0)):
        if lose and k % lose == 3:
            dropped += 1
            continue
        data = driver.write("board/motion", {"number": k, "ticks": int(t * 1e6), "acc": acc, "gyro": gyro})
        events += session.feed(Packet(100.0 + t + 0.005, SITE, "board/motion", data))
    events += session.finish()
    (said,) = [event.what for event in of(Limitation, events)]
    assert f"100 samples a second arrive, not the {declared:g} that were set" in said
    assert (sum([gap.gaps for gap in of(SampleGap, events)]), lost(events)) == (dropped, dropped)
    assert of(ClockReset, events) == []
    assert session.position is not None and session.position.position[0] == pytest.approx(40.0, abs=2.0)


@pytest.mark.parametrize("every", [(1, 2), (4, 1), *soaked((1, 4), (2, 1))])
def test_a_device_that_only_counts_may_change_its_rate_in_mid_walk(every: tuple[int, int]) -> None:
    before, after = every
    driver = evolve(DRIVERS["16 bits"], profile=evolve(DRIVERS["16 bits"].profile, nominal_rate=RATE / before))
    session, events, number = Session(profiles=[driver]), list[Event](), 0
    for k, (t, acc, gyro) in enumerate(counts(60.0)):
        if k % (before if t < 20.0 else after) == 0:
            data = driver.write("board/motion", {"number": number, "ticks": 0, "acc": acc, "gyro": gyro})
            events += session.feed(Packet(100.0 + t + 0.005, SITE, "board/motion", data))
            number += 1
    events += session.finish()
    (said,) = [event for event in of(Limitation, events) if "arrive" in event.what]
    assert f"{RATE / after:.3g} samples a second arrive" in said.what and said.t < 125.0
    assert of(DefectFound, events) == [] and of(CellsFailed, events) == []
    assert all(stride.length < 2.0 for stride in of(StrideTaken, events)), "of 1.4 m, also before the rate is known"
    late = [stride.length for stride in of(StrideTaken, events) if stride.t > 128.0]
    assert lost(events) == 0 and len(late) >= 10
    assert fsum(late) / len(late) == pytest.approx(1.4, abs=0.1), "once the rate is known"


@pytest.mark.parametrize("speed", [1.3, 2.0, *soaked(1.5, 4.0, 1e6)])
def test_packets_that_catch_up_after_a_silence_are_no_other_rate(speed: float) -> None:
    driver, events = DRIVERS["16 bits"], list[Event]()
    session = Session(profiles=[driver])
    for k, (t, acc, gyro) in enumerate(counts(40.0)):
        fields = {"number": k % driver.sequence, "ticks": 0, "acc": acc, "gyro": gyro}
        sent = max(t, 12.0 + (t - 10.0) / speed) if t >= 10.0 else t
        events += session.feed(Packet(100.005 + sent, SITE, "board/motion", driver.write("board/motion", fields)))
    assert of(Limitation, events) == [] and lost(events) == 0


@pytest.mark.parametrize("name", ["no counter", "8 bits", *soaked("16 bits")])
@pytest.mark.parametrize("apart", [2e-3, *soaked(1e-6)])
@pytest.mark.parametrize(("held", "kept"), [(3.0, 1.0), (8.0, 1.0), (25.0, 1.0), (6.0, 0.5)])
def test_what_a_phone_held_back_was_measured_one_after_another_in_the_silence(
    name: str, apart: float, held: float, kept: float
) -> None:
    driver, events, newest = DRIVERS[name], list[Event](), 0.0
    session = Session(profiles=[driver])
    for k, (t, acc, gyro) in enumerate(counts(40.0)):
        if 12.0 + kept * held <= t < 12.0 + held:
            continue
        newest = max(newest + apart, 12.0 + held if 12.0 <= t < 12.0 + held else t)
        fields = {"number": k % (driver.sequence or 2**32), "ticks": 0, "acc": acc, "gyro": gyro}
        events += session.feed(Packet(100.005 + newest, SITE, "board/motion", driver.write("board/motion", fields)))
    events += session.finish()
    assert of(DefectFound, events) == [] and of(Limitation, events) == []
    if kept == 1.0:
        assert of(SampleGap, events) == [] and of(ClockReset, events) == []
        assert len(of(StrideTaken, events)) >= plain(name)[0] - 1
    gaps = of(SampleGap, events)  # what came since, as fast as what was held back, is part of it without a count
    assert fsum(gap.duration for gap in gaps) == pytest.approx((1.0 - kept) * held, abs=0.2)
    assert all(112.0 + kept * held - 0.05 < gap.t < 113.5 + kept * held for gap in gaps)


def test_a_sensor_that_sends_nothing_but_zeros_is_named() -> None:
    _, events = walk(DRIVERS["no counter"], Course(zeros=10**6))
    assert "every value has been 0" in of(DefectFound, events)[0].what
    assert not of(StrideTaken, events)


@pytest.mark.parametrize("name", DRIVERS)
@pytest.mark.parametrize("reset_at", [21.35, *soaked(20.0, 23.7)])
def test_counters_that_start_again_are_no_loss(name: str, reset_at: float) -> None:
    _, events = walk(DRIVERS[name], Course(reset_at=reset_at))
    assert lost(events) == 0
    assert len(of(StrideTaken, events)) <= plain(name)[0]


@pytest.mark.parametrize("name", ["8 bits", "16 bits"])
@pytest.mark.parametrize("back", [1, 8, 64, 100, *soaked(2, 20, 50, 65, 120, 127)])
def test_a_count_that_goes_back_is_a_restart_and_no_sample_comes_twice_or_is_called_lost(name: str, back: int) -> None:
    session, events = walk(DRIVERS[name], Course(reset_at=20.0, back=back))
    late = max(0, back - 64)  # numbers older than those that a receiver remembers may be of packets that were overtaken
    # a number that comes once more with other values is that of the next packet of some devices
    assert lost(events) == 0 and len(of(ClockReset, events)) == (back > 1)
    assert sum([event.count for event in of(PacketRejected, events)]) == late
    assert [gap.duration for gap in of(SampleGap, events)] == pytest.approx([(late + 1) / RATE][:late], abs=0.03)
    assert len(of(StrideTaken, events)) >= plain(name)[0] - 1 - (late > 0)
    assert session.position is not None and session.position.position[0] == pytest.approx(plain(name)[1], abs=1.0)


@pytest.mark.parametrize("name", DRIVERS)
@pytest.mark.parametrize("away", [3.0, *soaked(2.0, 7.3)])
def test_the_last_packet_again_after_a_reconnection_is_no_sample_and_no_loss(name: str, away: float) -> None:
    course = Course((20.0, 20.0 + away), reconnects=True, repeats=True)
    _, events = walk(DRIVERS[name], course)
    assert lost(events) == 0
    (gap,) = of(SampleGap, events)
    assert (gap.t, gap.duration) == pytest.approx((120.0, away), abs=0.05)
    assert [event.reason.value for event in of(PacketRejected, events)] == ["duplicate"]


@pytest.mark.parametrize("name", DRIVERS)
@pytest.mark.parametrize("away", [62.0, *soaked(6.0, 81.7)])
@pytest.mark.parametrize("restarts", [True, *longer(False)])
def test_a_silence_is_a_gap_and_nothing_is_known_of_it(
    request: pytest.FixtureRequest, name: str, away: float, restarts: bool
) -> None:
    if (name, away, restarts) == ("a clock of 16 bits", 81.7, False):
        reason = "nothing tells a round of a clock without a counter from packets that were held back"
        request.applymarker(pytest.mark.xfail(reason=reason, strict=True))
    _, events = walk(DRIVERS[name], Course((30.0, 30.0 + away), restarts, distance=150.0 if away > 10.0 else 60.0))
    assert lost(events) == 0
    (gap,) = of(SampleGap, events)
    # a count of 8 bits that starts again may be taken for one that went on, if both fit the arrivals
    tolerance = 0.2 if restarts and name.startswith("8 bits") else 0.1
    assert (gap.t, gap.duration) == pytest.approx((130.0, away), abs=tolerance)
    final = [one for one in of(ActivityChanged, events) if one.final]
    before = [one.activity for one in final if one.t < 129.0]
    within = [one.activity for one in final if 129.0 <= one.t < 130.0 + away - 1.0]
    after = [one.activity for one in final if one.t >= 130.0 + away - 1.0]
    assert before[-1] is Activity.WALKING and within == [Activity.UNKNOWN] and after[0] is Activity.WALKING
    strides = of(StrideTaken, events)
    assert not [one for one in strides if one.t_start < 130.0 - 0.1 and one.t_end > 130.0 + away + 0.1]


@pytest.mark.parametrize("wild", [-5e12, 1e11, float("nan"), float("inf"), 1e300])
@pytest.mark.parametrize("cells", [(5,), *longer((0, 1, 2, 3, 4, 5))])
def test_cells_whose_values_cannot_be_cost_these_cells_and_no_stride(wild: float, cells: tuple[int, ...]) -> None:
    def motion(sent: object, known: object) -> Reading:
        acc, gyro = tuple([v * ACC for v in sent.acc]), tuple([v * GYRO for v in sent.gyro])  # type: ignore[attr-defined]
        return Reading((Measured(acc, gyro, tuple(sent.cells)),))  # type: ignore[attr-defined]

    layout = Struct("cells" / Fields("<6d"), "acc" / Fields("<3h"), "gyro" / Fields("<3h"))
    driver = evolve(board(RATE), formats={"board/motion": layout}, readers={"board/motion": motion})
    session, events = Session(profiles=[driver]), list[Event]()
    for k, (t, acc, gyro) in enumerate(counts(40.0)):
        values = [200.0 + 40.0 * (k % 100 < 60) * one + k % 3 for one in range(6)]
        sent = [wild if t > 15.0 and one in cells else value for one, value in enumerate(values)]
        data = driver.write("board/motion", {"cells": sent, "acc": acc, "gyro": gyro})
        events += session.feed(Packet(100.0 + t + 0.005, SITE, "board/motion", data))
    events += session.finish()
    assert not of(PacketRejected, events) and lost(events) == 0
    strides, distance = plain("no counter")
    assert len(of(StrideTaken, events)) >= strides - 2 and session.position is not None
    assert session.position.position[0] == pytest.approx(distance, abs=2.0)
    assert cells in [event.cells for event in of(CellsFailed, events) if event.fault is CellFault.MISSING]
