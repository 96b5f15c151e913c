"""Faulty constructs and readers of an app: `feed` raises no exception for their results."""

from __future__ import annotations

from math import inf, nan, nextafter
from typing import Any

import pytest
from attrs import evolve
from construct import ExprValidator, Int8ub, Struct, Terminated
from toys import BASE, BOTH, FORMATS, TICKING, Toy, data, more, toy
from walks import of

from solepath.events import PacketRejected, Rejection
from solepath.link.driver import Driver, Measured, Reading
from solepath.saving import codec

ABSURD, MALFORMED = Rejection.ABSURD, Rejection.MALFORMED
HUGE = 10**400
G3, G4 = (0.0, 0.0, 9.8), (1.0, 0.0, 0.0, 0.0)
BOUNDS: dict[str, tuple[Any, Any]] = {
    "battery": (0.0, 1.0),
    "rate": (0.1, 10_000.0),
    "air_pressure": (-1e8, 1e8),
    "sequence": (1 - 2**64, 2**64 - 1),
    "ticks": (1 - 2**64, 2**64 - 1),
    "interval": (1, 10_000_000),
}
"""Smallest and largest number of each field of a Reading of a device with 1,000,000 ticks a second."""
VECTORS = {"acc": G3, "gyro": G3, "mag": G3, "quat": G4, "pressure": (1.0, 2.0), "air_pressure": (1e5,)}
"""A value of each quantity of a sample; air pressure is a number, not a tuple."""
OF_ANOTHER_TYPE = (
    *[Reading(**{name: wrong}) for name in (*BOUNDS, "period", "mag", "keys", "foot", "layout") for wrong in ("x", {})],
    *[Reading(silent=1), Reading(keys=(1,)), Reading(sequence=True, samples=(Measured(G3),)), Reading(known=[1.0])],
    *[Reading(known={1: 2.0}), Reading(known={"mode": "fast"}), Reading(known={"a\n": 1.0}), Reading(samples=5)],
    *[Reading((G3,)), Reading((Measured(saturated=0.5),)), Reading(known={"n" * 81: 1.0}), None, "reading"],
)  # fmt: skip


def reason_of(reading: Any, driver: Driver = BOTH) -> str:
    """Return why a reading is rejected, "" if it is not; one that is rejected changes nothing."""

    def reader(sent: Any, known: Any) -> Any:
        return data(sent, known) if sent.number else reading

    device = toy(evolve(driver, readers={"toy/data": reader, "toy/more": more}))
    for k in range(5):
        device.packet(k)
    before = codec.save(device.decoder)
    rejected = of(PacketRejected, device.receive(10.06, "data", bytes(11)))
    assert not rejected or codec.save(device.decoder) == before
    return rejected[0].reason.value if rejected else ""


def of_samples(**values: Any) -> Reading:
    return Reading((Measured(**values),), sequence=6, ticks=2**32 - 1_940_000)


@pytest.mark.parametrize("name", BOUNDS)
def test_a_number_of_a_reading_is_used_up_to_its_ends_and_not_beyond(name: str) -> None:
    low, high = BOUNDS[name]
    step = 1 if isinstance(low, int) else 0.0
    for number in (low, high):
        assert reason_of(Reading(**{name: number})) == ""
    beyond = (low - 1, high + 1) if step else (nextafter(low, -inf), nextafter(high, inf))
    reasons = ["malformed" if name == "interval" else "absurd value", "absurd value"]
    assert [reason_of(Reading(**{name: number})) for number in beyond] == reasons
    assert reason_of(Reading(**{name: HUGE})) == "absurd value"
    if not step:
        assert {reason_of(Reading(**{name: number})) for number in (nan, inf, -inf)} == {"not finite"}


