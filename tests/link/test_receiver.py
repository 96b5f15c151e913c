"""Packets about the receiver itself, and the device to which a site is bound."""

from __future__ import annotations

from decoded import LEFT, insole_frame

from solepath import (
    BatteryLevel,
    ClockReset,
    Connected,
    Disconnected,
    LinkTrouble,
    Packet,
    PacketRejected,
    PacketsDropped,
    Rejection,
    SampleGap,
    Session,
    StreamRestarted,
)
from solepath.link.decoder import Decoder
from solepath.types import Sample
from solepath.wire.fields import build_text
from solepath.wire.receiver import ConnectionFrame, build_connected, build_dropped

CHARGED = b"\x64"


def packet(t: float, channel: str, data: bytes = b"", device: str = "") -> Packet:
    return Packet(t, LEFT, channel, data, device)


def test_receiver_packets_become_events() -> None:
    session = Session()
    values = [
        ("receiver/connected", build_connected(ConnectionFrame("solepath L", -61))),
        ("receiver/trouble", build_text("the battery is low")),
        ("receiver/dropped", build_dropped(7)),
        ("receiver/restarted", build_text("insole/frame")),
        ("receiver/disconnected", b""),
    ]
    events = session.feed([packet(float(t), *item, device="F0:01") for t, item in enumerate(values)])
    assert events == [
        Connected(t=0.0, known_at=0.0, site=LEFT, device="F0:01", name="solepath L", signal=-61),
        LinkTrouble(t=1.0, known_at=1.0, site=LEFT, what="the battery is low"),
        PacketsDropped(t=2.0, known_at=2.0, site=LEFT, count=7),
        StreamRestarted(t=3.0, known_at=3.0, site=LEFT, channel="insole/frame"),
        Disconnected(t=4.0, known_at=4.0, site=LEFT),
    ]


def test_a_tick_lets_a_silence_become_known_as_advance_does() -> None:
    advanced_session, ticked_session = Session(), Session()
    for session in (advanced_session, ticked_session):
        session.feed(packet(0.0, "insole/frame", insole_frame(1, ticks=0)))
    assert advanced_session.advance(5.0) == ticked_session.feed(packet(5.0, "receiver/tick")) != []


def reasons(session: Session, *packets: Packet) -> list[Rejection | None]:
    """Return the reason why each packet was rejected, None for an accepted packet."""
    reasons_found = []
    for item in packets:
        rejected = [event for event in session.feed(item) if isinstance(event, PacketRejected)]
        reasons_found.append(rejected[0].reason if rejected else None)
    return reasons_found


def test_a_site_is_bound_to_the_first_device_it_receives() -> None:
    sent_packets = [
        packet(0.0, "device/battery", CHARGED),
        packet(1.0, "device/battery", CHARGED, "F0:01"),
        packet(2.0, "device/battery", CHARGED, "F0:02"),
        packet(3.0, "device/battery", CHARGED),
        packet(4.0, "device/battery", CHARGED, "F0:01"),
    ]
    wrong_device = Rejection.WRONG_DEVICE
    assert reasons(Session(losses=True), *sent_packets) == [None, None, wrong_device, wrong_device, None]


def test_receiver_packets_are_accepted_whatever_device_the_site_is_bound_to() -> None:
    session = Session(devices={LEFT: "F0:01"})
    sent_packets = [packet(0.0, "receiver/tick"), packet(1.0, "receiver/disconnected", device="F0:02")]
    assert reasons(session, *sent_packets) == [None, Rejection.WRONG_DEVICE]


def test_a_site_can_be_bound_to_a_new_device_in_mid_walk() -> None:
    session = Session()
    session.feed([packet(0.01 * k, "insole/frame", insole_frame(k), "F0:01") for k in range(50)])
    session.bind(LEFT, "F0:02")
    events = session.feed(packet(0.6, "insole/frame", insole_frame(9000, ticks=77), "F0:02"))
    assert not [event for event in events if isinstance(event, PacketRejected | ClockReset)]
    assert reasons(session, packet(0.7, "device/battery", CHARGED, "F0:01")) == [Rejection.WRONG_DEVICE]
    session.bind(LEFT, "")
    [event] = session.feed(packet(0.8, "device/battery", CHARGED, "F0:03"))
    assert isinstance(event, BatteryLevel)


def test_an_insole_that_restarts_soon_after_its_start_is_not_taken_for_late() -> None:
    decoder = Decoder(site=LEFT)
    for k in range(60):
        decoder.feed(packet(0.01 * k, "insole/frame", insole_frame(k)))
    decoder.feed(packet(0.7, "receiver/disconnected"))
    decoder.feed(packet(0.9, "receiver/connected", build_connected(ConnectionFrame("", None))))
    first, *rest = decoder.feed(packet(1.0, "insole/frame", insole_frame(0)))
    assert isinstance(first, ClockReset) and first.restarted
    assert [type(item) for item in rest] == [SampleGap, Sample]
    [sample] = decoder.feed(packet(1.01, "insole/frame", insole_frame(1)))
    assert isinstance(sample, Sample)
