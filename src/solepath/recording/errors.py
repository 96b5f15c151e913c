"""Errors of recordings, each with one sentence for a person, and functions for their texts."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO


class RecordingError(Exception):
    """Error for a recording that cannot be used at all, or only up to `where`; its text has file, `where` and fault."""

    def __init__(self, path: Path | str, what: str, where: str = "") -> None:
        self.path, self.where, self.what = Path(path), where, what
        super().__init__(": ".join([printable(str(path))] + [part for part in (where, what) if part]))


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


def printable(text: str, max_length: int = 200) -> str:
    """Return `text` on one line, without control codes and not longer than `max_length` characters."""
    clean = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= max_length else clean[: max_length - 3] + "..."


def os_error_text(error: OSError) -> str:
    """Return the operating system's description of a failure, in lower case."""
    return (error.strerror or str(error)).lower()


def open_file(path: Path) -> BinaryIO:
    """Return the file opened for reading bytes; RecordingError when it is missing, a directory, or not readable."""
    try:
        if path.is_dir():
            raise RecordingError(path, "is a directory, not a recording")
        return path.open("rb")
    except OSError as error:
        raise RecordingError(path, os_error_text(error)) from error
