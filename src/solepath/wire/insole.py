"""The insole frame, version 1 (protocol/insole.md): several samples of one foot with sequence, ticks and CRC."""

from __future__ import annotations

from struct import Struct
from struct import error as StructError
from typing import TYPE_CHECKING, Any

from construct import FormatFieldError

from ..types import Foot
from ..types.attrs import frozen
from .cells import pack12, packed_size, unpack12
from .envelope import CRC_SIZE, FRAME, MAGIC, check_end, check_start, seal
from .fields import Definition, Fields, build_whole, malformed

if TYPE_CHECKING:
    from typing import IO

MAX_CELLS = 128
"""Number of cells of an insole at most."""

_RIGHT, _IMU, _QUAT, _SATURATED, _RETRANSMITTED = 1, 2, 4, 8, 16
_RESERVED_FLAGS = 0xE0


@frozen
class InsoleSample:
    """One sample in raw counts; INFO declares the scales.

    `cells`: pressure, 0 to 4095 each, in the layout's order. `imu`: specific force x, y, z and angular rate x, y, z as
    i16 in the sensor frame. `quat`: w, x, y, z in Q14 (16384 is 1), sensor to world."""

    cells: tuple[int, ...]
    imu: tuple[int, int, int, int, int, int] | None = None
    quat: tuple[int, int, int, int] | None = None


@frozen
class InsoleFrame:
    """One notification: samples of one foot at equal distances.

    `layout`: id of the cell layout that INFO describes. `sequence`: u16, +1 a frame. `ticks`: u32, time of the first
    sample; `interval`: ticks from one sample to the next, 1 to 65535. `saturated`: at least one IMU axis or cell was at
    its limit. `retransmitted`: sent again on request. All samples have the same cells and sensors."""

    foot: Foot
    layout: int
    sequence: int
    ticks: int
    interval: int
    samples: tuple[InsoleSample, ...]
    saturated: bool = False
    retransmitted: bool = False


class _Samples(Definition):
    """The samples of a frame in a row: cells, then IMU, then quaternion, as far as its flags have them.

    To parse, the context has their `count`, their `cells`, the bytes `packed` that these take, and `flags`. One
    construct handles all of them, because an insole frame comes 100 times a second."""

    def _parse(self, stream: IO[bytes], context: Any, path: str) -> tuple[InsoleSample, ...]:
        cells, packed, flags = context.cells, context.packed, context.flags
        samples = []
        for _ in range(context.count):
            values = unpack12(stream.read(packed), cells)
            imu = _IMU_COUNTS.unpack(stream.read(_IMU_COUNTS.size)) if flags & _IMU else None
            quat = _QUAT_COUNTS.unpack(stream.read(_QUAT_COUNTS.size)) if flags & _QUAT else None
            samples.append(InsoleSample(values, imu, quat))
        return tuple(samples)

    def _build(self, obj: Any, stream: IO[bytes], context: Any, path: str) -> Any:
        for sample in obj:
            stream.write(pack12(sample.cells))
            for numbers, part in ((_IMU_COUNTS, sample.imu), (_QUAT_COUNTS, sample.quat)):
                if part is not None:
                    try:
                        stream.write(numbers.pack(*part))
                    except StructError as error:
                        raise FormatFieldError(f"{part} do not fit: {error}", path=path) from error
        return obj


_HEADER = Fields("<BBBBHIHBB")
"""Header: magic, kind, flags, layout, sequence, ticks, interval, samples, cells."""
_HEADER_SIZE = 14
_IMU_COUNTS, _QUAT_COUNTS = Struct("<6h"), Struct("<4h")
_SAMPLES = _Samples()
"""Construct of the bytes between the header and the CRC."""
_PACKED = tuple(map(packed_size, range(256)))
"""Bytes that cells take, by their number."""


def parse_frame(data: bytes) -> InsoleFrame:
    """Return the frame in `data`. WireError when it is not one, whatever the bytes."""
    data = bytes(data)
    check_start(data, FRAME, _HEADER_SIZE)
    _, _, flags, layout, sequence, ticks, interval, count, cells = _HEADER.parse(data)
    packed = _PACKED[cells]
    size = packed + (_IMU_COUNTS.size if flags & _IMU else 0) + (_QUAT_COUNTS.size if flags & _QUAT else 0)
    check_end(data, _HEADER_SIZE + count * size + CRC_SIZE)
    problem = _problem(flags, interval, count, cells)
    if problem:
        raise malformed(problem)
    samples = _SAMPLES.parse(data[_HEADER_SIZE:-CRC_SIZE], count=count, cells=cells, packed=packed, flags=flags)
    return InsoleFrame(
        Foot.RIGHT if flags & _RIGHT else Foot.LEFT,
        layout,
        sequence,
        ticks,
        interval,
        samples,
        bool(flags & _SATURATED),
        bool(flags & _RETRANSMITTED),
    )


def build_frame(frame: InsoleFrame) -> bytes:
    """Return the bytes of `frame`, the inverse of `parse_frame`. ValueError when it does not fit the format."""
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
    problem = _problem(flags, frame.interval, len(frame.samples), len(first.cells))
    if problem:
        raise ValueError(problem)
    numbers = (frame.layout, frame.sequence, frame.ticks, frame.interval, len(frame.samples), len(first.cells))
    header = build_whole(_HEADER, (MAGIC, FRAME, flags, *numbers))
    return seal(header + build_whole(_SAMPLES, frame.samples))


def _problem(flags: int, interval: int, count: int, cells: int) -> str:
    """Return a contradiction to the format that length and CRC do not show; "" when there is none."""
    if flags & _RESERVED_FLAGS:
        return f"reserved flags are set: {flags:#04x}"
    if count == 0:
        return "a frame without samples"
    if cells > MAX_CELLS:
        return f"{cells} cells, at most {MAX_CELLS}"
    if cells == 0 and not flags & (_IMU | _QUAT):
        return "samples with neither cells nor IMU nor quaternion"
    if interval == 0:
        return "an interval of no ticks"
    return ""
