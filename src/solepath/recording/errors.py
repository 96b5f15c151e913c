"""Errors of recordings, each with one sentence for a person, and functions for their texts."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from math import isfinite, nan
from pathlib import Path
from typing import BinaryIO

_SAVE = "save its table as .csv or .xlsx"
_UNPACK = "unpack it, and give what is in it; the log of an iPhone (logs/Bluetooth) is for `solepath convert`"
UNREAD_SAMPLES = {
    ".xls": _SAVE,
    ".xlsb": _SAVE,
    ".ods": _SAVE,
    ".h5": _SAVE,
    ".hdf5": _SAVE,
    ".feather": _SAVE,
    ".tar": _UNPACK,
    ".tgz": _UNPACK,
    ".mat": "in MATLAB, writematrix([t, acc, gyro], 'walk.csv') with columns of your own; then give walk.csv"
    " with --columns t=1,acc=2,3,4,gyro=5,6,7",
}
"""What to do with files of samples that are not read, by their suffixes."""
SAMPLE_SUFFIXES = (".npz", ".csv", ".tsv", ".txt", ".xlsx", ".xlsm", ".parquet", *UNREAD_SAMPLES)
"""Suffixes of files that hold samples."""
MAX_NAMED_FILES = 3
"""Largest number of files that the error for a folder names; chosen by hand."""


class RecordingError(Exception):
    """Error for a recording that cannot be used at all, or only up to `where`; its text has file, `where` and fault.

    `repair` is an option of the command line, a line of a mapping or an action with which the fault ends; "" if none is
    known."""

    _problems: tuple[RecordingError, ...] = ()

    def __init__(self, path: Path | str, what: str, where: str = "", repair: str = "") -> None:
        self.path, self.where, self.what, self.repair = Path(path), where, what, repair
        parts = [printable(str(path)), *(part for part in (where, what) if part)]
        super().__init__(": ".join(parts) + (f"; repair: {repair}" if repair else ""))

    @property
    def problems(self) -> tuple[RecordingError, ...]:
        """All faults that were found, in their order: this one, unless it was made by `of`."""
        return self._problems or (self,)

    @classmethod
    def of(cls, problems: Sequence[RecordingError]) -> RecordingError:
        """Return one error for all of these, which are at least one; its text has one line for each."""
        first = problems[0]
        if len(problems) > 1:
            first = RecordingError(first.path, first.what, first.where, first.repair)
            first.args, first._problems = ("\n".join(map(str, problems)),), tuple(problems)
        return first


class UnusableValues(RecordingError):
    """Error for a recording whose numbers can be read but are not what they should be.

    They are in another unit, or the times are not those of the samples."""


class RecordingWarning(UserWarning):
    """Warning about a flaw that only makes data missing, such as an incomplete last line."""


Report = Callable[[str], None]
"""A function that receives one sentence about a flaw that does not stop the reading."""


def warn(sentence: str) -> None:
    """Issue a sentence as a RecordingWarning, as the default report does."""
    warnings.warn(sentence, RecordingWarning, stacklevel=3)


def finite(text: str) -> float:
    """Return the finite number in `text`; raise ValueError for any other text."""
    value = nan if "_" in text else float(text)  # Python reads 1_0 as ten
    if not isfinite(value):
        raise ValueError(f"{text!r} is no number")
    return value


def printable(text: str, max_length: int = 200) -> str:
    """Return `text` on one line, without control codes and not longer than `max_length` characters."""
    clean = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= max_length else clean[: max_length - 3] + "..."


def os_error_text(error: OSError) -> str:
    """Return the operating system's description of a failure, in lower case."""
    return (error.strerror or str(error)).lower()


def describe_error(error: BaseException, max_length: int = 120) -> str:
    """Return the first line of an error of a library, or the name of its kind."""
    lines = str(error).strip().splitlines()
    return printable(lines[0] if lines else type(error).__name__, max_length)


def _recordings_in(folder: Path) -> str:
    """Return the first files of a folder that may be recordings, by their names, as the end of a sentence."""
    names = sorted(one.name for one in folder.iterdir() if one.suffix.lower() in (".jsonl", *SAMPLE_SUFFIXES))
    more = " and others" if len(names) > MAX_NAMED_FILES else ""
    return f"; it has {', '.join(map(printable, names[:MAX_NAMED_FILES]))}{more}" if names else ""


def open_file(path: Path) -> BinaryIO:
    """Return the file opened for reading bytes; RecordingError when it is missing, a folder, or not readable."""
    try:
        if path.is_dir():
            raise RecordingError(path, f"is a folder, not a recording{_recordings_in(path)}")
        return path.open("rb")
    except OSError as error:
        raise RecordingError(path, os_error_text(error)) from error
