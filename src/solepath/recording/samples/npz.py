"""Reading of samples from a NumPy archive with the keys t, acc, gyro, pressure, or these with _left and _right."""

from __future__ import annotations

import struct
import tokenize
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from math import prod
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile

import numpy as np
from numpy.typing import NDArray

from ...types import Foot
from ..errors import RecordingError, describe_error, open_file, printable
from ..mapping.mapping import COMPONENTS, MEASURED, QUANTITIES, TableMapping
from ..mapping.units import DATETIME, UNITS, unit_of
from .table import MAX_VALUES, FootTable

MAX_PIPED = 256_000_000
"""Largest size of an archive that comes through a pipe, bytes; which is kept whole, as its list is at its end."""
HEADER_READERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
"""Functions of numpy that read the header of an array, by version; version 3 is for names of columns."""
NUMBER_KINDS = "biuf"
"""Kinds of numpy types that are numbers: a text or a record may be of any size."""
FLOAT_SIZE = np.dtype(np.float64).itemsize
"""Size of a number in memory, bytes; a longer one counts as several."""

ARCHIVE_ERRORS = (
    ValueError,  # pickled objects, a header that does not fit its array
    EOFError,
    OSError,
    KeyError,
    MemoryError,
    NotImplementedError,  # a compression that zipfile does not know
    RuntimeError,  # an encrypted member
    SyntaxError,
    tokenize.TokenError,
    struct.error,
    BadZipFile,
    zlib.error,
)
"""Exceptions that numpy raises for a damaged archive."""


def read_npz(path: Path, one_foot: Foot | None, mapping: TableMapping) -> list[FootTable]:
    """Return the tables of the feet in the file, of which only the shapes are checked.

    `one_foot`: foot of a file whose keys name no foot, None if it is not known. `mapping`: keys and units, where they
    are not this project's own; a key holds all components of a quantity, or one of them. RecordingError as for
    `read_arrays`."""
    with _open_archive(path) as archive:
        archive.rename(mapping)
        named = [foot for foot in Foot if any(f"{q}_{foot.value}" in archive.keys for q in MEASURED)]
        bare = [q for q in MEASURED if q in archive.keys]
        if bare and named:
            named_key = next(key for q in MEASURED if (key := f"{q}_{named[0].value}") in archive.keys)
            raise RecordingError(path, f"holds both {bare[0]} and {named_key}: is it of one foot or of two?")
        if not bare and not named:
            text = f"has no key acc or pressure, nor acc_left or acc_right (it holds {archive.list_keys()})"
            raise RecordingError(path, text, repair="--columns t=KEY,acc=KEY,gyro=KEY")
        feet = named or (one_foot,)
        return [_read_table(archive, foot, mapping, is_named=not bare) for foot in feet]


def read_arrays(path: Path, is_used: Callable[[str], bool]) -> dict[str, NDArray[Any]]:
    """Return the arrays of an archive whose keys are used, in order.

    The sizes that the archive and its arrays claim are compared before anything is unpacked. RecordingError for a file
    that is no whole archive, and for more than MAX_VALUES numbers."""
    with _open_archive(path) as archive:
        return {key: archive.read(key) for key in archive.keys if is_used(key)}


@contextmanager
def _open_archive(path: Path) -> Iterator[_Archive]:
    with open_file(path) as file:
        stream: BinaryIO = file
        if not file.seekable():
            stream = BytesIO(file.read(MAX_PIPED + 1))
            if stream.getbuffer().nbytes > MAX_PIPED:
                raise RecordingError(path, f"is a pipe of more than {MAX_PIPED // 1_000_000} MB: save it as a file")
        start = stream.read(4)
        stream.seek(0)
        if not start:
            raise RecordingError(path, "is empty")
        if start != b"PK\x03\x04":
            raise RecordingError(path, "is not an .npz archive")
        try:
            archive = _Archive(path, ZipFile(stream))
        except ARCHIVE_ERRORS as error:
            raise RecordingError(
                path, f"is not a whole .npz archive ({describe_error(error, 80)}); was it cut off?"
            ) from error
        yield archive


