"""Errors of recordings, in one sentence; and files opened so that the sentence names them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO


class RecordingError(Exception):
    """A recording cannot be used, or not beyond a place: one sentence with the file, the place and the fault."""

    def __init__(self, path: Path | str, what: str, where: str = "") -> None:
        self.path, self.where, self.what = Path(path), where, what
        super().__init__(": ".join([printable(str(path))] + [part for part in (where, what) if part]))


class RecordingWarning(UserWarning):
    """A recording has a flaw whose only effect is missing data (a torn last line)."""


Report = Callable[[str], None]
"""A function that receives one sentence about a flaw that does not stop the reading."""


def warn(sentence: str) -> None:
    """Report a sentence as a RecordingWarning; the default report."""
    warnings.warn(sentence, RecordingWarning, stacklevel=3)


def printable(text: str, longest: int = 200) -> str:
    """Return `text` on one line and without control codes, whatever a file or its name holds."""
    clean = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= longest else clean[: longest - 3] + "..."


def os_error_text(error: OSError) -> str:
    """Return the system's own text of a failure, in lower case."""
    return (error.strerror or str(error)).lower()


def open_file(path: Path) -> BinaryIO:
    """Return the file opened for reading bytes.

    RecordingError when there is none, it is a directory or may not be read."""
    try:
        if path.is_dir():
            raise RecordingError(path, "is a directory, not a recording")
        return path.open("rb")
    except OSError as error:
        raise RecordingError(path, os_error_text(error)) from error
