"""A site is bound to the address of a device, in whatever letters the app writes it."""

from __future__ import annotations

from attrs import evolve
from walks import LEFT, insoles

from solepath import Session


def test_a_site_that_is_bound_again_to_its_device_in_other_letters_forgets_nothing() -> None:
    session = Session(devices={LEFT: "c0:ff:ee:00:00:0a"})
    session.feed([evolve(packet, device="C0:FF:EE:00:00:0A") for packet in insoles().packets if packet.site is LEFT])
    before = session.snapshot()
    session.bind(LEFT, "C0:FF:ee:00:00:0A")
    assert session.snapshot() == before and session.position is not None