def _read_table(archive: _Archive, foot: Foot | None, mapping: TableMapping, *, is_named: bool) -> FootTable:
    suffix = f"_{foot.value}" if is_named and foot is not None else ""
    names = {q: q + suffix for q in QUANTITIES if q + suffix in archive.keys}
    missing = []
    if "t" not in names and "t" not in archive.keys:
        missing.append(("t", f'"t"{suffix and f" and no key t{suffix}"}'))
    if "gyro" in names and "acc" not in names:
        missing.append(("acc", f"acc{suffix}"))
    if missing:
        text = f"has no key {' and no key '.join(name for _, name in missing)} (it holds {archive.list_keys()})"
        raise RecordingError(archive.path, text, repair=f"--columns {','.join(f'{key}=KEY' for key, _ in missing)}")
    names = {"t": "t", **names}
    units = {q: unit_of(unit, q) or unit for q, unit in mapping.units.items()}
    table = FootTable(
        archive.path,
        foot or Foot.RIGHT,
        names,
        units=units,
        mapping=mapping,
        is_named=is_named,
        is_assumed=foot is None,
    )
    for quantity, name in names.items():
        values = _to_floats(archive.path, name, archive.read(name), COMPONENTS.get(quantity))
        if quantity != "t" and len(values) != len(table):
            raise RecordingError(archive.path, f"has {len(values)} rows but {names['t']} has {len(table)}", name)
        columns = [values.tolist()] if quantity == "t" else values.T.tolist()
        table.set_quantity(quantity, columns, units.get(quantity, next(iter(UNITS[quantity]))))
    table.is_own = units.get("t", "s") in ("s", DATETIME)
    return table


def _to_floats(path: Path, name: str, value: NDArray[Any], width: int | None) -> NDArray[np.float64]:
    """Return `value` as float64; RecordingError for another type, or for another shape than `width` requires.

    The shape is (n,) for a width of 1, (n, any) for None, and else (n, width)."""
    if value.dtype.kind not in "fiu":
        raise RecordingError(path, f"holds {printable(str(value.dtype), 40)}, not numbers", name)
    expected = "(n,)" if width == 1 else f"(n, {'cells' if width is None else width})"
    fits = value.ndim == 1 if width == 1 else value.ndim == 2 and value.shape[1] > 0 and width in (None, value.shape[1])
    if not fits:
        raise RecordingError(path, f"has the shape {value.shape} instead of {expected}", name)
    return value.astype(np.float64)


class _Archive:
    """The arrays of an archive by key, of which at most MAX_VALUES numbers are read in all."""

    def __init__(self, path: Path, zip_file: ZipFile) -> None:
        self.path, self._zip_file, self._values = path, zip_file, 0
        self.keys = {info.filename.removesuffix(".npy"): info for info in zip_file.infolist()}
        self._parts: dict[str, tuple[str, ...]] = {}

    def list_keys(self) -> str:
        """Return the keys of the archive as a text."""
        return printable(", ".join(sorted(self.keys)) or "nothing", 80)

    def rename(self, mapping: TableMapping) -> None:
        """Let this project's keys stand for those that a mapping names."""
        missing = [name for names in mapping.columns.values() for name in names if name.lstrip("-") not in self.keys]
        if missing:
            text = f"has no key {printable(', '.join(missing), 80)} (it holds {self.list_keys()})"
            key, names = next((key, names) for key, names in mapping.columns.items() if set(names) & set(missing))
            raise RecordingError(self.path, text, repair=mapping.write_columns(key, {key: ["KEY"] * len(names)}))
        for key, names in mapping.columns.items():
            if names != (key,):
                self._parts[key], self.keys[key] = names, self.keys[names[0].lstrip("-")]

    def read(self, key: str) -> NDArray[Any]:
        """Return an array; raise RecordingError when it is too large, damaged, or of objects."""
        names = self._parts.get(key, ())
        if not names:
            return self._read(key)
        parts = [(-1.0 if name.startswith("-") else 1.0) * self._read(name.lstrip("-")) for name in names]
        return parts[0] if len(parts) == 1 else np.stack(parts, axis=-1)

    def _read(self, key: str) -> NDArray[Any]:
        info = self.keys[key]
        try:
            if info.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
                raise ValueError("numpy packs in another way")
            with self._zip_file.open(info) as file:
                version = np.lib.format.read_magic(file)
                if version not in HEADER_READERS:
                    raise ValueError("its header has another version")
                shape, is_fortran, dtype = HEADER_READERS[version](file)
                count = prod(shape)
                if not dtype.hasobject and count * dtype.itemsize > info.file_size:
                    raise ValueError(f"its header claims {count} values, which do not fit into it")
                if dtype.kind not in NUMBER_KINDS:
                    raise RecordingError(self.path, f"holds {printable(str(dtype), 40)}, not numbers", key)
                self._values += count * max(1, dtype.itemsize // FLOAT_SIZE)
                if self._values > MAX_VALUES:
                    raise RecordingError(self.path, f"holds more than {MAX_VALUES:,} numbers")
                data = file.read(count * dtype.itemsize)
            return np.frombuffer(data, dtype).reshape(shape, order="F" if is_fortran else "C")
        except ARCHIVE_ERRORS as error:
            raise RecordingError(self.path, f"cannot be read ({describe_error(error, 80)})", key) from error
