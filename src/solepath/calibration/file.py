"""The file of a calibration: JSON (protocol/calibration.md), as `solepath calibrate` writes it."""

from __future__ import annotations

import json
from pathlib import Path

from ..saving.codec import SnapshotError, load, save
from .limits import unusable
from .records import Calibration, CalibrationError

FORMAT = "solepath-calibration"
VERSION = 1
LARGEST = 8_000_000
"""Bytes of a file; two insoles of a thousand cells have a hundredth of that."""


def write_calibration(path: Path | str, calibration: Calibration) -> None:
    """Write it to a file; OSError where that cannot be."""
    told = {"format": FORMAT, "version": VERSION, "calibration": save(calibration)}
    Path(path).write_text(json.dumps(told, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def read_calibration(path: Path | str) -> Calibration:
    """The calibration in a file. CalibrationError when the file cannot be read, is not one, or holds what cannot be."""
    try:
        if Path(path).exists() and not Path(path).is_file() and not Path(path).is_dir():
            raise CalibrationError(f"{path}: is no regular file")
        told = json.loads(bounded_text(Path(path)))
    except CalibrationError:
        raise
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise CalibrationError(f"{path}: is not JSON ({error})") from None
    except RecursionError:
        raise CalibrationError(f"{path}: is not a calibration: it is nested too deeply") from None
    if not isinstance(told, dict) or told.get("format") != FORMAT:
        raise CalibrationError(f"{path}: is not a calibration")
    if told.get("version") != VERSION:
        raise CalibrationError(f"{path}: is of version {told.get('version')!r}; this release reads {VERSION}")
    what = told.get("calibration")
    if isinstance(what, dict):
        what.setdefault("toe_out", {})  # files from before there was one are good
    try:
        found = load(Calibration, what)
    except SnapshotError as error:
        what = str(error).removeprefix("not a snapshot of Calibration: ")
        raise CalibrationError(f"{path}: is not a calibration ({what})") from None
    why_not = unusable(found)
    if why_not is not None:
        raise CalibrationError(f"{path}: {why_not}")
    return found


def bounded_text(path: Path, encoding: str = "utf-8") -> str:
    """What is in a file. CalibrationError when it is larger than any of ours, or never ends; OSError and ValueError
    when it cannot be read or is no text."""
    with path.open("rb") as file:
        data = file.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise CalibrationError(f"{path}: is larger than {LARGEST // 1_000_000} MB, too large for what it should be")
    return data.decode(encoding)
