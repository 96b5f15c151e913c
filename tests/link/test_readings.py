"""Faulty constructs and readers of an app: `feed` raises no exception for their results."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import inf, nan
from typing import Any

import pytest
from attrs import evolve
from construct import Bytes, ExprAdapter, ExprValidator, GreedyBytes, Int8ub, Struct, Terminated, this
from toys import BOTH, FORMATS, LEFT, TICKING, Toy, data, more, toy

from solepath import Packet, Session
from solepath.events import PacketRejected, Rejection
from solepath.link.driver import Measured, Reading
from solepath.saving import codec

ACC_AT_REST = (0.0, 0.0, 9.80665)
HUGE = 10**400
ABSURD, MALFORMED = Rejection.ABSURD, Rejection.MALFORMED


def one(**values: Any) -> Reading:
    return Reading((Measured(**{"acc": ACC_AT_REST, **values}),), sequence=6, ticks=2**32 - 1_940_000)


def numbered(**values: Any) -> Reading:
    return evolve(one(), **values)


READINGS: dict[str, tuple[Any, Rejection]] = {
    "no reading": (None, MALFORMED),
    "samples that are a number": (Reading(5), MALFORMED),  # type: ignore[arg-type]
    "a sample that is none": (Reading((ACC_AT_REST,)), MALFORMED),  # type: ignore[arg-type]
    "more samples than bytes": (numbered(samples=(Measured(ACC_AT_REST),) * 1000), ABSURD),
    "a huge integer": (one(acc=(HUGE, 0, 0)), ABSURD),
    "a full battery in atoms": (Reading(battery=HUGE), ABSURD),
    "two axes": (one(acc=(0.0, 9.8)), MALFORMED),
    "four axes": (one(gyro=(0.0, 9.8, 0.0, 0.0)), MALFORMED),
    "axes in a list": (one(acc=[0.0, 0.0, 9.8]), MALFORMED),
    "axes that are words": (one(acc=("a", 0.0, 1.0)), MALFORMED),
    "a quaternion of three": (one(quat=(1.0, 0.0, 0.0)), MALFORMED),
    "a field of one axis in a sample": (one(mag=(1e-5,)), MALFORMED),
    "a field of one axis": (Reading(mag=(1e-5,)), MALFORMED),  # type: ignore[arg-type]
    "pressure of one number": (one(pressure=3.0), MALFORMED),
    "pressure of 10,000 cells": (one(pressure=(0.0,) * 10_000), ABSURD),
    "air pressure in words": (Reading(air_pressure="high"), MALFORMED),  # type: ignore[arg-type]
    "no number": (one(gyro=(nan, 0.0, 0.0)), Rejection.NOT_FINITE),
    "nearly saturated": (one(saturated=0.5), MALFORMED),
    "half a packet on": (numbered(sequence=6.5), MALFORMED),
    "half a tick on": (numbered(ticks=10.5), MALFORMED),
    "ticks without end": (numbered(ticks=HUGE), ABSURD),
    "numbers below any": (numbered(sequence=-HUGE), ABSURD),
    "an interval without end": (numbered(interval=HUGE), ABSURD),
    "an interval of a day": (numbered(interval=86_400_000_000), ABSURD),
    "no interval": (numbered(interval=0), MALFORMED),
    "a range of nothing": (Reading(known={"acc_range": 0.0}), ABSURD),
    "a range below nothing": (Reading(known={"acc_range": -8.0}), ABSURD),
    "known without end": (Reading(known={"gain": inf}), Rejection.NOT_FINITE),
    "known by a word": (Reading(known={"mode": "fast"}), MALFORMED),  # type: ignore[dict-item]
    "known by a number": (Reading(known={1: 2.0}), MALFORMED),  # type: ignore[dict-item]
    "known as a list": (Reading(known=[1.0]), MALFORMED),  # type: ignore[arg-type]
    "keys in a list": (Reading(keys=["a"]), MALFORMED),  # type: ignore[arg-type]
    "keys by number": (Reading(keys=(1,)), MALFORMED),  # type: ignore[arg-type]
    "a foot by name": (Reading(foot="left"), MALFORMED),  # type: ignore[arg-type]
    "a layout by name": (Reading(layout="left"), MALFORMED),  # type: ignore[arg-type]
    "silence by number": (Reading(silent=1), MALFORMED),  # type: ignore[arg-type]
    "a rate in words": (Reading(rate="fast"), MALFORMED),  # type: ignore[arg-type]
    "a rate without end": (Reading(rate=inf), Rejection.NOT_FINITE),
}


def assert_rejected(device: Toy, value: bytes, reason: Rejection, channel_name: str = "data") -> None:
    before = codec.save(device.decoder)
    (reported,) = device.receive(10.06, channel_name, value)
    assert isinstance(reported, PacketRejected) and reported.reason is reason, reported
    assert codec.save(device.decoder) == before


REJECTED = {
    "too short": ("data", b"\x00" * 10, Rejection.TRUNCATED),
    "too long": ("data", b"\x00" * 12, Rejection.OVERSIZED),
    "no channel of its": ("crumbs", b"", Rejection.UNKNOWN_CHANNEL),
    "what its reader does not know": ("more", b"\x63" + bytes(8), Rejection.MALFORMED),
    "samples on another channel": ("more", b"\x09" + bytes(8), Rejection.MALFORMED),
    "a division by zero": ("more", b"\x0a" + bytes(8), Rejection.MALFORMED),
    "a missing key": ("more", b"\x0b" + bytes(8), Rejection.MALFORMED),
    "the other foot": ("more", b"\x05" + bytes(8), Rejection.WRONG_SITE),
    "a full battery and more": ("more", b"\x00\x40" + bytes(7), Rejection.ABSURD),
    "no rate": ("more", b"\x01" + bytes(8), Rejection.ABSURD),
    "air pressure without end": ("more", b"\x03\x7f\xf0" + bytes(6), Rejection.NOT_FINITE),
    "air pressure of a star": ("more", b"\x03\x7f\xe0" + bytes(6), Rejection.ABSURD),
    "acceleration that is no number": ("data", bytes(6) + b"\x01\x7f\xc0\x00\x00", Rejection.NOT_FINITE),
}


@pytest.mark.parametrize("name", REJECTED)
def test_an_unusable_value_is_rejected_and_changes_nothing(name: str) -> None:
    channel_name, value, reason = REJECTED[name]
    device = toy(BOTH)
    for k in range(5):
        device.packet(k)
    assert_rejected(device, value, reason, channel_name)


@pytest.mark.parametrize("name", READINGS)
def test_a_reading_that_is_none_is_rejected_and_changes_nothing(name: str) -> None:
    reading, reason = READINGS[name]

    def reader(sent: Any, known: Any) -> Reading:
        return reading if sent.number == 0 else data(sent, known)  # type: ignore[no-any-return]

    device = toy(evolve(BOTH, readers={"toy/data": reader, "toy/more": more}))
    for k in range(5):
        device.packet(k)
    assert_rejected(device, bytes(11), reason)
    first = toy(device.driver)
    (reported,) = first.receive(10.0, "data", bytes(11))
    assert isinstance(reported, PacketRejected) and first.decoder.link is None


def is_positive_reciprocal(value: Any, context: Any) -> bool:
    return 1 / value > 0


def choose(value: Any, context: Any) -> Any:
    return ("one", "two")[value]


def fail(value: Any, context: Any) -> Any:
    return float(f"{value} apples")


@pytest.mark.parametrize(
    "part",
    [
        ExprValidator(Int8ub, is_positive_reciprocal),
        ExprAdapter(Int8ub, choose, choose),
        ExprAdapter(Int8ub, fail, fail),
    ],
    ids=["divides", "has no such item", "reads no number"],
)
@pytest.mark.parametrize("first", [True, False])
def test_a_construct_that_cannot_make_anything_of_bytes_rejects_them(part: Any, first: bool) -> None:
    device = toy(evolve(TICKING, formats={**FORMATS, "toy/more": Struct("what" / part, Terminated)}, readers={}))
    if not first:
        device.packet(1)
    assert_rejected(device, b"\x00" if part.__class__ is ExprValidator else b"\x09", MALFORMED, "more")


def test_a_construct_that_needs_a_missing_field_rejects_all() -> None:
    device = toy(evolve(TICKING, formats={**FORMATS, "toy/data": Struct("a" / Bytes(this.nothing), Terminated)}))
    assert_rejected(device, b"123", MALFORMED)


def test_bytes_left_over_are_rejected_though_the_construct_does_not_end_in_terminated() -> None:
    formats = {**FORMATS, "toy/more": Struct("what" / Int8ub), "toy/start": GreedyBytes}
    device = toy(evolve(TICKING, formats=formats, readers={}))
    (reported,) = device.receive(10.0, "more", b"\x01\x02")
    assert isinstance(reported, PacketRejected) and reported.reason is Rejection.OVERSIZED
    assert device.receive(10.0, "more", b"\x01") == device.receive(10.0, "start", b"all of it") == []


def test_a_reader_cannot_change_what_is_known() -> None:
    def reader(sent: Any, known: Any) -> Reading:
        known["times"] = 3.0
        return Reading()

    device = toy(evolve(TICKING, readers={"toy/data": reader}))
    with pytest.raises(TypeError):
        device.packet(0)


def test_what_a_construct_calls_an_integer_can_be_saved() -> None:
    class Number(int):
        """As construct's Enum gives them."""

    def reader(sent: Any, known: Any) -> Reading:
        return evolve(data(sent, known), sequence=Number(sent.number), ticks=Number(sent.ticks))

    device = toy(evolve(BOTH, readers={"toy/data": reader}))
    reported = [device.packet(k) for k in range(3)]
    assert all(reported) and not any([isinstance(one, PacketRejected) for some in reported for one in some])
    json.dumps(codec.save(device.decoder))


def test_a_clock_of_nanoseconds_since_1970_goes_on_the_same_after_it_was_saved() -> None:
    def reader(sent: Any, known: Any) -> Reading:
        return Reading((Measured(ACC_AT_REST),), ticks=1_800_000_000_123_456_789 + 1000 * sent.ticks)

    driver = evolve(TICKING, readers={"toy/data": reader}, tick_rate=1e9, tick_modulus=1 << 64)

    def packets(first: int, last: int) -> list[Packet]:
        write: Callable[[Any], bytes] = lambda k: driver.write(  # noqa: E731
            "toy/data", {"number": k, "ticks": 10_000 * k, "count": 1, "up": [9.8]}
        )
        return [Packet(1.0 + 0.01 * k, LEFT, "toy/data", write(k)) for k in range(first, last)]

    session = Session(poses=True, profiles=[driver])
    session.feed(packets(0, 60))
    restored = Session.restore(json.loads(json.dumps(session.snapshot())), profiles=[driver])
    assert restored.feed(packets(60, 120)) == session.feed(packets(60, 120)) != []
