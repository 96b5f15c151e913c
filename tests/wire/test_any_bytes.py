"""Properties of the wire formats for any bytes and any records."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from any_packets import FOOT, U8, U16, U32, damaged, frames, packets_of
from formats import FORMATS
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from solepath.types import Cell
from solepath.wire import cells, fragment, insole, insole_control, insole_info, receiver
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
@given(data=st.binary(max_size=600))
def test_any_bytes_are_a_record_or_a_wire_error(name: str, data: bytes) -> None:
    check_bytes(name, data)


@pytest.mark.parametrize("name", CODECS)
@settings(max_examples=40)
@given(data=st.data())
def test_any_damaged_packet_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    check_bytes(name, data.draw(damaged(SEEDS[name], resealed=False)))


@pytest.mark.parametrize("name", ["insole-frame", "insole-info"])
@given(data=st.data())
def test_damage_under_a_right_crc_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    check_bytes(name, data.draw(damaged(SEEDS[name], resealed=True)))


@pytest.mark.parametrize("name", CODECS)
def test_bytes_in_any_kind_of_buffer_are_read_alike(name: str) -> None:
    parse, _ = CODECS[name]
    valid = [d for d in SEEDS[name] if not _rejected(parse, d)]
    assert valid
    for data in valid:
        assert parse(bytearray(data)) == parse(data) == parse(memoryview(data))  # type: ignore[arg-type]


def _rejected(parse: Callable[[bytes], Any], data: bytes) -> bool:
    try:
        parse(data)
    except WireError:
        return True
    return False


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


@given(frames(), st.integers(0, 10_000), st.integers(1, 255))
def test_no_frame_survives_a_changed_byte(frame: insole.InsoleFrame, position: int, change: int) -> None:
    data = bytearray(insole.build_frame(frame))
    data[position % len(data)] ^= change
    with pytest.raises(WireError):
        insole.parse_frame(bytes(data))


@given(frames(), st.integers(0, 10_000))
def test_no_frame_is_read_from_a_part_of_it(frame: insole.InsoleFrame, length: int) -> None:
    data = insole.build_frame(frame)
    with pytest.raises(WireError, match="truncated"):
        insole.parse_frame(data[: length % len(data)])


SCALE = st.floats(0, 2.0**100, width=32)
CELL = st.builds(
    Cell,
    st.integers(0, 4095).map(lambda n: n / 10_000),
    st.integers(-2048, 2047).map(lambda n: n / 10_000),
    st.sampled_from([0, 1, 625, 65535]).map(lambda n: n / 10_000_000),
)
INFOS = st.builds(
    insole_info.InsoleInfo,
    foot=FOOT,
    layout=U8,
    serial=U32,
    tick_rate=st.integers(1, 2**32 - 1),
    interval=st.integers(1, 65535),
    acc_scale=SCALE,
    gyro_scale=SCALE,
    pressure_scale=SCALE,
    length=U16.map(lambda n: n / 10_000),
    cells=st.lists(CELL, max_size=60).map(tuple),
    firmware=st.text(st.characters(codec="utf-8"), max_size=20),
)


RECORDS = {
    "insole-frame": frames(),
    "insole-info": INFOS,
    "insole-fragment": st.builds(
        fragment.Fragment, st.integers(0, 6), st.booleans(), st.integers(0, 15), st.binary(min_size=1, max_size=511)
    ),
    "insole-control": st.one_of(
        st.builds(insole_control.StartSampling),
        st.builds(insole_control.StopSampling),
        st.builds(insole_control.SetInterval, st.integers(1, 65535)),
        st.builds(insole_control.Resend, U16, st.integers(1, 255)),
    ),
    "device-battery": st.integers(0, 100),
    "device-firmware": st.text(st.characters(codec="utf-8"), min_size=1, max_size=100),
    "receiver-connected": st.builds(
        receiver.ConnectionFrame, st.text(st.characters(codec="utf-8"), max_size=62), st.none() | st.integers(-128, 126)
    ),
    "receiver-dropped": st.integers(1, 2**32 - 1),
    "receiver-trouble": st.text(st.characters(codec="utf-8"), min_size=1, max_size=100),
}


@pytest.mark.parametrize("name", RECORDS)
@given(data=st.data())
def test_every_record_is_read_as_it_was_written(name: str, data: st.DataObject) -> None:
    parse, build = CODECS[name]
    record = data.draw(RECORDS[name])
    assert parse(build(record)) == record


@given(st.lists(st.integers(0, 4095), max_size=260))
def test_twelve_bit_values_are_unpacked_as_they_were_packed(values: list[int]) -> None:
    packed = cells.pack12(values)
    assert len(packed) == cells.packed_size(len(values))
    assert cells.unpack12(packed, len(values)) == tuple(values)


@given(st.lists(st.integers(0, 4095), min_size=1, max_size=130), st.data())
def test_each_cell_is_at_the_bits_of_its_number(values: list[int], data: st.DataObject) -> None:
    number = data.draw(st.integers(0, len(values) - 1))
    bits = int.from_bytes(cells.pack12(values), "little")
    assert bits >> 12 * number & 0xFFF == values[number]


def test_a_fragment_never_starts_as_a_frame_does() -> None:
    first_bytes = {
        fragment.build_fragment(fragment.Fragment(frame_id, last, index, b"x"))[0]
        for frame_id in range(fragment.FRAME_ID_COUNT)
        for last in (False, True)
        for index in range(fragment.MAX_FRAGMENTS)
    }
    assert len(first_bytes) == fragment.FRAME_ID_COUNT * 2 * fragment.MAX_FRAGMENTS
    assert MAGIC not in first_bytes
