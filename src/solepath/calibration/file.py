"""Reads and writes the calibration file: JSON (protocol/calibration.md), as `solepath calibrate` writes it."""

from __future__ import annotations

import json
from pathlib import Path

from ..saving.codec import SnapshotError, load, save
from ..saving.files import BeforeMove, FileTooLarge, accept_any, read_bounded, write_whole
from ..types.checking import find_fault
from .records import Calibration, CalibrationError

FORMAT = "solepath-calibration"
VERSION = 2
"""Version of the file: in 1, noise was in newtons if the insole had a conversion to them."""
MAX_FILE_SIZE = 8_000_000
"""Largest accepted size of a file, bytes: a hundred times that of two insoles of a thousand cells."""


def write_calibration(path: Path | str, calibration: Calibration, before_move: BeforeMove = accept_any) -> None:
    """Write the calibration to a file. Raise OSError when that fails; the file then has its earlier content.

    `before_move` is called before the new file replaces the earlier one, which then stays if it raises an error."""
    document = {"format": FORMAT, "version": VERSION, "calibration": save(calibration)}
    write_whole(path, json.dumps(document, indent=1, allow_nan=False) + "\n", before_move)


def read_calibration(path: Path | str) -> Calibration:
    """Return the calibration in a file.

    CalibrationError is raised when the file cannot be read, is not a calibration, or holds a value outside its limits.
    """
    try:
        document = json.loads(bounded_text(Path(path)))
    except CalibrationError:
        raise
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise CalibrationError(f"{path}: is not JSON ({error})") from None
    except RecursionError:
        raise CalibrationError(f"{path}: is not a calibration: it is nested too deeply") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise CalibrationError(f"{path}: is not a calibration")
    if document.get("version") != VERSION:
        found = document.get("version")
        raise CalibrationError(f"{path}: is of version {found!r}; this release reads {VERSION}: calibrate again")
    try:
        calibration = load(Calibration, document.get("calibration"))
    except SnapshotError as error:
        content = str(error).removeprefix("not a snapshot of Calibration: ")
        raise CalibrationError(f"{path}: is not a calibration ({content})") from None
    fault = find_fault(calibration, Calibration)
    if fault is not None:
        raise CalibrationError(f"{path}: {fault}")
    return calibration


def bounded_text(path: Path, encoding: str = "utf-8") -> str:
    """Return the text of a file of at most MAX_FILE_SIZE bytes.

    CalibrationError is raised when the file is larger or has no end, OSError when it cannot be read, ValueError when it
    is not text."""
    try:
        return read_bounded(path, MAX_FILE_SIZE).decode(encoding)
    except FileTooLarge as error:
        raise CalibrationError(f"{path}: {error}, too large for what it should be") from None
