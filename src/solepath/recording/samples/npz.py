"""Reading of samples from a NumPy archive with the keys t, acc, gyro, pressure, or these with _left and _right."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZipFile

import numpy as np
from attrs import evolve
from numpy.lib.format import read_array
from numpy.typing import NDArray

from ..errors import RecordingError, describe_error, open_file, printable
from ..mapping.mapping import KEYS, QUANTITIES, TableMapping
from .columns import TableColumns
from .numbers import fill_table
from .sheet import SheetLayout
from .table import MAX_VALUES, FootTable

MAX_PIPED = 256_000_000
"""Largest size of an archive that comes through a pipe, bytes; which is kept whole, as its list is at its end."""
FLOAT_SIZE = 8
"""Size of a number in memory, bytes."""


def read_npz(path: Path, mapping: TableMapping) -> tuple[SheetLayout, TableMapping, dict[str, NDArray[Any]]]:
    """Return the keys of an archive as a header of columns, the mapping with their names, and the used columns.

    A key holds all components of a quantity, which become columns such as acc_0, or one of them. RecordingError as for
    `read_arrays`, and for an array that is used and does not hold columns of numbers."""
    given = {name.lstrip("-") for names in mapping.columns.values() for name in names}
    names: dict[str, list[str]] = {}
    columns: dict[str, NDArray[Any]] = {}
    for key, array in _read_members(path, {*KEYS, *given}.__contains__).items():
        if array is None:
            names[key] = [key]
            continue
        if array.dtype.kind not in "fiu" or array.ndim not in (1, 2):
            what = f"holds {printable(str(array.dtype), 40)} of the shape {array.shape}, not columns of numbers"
            raise RecordingError(path, what, key)
        names[key] = [key] if array.ndim == 1 else [f"{key}_{k}" for k in range(array.shape[1])]
        columns |= zip(names[key], array.astype(np.float64).reshape(len(array), len(names[key])).T, strict=True)

    def expand(name: str) -> list[str]:
        key = name.lstrip("-")
        return ["-" * (key != name) + part for part in names.get(key, [key])]

    expanded = {key: [part for name in given for part in expand(name)] for key, given in mapping.columns.items()}
    layout = SheetLayout(path, tuple(name for its_names in names.values() for name in its_names))
    return layout, evolve(mapping, columns=expanded), columns


def fill_tables(found: TableColumns, columns: Mapping[str, NDArray[Any]]) -> list[FootTable]:
    """Return the tables of the feet with the values of these columns; RecordingError for columns of other lengths."""
    for table in found.feet:
        values = [one.sign * columns[one.name] for q in QUANTITIES for one in table.sources.get(q, ())]
        if "t" not in table.sources:
            values.insert(0, np.arange(float(len(values[0]))))
        for quantity, (first, *_) in table.sources.items():
            if len(columns[first.name]) != len(values[0]):
                what = f"has {len(columns[first.name])} rows but {table.names['t']} has {len(values[0])}"
                raise RecordingError(table.path, what, table.names[quantity])
        fill_table(table, found, [one.tolist() for one in values])
    return found.feet


def read_arrays(path: Path, is_used: Callable[[str], bool]) -> dict[str, NDArray[Any]]:
    """Return the arrays of an archive whose keys are used, in order.

    The sizes that the archive claims are added before anything is unpacked. RecordingError for a file that is no whole
    archive, and for more than MAX_VALUES numbers."""
    return {key: array for key, array in _read_members(path, is_used).items() if array is not None}


def _read_members(path: Path, is_used: Callable[[str], bool]) -> dict[str, NDArray[Any] | None]:
    """Return all keys of an archive in order; the values of those that are not used are None."""
    with open_file(path) as file:
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
