"""Properties of the wire formats for any bytes and any records."""

from __future__ import annotations

import pytest
from any_packets import damaged, packets_of
from formats import FORMATS
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.wire import fragment
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


def test_a_fragment_never_starts_as_a_frame_does() -> None:
    first_bytes = {
        fragment.build_fragment(fragment.Fragment(frame_id, last, index, b"x"))[0]
        for frame_id in range(fragment.FRAME_ID_COUNT)
        for last in (False, True)
        for index in range(fragment.MAX_FRAGMENTS)
    }
    assert len(first_bytes) == fragment.FRAME_ID_COUNT * 2 * fragment.MAX_FRAGMENTS
    assert MAGIC not in first_bytes
