"""What holds on the wire for all bytes and for all records."""

from __future__ import annotations

import json
from binascii import crc_hqx
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from hypothesis import assume, given
from hypothesis import strategies as st

from solepath.types import Cell, Foot
from solepath.wire import cc2541, cc2650, cells, device, fragment, insole, insole_control, insole_info, period
from solepath.wire.error import WireError

VECTORS = Path(__file__).parent.parent / "protocol" / "vectors"

CODECS: dict[str, tuple[Callable[[bytes], Any], Callable[[Any], bytes]]] = {
    "insole-frame": (insole.parse_frame, insole.build_frame),
    "insole-fragment": (fragment.parse_fragment, fragment.build_fragment),
    "insole-info": (insole_info.parse_info, insole_info.build_info),
    "insole-control": (insole_control.parse_control, insole_control.build_control),
    "cc2650-movement": (cc2650.parse_movement, cc2650.build_movement),
    "cc2650-movement-config": (cc2650.parse_movement_config, cc2650.build_movement_config),
    "cc2650-barometer": (cc2650.parse_barometer, cc2650.build_barometer),
    "cc2650-keys": (cc2650.parse_keys, cc2650.build_keys),
    "cc2541-accelerometer": (cc2541.parse_accelerometer, cc2541.build_accelerometer),
    "cc2541-accelerometer-config": (cc2541.parse_accelerometer_config, cc2541.build_accelerometer_config),
    "cc2541-gyroscope": (cc2541.parse_gyroscope, cc2541.build_gyroscope),
    "cc2541-gyroscope-config": (cc2541.parse_gyroscope_config, cc2541.build_gyroscope_config),
    "cc2541-magnetometer": (cc2541.parse_magnetometer, cc2541.build_magnetometer),
    "cc2541-barometer": (cc2541.parse_barometer, cc2541.build_barometer),
    "cc2541-barometer-calibration": (cc2541.parse_barometer_calibration, cc2541.build_barometer_calibration),
    "cc2541-keys": (cc2541.parse_keys, cc2541.build_keys),
    "device-battery": (device.parse_battery, device.build_battery),
    "device-firmware": (device.parse_firmware, device.build_firmware),
    "sensortag-period": (period.parse_period, period.build_period),
}


def packets_of(name: str) -> list[bytes]:
    file = json.loads((VECTORS / f"{name}.json").read_text("utf-8"))
    return [bytes.fromhex(vector["hex"]) for vector in file["vectors"]]


SEEDS = {name: packets_of(name) for name in CODECS}


@st.composite
def damaged(draw: st.DrawFn, seeds: list[bytes], resealed: bool) -> bytes:
    """A packet with some bytes changed, cut or lengthened; `resealed` gives it the CRC that fits the damage."""
    data = bytearray(draw(st.sampled_from(seeds)))
    for position, value in draw(st.lists(st.tuples(st.integers(0, 599), st.integers(0, 255)), max_size=4)):
        if position < len(data):
            data[position] = value
    end = draw(st.sampled_from(["as it is", "cut", "lengthened"]))
    if end == "cut":
        del data[draw(st.integers(0, len(data))) :]
    elif end == "lengthened":
        data += draw(st.binary(max_size=20))
    if resealed and len(data) >= 2:
        data[-2:] = crc_hqx(bytes(data[:-2]), 0xFFFF).to_bytes(2, "little")
    return bytes(data)


def read(name: str, data: bytes) -> None:
    """`data` is a record that is written as the same bytes, or a WireError; nothing else may come of it."""
    parse, build = CODECS[name]
    try:
        record = parse(data)
    except WireError:
        return
    assert build(record) == data


@pytest.mark.parametrize("name", CODECS)
@given(data=st.binary(max_size=600))
def test_any_bytes_are_a_record_or_a_wire_error(name: str, data: bytes) -> None:
    read(name, data)


@pytest.mark.parametrize("name", CODECS)
@given(data=st.data())
def test_any_damaged_packet_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    read(name, data.draw(damaged(SEEDS[name], resealed=False)))


