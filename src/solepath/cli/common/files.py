"""Checks that files can be written before the work starts, and replaces files only by complete ones."""

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
    """Check that a file can be written, without changing its contents; raise OSError when it cannot."""
    exists = path.exists()
    if not exists or path.is_file() or path.is_dir():  # closing would end a pipe
        path.open("ab").close()
    if not exists:
        path.unlink()


def write_json(path: Path, value: Any) -> None:
    """Write a value as indented JSON; raise OSError when it cannot be written."""
    with path.open("w", encoding="utf-8") as file:
        json.dump(value, file, indent=1, allow_nan=False)
        file.write("\n")


@define
class FileReplacements:
    """Replaces files when they are complete.

    `temporary_path` returns a file to write instead of the target. `move_to_targets` moves all temporary files to their
    targets; `discard` removes them. A temporary file is in the directory of its target, so that a target is unchanged
    or complete, whatever ends the program. A path that is no regular file, such as a pipe, is written directly."""

    _targets: dict[Path, Path] = field(factory=dict, init=False)
    """Path of the file that each temporary path replaces."""

    def temporary_path(self, path: Path, *, read_only: bool = False) -> Path:
        """Make an empty file in the directory of `path` and return it; raise OSError, naming `path`, when that fails.

        With `read_only`, a file without write permission is replaced as well, by one without this permission."""
        target = Path(os.path.realpath(path))  # a symbolic link stays; the file that it points to is replaced
        exists = target.exists()
        if target.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
        if exists and not target.is_file():
            return path
        if exists and not read_only:
            target.open("ab").close()
        temporary = target.with_name(f".solepath-{os.getpid()}-{next(_numbers)}.part")
        self._targets[temporary] = target  # before it exists: Ctrl-C may come between any two lines
        try:
            temporary.open("xb").close()
            if exists:
                shutil.copymode(target, temporary)  # the new file has the same permissions
                temporary.chmod(temporary.stat().st_mode | S_IWUSR)
        except OSError as error:
            if isinstance(error, FileExistsError):
                del self._targets[temporary]  # the file belongs to another program and stays
            raise OSError(error.errno, error.strerror, str(path)) from None
        return temporary

    def move_to_targets(self) -> None:
        """Move all temporary files to their targets; raise OSError, naming the target, when one cannot be moved."""
        for temporary, target in list(self._targets.items()):
            try:
                if target.exists():
                    shutil.copymode(target, temporary)
                os.replace(temporary, target)
            except OSError as error:
                raise OSError(error.errno, error.strerror, str(target)) from None
            del self._targets[temporary]

    def discard(self) -> None:
        """Remove all temporary files."""
        for temporary in self._targets:
            with suppress(OSError):
                temporary.unlink()
        self._targets.clear()
