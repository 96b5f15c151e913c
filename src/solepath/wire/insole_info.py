"""The insole's INFO record (protocol/insole.md): positions of the cells, scales of the counts, tick rate."""

from __future__ import annotations

from itertools import groupby
from math import isfinite
from operator import eq
from struct import Struct
from struct import error as StructError

from ..types import Cell, Foot
from ..types.attrs import frozen
from .cells import pack12, packed_size, unpack12
from .envelope import CRC_SIZE, INFO_TYPE, MAGIC, check_end, check_start, seal
from .error import WireError
from .fields import malformed, to_counts
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


_HEADER = Struct("<BBBBIIHfffHBBB")
"""Magic, type, flags, layout, serial number, tick rate, interval, scales of accelerometer, gyroscope and pressure,
length, number of cells, number of areas, and size of the firmware name."""


def _record_struct(cells: int, areas: int, name_size: int) -> Struct:
    """Return the definition of a whole record.

    After the header it has the packed coordinates x and y of each cell, the areas, of which each has the number of
    neighbouring cells that have it, the name of the firmware, and the CRC."""
    return Struct(_HEADER.format + f"{packed_size(2 * cells)}s" + areas * "BH" + f"{name_size}sH")


def parse_info(data: bytes) -> InsoleInfo:
    """Return the INFO record in `data`; WireError for any other bytes."""
    data = bytes(data)
    check_start(data, INFO_TYPE, _HEADER.size)
    _, _, flags, layout, serial, tick_rate, interval, acc, gyro, force, length, cells, areas, name_size = (
        _HEADER.unpack_from(data)
    )
    whole = _record_struct(cells, areas, name_size)
    check_end(data, whole.size)
    scales = acc, gyro, force
    coordinates, *runs, name, _ = whole.unpack(data)[14:]  # without the header
    counts, sizes = runs[0::2], runs[1::2]
    for is_wrong, problem in (
        (flags & _RESERVED_FLAGS, f"reserved flags are set: {flags:#04x}"),
        (cells > MAX_CELLS, f"{cells} cells, at most {MAX_CELLS}"),
        (tick_rate == 0 or interval == 0, "a tick rate or interval of zero"),
        (not all([isfinite(scale) and scale >= 0.0 for scale in scales]), f"scales negative or not finite: {scales}"),
        (sum(counts) != cells or 0 in counts, f"areas for {sum(counts)} of {cells} cells"),
        (any(map(eq, sizes, sizes[1:])), "neighbouring areas that should be one run"),
    ):
        if is_wrong:
            raise malformed(problem)
    numbers = unpack12(coordinates, 2 * cells)
    areas_of_cells = [
        size / _COUNTS_PER_SQUARE_METRE for count, size in zip(counts, sizes, strict=True) for _ in range(count)
    ]
    try:
        firmware = name.decode("utf-8")
    except UnicodeDecodeError as error:
        raise malformed(f"the firmware name is not UTF-8: {error}") from error
    return InsoleInfo(
        Foot.RIGHT if flags & _RIGHT_FLAG else Foot.LEFT,
        layout,
        serial,
        tick_rate,
        interval,
        *scales,
        length / _COUNTS_PER_METRE,
        tuple(
            Cell(x / _COUNTS_PER_METRE, (y - _Y_ZERO_COUNTS) / _COUNTS_PER_METRE, area)
            for x, y, area in zip(numbers[0::2], numbers[1::2], areas_of_cells, strict=True)
        ),
        firmware,
    )


def build_info(info: InsoleInfo) -> bytes:
    """Return the bytes of `info`, the inverse of `parse_info`; lengths are rounded to 0.1 mm, areas to 0.1 mm^2.

    ValueError when a value does not fit: too many cells, a cell too far out, a firmware name too long."""
    coordinates: list[int] = []
    for cell in info.cells:
        coordinates += to_counts(cell.x, _COUNTS_PER_METRE), to_counts(cell.y, _COUNTS_PER_METRE) + _Y_ZERO_COUNTS
    areas = [to_counts(cell.area, _COUNTS_PER_SQUARE_METRE) for cell in info.cells]
    runs = [number for area, equal in groupby(areas) for number in (len([*equal]), area)]
    name = info.firmware.encode("utf-8")
    sizes = len(info.cells), len(runs) // 2, len(name)
    header = MAGIC, INFO_TYPE, _RIGHT_FLAG * (info.foot is Foot.RIGHT), info.layout, info.serial
    ticks, scales = (info.tick_rate, info.interval), (info.acc_scale, info.gyro_scale, info.pressure_scale)
    numbers = *header, *ticks, *scales, to_counts(info.length, _COUNTS_PER_METRE), *sizes
    try:
        record = _record_struct(*sizes).pack(*numbers, pack12(coordinates), *runs, name, 0)
        data = seal(record[:-CRC_SIZE])
        parse_info(data)
    except (StructError, OverflowError, WireError) as error:  # OverflowError: a float too large for binary32
        raise ValueError(f"this INFO does not fit its format: {error}") from error
    return data
