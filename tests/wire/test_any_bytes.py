"""Properties of the wire formats for any bytes and any records."""

from __future__ import annotations

import pytest
from any_packets import damaged, frames, packets_of
from formats import FORMATS
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from solepath.wire import fragment, insole
from solepath.wire.envelope import MAGIC
from solepath.wire.error import WireError

CODECS = {name: (wire_format.parse, wire_format.build) for name, wire_format in FORMATS.items()}


SEEDS = {name: packets_of(name) for name in CODECS}


def check_bytes(name: str, data: bytes) -> None:
    """Check that `data` is parsed to a record that builds the same bytes, or raises WireError."""
    parse, build = CODECS[name]
    try:
        record = parse(data)
    except WireError:
        return
    assert build(record) == data


@pytest.mark.parametrize("name", CODECS)
@settings(max_examples=40)
@given(data=st.data())
def test_any_damaged_packet_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    check_bytes(name, data.draw(damaged(SEEDS[name], resealed=False)))


@pytest.mark.parametrize("name", ["insole-frame", "insole-info"])
@given(data=st.data())
def test_damage_under_a_right_crc_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    check_bytes(name, data.draw(damaged(SEEDS[name], resealed=True)))


@settings(max_examples=40)
@given(frames(), st.integers(2, 600), st.integers(0, 6))
def test_every_frame_that_is_cut_can_be_joined(frame: insole.InsoleFrame, payload: int, frame_id: int) -> None:
    data = insole.build_frame(frame)
    assume(len(data) <= 16 * (payload - 1))
    notifications = fragment.split(data, payload, frame_id)
    assert all(0 < len(n) <= payload for n in notifications)
    if notifications != [data]:
        pieces = [fragment.parse_fragment(n) for n in notifications]
        assert [p.index for p in pieces] == list(range(len(pieces)))
        assert [p.last for p in pieces] == [False] * (len(pieces) - 1) + [True]
        assert {p.frame_id for p in pieces} == {frame_id}
        data = b"".join(p.body for p in pieces)
    assert insole.parse_frame(data) == frame


@settings(max_examples=40)
@given(frames(), st.integers(0, 10_000), st.integers(1, 255))
def test_no_frame_survives_a_changed_byte(frame: insole.InsoleFrame, position: int, change: int) -> None:
    data = bytearray(insole.build_frame(frame))
    data[position % len(data)] ^= change
    with pytest.raises(WireError):
        insole.parse_frame(bytes(data))


def test_a_fragment_never_starts_as_a_frame_does() -> None:
    first_bytes = {
        fragment.build_fragment(fragment.Fragment(frame_id, last, index, b"x"))[0]
        for frame_id in range(fragment.FRAME_ID_COUNT)
        for last in (False, True)
        for index in range(fragment.MAX_FRAGMENTS)
    }
    assert len(first_bytes) == fragment.FRAME_ID_COUNT * 2 * fragment.MAX_FRAGMENTS
    assert MAGIC not in first_bytes
