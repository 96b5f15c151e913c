"""The insole's INFO record (protocol/insole.md): positions of the cells, scales of the counts, tick rate."""

from __future__ import annotations

from itertools import groupby, pairwise
from math import isfinite
from typing import NamedTuple

from construct import Array, Bytes, Struct, Terminated

from ..types import Cell, Foot
from ..types.attrs import frozen
from .cells import Packed12, packed_size
from .envelope import CRC_SIZE, INFO_TYPE, MAGIC, check_end, check_start, seal
from .fields import Fields, build_whole, decode, malformed, parse_whole, to_counts
from .insole import MAX_CELLS

_RIGHT_FLAG = 1
_RESERVED_FLAGS = 0xFE
_Y_ZERO_COUNTS = 2048
_COUNTS_PER_METRE = 10_000  # x, y and length count 0.1 mm
_COUNTS_PER_SQUARE_METRE = 10_000_000  # areas count 0.1 mm^2


@frozen
class InsoleInfo:
    """The INFO record of an insole.

    `layout`: id of the cell layout. `tick_rate`: nominal ticks per second. `interval`: ticks between samples.
    `acc_scale`: m/s^2 per count. `gyro_scale`: rad/s per count. `pressure_scale`: N per count. A scale of 0 means that
    there is no such sensor, or that pressure is not calibrated. `length`: heel to toe, m. `cells`: in the order of the
    values in a sample, foot frame: x 0 to 0.4095 m, y -0.2048 to 0.2047 m, area up to 6.5535e-3 m^2, 0 if unknown."""

    foot: Foot
    layout: int
    serial: int
    tick_rate: int
    interval: int
    acc_scale: float
    gyro_scale: float
    pressure_scale: float
    length: float
    cells: tuple[Cell, ...]
    firmware: str = ""


class _InfoHeader(NamedTuple):
    magic: int
    kind: int
    flags: int
    layout: int
    serial: int
    tick_rate: int
    interval: int
    acc_scale: float
    gyro_scale: float
    pressure_scale: float
    length: int
    cells: int
    runs: int
    firmware_size: int

    @property
    def size(self) -> int:
        """Size of the whole record with its CRC, bytes."""
        return _HEADER_SIZE + packed_size(2 * self.cells) + 3 * self.runs + self.firmware_size + CRC_SIZE


class _AreaRun(NamedTuple):
    """A run of neighbouring cells that have the same area."""

    cells: int
    area: int


_HEADER = Fields("<BBBBIIHfffHBBB", _InfoHeader)
_HEADER_SIZE = 31

_BODY = Struct(
    "header" / _HEADER,
    "coordinates" / Packed12(lambda context: 2 * context.header.cells),
    "runs" / Array(lambda context: context.header.runs, Fields("<BH", _AreaRun)),
    "firmware" / Bytes(lambda context: context.header.firmware_size),
    Terminated,
)
"""Construct of the record without the CRC that follows it."""


def parse_info(data: bytes) -> InsoleInfo:
    """Return the INFO record in `data`; WireError for any other bytes."""
    data = bytes(data)
    check_start(data, INFO_TYPE, _HEADER_SIZE)
    header: _InfoHeader = _HEADER.parse(data)
    check_end(data, header.size)
    body = parse_whole(_BODY, data[:-CRC_SIZE])
    problem = _find_problem(header, body.runs)
    if problem:
        raise malformed(problem)
    areas = [run.area / _COUNTS_PER_SQUARE_METRE for run in body.runs for _ in range(run.cells)]
    return InsoleInfo(
        Foot.RIGHT if header.flags & _RIGHT_FLAG else Foot.LEFT,
        *header[3:10],  # layout to scales, in the same order
        header.length / _COUNTS_PER_METRE,
        tuple(
            Cell(x / _COUNTS_PER_METRE, (y - _Y_ZERO_COUNTS) / _COUNTS_PER_METRE, area)
            for x, y, area in zip(body.coordinates[0::2], body.coordinates[1::2], areas, strict=True)
        ),
        decode(body.firmware, "the firmware name is "),
    )


def build_info(info: InsoleInfo) -> bytes:
    """Return the bytes of `info`, the inverse of `parse_info`; lengths are rounded to 0.1 mm, areas to 0.1 mm^2.

    ValueError when a value does not fit: too many cells, a cell too far out, a firmware name too long."""
    coordinates = [
        c
        for cell in info.cells
        for c in (to_counts(cell.x, _COUNTS_PER_METRE), to_counts(cell.y, _COUNTS_PER_METRE) + _Y_ZERO_COUNTS)
    ]
    areas = [to_counts(cell.area, _COUNTS_PER_SQUARE_METRE) for cell in info.cells]
    runs = [_AreaRun(len(list(equal)), area) for area, equal in groupby(areas)]
    firmware = info.firmware.encode("utf-8")
    header = _InfoHeader(
        MAGIC,
        INFO_TYPE,
        _RIGHT_FLAG if info.foot is Foot.RIGHT else 0,
        info.layout,
        info.serial,
        info.tick_rate,
        info.interval,
        info.acc_scale,
        info.gyro_scale,
        info.pressure_scale,
        to_counts(info.length, _COUNTS_PER_METRE),
        len(info.cells),
        len(runs),
        len(firmware),
    )
    problem = _find_problem(header, runs)
    if problem:
        raise ValueError(problem)
    body = {"header": header, "coordinates": coordinates, "runs": runs, "firmware": firmware}
    return seal(build_whole(_BODY, body))


def _find_problem(header: _InfoHeader, runs: list[_AreaRun]) -> str:
    """Return a description of an error that length and CRC do not show; "" when there is none."""
    scales = (header.acc_scale, header.gyro_scale, header.pressure_scale)
    if header.flags & _RESERVED_FLAGS:
        return f"reserved flags are set: {header.flags:#04x}"
    if header.cells > MAX_CELLS:
        return f"{header.cells} cells, at most {MAX_CELLS}"
    if header.tick_rate == 0 or header.interval == 0:
        return "a tick rate or interval of zero"
    if not all(isfinite(scale) and scale >= 0.0 for scale in scales):
        return f"scales that are negative or not finite: {scales}"
    cells = sum([run.cells for run in runs])  # whole numbers
    if cells != header.cells or any([run.cells == 0 for run in runs]):
        return f"areas for {cells} of {header.cells} cells"
    if any(a.area == b.area for a, b in pairwise(runs)):
        return "neighbouring areas that should be one run"
    return ""
