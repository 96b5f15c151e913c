"""Reading of samples from a NumPy archive with the keys t, acc, gyro, pressure, or these with _left and _right."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZipFile

import numpy as np
from attrs import evolve
from numpy.lib.format import read_array
from numpy.typing import NDArray

from ..errors import RecordingError, describe_error, printable
from ..mapping.mapping import COMPONENTS, KEYS, TableMapping
from ..unpacking import open_unpacked
from .columns import TableColumns
from .sheet import SheetLayout
from .table import FLOAT_SIZE, MAX_VALUES

MAX_PIPED = 256_000_000
"""Largest size of an archive that comes through a pipe, bytes; which is kept whole, as its list is at its end."""


def open_npz(path: Path, mapping: TableMapping) -> tuple[SheetLayout, TableMapping, dict[int, list[float]]]:
    """Return the keys of an archive as a header of columns, the mapping with their names, and the columns in use.

    A key holds all components of a quantity, which become columns such as acc_x, or one of them. RecordingError as for
    `read_arrays`, and for an array that is used and does not hold columns of numbers."""
    given = {name.lstrip("-") for names in (*mapping.columns.values(), mapping.rows) for name in names}
    parts: dict[str, list[str]] = {}
    names: list[str] = []
    columns: dict[int, list[float]] = {}
    for key, array in _read_members(path, {*KEYS, *given}.__contains__).items():
        quantity, _, foot = key.partition("_")
        parts[key] = [key]
        if array is not None:
            width = COMPONENTS.get(quantity) if key in KEYS and array.ndim == 2 else None
            if array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or width not in (None, array.shape[-1]):
                what = f"holds {printable(str(array.dtype), 40)} of the shape {array.shape}, not columns of numbers"
                raise RecordingError(path, what, key)
            if array.ndim == 2:
                axes = "xyz" if width == 3 else range(array.shape[1])
                start, end = (quantity, foot and f"_{foot}") if key in KEYS else (key, "")
                parts[key] = [f"{start}_{axis}{end}" for axis in axes]
            values = array.astype(np.float64).reshape(len(array), len(parts[key]))
            columns |= enumerate(values.T.tolist(), len(names))
        names += parts[key]

    def expand(name: str) -> list[str]:
        key = name.lstrip("-")
        return ["-" * (key != name) + part for part in parts.get(key, [key])]

    expanded = {
        key: [part for name in its_names for part in expand(name)] for key, its_names in mapping.columns.items()
    }
    return SheetLayout(path, tuple(names)), evolve(mapping, columns=expanded), columns


def check_lengths(found: TableColumns, columns: Mapping[int, Sequence[float]]) -> list[float]:
    """Return the numbers of the rows; RecordingError for a foot whose columns differ in length."""
    for table in found.feet:
        lengths = {quantity: len(columns[first.index]) for quantity, (first, *_) in table.sources.items()}
        for quantity, length in lengths.items():
            if length != lengths.get("t", length):
                what = f"has {length} rows but {table.names['t']} has {lengths['t']}"
                raise RecordingError(table.path, what, table.names[quantity])
    return [float(row) for row in range(min(map(len, columns.values())))]


def read_arrays(path: Path, is_used: Callable[[str], bool]) -> dict[str, NDArray[Any]]:
    """Return the arrays of an archive whose keys are used, in order.

    The sizes that the archive claims are added before anything is unpacked. RecordingError for a file that is no whole
    archive, and for more than MAX_VALUES numbers."""
    return {key: array for key, array in _read_members(path, is_used).items() if array is not None}


def _read_members(path: Path, is_used: Callable[[str], bool]) -> dict[str, NDArray[Any] | None]:
    """Return all keys of an archive in order; the values of those that are not used are None."""
    with open_unpacked(path) as file:
        stream: BinaryIO = file
        if not file.seekable():
            stream = BytesIO(file.read(MAX_PIPED + 1))
            if stream.getbuffer().nbytes > MAX_PIPED:
                raise RecordingError(path, f"is a pipe of more than {MAX_PIPED // 1_000_000} MB: save it as a file")
        start = stream.read(4)
        stream.seek(0)
        if start != b"PK\x03\x04":
            raise RecordingError(path, "is not an .npz archive" if start else "is empty")
        key = ""
        try:
            archive = ZipFile(stream)
            infos = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
            if sum(info.file_size for key, info in infos.items() if is_used(key)) > MAX_VALUES * FLOAT_SIZE:
                raise RecordingError(path, f"holds more than {MAX_VALUES:,} numbers")
            arrays = dict[str, NDArray[Any] | None].fromkeys(infos)
            for key in filter(is_used, infos):
                arrays[key] = read_array(BytesIO(archive.read(infos[key])), allow_pickle=False)
        except RecordingError:
            raise
        except Exception as error:  # both libraries raise errors of many kinds for a damaged archive
            what = "cannot be read" if key else "is not a whole .npz archive; was it cut off?"
            raise RecordingError(path, f"{what} ({describe_error(error, 80)})", key) from error
        return arrays
