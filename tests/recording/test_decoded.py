"""Samples in place of packets: those of the devices of an app, and the samples of a session with their poses."""

from __future__ import annotations

from typing import Any

import pytest
from toys import KIND, Toy
from walks import insoles, of, samples

from solepath import FootMoved, Packet, Sample, Session, Site
from solepath.link.decoder import Decoder
from solepath.link.kinds import make_kinds
from solepath.recording.decoded import decode_own
from solepath.recording.posed import PosedSession


@pytest.mark.parametrize("name", KIND)
def test_the_packets_of_the_devices_of_an_app_become_samples_and_all_others_stay(name: str) -> None:
    driver = KIND[name]
    fields = [{"number": k, "ticks": 10_000 * k, "count": 1, "up": [9.0 + 0.01 * k]} for k in range(60)]
    sent = [
        Packet(1.0 + 0.01 * k, site, "toy/data", driver.write("toy/data", value))
        for k, value in enumerate(fields)
        for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)
    ]
    broken = Packet(1.3, Site.LEFT_FOOT, "toy/data", b"?")
    others: list[Any] = [*insoles().packets[:20], *samples()[:5]]
    found = [*decode_own([*sent, *others, broken], make_kinds([driver]))]
    assert [one for one in found if one in others] == others
    for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT):
        toy = Toy(driver, Decoder(site))
        expected = [
            one for packet in sent if packet.site is site for one in toy.receive(packet.t, "data", packet.data, site)
        ]
        own = [one for one in found if one not in others and one.site is site]
        assert own == of(Sample, expected + toy.decoder.finish()) and len(own) >= 59


@pytest.mark.parametrize("kind", ["packets", "samples"])
def test_a_session_whose_samples_are_kept_says_the_same_and_each_has_the_pose_of_its_foot(kind: str) -> None:
    posed, plain = PosedSession(Session(poses=True)), Session(poses=True)
    taken, moved = [], []
    for item in insoles().packets if kind == "packets" else samples():
        events = posed.session.feed(item)
        assert events == plain.feed(item)
        moved += of(FootMoved, events)
        taken += posed.take()
    assert posed.session.finish() == plain.finish()
    assert [(one.sample.site.foot, one.sample.t) for one in taken] == [(event.foot, event.t) for event in moved]
    for one, event in zip(taken, moved, strict=True):
        if one.state is None:
            assert one.sample.t < 0.5, "its attitude is not known yet"
            continue
        assert (one.state.position, one.state.velocity) == (event.position, event.velocity)
        assert one.state.phase is event.phase
    assert len(taken) > 500 and any(one.state is not None for one in taken[:60])
    with pytest.raises(ValueError, match="from its start"):
        PosedSession(plain)
