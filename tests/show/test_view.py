"""Tests tables, plots and summaries for people."""

from attrs import evolve
from strides import stride

from solepath.events import Defect, DefectFound, Flaw, HeelStrike, Limitation, PacketRejected, Rejection, SampleGap
from solepath.session import Session
from solepath.show.findings import Concern, texts
from solepath.show.tables.summary import status, summary
from solepath.types import Foot, Packet, Sample, Site
from solepath.walk.walk import Walk

STRIDE = stride(
    Foot.LEFT, 2.0, (1.25, 0.0, 0.0), known_at=2.0625, position=(1.25, 0.0, 0.0), flaws=(Flaw.GAP,),
    covariance=(1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4),
)  # fmt: skip


def test_a_summary_counts_the_events_of_each_foot():
    walk = Walk()
    for n in range(11):
        walk.take(Sample(n * 0.25 + (1.5 if n > 5 else 0.0), Site.LEFT_FOOT), [])
    strike = HeelStrike(t=1.9375, known_at=2.0, foot=Foot.LEFT)
    gap = SampleGap(t=1.25, known_at=3.0, site=Site.LEFT_FOOT, duration=1.75, count=6)
    walk.take(None, [gap, strike, evolve(strike, final=False), STRIDE])
    left, link = walk.feet[Foot.LEFT], walk.links[Site.LEFT_FOOT]
    assert (link.samples, link.missing, link.missing_time, link.rate) == (11, 6, 1.5, 4.0)
    assert (left.events["heel-strike"], left.strides, left.degraded, left.distance) == (1, 1, 1, 1.25)
    text = summary(walk, title="walk.npz", seconds=2.0)
    assert text.splitlines()[0] == "walk.npz: 4.0 s"
    assert (
        "left foot: 1 of 1 stride degraded: a gap of more than 60 ms and two samples in 1" in text
        and "2 times as fast as walked" in text
    )


def test_a_healthy_link_is_not_mentioned_and_a_bad_one_line_by_line():
    walk = Walk()
    assert texts(walk, Concern.LINK) == []
    frame = Packet(1.0, Site.LEFT_FOOT, "insole/frame", b"")
    for _ in range(97):
        walk.take(frame, [])
    walk.add(SampleGap(t=0.0, known_at=1.0, site=Site.LEFT_FOOT, duration=0.04, count=3))
    for reason in (Rejection.CHECKSUM, Rejection.DUPLICATE, Rejection.CHECKSUM):
        rejected = PacketRejected(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, channel="insole/frame", reason=reason)
        walk.take(frame, [rejected])
    missing = "left foot: 3 of 100 samples missing (3.0 %, 0.00 s)"
    assert texts(walk, Concern.LINK) == [missing, "left foot: 3 packets rejected (checksum 2, duplicate 1)"]


def test_defects_are_the_first_lines_of_a_summary_and_limitations_are_reported():
    walk = Walk()
    walk.add(Limitation(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, what="no gyroscope"))
    walk.add(DefectFound(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, defect=Defect.WRONG_SCALE, what="reads 4.9"))
    text = summary(walk, title="walk", seconds=0.0)
    assert "limitation, left foot: no gyroscope" in text
    assert text.splitlines()[1] == "DEFECT, left foot: reads 4.9"


def test_control_codes_of_devices_do_not_reach_the_terminal():
    walk, packet = Walk(), Packet(1.0, Site.LEFT_FOOT, "receiver/trouble", b"\x1b[31mA\x07 is none")
    walk.take(packet, Session().feed(packet))
    for text in (*status(walk), *texts(walk, Concern.LINK)):
        assert text.isprintable() and "A" in text
