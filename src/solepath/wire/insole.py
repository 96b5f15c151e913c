"""The insole frame, version 1 (protocol/insole.md): several samples of one foot with sequence, ticks and CRC."""

from __future__ import annotations

from struct import Struct
from struct import error as StructError
from typing import TYPE_CHECKING, Any

from construct import FormatFieldError

from ..types import Foot
from ..types.attrs import frozen
from .cells import pack12, packed_size, unpack12
from .envelope import CRC_SIZE, FRAME_TYPE, MAGIC, check_end, check_start, seal
from .fields import Definition, Fields, build_whole, malformed

if TYPE_CHECKING:
    from typing import IO

MAX_CELLS = 128
"""Largest number of pressure cells of an insole."""

_RIGHT_FLAG, _IMU_FLAG, _QUAT_FLAG, _SATURATED_FLAG, _RETRANSMITTED_FLAG = 1, 2, 4, 8, 16
_RESERVED_FLAGS = 0xE0


@frozen
class InsoleSample:
    """One sample in raw counts, whose scales are in INFO.

    `cells`: pressure of each cell, 0 to 4095, in the layout's order. `imu`: specific force x, y, z and angular rate
    x, y, z, i16, sensor frame. `quat`: attitude w, x, y, z, sensor to world; 16384 stands for 1."""

    cells: tuple[int, ...]
    imu: tuple[int, int, int, int, int, int] | None = None
    quat: tuple[int, int, int, int] | None = None


@frozen
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


class _Samples(Definition):
    """A construct for all samples of a frame: cells in each sample, then IMU and quaternion as far as `flags` say so.

    For parsing, the context has `count` (samples), `cells` (cells in a sample), `cells_size` (their bytes) and `flags`.
    One construct for all samples is fast enough for 100 frames a second."""

    def _parse(self, stream: IO[bytes], context: Any, path: str) -> tuple[InsoleSample, ...]:
        cells, cells_size, flags = context.cells, context.cells_size, context.flags
        samples = []
        for _ in range(context.count):
            values = unpack12(stream.read(cells_size), cells)
            imu = _IMU_COUNTS.unpack(stream.read(_IMU_COUNTS.size)) if flags & _IMU_FLAG else None
            quat = _QUAT_COUNTS.unpack(stream.read(_QUAT_COUNTS.size)) if flags & _QUAT_FLAG else None
            samples.append(InsoleSample(values, imu, quat))
        return tuple(samples)

    def _build(self, obj: Any, stream: IO[bytes], context: Any, path: str) -> Any:
        for sample in obj:
            stream.write(pack12(sample.cells))
            for packing, counts in ((_IMU_COUNTS, sample.imu), (_QUAT_COUNTS, sample.quat)):
                if counts is not None:
                    try:
                        stream.write(packing.pack(*counts))
                    except StructError as error:
                        raise FormatFieldError(f"{counts} do not fit: {error}", path=path) from error
        return obj


_HEADER = Fields("<BBBBHIHBB")
"""Header: magic, kind, flags, layout, sequence, ticks, interval, samples, cells."""
_HEADER_SIZE = 14
_IMU_COUNTS, _QUAT_COUNTS = Struct("<6h"), Struct("<4h")
_SAMPLES = _Samples()
"""Construct of the bytes between the header and the CRC."""
_PACKED_SIZES = tuple(map(packed_size, range(256)))
"""Size of packed cells, bytes, by the number of cells."""


def parse_frame(data: bytes) -> InsoleFrame:
    """Return the frame in `data`; WireError for any other bytes."""
    data = bytes(data)
    check_start(data, FRAME_TYPE, _HEADER_SIZE)
    _, _, flags, layout, sequence, ticks, interval, count, cells = _HEADER.parse(data)
    cells_size = _PACKED_SIZES[cells]
    size = (
        cells_size + (_IMU_COUNTS.size if flags & _IMU_FLAG else 0) + (_QUAT_COUNTS.size if flags & _QUAT_FLAG else 0)
    )
    check_end(data, _HEADER_SIZE + count * size + CRC_SIZE)
    problem = _find_problem(flags, interval, count, cells)
    if problem:
        raise malformed(problem)
    samples = _SAMPLES.parse(data[_HEADER_SIZE:-CRC_SIZE], count=count, cells=cells, cells_size=cells_size, flags=flags)
    return InsoleFrame(
        Foot.RIGHT if flags & _RIGHT_FLAG else Foot.LEFT,
        layout,
        sequence,
        ticks,
        interval,
        samples,
        bool(flags & _SATURATED_FLAG),
        bool(flags & _RETRANSMITTED_FLAG),
    )


def build_frame(frame: InsoleFrame) -> bytes:
    """Return the bytes of `frame`, the inverse of `parse_frame`; ValueError when it does not fit the format."""
    if not frame.samples:
        raise ValueError("a frame without samples")
    first = frame.samples[0]
    shape = (len(first.cells), first.imu is None, first.quat is None)
    if any((len(s.cells), s.imu is None, s.quat is None) != shape for s in frame.samples):
        raise ValueError("the samples of a frame have different cells or sensors")
    flags = (
        (_RIGHT_FLAG if frame.foot is Foot.RIGHT else 0)
        | (_IMU_FLAG if first.imu is not None else 0)
        | (_QUAT_FLAG if first.quat is not None else 0)
        | (_SATURATED_FLAG if frame.saturated else 0)
        | (_RETRANSMITTED_FLAG if frame.retransmitted else 0)
    )
    problem = _find_problem(flags, frame.interval, len(frame.samples), len(first.cells))
    if problem:
        raise ValueError(problem)
    header_numbers = (frame.layout, frame.sequence, frame.ticks, frame.interval, len(frame.samples), len(first.cells))
    header = build_whole(_HEADER, (MAGIC, FRAME_TYPE, flags, *header_numbers))
    return seal(header + build_whole(_SAMPLES, frame.samples))


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
