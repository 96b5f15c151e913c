"""Samples in a NumPy archive: keys t, acc, gyro, pressure for one foot, or with _left and _right."""

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
from .table import QUANTITIES, Floats, FootTable, as_floats

UNREADABLE = (
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
"""Exceptions of a damaged archive."""


def read_npz(path: Path, one_foot: Foot) -> list[FootTable]:
    """Return the tables of the feet in the file; only their shapes are checked.

    `one_foot` is the foot of a file whose keys name no foot."""
    with open_file(path) as file:
        start = file.read(4)
    if not start:
        raise RecordingError(path, "is empty")
    if start != b"PK\x03\x04":
        raise RecordingError(path, "is not an .npz archive")
    try:
        archive = np.load(path, allow_pickle=False)
    except UNREADABLE as error:
        raise RecordingError(path, f"is not a whole .npz archive ({_reason(error)}); was it cut off?") from error
    with archive:
        found = set(archive.files)
        both = [foot for foot in Foot if any(f"{q}_{foot.value}" in found for q in QUANTITIES)]
        bare = [q for q in QUANTITIES if q in found]
        if bare and both:
            named = f"{bare[0]} and {next(q for q in QUANTITIES if f'{q}_{both[0].value}' in found)}_{both[0].value}"
            raise RecordingError(path, f"holds both {named}: is it of one foot or of two?")
        if bare:
            return [_table(path, archive, one_foot, "")]
        if both:
            return [_table(path, archive, foot, f"_{foot.value}") for foot in both]
        keys = printable(", ".join(sorted(found)) or "nothing", 80)
        raise RecordingError(path, f"has no key acc or pressure, nor acc_left or acc_right (it holds {keys})")


def _table(path: Path, archive: Any, foot: Foot, suffix: str) -> FootTable:
    names = {q: q + suffix for q in QUANTITIES if q + suffix in archive.files}
    time = "t" + suffix if "t" + suffix in archive.files else "t"
    if time not in archive.files:
        raise RecordingError(path, f'has no key "t"{suffix and f" and no key {time + suffix}"}')
    if "gyro" in names and "acc" not in names:
        raise RecordingError(path, f"has the key gyro{suffix} but no key acc{suffix}")
    t = as_floats(path, time, _array(path, archive, time), 0)
    columns: dict[str, Floats] = {}
    for quantity, name in names.items():
        value = as_floats(path, name, _array(path, archive, name), None if quantity == "pressure" else 3)
        if len(value) != len(t):
            raise RecordingError(path, f"has {len(value)} rows but {time} has {len(t)}", name)
        columns[quantity] = value
    return FootTable(path, foot, {"t": time, **names}, t, columns)


def _array(path: Path, archive: Any, key: str) -> NDArray[Any]:
    try:
        value: NDArray[Any] = archive[key]
    except UNREADABLE as error:
        raise RecordingError(path, f"cannot be read ({_reason(error)})", key) from error
    return value


def _reason(error: BaseException) -> str:
    return printable(str(error).splitlines()[0] if str(error) else type(error).__name__, 80)
