"""Tests the ledger of a link and the walk of a session: each figure by its own definition."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from attrs import evolve
from walks import SHORT, insoles

from solepath import Packet, Sample, Session, Site
from solepath.emulate.radio import CLEAN, Radio
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.show.tables.summary import status
from solepath.walk.walk import Walk

LEFT = Site.LEFT_FOOT


def observed(items: Iterable[Packet | Sample]) -> Walk:
    """Return an walk of a session that was fed with the items."""
    session, walk = Session(poses=True, pressures=True, losses=True), Walk()
    for item in items:
        walk.take(item, session.feed(item))
    walk.take(None, session.finish())
    return walk


def frames(radio: Radio, **device: int) -> tuple[Packet, ...]:
    return emulate(SHORT, devices={LEFT: Insole(**device)}, radio=radio, seed=1).packets


@pytest.mark.parametrize("batch", [1, 4])
def test_the_missing_share_is_that_of_samples_however_many_a_packet_has(batch: int) -> None:
    link = observed(frames(Radio(loss=0.25), cells=8, batch=batch)).links[LEFT]
    assert link.missing_share == pytest.approx(0.25, abs=0.06)
    assert link.samples == batch * link.received


def test_received_and_missing_samples_are_all_that_were_sent_whatever_came_damaged_or_twice() -> None:
    """Each frame comes in fragments, of which any may be lost, damaged or doubled."""
    sent = len(emulate(SHORT, devices={LEFT: Insole(cells=8)}, radio=CLEAN, seed=1).packets)
    rough = Radio(loss=0.03, duplicate=0.05, corrupt=0.05)
    for device in ({"cells": 8}, {"mtu": 60}):
        link = observed(frames(rough, **device)).links[LEFT]
        assert link.rejected.total() > 10 and link.missing > 10
        assert link.received == link.samples
        assert link.samples + link.missing == pytest.approx(sent, abs=6), "what is no frame of samples are a few"


def test_a_clock_that_was_set_back_goes_on_from_there() -> None:
    shifted = [evolve(p, t=p.t + (5000.0 if p.t < 3.0 else 1000.0)) for p in insoles().packets]
    session, walk = Session(poses=True, losses=True), Walk()
    for packet in shifted:
        walk.take(packet, session.feed(packet))
    assert walk.now == pytest.approx(shifted[-1].t, abs=0.1)
    assert walk.covered_time.total == pytest.approx(shifted[-1].t - 1000.0, abs=1.0)
    for line in status(walk):
        assert " 50 Hz" in line or " 49 Hz" in line, line
