"""Files that a command writes: tried before the work, and put in place of an earlier run's only when complete."""

from __future__ import annotations

import json
import os
import shutil
from contextlib import suppress
from errno import EISDIR
from itertools import count
from pathlib import Path
from stat import S_IWUSR
from typing import Any

from attrs import define, field

_numbers = count()


def check_writable(path: Path) -> None:
    """Check that a file can be written, before a long recording is read; its contents stay. OSError when it cannot."""
    there = path.exists()
    if not there or path.is_file() or path.is_dir():  # closing would end a pipe
        path.open("ab").close()
    if not there:
        path.unlink()


def write_json(path: Path, value: Any) -> None:
    """Write a value as JSON that people can read too. OSError when it cannot be written."""
    with path.open("w", encoding="utf-8") as file:
        json.dump(value, file, indent=1, allow_nan=False)
        file.write("\n")


@define
class FileReplacements:
    """Replaces files when they are complete.

    `temporary_path` returns where to write instead; `keep` moves what was written there to its place, `discard` removes it. The
    temporary file is in the same directory, so that at any moment a file is either as it was or as it is to be,
    whatever ends the program. A path that is no regular file, such as a pipe, is written in place: it holds nothing
    that could be kept."""

    _places: dict[Path, Path] = field(factory=dict, init=False)
    """Temporary path -> path of the file that it replaces."""

    def temporary_path(self, path: Path, *, read_only: bool = False) -> Path:
        """Return an empty file in the directory of `path`; OSError, naming `path`, when it cannot be written.

        With `read_only`, a file without write permission is replaced all the same, and stays without it."""
        place = Path(os.path.realpath(path))  # the target of a link
        there = place.exists()
        if place.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
        if there and not place.is_file():
            return path
        if there and not read_only:
            place.open("ab").close()
        written = place.with_name(f".solepath-{os.getpid()}-{next(_numbers)}.part")
        self._places[written] = place  # before it exists: Ctrl-C may come between any two lines
        try:
            written.open("xb").close()
            if there:
                shutil.copymode(place, written)  # the new file has the same permissions
                written.chmod(written.stat().st_mode | S_IWUSR)
        except OSError as error:
            if isinstance(error, FileExistsError):
                del self._places[written]  # the file belongs to another program and stays
            raise OSError(error.errno, error.strerror, str(path)) from None
        return written

    def keep(self) -> None:
        """Move all temporary files to their places. OSError, naming the file, when one cannot be moved."""
        for written, place in list(self._places.items()):
            try:
                if place.exists():
                    shutil.copymode(place, written)
                os.replace(written, place)
            except OSError as error:
                raise OSError(error.errno, error.strerror, str(place)) from None
            del self._places[written]

    def discard(self) -> None:
        """Remove all temporary files."""
        for written in self._places:
            with suppress(OSError):
                written.unlink()
        self._places.clear()
