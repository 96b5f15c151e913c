"""The insole frame, version 1 (protocol/insole.md): several samples of one foot with sequence, ticks and CRC."""

from __future__ import annotations

from functools import lru_cache
from struct import Struct as Packing
from struct import error as StructError
from typing import Any, NamedTuple

from construct import Array, Container, FormatField, If, IfThenElse, Int16ul, Renamed, Sequence, Struct

from ..types import Foot
from ..types.attrs import define
from .cells import Packed12, pack12, packed_size, unpack12
from .envelope import CRC_SIZE, FRAME_TYPE, MAGIC, check_end, check_start, seal
from .fields import Definition, Fields, malformed

# A reader and writer generated from a construct: one call of the module struct for a whole packet.
#
# For every part that it reads, construct makes a stream, a context and a container, which takes five times as long as
# reading the numbers. If the sizes in a packet follow from its header, all of its parts have one notation in `struct`,
# which `flat_struct` derives from the construct. So the construct stays the only definition of the format.


def flat_struct(definition: Definition, **context: Any) -> Packing:
    """Return the struct of all numbers of `definition`, in order; a block of 12-bit values is one `bytes`.

    `context` has what the parts before are to have been parsed to, by their names, as in construct. Numbers are
    little-endian."""
    return Packing("<" + _notation(definition, Container(context)))


def _notation(definition: Any, context: Any) -> str:
    """Return the notation of all numbers of a part, without their byte order."""
    if isinstance(definition, Renamed):
        return _notation(definition.subcon, context)
    if isinstance(definition, Fields):
        return definition.notation.removeprefix("<")
    if isinstance(definition, FormatField):
        return definition.fmtstr.removeprefix("<")
    if isinstance(definition, Packed12):
        return f"{packed_size(definition.count(context))}s"
    if isinstance(definition, Array):
        count: Any = definition.count  # a function, in all definitions here
        return _notation(definition.subcon, context) * int(count(context))
    if isinstance(definition, IfThenElse):
        condition: Any = definition.condfunc
        return _notation(definition.thensubcon, context) if condition(context) else ""
    within = Container(context, _=context)  # a Struct or a Sequence
    return "".join([_notation(part, within) for part in definition.subcons])


MAX_CELLS = 128
"""Largest number of pressure cells of an insole."""

_RIGHT_FLAG, _IMU_FLAG, _QUAT_FLAG, _SATURATED_FLAG, _RETRANSMITTED_FLAG = 1, 2, 4, 8, 16
_RESERVED_FLAGS = 0xE0
_SENSOR_FLAGS = _IMU_FLAG | _QUAT_FLAG


@define
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


class FrameHeader(NamedTuple):
    """The header of a frame: `samples` is their number, `cells` the number of cells in each."""

    magic: int
    kind: int
    flags: int
    layout: int
    sequence: int
    ticks: int
    interval: int
    samples: int
    cells: int


_HEADER = Fields("<BBBBHIHBB", FrameHeader)
_SAMPLE = Sequence(
    Packed12(lambda context: context._.header.cells),
    If(lambda context: context._.header.flags & _IMU_FLAG, Fields("<6h")),
    If(lambda context: context._.header.flags & _QUAT_FLAG, Fields("<4h")),
)
FRAME = Struct("header" / _HEADER, "samples" / Array(lambda context: context.header.samples, _SAMPLE), "crc" / Int16ul)
"""The construct of a frame, from which `flat_struct` generates reader and writer."""

_HEADER_NUMBERS = flat_struct(_HEADER)


@lru_cache(maxsize=16)
def _frame_struct(sensors: int, count: int, cells: int) -> Packing:
    """Return the struct of a whole frame; `sensors` are the flags of IMU and quaternion."""
    return flat_struct(FRAME, header=FrameHeader(MAGIC, FRAME_TYPE, sensors, 0, 0, 0, 0, count, cells))


def parse_frame(data: bytes) -> InsoleFrame:
    """Return the frame in `data`; WireError for any other bytes."""
    data = bytes(data)
    check_start(data, FRAME_TYPE, _HEADER_NUMBERS.size)
    _, _, flags, layout, sequence, ticks, interval, count, cells = _HEADER_NUMBERS.unpack_from(data)
    whole = _frame_struct(flags & _SENSOR_FLAGS, count, cells)
    check_end(data, whole.size)
    problem = _find_problem(flags, interval, count, cells)
    if problem:
        raise malformed(problem)
    numbers, at = whole.unpack(data), len(FrameHeader._fields)
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
    count, cells = len(frame.samples), len(first.cells)
    problem = _find_problem(flags, frame.interval, count, cells)
    if problem:
        raise ValueError(problem)
    numbers: list[Any] = [
        *FrameHeader(MAGIC, FRAME_TYPE, flags, frame.layout, frame.sequence, frame.ticks, frame.interval, count, cells)
    ]
    for sample in frame.samples:
        numbers += [pack12(sample.cells), *(sample.imu or ()), *(sample.quat or ())]
    try:
        return seal(_frame_struct(flags & _SENSOR_FLAGS, count, cells).pack(*numbers, 0)[:-CRC_SIZE])
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
