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
from typing import IO, Any, BinaryIO
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile

import numpy as np
from numpy.typing import NDArray

from ...types import Foot
from ..errors import RecordingError, open_file, printable
from ..mapping.mapping import TableMapping
from ..mapping.units import UNITS, find_unit
from .table import MAX_VALUES, QUANTITIES, Floats, FootTable, to_floats

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


def read_npz(path: Path, one_foot: Foot | None, mapping: TableMapping | None = None) -> list[FootTable]:
    """Return the tables of the feet in the file, of which only the shapes are checked.

    `one_foot`: foot of a file whose keys name no foot, None if it is not known. `mapping`: keys and units, where they
    are not this project's own; a key holds all components of a quantity, or one of them. RecordingError as for
    `read_arrays`."""
    mapping = mapping or TableMapping()
    with _open_archive(path) as archive:
        archive.rename(mapping)
        tables = _read_tables(path, archive, one_foot)
    for table in tables:
        table.mapping = mapping
        for quantity, unit in mapping.units.items():
            known = find_unit(unit)
            factor = 1.0 if known is None else UNITS[quantity][known[1]]
            table.units[quantity] = unit if known is None else known[1]
            if quantity == "t":
                table.t = table.t * factor
                table.is_own = table.is_own and factor == 1.0
            elif quantity in table.columns:
                table.columns[quantity] = table.columns[quantity] * factor
    return tables


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
                path, f"is not a whole .npz archive ({_describe_error(error)}); was it cut off?"
            ) from error
        yield archive


def _read_tables(path: Path, archive: _Archive, one_foot: Foot | None) -> list[FootTable]:
    keys_found = set(archive.keys)
    feet = [foot for foot in Foot if any(f"{q}_{foot.value}" in keys_found for q in QUANTITIES)]
    bare_keys = [q for q in QUANTITIES if q in keys_found]
    if bare_keys and feet:
        named_key = next(q for q in QUANTITIES if f"{q}_{feet[0].value}" in keys_found)
        example_keys = f"{bare_keys[0]} and {named_key}_{feet[0].value}"
        raise RecordingError(path, f"holds both {example_keys}: is it of one foot or of two?")
    if bare_keys:
        return [_read_table(path, archive, one_foot, "")]
    if feet:
        return [_read_table(path, archive, foot, f"_{foot.value}") for foot in feet]
    text = f"has no key acc or pressure, nor acc_left or acc_right (it holds {archive.list_keys()})"
    raise RecordingError(path, text, repair="--columns t=KEY,acc=KEY,gyro=KEY")


def _read_table(path: Path, archive: _Archive, foot: Foot | None, suffix: str) -> FootTable:
    names = {q: q + suffix for q in QUANTITIES if q + suffix in archive.keys}
    time_key = "t" + suffix if "t" + suffix in archive.keys else "t"
    missing = [] if time_key in archive.keys else [("t", f'"t"{suffix and f" and no key {time_key + suffix}"}')]
    if "gyro" in names and "acc" not in names:
        missing.append(("acc", f"acc{suffix}"))
    if missing:
        text = f"has no key {' and no key '.join(name for _, name in missing)} (it holds {archive.list_keys()})"
        raise RecordingError(path, text, repair=f"--columns {','.join(f'{key}=KEY' for key, _ in missing)}")
    t = to_floats(path, time_key, archive.read(time_key), 0)
    columns: dict[str, Floats] = {}
    for quantity, name in names.items():
        array = to_floats(path, name, archive.read(name), None if quantity == "pressure" else 3)
        if len(array) != len(t):
            raise RecordingError(path, f"has {len(array)} rows but {time_key} has {len(t)}", name)
        columns[quantity] = array
    names = {"t": time_key, **names}
    return FootTable(path, foot or Foot.RIGHT, names, t, columns, is_assumed=foot is None, is_named=bool(suffix))


class _Archive:
    """The arrays of an archive by key, of which at most MAX_VALUES numbers are read in all."""

    def __init__(self, path: Path, zip_file: ZipFile) -> None:
        self._path, self._zip_file, self._values = path, zip_file, 0
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
            raise RecordingError(self._path, text, repair=mapping.write_columns(key, {key: ["KEY"] * len(names)}))
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
                count, dtype = _read_claim(file, info.file_size)
            if dtype.kind not in NUMBER_KINDS:
                raise RecordingError(self._path, f"holds {printable(str(dtype), 40)}, not numbers", key)
            self._values += count * max(1, dtype.itemsize // FLOAT_SIZE)
            if self._values > MAX_VALUES:
                raise RecordingError(self._path, f"holds more than {MAX_VALUES:,} numbers")
            with self._zip_file.open(info) as file:
                array: NDArray[Any] = np.lib.format.read_array(file, allow_pickle=False)
        except ARCHIVE_ERRORS as error:
            raise RecordingError(self._path, f"cannot be read ({_describe_error(error)})", key) from error
        return array


def _read_claim(file: IO[bytes], size: int) -> tuple[int, np.dtype[Any]]:
    """Return the number of values that the header of an array claims, and their type, before any is unpacked.

    ValueError when the file is not as large."""
    version = np.lib.format.read_magic(file)
    if version not in HEADER_READERS:
        raise ValueError("its header has another version")
    shape, _, dtype = HEADER_READERS[version](file)
    count = prod(shape)
    if not dtype.hasobject and count * dtype.itemsize > size:
        raise ValueError(f"its header claims {count} values, which do not fit into it")
    return count, dtype


def _describe_error(error: BaseException) -> str:
    return printable(str(error).splitlines()[0] if str(error) else type(error).__name__, 80)
