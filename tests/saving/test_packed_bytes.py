"""Packed bytes: numbers are exact to the bit, and all other bytes raise SnapshotError."""

from __future__ import annotations

import tracemalloc
import zlib
from functools import cache
from typing import Any

import pytest
from attrs import define
from hypothesis import example, given, settings
from hypothesis import strategies as st
from signed import signed
from walks import machines

from solepath import Foot, Session, SnapshotError
from solepath.saving.codec import no_class
from solepath.saving.schema import record_of
from solepath.saving.streams import LARGEST_BODY, Lists, from_bytes, to_bytes
from solepath.session.packed import HEADER

FEW = settings(max_examples=40)


@cache
def packed() -> bytes:
    """In the middle of a walk."""
    machine = machines()["session, whole frames"]
    session = machine.start()
    session.feed(machine.items[: len(machine.items) // 2])
    return bytes(session.pack())


def streams_of(body: bytes | memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    streams = from_bytes(body, no_class)
    return [*streams.floats], [*streams.ints], [*streams.flags], streams.data.read()


def rejected_or_sound(data: bytes) -> None:
    """SnapshotError, or a session that can be packed again."""
    try:
        session = Session.unpack(data)
    except SnapshotError:
        return
    session.pack()


@pytest.mark.parametrize("data", [None, 5, "sole", [], {}, b"", b"sole", bytearray(b"sole"), memoryview(b"x" * 99)])
def test_what_are_no_packed_bytes_is_rejected(data: Any) -> None:
    with pytest.raises(SnapshotError, match="not a packed session"):
        Session.unpack(data)


@given(st.data())
@FEW
def test_every_flipped_bit_is_noticed(data: st.DataObject) -> None:
    saved = bytearray(packed())
    at = data.draw(st.integers(0, len(saved) - 1))
    saved[at] ^= 1 << data.draw(st.integers(0, 7))
    with pytest.raises(SnapshotError):
        Session.unpack(bytes(saved))


@given(st.data(), st.integers(1, 40), st.sampled_from(["flip", "cut", "insert", "zero", "fill"]))
@settings(max_examples=60)
def test_damage_behind_a_right_checksum_is_always_rejected(data: st.DataObject, length: int, how: str) -> None:
    saved = packed()
    at = HEADER.size + data.draw(st.one_of(st.integers(0, 40), st.integers(0, len(saved) - HEADER.size - 1)))
    inside = {
        "flip": bytes([saved[at] ^ (1 << length % 8)]) + saved[at + 1 : at + length],
        "cut": b"",
        "insert": bytes(length) + saved[at : at + length],
        "zero": bytes(length),
        "fill": b"\xff" * length,
    }[how]
    rejected_or_sound(signed(saved[:at] + inside + saved[at + length :]))


def test_bytes_that_inflate_to_a_gigabyte_are_rejected_before_that() -> None:
    deflater = zlib.compressobj(1)
    body = b"".join([deflater.compress(bytes(1_000_000)) for _ in range(100)]) + deflater.flush()
    tracemalloc.start()
    with pytest.raises(SnapshotError, match="no state has more than"):
        Session.unpack(signed(packed()[: HEADER.size] + body))
    assert tracemalloc.get_traced_memory()[1] < 4 * LARGEST_BODY
    tracemalloc.stop()


def test_other_versions_forms_and_schemas_are_rejected_by_name() -> None:
    saved = packed()
    magic, form, version, made_with, check = HEADER.unpack_from(saved)
    body = saved[HEADER.size :]
    for header, what in (
        ((form, 0, made_with), "version 0"),
        ((form, 9999, made_with), "version 9999"),
        ((form + 1, version, made_with), f"form {form + 1}"),
        ((form, version, made_with ^ 1), "its schema is another"),
        ((form, 1, made_with), "version 1"),
    ):
        with pytest.raises(SnapshotError, match=what):
            Session.unpack(signed(HEADER.pack(magic, *header, check) + body))


def test_what_is_left_over_in_any_of_the_streams_is_rejected() -> None:
    floats, ints, flags, data = streams_of(memoryview(packed())[HEADER.size :])
    for more in ([[], [], [], []], [[0.5], [], [], []], [[], [0], [], []], [[], [], [False], []], [[], [], [], [b"x"]]):
        streams: Any = [floats + more[0], ints + more[1], flags + more[2], [data, *more[3]]]
        saved = signed(packed()[: HEADER.size] + to_bytes(Lists(*streams)))
        if any(more):
            with pytest.raises(SnapshotError, match="more is packed than a session holds"):
                Session.unpack(saved)
        else:
            assert Session.unpack(saved).pack() == packed()


def test_a_word_before_the_first_is_none() -> None:
    """Python would count from the end."""
    for k, what in ((0, Foot.LEFT), (1, Foot.RIGHT), (-1, None), (-2, None), (2, None)):
        streams = from_bytes(to_bytes(Lists([], [k], [], [])), no_class)
        if what is not None:
            assert record_of(Worded).read(None, streams) == Worded(what)
        else:
            with pytest.raises((SnapshotError, IndexError)):
                record_of(Worded).read(None, streams)


@define
class Worded:
    """A record of one word."""

    foot: Foot


_FLOATS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -0.0, 5e-324, 1.7976931348623157e308, 3.4028235677973366e38, 2.0**53]),
)


@given(
    st.lists(_FLOATS),
    st.lists(st.one_of(st.integers(), st.integers(-300, 300), st.integers(-(2**70), 2**70))),
    st.lists(st.booleans()),
    st.lists(st.binary()),
)
@example([1.5, 1.5, 0.1, -0.0, 0.1], [-(2**63), 2**63, 2**63 - 1, 1 - 2**63], [], [])
@settings(max_examples=100)
def test_every_number_comes_back_to_the_bit(
    floats: list[float], ints: list[int], flags: list[bool], data: list[bytes]
) -> None:
    found = streams_of(to_bytes(Lists(floats, ints, flags, data)))
    assert repr(found) == repr((floats, ints, flags, b"".join(data)))
