"""Files that a command writes: tried before the work, and in the place of an earlier run's only once they are whole."""

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
    """OSError now, not after a long recording was read. What is in the file stays."""
    there = path.exists()
    if not there or path.is_file() or path.is_dir():  # a pipe would take it for the end
        path.open("ab").close()
    if not there:
        path.unlink()


def write_json(path: Path, value: Any) -> None:
    """Write it as JSON, to be read by people too. OSError."""
    with path.open("w", encoding="utf-8") as file:
        json.dump(value, file, indent=1, allow_nan=False)
        file.write("\n")


@define
class FileReplacements:
    """`beside` says where to write instead; `keep` puts what was written there into its place, `discard` throws it away.

    Written in the same directory, so that a file is there as it was or as it is to be at any moment, whatever ends the
    program. What is no file, as a pipe, is written in place: it holds nothing that could be kept."""

    _places: dict[Path, Path] = field(factory=dict, init=False)
    """What is written -> whose place it takes."""

    def beside(self, path: Path, *, read_only: bool = False) -> Path:
        """An empty file in the directory of `path`. OSError, naming `path`, where that cannot be written. `read_only`:
        one that may not be written is replaced all the same, and stays so."""
        place = Path(os.path.realpath(path))  # of a link, what it leads to
        there = place.exists()
        if place.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
        if there and not place.is_file():
            return path
        if there and not read_only:
            place.open("ab").close()
        written = place.with_name(f".solepath-{os.getpid()}-{next(_numbers)}.part")
        self._places[written] = place  # before it is there: Ctrl-C may come between any two lines
        try:
            written.open("xb").close()
            if there:
                shutil.copymode(place, written)  # whoever may not read the one may not read the other
                written.chmod(written.stat().st_mode | S_IWUSR)
        except OSError as error:
            if isinstance(error, FileExistsError):
                del self._places[written]  # another program's, which is not ours to throw away
            raise OSError(error.errno, error.strerror, str(path)) from None
        return written

    def keep(self) -> None:
        for written, place in list(self._places.items()):
            try:
                if place.exists():
                    shutil.copymode(place, written)
                os.replace(written, place)
            except OSError as error:
                raise OSError(error.errno, error.strerror, str(place)) from None
            del self._places[written]

    def discard(self) -> None:
        for written in self._places:
            with suppress(OSError):
                written.unlink()
        self._places.clear()
