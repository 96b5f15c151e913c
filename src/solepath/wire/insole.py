"""The insole frame, version 1 (protocol/insole.md): several samples of one foot with sequence, ticks and CRC."""

from __future__ import annotations

from functools import lru_cache
from struct import Struct
from struct import error as StructError
from typing import Any

from ..types import Foot
from ..types.attrs import define, frozen
from .cells import pack12, packed_size, unpack12
from .envelope import CRC_SIZE, FRAME_TYPE, MAGIC, check_end, check_start, seal
from .fields import malformed

MAX_CELLS = 128
"""Largest number of pressure cells of an insole."""

_RIGHT_FLAG, _IMU_FLAG, _QUAT_FLAG, _SATURATED_FLAG, _RETRANSMITTED_FLAG = 1, 2, 4, 8, 16
_RESERVED_FLAGS = 0xE0
_SENSOR_FLAGS = _IMU_FLAG | _QUAT_FLAG


@frozen
class InsoleSample:
    """One sample in raw counts, whose scales are in INFO.

    `cells`: pressure of each cell, 0 to 4095, in the layout's order. `imu`: specific force x, y, z and angular rate
    x, y, z, i16, sensor frame. `quat`: attitude w, x, y, z, sensor to world; 16384 stands for 1."""

    cells: tuple[int, ...]
    imu: tuple[int, int, int, int, int, int] | None = None
    quat: tuple[int, int, int, int] | None = None


@define
class InsoleFrame:
    """One notification of an insole: samples at equal time intervals, with the same cells and sensors in each.

    `layout`: id of the cell layout that INFO describes. `sequence`: u16, one more for each frame. `ticks`: u32, time of
    the first sample. `interval`: ticks from one sample to the next, 1 to 65535. `saturated`: True if an IMU axis or a
    cell was at its limit. `retransmitted`: True if the frame was sent again on request."""

    foot: Foot
    layout: int
    sequence: int
    ticks: int
    interval: int
    samples: tuple[InsoleSample, ...]
    saturated: bool = False
    retransmitted: bool = False


_HEADER = Struct("<BBBBHIHBB")
"""Magic, type, flags, layout, sequence, ticks, interval, number of samples, and number of cells of each."""
_HEADER_NUMBERS = 9
"""Number of numbers in the header."""


@lru_cache(maxsize=16)
def _frame_struct(sensors: int, count: int, cells: int) -> Struct:
    """Return the definition of a whole frame: header, samples, CRC; `sensors` are the flags of IMU and quaternion.

    A sample has its packed cells, six numbers of the IMU, and four of the quaternion. One call of `struct` for all of
    them takes a fifth of the time of a construct for each part."""
    imu, quat = "6h" if sensors & _IMU_FLAG else "", "4h" if sensors & _QUAT_FLAG else ""
    return Struct(_HEADER.format + count * f"{packed_size(cells)}s{imu}{quat}" + "H")


def parse_frame(data: bytes) -> InsoleFrame:
    """Return the frame in `data`; WireError for any other bytes."""
    data = bytes(data)
    check_start(data, FRAME_TYPE, _HEADER.size)
    _, _, flags, layout, sequence, ticks, interval, count, cells = _HEADER.unpack_from(data)
    whole = _frame_struct(flags & _SENSOR_FLAGS, count, cells)
    check_end(data, whole.size)
    problem = _find_problem(flags, interval, count, cells)
    if problem:
        raise malformed(problem)
    numbers, at = whole.unpack(data), _HEADER_NUMBERS
    samples = []
    for _ in range(count):
        packed_cells, imu, quat = numbers[at], None, None
        at += 1
        if flags & _IMU_FLAG:
            imu, at = numbers[at : at + 6], at + 6
        if flags & _QUAT_FLAG:
            quat, at = numbers[at : at + 4], at + 4
        samples.append(InsoleSample(unpack12(packed_cells, cells), imu, quat))
    return InsoleFrame(
        Foot.RIGHT if flags & _RIGHT_FLAG else Foot.LEFT,
        layout,
        sequence,
        ticks,
        interval,
        tuple(samples),
        bool(flags & _SATURATED_FLAG),
        bool(flags & _RETRANSMITTED_FLAG),
    )


def build_frame(frame: InsoleFrame) -> bytes:
    """Return the bytes of `frame`, the inverse of `parse_frame`; ValueError when it does not fit the format."""
    first = frame.samples[0] if frame.samples else InsoleSample(())
    flags = (
        _RIGHT_FLAG * (frame.foot is Foot.RIGHT)
        | _IMU_FLAG * (first.imu is not None)
        | _QUAT_FLAG * (first.quat is not None)
        | _SATURATED_FLAG * frame.saturated
        | _RETRANSMITTED_FLAG * frame.retransmitted
    )
    count, cells = len(frame.samples), len(first.cells)
    problem = _find_problem(flags, frame.interval, count, cells)
    if problem:
        raise ValueError(problem)
    shape = (cells, 6 if first.imu is not None else 0, 4 if first.quat is not None else 0)
    numbers: list[Any] = []
    for sample in frame.samples:
        imu, quat = sample.imu or (), sample.quat or ()
        if (len(sample.cells), len(imu), len(quat)) != shape:
            raise ValueError(
                "the samples of a frame have the same cells and sensors: six numbers of an IMU, four of a quaternion"
            )
        numbers += [pack12(sample.cells), *imu, *quat]
    header = MAGIC, FRAME_TYPE, flags, frame.layout, frame.sequence, frame.ticks, frame.interval, count, cells
    try:
        return seal(_frame_struct(flags & _SENSOR_FLAGS, count, cells).pack(*header, *numbers, 0)[:-CRC_SIZE])
    except StructError as error:
        raise ValueError(f"a number does not fit its place in a frame: {error}") from error


def _find_problem(flags: int, interval: int, count: int, cells: int) -> str:
    """Return a description of an error that length and CRC do not show; "" when there is none."""
    if flags & _RESERVED_FLAGS:
        return f"reserved flags are set: {flags:#04x}"
    if count == 0:
        return "a frame without samples"
    if cells > MAX_CELLS:
        return f"{cells} cells, at most {MAX_CELLS}"
    if cells == 0 and not flags & (_IMU_FLAG | _QUAT_FLAG):
        return "samples with neither cells nor IMU nor quaternion"
    if interval == 0:
        return "an interval of no ticks"
    return ""
