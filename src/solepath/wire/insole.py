"""The insole frame, version 1 (protocol/insole.md): several samples of one foot with sequence, ticks and CRC."""

from __future__ import annotations

from typing import Any

from attrs import frozen
from construct import Array, If, Struct, Terminated

from ..types import Foot
from .cells import Packed12, packed_size
from .envelope import CRC_SIZE, FRAME, MAGIC, check_end, check_start, seal
from .fields import Fields, Record, build_whole, malformed, parse_whole

MAX_CELLS = 128

_RIGHT, _IMU, _QUAT, _SATURATED, _RETRANSMITTED = 1, 2, 4, 8, 16
_RESERVED_FLAGS = 0xE0


@frozen
class InsoleSample:
    """One sample in raw counts; INFO declares the scales.

    `cells`: pressure, 0 to 4095 each, in the layout's order. `imu`: specific force x, y, z and angular rate x, y, z as
    i16 in the sensor frame. `quat`: w, x, y, z in Q14 (16384 is 1), sensor to world.
    """

    cells: tuple[int, ...]
    imu: tuple[int, int, int, int, int, int] | None = None
    quat: tuple[int, int, int, int] | None = None


@frozen
class InsoleFrame:
    """One notification: samples of one foot at equal distances.

    `layout`: id of the cell layout that INFO describes. `sequence`: u16, +1 a frame. `ticks`: u32, when the first
    sample was taken; `interval`: ticks from one sample to the next, 1 to 65535. `saturated`: at least one IMU axis or
    cell was at its limit. `retransmitted`: sent again on request. All samples have the same cells and sensors.
    """

    foot: Foot
    layout: int
    sequence: int
    ticks: int
    interval: int
    samples: tuple[InsoleSample, ...]
    saturated: bool = False
    retransmitted: bool = False


@frozen
class _FrameHeader:
    magic: int
    kind: int
    flags: int
    layout: int
    sequence: int
    ticks: int
    interval: int
    samples: int
    cells: int

    @property
    def sample_size(self) -> int:
        return packed_size(self.cells) + (12 if self.flags & _IMU else 0) + (8 if self.flags & _QUAT else 0)


def _sample_count(context: Any) -> int:
    count: int = context.header.samples
    return count


def _cell_count(context: Any) -> int:
    count: int = context._.header.cells
    return count


def _has_imu(context: Any) -> bool:
    return bool(context._.header.flags & _IMU)


def _has_quat(context: Any) -> bool:
    return bool(context._.header.flags & _QUAT)


_HEADER = Fields("<BBBBHIHBB", _FrameHeader)
_HEADER_SIZE = 14

_SAMPLE = Record(
    InsoleSample,
    Struct(
        "cells" / Packed12(_cell_count),
        "imu" / If(_has_imu, Fields("<6h")),
        "quat" / If(_has_quat, Fields("<4h")),
    ),
)

_BODY = Struct(
    "header" / _HEADER,
    "samples" / Array(_sample_count, _SAMPLE),
    Terminated,
)
"""Everything but the CRC that follows it."""


def parse_frame(data: bytes) -> InsoleFrame:
    """The frame in `data`. WireError when it is not one, whatever the bytes."""
    data = bytes(data)
    check_start(data, FRAME, _HEADER_SIZE)
    header: _FrameHeader = _HEADER.parse(data)
    check_end(data, _HEADER_SIZE + header.samples * header.sample_size + CRC_SIZE)
    problem = _problem(header)
    if problem:
        raise malformed(problem)
    body = parse_whole(_BODY, data[:-CRC_SIZE])
    flags = header.flags
    return InsoleFrame(
        Foot.RIGHT if flags & _RIGHT else Foot.LEFT,
        header.layout,
        header.sequence,
        header.ticks,
        header.interval,
        tuple(body.samples),
        bool(flags & _SATURATED),
        bool(flags & _RETRANSMITTED),
    )


def build_frame(frame: InsoleFrame) -> bytes:
    """The bytes of `frame`, the inverse of `parse_frame`. ValueError when it does not fit the format."""
    if not frame.samples:
        raise ValueError("a frame without samples")
    first = frame.samples[0]
    shape = (len(first.cells), first.imu is None, first.quat is None)
    if any((len(s.cells), s.imu is None, s.quat is None) != shape for s in frame.samples):
        raise ValueError("the samples of a frame have different cells or sensors")
    flags = (
        (_RIGHT if frame.foot is Foot.RIGHT else 0)
        | (_IMU if first.imu is not None else 0)
        | (_QUAT if first.quat is not None else 0)
        | (_SATURATED if frame.saturated else 0)
        | (_RETRANSMITTED if frame.retransmitted else 0)
    )
    header = _FrameHeader(
        MAGIC,
        FRAME,
        flags,
        frame.layout,
        frame.sequence,
        frame.ticks,
        frame.interval,
        len(frame.samples),
        len(first.cells),
    )
    problem = _problem(header)
    if problem:
        raise ValueError(problem)
    return seal(build_whole(_BODY, {"header": header, "samples": frame.samples}))


def _problem(header: _FrameHeader) -> str:
    """What contradicts the format although length and CRC are right; "" when nothing does."""
    if header.flags & _RESERVED_FLAGS:
        return f"reserved flags are set: {header.flags:#04x}"
    if header.samples == 0:
        return "a frame without samples"
    if header.cells > MAX_CELLS:
        return f"{header.cells} cells, at most {MAX_CELLS}"
    if header.sample_size == 0:
        return "samples with neither cells nor IMU nor quaternion"
    if header.interval == 0:
        return "an interval of no ticks"
    return ""