def test_a_period_is_of_a_device_without_counters_and_from_a_tenth_of_a_millisecond_to_10_s() -> None:
    numbers = (nextafter(1e-4, 0.0), 1e-4, 10.0, nextafter(10.0, inf))
    assert [reason_of(Reading(period=number), BASE) for number in numbers] == ["absurd value", "", "", "absurd value"]
    assert reason_of(Reading(period=1.0)) == "malformed"


@pytest.mark.parametrize("name", VECTORS)
def test_a_quantity_of_a_sample_has_its_numbers_within_the_largest(name: str) -> None:
    values = VECTORS[name]
    for place in range(len(values)):
        for number, reason in ((1e8, ""), (-1e8, ""), (nextafter(1e8, inf), "absurd value"), (nan, "not finite"),
                               (-HUGE, "absurd value"), ("a", "malformed"), (None, "malformed")):  # fmt: skip
            changed: Any = (*values[:place], number, *values[place + 1 :])
            if name == "air_pressure" and number is None:
                continue
            if name == "pressure" and reason in ("absurd value", "not finite"):
                reason = ""  # it costs the cell
            assert reason_of(of_samples(**{name: changed[0] if name == "air_pressure" else changed})) == reason
    too_many: Any = (0.0,) * (513 if name == "pressure" else 5)
    for wrong in ([*values], "text", too_many, values[:-1] if len(values) > 2 else "x"):
        assert reason_of(of_samples(**{name: wrong})) in ("malformed", "absurd value")


@pytest.mark.parametrize("reading", OF_ANOTHER_TYPE, ids=lambda reading: repr(reading)[:50])
def test_what_is_of_another_type_is_rejected(reading: Any) -> None:
    assert reason_of(reading) in ("malformed", "absurd value")


def test_readings_hold_at_most_512_samples_and_64_known_numbers() -> None:
    assert reason_of(evolve(of_samples(), samples=(Measured(G3),) * 512)) == ""
    assert reason_of(evolve(of_samples(), samples=(Measured(G3),) * 513)) == "absurd value"
    known = {f"n{k}": float(k) for k in range(64)}
    assert reason_of(Reading(known=known)) == ""
    assert reason_of(Reading(known={**known, "more": 1.0})) == "absurd value"
    assert [reason_of(Reading(known={"acc_range": value})) for value in (0.0, -8.0, 1e-9)] == ["absurd value"] * 2 + [
        ""
    ]


def assert_rejected(device: Toy, value: bytes, reason: Rejection, channel_name: str = "data") -> None:
    before = codec.save(device.decoder)
    (reported,) = device.receive(10.06, channel_name, value)
    assert isinstance(reported, PacketRejected) and reported.reason is reason, reported
    assert codec.save(device.decoder) == before


REJECTED = {
    "what its reader does not know": ("more", b"\x63" + bytes(8), Rejection.MALFORMED),
    "samples on another channel": ("more", b"\x09" + bytes(8), Rejection.MALFORMED),
    "a division by zero": ("more", b"\x0a" + bytes(8), Rejection.MALFORMED),
    "a missing key": ("more", b"\x0b" + bytes(8), Rejection.MALFORMED),
    "the other foot": ("more", b"\x05" + bytes(8), Rejection.WRONG_SITE),
    "acceleration that is no number": ("data", bytes(6) + b"\x01\x7f\xc0\x00\x00", Rejection.NOT_FINITE),
}


@pytest.mark.parametrize("name", REJECTED)
def test_an_unusable_value_is_rejected_and_changes_nothing(name: str) -> None:
    channel_name, value, reason = REJECTED[name]
    device = toy(BOTH)
    for k in range(5):
        device.packet(k)
    assert_rejected(device, value, reason, channel_name)


def test_a_construct_that_cannot_make_anything_of_bytes_rejects_them() -> None:
    divides = ExprValidator(Int8ub, lambda value, context: 1 / value > 0)
    device = toy(evolve(TICKING, formats={**FORMATS, "toy/more": Struct("what" / divides, Terminated)}, readers={}))
    device.packet(1)
    assert_rejected(device, b"\x00", MALFORMED, "more")
