"""Reading of samples from a NumPy archive with the keys t, acc, gyro, pressure, or these with _left and _right."""

from __future__ import annotations

import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...types import Foot
from ..errors import RecordingError, open_file, printable
from .table import QUANTITIES, Floats, FootTable, to_floats

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
    zipfile.BadZipFile,
    zlib.error,
)
"""Exceptions that numpy raises for a damaged archive."""


def read_npz(path: Path, one_foot: Foot) -> list[FootTable]:
    """Return the tables of the feet in the file, of which only the shapes are checked.

    `one_foot`: foot of a file whose keys name no foot."""
    with open_file(path) as file:
        start = file.read(4)
    if not start:
        raise RecordingError(path, "is empty")
    if start != b"PK\x03\x04":
        raise RecordingError(path, "is not an .npz archive")
    try:
        archive = np.load(path, allow_pickle=False)
    except ARCHIVE_ERRORS as error:
        raise RecordingError(
            path, f"is not a whole .npz archive ({_describe_error(error)}); was it cut off?"
        ) from error
    with archive:
        keys_found = set(archive.files)
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
        keys = printable(", ".join(sorted(keys_found)) or "nothing", 80)
        raise RecordingError(path, f"has no key acc or pressure, nor acc_left or acc_right (it holds {keys})")


def _read_table(path: Path, archive: Any, foot: Foot, suffix: str) -> FootTable:
    names = {q: q + suffix for q in QUANTITIES if q + suffix in archive.files}
    time_key = "t" + suffix if "t" + suffix in archive.files else "t"
    if time_key not in archive.files:
        raise RecordingError(path, f'has no key "t"{suffix and f" and no key {time_key + suffix}"}')
    if "gyro" in names and "acc" not in names:
        raise RecordingError(path, f"has the key gyro{suffix} but no key acc{suffix}")
    t = to_floats(path, time_key, _read_array(path, archive, time_key), 0)
    columns: dict[str, Floats] = {}
    for quantity, name in names.items():
        array = to_floats(path, name, _read_array(path, archive, name), None if quantity == "pressure" else 3)
        if len(array) != len(t):
            raise RecordingError(path, f"has {len(array)} rows but {time_key} has {len(t)}", name)
        columns[quantity] = array
    return FootTable(path, foot, {"t": time_key, **names}, t, columns)


def _read_array(path: Path, archive: Any, key: str) -> NDArray[Any]:
    try:
        array: NDArray[Any] = archive[key]
    except ARCHIVE_ERRORS as error:
        raise RecordingError(path, f"cannot be read ({_describe_error(error)})", key) from error
    return array


def _describe_error(error: BaseException) -> str:
    return printable(str(error).splitlines()[0] if str(error) else type(error).__name__, 80)