@pytest.mark.parametrize("name", ["insole-frame", "insole-info"])
@given(data=st.data())
def test_damage_under_a_right_crc_is_a_record_or_a_wire_error(name: str, data: st.DataObject) -> None:
    read(name, data.draw(damaged(SEEDS[name], resealed=True)))


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


I8, I16 = st.integers(-128, 127), st.integers(-32768, 32767)
U8, U16, U32 = st.integers(0, 255), st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1)
BITS = st.tuples(st.booleans(), st.booleans(), st.booleans())
FOOT = st.sampled_from(Foot)


@st.composite
def frames(draw: st.DrawFn) -> insole.InsoleFrame:
    count, imu, quat = draw(st.integers(0, 128)), draw(st.booleans()), draw(st.booleans())
    size = cells.packed_size(count) + 12 * imu + 8 * quat
    assume(size > 0)
    sample = st.builds(
        insole.InsoleSample,
        cells=st.lists(st.integers(0, 4095), min_size=count, max_size=count).map(tuple),
        imu=st.tuples(*[I16] * 6) if imu else st.none(),
        quat=st.tuples(*[I16] * 4) if quat else st.none(),
    )
    most = min(255, (512 - 16) // size)
    samples = draw(st.lists(sample, min_size=1, max_size=min(most, 4)))
    if draw(st.booleans()):
        samples = (samples * most)[:most]
    return insole.InsoleFrame(
        draw(FOOT),
        draw(U8),
        draw(U16),
        draw(U32),
        draw(st.integers(1, 65535)),
        tuple(samples),
        draw(st.booleans()),
        draw(st.booleans()),
    )


@given(frames())
def test_every_frame_is_read_as_it_was_written(frame: insole.InsoleFrame) -> None:
    assert insole.parse_frame(insole.build_frame(frame)) == frame


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


@given(INFOS)
def test_every_info_is_read_as_it_was_written(info: insole_info.InsoleInfo) -> None:
    assert insole_info.parse_info(insole_info.build_info(info)) == info


OTHERS = {
    "insole-fragment": st.builds(
        fragment.Fragment,
        st.integers(0, 6),
        st.booleans(),
        st.integers(0, 15),
        st.binary(min_size=1, max_size=511),
    ),
    "insole-control": st.one_of(
        st.builds(insole_control.Start),
        st.builds(insole_control.Stop),
        st.builds(insole_control.SetInterval, st.integers(1, 65535)),
        st.builds(insole_control.Resend, U16, st.integers(1, 255)),
    ),
    "cc2650-movement": st.builds(cc2650.Movement, *[st.tuples(I16, I16, I16)] * 3),
    "cc2650-movement-config": st.builds(
        cc2650.MovementConfig, BITS, BITS, st.booleans(), st.booleans(), st.sampled_from([2, 4, 8, 16])
    ),
    "cc2650-barometer": st.builds(
        cc2650.Barometer,
        st.integers(-(2**23), 2**23 - 1).map(lambda n: n / 100),
        st.integers(0, 2**24 - 1).map(float),
    ),
    "cc2650-keys": st.builds(cc2650.Keys, st.booleans(), st.booleans(), st.booleans()),
    "cc2541-accelerometer": st.builds(cc2541.Accelerometer, st.tuples(I8, I8, I8)),
    "cc2541-accelerometer-config": st.builds(cc2541.AccelerometerConfig, st.integers(0, 3)),
    "cc2541-gyroscope": st.builds(cc2541.Gyroscope, st.tuples(I16, I16, I16)),
    "cc2541-gyroscope-config": st.builds(cc2541.GyroscopeConfig, BITS),
    "cc2541-magnetometer": st.builds(cc2541.Magnetometer, st.tuples(I16, I16, I16)),
    "cc2541-barometer": st.builds(cc2541.Barometer, I16, U16),
    "cc2541-barometer-calibration": st.builds(cc2541.BarometerCalibration, *[U16] * 4, *[I16] * 4),
    "cc2541-keys": st.builds(cc2541.Keys, st.booleans(), st.booleans(), st.booleans()),
    "device-battery": st.integers(0, 100),
    "device-firmware": st.text(st.characters(codec="utf-8"), min_size=1, max_size=100),
    "sensortag-period": st.integers(1, 255).map(lambda n: n / 100),
}


@pytest.mark.parametrize("name", OTHERS)
@given(data=st.data())
def test_every_other_record_is_read_as_it_was_written(name: str, data: st.DataObject) -> None:
    parse, build = CODECS[name]
    record = data.draw(OTHERS[name])
    assert parse(build(record)) == record


@given(st.lists(st.integers(0, 4095), max_size=260))
def test_twelve_bit_values_are_unpacked_as_they_were_packed(values: list[int]) -> None:
    packed = cells.pack12(values)
    assert len(packed) == cells.packed_size(len(values))
    assert cells.unpack12(packed, len(values)) == tuple(values)


@given(st.lists(st.integers(0, 4095), min_size=1, max_size=130), st.data())
def test_each_cell_lies_where_its_number_says(values: list[int], data: st.DataObject) -> None:
    number = data.draw(st.integers(0, len(values) - 1))
    bits = int.from_bytes(cells.pack12(values), "little")
    assert bits >> 12 * number & 0xFFF == values[number]


SAMPLE = insole.InsoleSample((1, 2), (0, 0, 0, 0, 0, 0))
FRAME = insole.InsoleFrame(Foot.LEFT, 1, 2, 3, 4, (SAMPLE,))
INFO = insole_info.InsoleInfo(Foot.LEFT, 1, 2, 32768, 327, 0.5, 0.25, 0.125, 0.27, (Cell(0.1, 0.0),), "1")


def frame_of(*samples: insole.InsoleSample) -> insole.InsoleFrame:
    return evolve(FRAME, samples=samples)


MISFITS: dict[str, tuple[Callable[[Any], bytes], Any]] = {
    "a frame without samples": (insole.build_frame, frame_of()),
    "a frame of empty samples": (insole.build_frame, frame_of(insole.InsoleSample(()))),
    "a cell over 4095": (insole.build_frame, frame_of(insole.InsoleSample((4096,)))),
    "a cell under 0": (insole.build_frame, frame_of(insole.InsoleSample((-1,)))),
    "129 cells": (insole.build_frame, frame_of(insole.InsoleSample((0,) * 129))),
    "samples of different cells": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, cells=(1,)))),
    "samples of different sensors": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, imu=None))),
    "an angular rate over i16": (insole.build_frame, frame_of(evolve(SAMPLE, imu=(0, 0, 0, 0, 0, 32768)))),
    "a frame over 512 bytes": (insole.build_frame, frame_of(*[SAMPLE] * 40)),
    "256 samples": (insole.build_frame, frame_of(*[insole.InsoleSample((1,))] * 256)),
    "a sequence over u16": (insole.build_frame, evolve(FRAME, sequence=65536)),
    "a sequence under 0": (insole.build_frame, evolve(FRAME, sequence=-1)),
    "ticks over u32": (insole.build_frame, evolve(FRAME, ticks=2**32)),
    "an interval of zero": (insole.build_frame, evolve(FRAME, interval=0)),
    "a layout over u8": (insole.build_frame, evolve(FRAME, layout=256)),
    "fragment id 7": (fragment.build_fragment, fragment.Fragment(7, False, 0, b"a")),
    "fragment index 16": (fragment.build_fragment, fragment.Fragment(0, False, 16, b"a")),
    "an empty fragment": (fragment.build_fragment, fragment.Fragment(0, False, 0, b"")),
    "a fragment over 512 bytes": (fragment.build_fragment, fragment.Fragment(0, False, 0, bytes(512))),
    "a cell behind the heel": (insole_info.build_info, evolve(INFO, cells=(Cell(-0.001, 0.0),))),
    "a cell half a metre ahead": (insole_info.build_info, evolve(INFO, cells=(Cell(0.5, 0.0),))),
    "a cell far to the left": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.205),))),
    "a cell nowhere": (insole_info.build_info, evolve(INFO, cells=(Cell(float("nan"), 0.0),))),
    "a cell as large as a table": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.0, 1.0),))),
    "129 cells in info": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.0),) * 129)),
    "128 cells of different areas": (
        insole_info.build_info,
        evolve(INFO, cells=tuple(Cell(0.1, 0.0, n / 10_000_000) for n in range(128))),
    ),
    "a firmware name that does not fit": (insole_info.build_info, evolve(INFO, firmware="n" * 256)),
    "a scale that is no number": (insole_info.build_info, evolve(INFO, acc_scale=float("nan"))),
    "a scale under 0": (insole_info.build_info, evolve(INFO, gyro_scale=-1.0)),
    "a scale beyond binary32": (insole_info.build_info, evolve(INFO, pressure_scale=1e300)),
    "a tick rate of zero": (insole_info.build_info, evolve(INFO, tick_rate=0)),
    "a length over u16": (insole_info.build_info, evolve(INFO, length=7.0)),
    "set interval to zero": (insole_control.build_control, insole_control.SetInterval(0)),
    "set interval over u16": (insole_control.build_control, insole_control.SetInterval(65536)),
    "resend nothing": (insole_control.build_control, insole_control.Resend(0, 0)),
    "resend 256": (insole_control.build_control, insole_control.Resend(0, 256)),
    "a movement count over i16": (
        cc2650.build_movement,
        cc2650.Movement((0, 0, 32768), (0, 0, 0), (0, 0, 0)),
    ),
    "a range of 3 g": (cc2650.build_movement_config, cc2650.MovementConfig(range=3)),
    "a temperature over i24": (cc2650.build_barometer, cc2650.Barometer(83886.08, 0.0)),
    "a pressure over u24": (cc2650.build_barometer, cc2650.Barometer(0.0, 2.0**24)),
    "a pressure under 0": (cc2650.build_barometer, cc2650.Barometer(0.0, -1.0)),
    "an infinite pressure": (cc2650.build_barometer, cc2650.Barometer(0.0, float("inf"))),
    "an acceleration over i8": (cc2541.build_accelerometer, cc2541.Accelerometer((0, 0, 128))),
    "range code 4": (cc2541.build_accelerometer_config, cc2541.AccelerometerConfig(4)),
    "an angular rate under i16": (cc2541.build_gyroscope, cc2541.Gyroscope((-32769, 0, 0))),
    "a field over i16": (cc2541.build_magnetometer, cc2541.Magnetometer((32768, 0, 0))),
    "a raw pressure under 0": (cc2541.build_barometer, cc2541.Barometer(0, -1)),
    "a signed c1": (
        cc2541.build_barometer_calibration,
        cc2541.BarometerCalibration(-1, 0, 0, 0, 0, 0, 0, 0),
    ),
    "101 percent": (device.build_battery, 101),
    "an empty firmware revision": (device.build_firmware, ""),
    "a long firmware revision": (device.build_firmware, "n" * 513),
    "no period": (period.build_period, 0.0),
    "a period over 2.55 s": (period.build_period, 2.56),
    "a period that is no number": (period.build_period, float("nan")),
}


@pytest.mark.parametrize("case", MISFITS)
def test_what_does_not_fit_is_refused_when_written(case: str) -> None:
    build, record = MISFITS[case]
    with pytest.raises(ValueError) as caught:
        build(record)
    assert not isinstance(caught.value, WireError)


def test_seventeen_fragments_are_refused() -> None:
    data = insole.build_frame(frame_of(insole.InsoleSample((0,) * 96)))
    with pytest.raises(ValueError, match="16 fragments"):
        fragment.split(data, len(data) // 17, 0)


def test_a_fragment_never_begins_as_a_frame_does() -> None:
    heads = {
        fragment.build_fragment(fragment.Fragment(frame_id, last, index, b"x"))[0]
        for frame_id in range(fragment.FRAME_IDS)
        for last in (False, True)
        for index in range(fragment.MAX_FRAGMENTS)
    }
    assert len(heads) == fragment.FRAME_IDS * 2 * fragment.MAX_FRAGMENTS
    assert insole.build_frame(FRAME)[0] not in heads
