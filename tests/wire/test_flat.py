"""The reader of frames is generated from their construct, and reads what the construct reads."""

from __future__ import annotations

from typing import Any

import pytest
from any_packets import damaged, frames, packets_of
from construct import Array, Bytes, If, Int16ub, Int16ul, Int32ul, Sequence, StreamError, Struct, this
from hypothesis import given
from hypothesis import strategies as st

from solepath.events import Rejection
from solepath.types import Foot
from solepath.wire.error import WireError
from solepath.wire.fields import Fields, parse_whole
from solepath.wire.flat import flat_struct
from solepath.wire.insole import FRAME, InsoleFrame, build_frame, parse_frame


def parts(frame: InsoleFrame) -> list[list[Any]]:
    """Return the samples of a frame as the construct parses them."""
    return [[sample.cells, sample.imu, sample.quat] for sample in frame.samples]


@given(frames())
def test_a_frame_is_read_as_its_construct_reads_it(frame: InsoleFrame) -> None:
    data = build_frame(frame)
    parsed = parse_whole(FRAME, data)
    read = parse_frame(data)
    assert parts(read) == [list(sample) for sample in parsed.samples]
    header = parsed.header
    assert (read.layout, read.sequence, read.ticks, read.interval) == tuple(header[3:7])
    flags = (read.foot is Foot.RIGHT, read.saturated, read.retransmitted)
    assert flags == tuple(bool(header.flags & flag) for flag in (1, 8, 16))


@given(frames())
def test_a_frame_is_built_as_its_construct_builds_it(frame: InsoleFrame) -> None:
    data = build_frame(frame)
    assert FRAME.build(FRAME.parse(data)) == data


@given(damaged(packets_of("insole-frame"), resealed=True))
def test_a_packet_that_is_too_short_for_the_construct_is_rejected_as_truncated(data: bytes) -> None:
    try:
        FRAME.parse(data)
    except StreamError:
        with pytest.raises(WireError) as raised:
            parse_frame(data)
        starts_as_frame = data[:2] == bytes.fromhex("f510")[: len(data)]
        assert raised.value.reason is (Rejection.TRUNCATED if starts_as_frame else Rejection.MALFORMED)
    except WireError as error:  # an unused nibble that is not zero
        with pytest.raises(WireError, match="malformed|oversized|truncated"):
            parse_frame(data)
        assert error.reason is Rejection.MALFORMED
    else:
        try:
            read = parse_frame(data)
        except WireError as error:
            assert error.reason in (Rejection.MALFORMED, Rejection.OVERSIZED)
        else:
            assert parts(read) == [list(sample) for sample in FRAME.parse(data).samples]


PARTS = st.sampled_from([Int16ul, Int32ul, Fields("<BbH"), Fields("<6h"), Fields("<2i")])


def flattened(value: Any) -> list[int]:
    """Return the numbers in lists of lists, in order; None is no number."""
    if isinstance(value, (list, tuple)):
        return [number for part in value for number in flattened(part)]
    return [] if value is None else [value]


@given(st.lists(PARTS, min_size=1, max_size=5), st.integers(0, 3), st.booleans(), st.binary(max_size=400))
def test_any_construct_of_numbers_is_read_at_once(subcons: list[Any], count: int, present: bool, data: bytes) -> None:
    definition = Sequence(Fields("<B"), Array(count, Sequence(*subcons)), If(present, Int16ul))
    whole = flat_struct(definition)
    if len(data) < whole.size:
        with pytest.raises(StreamError):
            definition.parse(data)
    else:
        assert list(whole.unpack_from(data)) == flattened(definition.parse(data))


def test_only_what_has_a_notation_in_struct_is_taken() -> None:
    assert flat_struct(Struct("a" / Int16ul, "b" / Fields("<3h"))).format == "<H3h"
    with pytest.raises(TypeError, match="Bytes"):
        flat_struct(Struct("text" / Bytes(this.size)), size=3)
    with pytest.raises(ValueError, match="byte orders"):
        flat_struct(Struct("a" / Int16ul, "b" / Int16ub))
    with pytest.raises(ValueError, match="byte orders"):
        flat_struct(Struct("a" / Fields("<HB"), "b" / Fields(">HB")))
    with pytest.raises(ValueError, match="without its byte order"):
        flat_struct(Fields("HB"))
