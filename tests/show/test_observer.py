"""Tests the ledger of a link and the observer of a session: each figure by its own definition."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import inf, nan

import pytest
from attrs import evolve
from walks import SHORT, insoles, packets

from solepath import (
    Connected,
    Disconnected,
    Foot,
    FootMoved,
    FootPressed,
    Packet,
    PacketsDropped,
    PacketsLost,
    Phase,
    Rejection,
    Sample,
    SampleGap,
    SampleRejected,
    Session,
    Site,
    StreamStale,
)
from solepath.emulate.radio import CLEAN, Radio
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.show.links import LinkLedger
from solepath.show.observer import Observer
from solepath.show.tables.summary import status
from solepath.show.track import MAX_POINTS, LiveTrack

LEFT = Site.LEFT_FOOT


def observed(items: Iterable[Packet | Sample]) -> Observer:
    """Return an observer of a session that was fed with the items."""
    session, observer = Session(poses=True, pressures=True), Observer()
    for item in items:
        observer.take(item, session.feed(item))
    observer.take(None, session.finish())
    return observer


def frames(radio: Radio, **device: int) -> tuple[Packet, ...]:
    return emulate(SHORT, devices={LEFT: Insole(**device)}, radio=radio, seed=1).packets


@pytest.mark.parametrize("batch", [1, 4])
def test_loss_is_a_share_of_packets_not_of_samples(batch: int) -> None:
    link = observed(frames(Radio(loss=0.25), cells=8, batch=batch)).links[LEFT]
    assert link.loss == pytest.approx(0.25, abs=0.06)
    assert link.samples == batch * link.received


def test_a_frame_in_fragments_is_one_packet() -> None:
    observer = observed(frames(CLEAN, mtu=60))
    link = observer.links[LEFT]
    assert link.received == link.samples < 0.5 * observer.item_count


def test_received_and_lost_frames_are_all_that_were_sent_whatever_came_damaged_or_twice() -> None:
    """Each frame comes in fragments, of which any may be lost, damaged or doubled."""
    sent = len(emulate(SHORT, devices={LEFT: Insole(cells=8)}, radio=CLEAN, seed=1).packets)
    rough = Radio(loss=0.03, duplicate=0.05, corrupt=0.05)
    for device in ({"cells": 8}, {"mtu": 60}):
        link = observed(frames(rough, **device)).links[LEFT]
        assert link.rejected.total() > 10 and link.lost > 10
        assert link.received == link.samples
        assert link.received + link.lost == pytest.approx(sent, abs=6), "what is no frame of samples are a few"


def test_what_the_receiver_dropped_is_lost_once() -> None:
    link = LinkLedger()
    link.add_event(PacketsDropped(t=1.0, known_at=1.0, site=LEFT, count=5))
    link.add_event(PacketsLost(t=1.0, known_at=1.1, site=LEFT, channel="insole/frame", count=5))
    assert (link.lost, link.dropped) == (5, 5)


def test_packets_of_a_device_of_an_apps_own_are_lost_like_others() -> None:
    observer = Observer()
    observer.add(PacketsLost(t=1.0, known_at=1.0, site=LEFT, channel="strap/values", count=2))
    assert observer.links[LEFT].lost == 2


def moved(t: float, known_at: float) -> FootMoved:
    zero = (0.0, 0.0, 0.0)
    return FootMoved(t=t, known_at=known_at, foot=Foot.LEFT, position=zero, velocity=zero, phase=Phase.SWING)


def pressed(t: float, known_at: float) -> FootPressed:
    return FootPressed(t=t, known_at=known_at, foot=Foot.LEFT, values=(1.0,), force=1.0, centre=None)


def test_a_sample_that_moved_and_pressed_is_one_sample() -> None:
    observer = Observer()
    for k in range(300):
        t = 0.01 * k
        observer.take(Sample(t, LEFT), [moved(t, t), pressed(t, t)])
    link = observer.links[LEFT]
    assert (link.samples, link.has_motion, link.has_pressure) == (300, True, True)
    assert link.rate == pytest.approx(100.0) and link.recent_rate(observer.now) == pytest.approx(100.0, abs=1.0)


def test_samples_that_are_rejected_are_not_used() -> None:
    observer = Observer()
    late = SampleRejected(t=0.5, known_at=0.5, site=LEFT, reason=Rejection.TIME_BACKWARDS)
    observer.take(Sample(1.0, LEFT), [])
    observer.take(Sample(0.5, LEFT), [late])
    link = observer.links[LEFT]
    assert (link.samples, link.rejected) == (1, {("samples", "time runs backwards"): 1})


def test_the_rate_leaves_gaps_and_silences_out() -> None:
    link = LinkLedger()
    for k in range(100):
        link.add_sample(0.01 * k, 0.01 * k)
    link.add_event(SampleGap(t=0.99, known_at=1.49, site=LEFT, duration=0.5))
    for k in range(100):
        link.add_sample(1.49 + 0.01 * k, 1.49 + 0.01 * k)
    link.add_event(StreamStale(t=3.5, known_at=3.5, site=LEFT, silent_for=1.0))
    for k in range(100):
        link.add_sample(60.0 + 0.01 * k, 60.0 + 0.01 * k)
    assert link.rate == pytest.approx(100.0)
    assert (link.gaps, link.gap_time, link.silences) == (1, 0.5, 1)


def test_of_a_sensor_that_is_on_no_foot_the_samples_are_counted_too() -> None:
    worn = [
        evolve(packet, site=Site.PELVIS)
        for packet in packets()["cc2650"]
        if packet.site is Site.LEFT_FOOT and packet.t < 10.0
    ]
    observer = observed(worn)
    (line,) = status(observer)
    assert re.match(r"pelvis: ([6-9]|10|11) Hz", line)


def test_a_packet_that_is_rejected_is_no_sign_of_time_passing() -> None:
    session, observer = Session(poses=True), Observer()
    for t in (1.0, 1e9, inf, nan, 2.0):
        packet = Packet(t, LEFT, "insole/nothing" if t != 2.0 else "receiver/tick", b"")
        observer.take(packet, session.feed(packet))
    assert (observer.item_count, observer.now, observer.covered_time.total) == (5, 2.0, 0.0)


def test_a_clock_that_was_set_back_goes_on_from_there() -> None:
    shifted = [evolve(p, t=p.t + (5000.0 if p.t < 3.0 else 1000.0)) for p in insoles().packets]
    session, observer = Session(poses=True), Observer()
    for packet in shifted:
        observer.take(packet, session.feed(packet))
    assert observer.now == pytest.approx(shifted[-1].t, abs=0.1)
    assert observer.covered_time.total == pytest.approx(shifted[-1].t - 1000.0, abs=1.0)
    for line in status(observer):
        assert " 100 Hz" in line or " 99 Hz" in line, line


def test_a_link_is_lost_until_samples_come_that_are_no_stragglers() -> None:
    link = LinkLedger()
    link.add_event(Connected(t=0.0, known_at=0.0, site=LEFT, device="", name="sole", signal=-50))
    assert link.state(0.0) == "waiting"
    link.add_sample(0.1, 0.1)
    assert (link.state(0.2), link.state(2.0)) == ("ok", "silent")
    link.add_event(Disconnected(t=1.0, known_at=1.0, site=LEFT))
    link.add_sample(1.1, 1.2)
    assert link.state(1.2) == "lost"
    link.add_sample(3.0, 3.0)
    assert (link.state(3.0), link.name, link.connections) == ("ok", "sole", 1)


def test_the_recent_means_equal_those_of_the_session() -> None:
    session, observer = Session(poses=True), Observer()
    for packet in insoles(SHORT.walk(30.0, 1.3)).packets:
        observer.take(packet, session.feed(packet))
    observer.take(None, session.finish())
    assert session.gait is not None and observer.recent_gait.parameters == session.gait


def test_events_with_a_number_that_is_not_finite_are_left_out() -> None:
    observer = Observer()
    assert not observer.add(evolve(moved(1.0, 1.0), position=(nan, 0.0, 0.0)))
    assert not observer.add(PacketsLost(t=nan, known_at=1.0, site=LEFT, channel="insole/frame", count=2))
    assert observer == Observer()


def test_a_live_track_is_bounded_and_keeps_its_start_and_both_feet() -> None:
    track = LiveTrack()
    for k in range(5 * MAX_POINTS):
        for foot in Foot:
            track.add(foot, 0.2 * k, 0.0)
    assert len(track.points) <= MAX_POINTS and track.points[0] == (Foot.LEFT, 0.0, 0.0)
    counts = [sum(point[0] is foot for point in track.points) for foot in Foot]
    assert min(counts) > 0.4 * sum(counts)
    assert track.points[-1][1] > 0.99 * 0.2 * 5 * MAX_POINTS
