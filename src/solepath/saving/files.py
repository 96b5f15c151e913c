"""Reading of whole files up to a limit, and writing of files that are replaced only by complete ones."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from errno import EISDIR
from functools import partial
from pathlib import Path
from stat import S_IMODE, S_IWUSR

from ..types.attrs import define, field
from .lock import locked


class FileTooLarge(ValueError):
    """Error for a file that is larger than what is read, or that has no end, such as a device."""


def read_bounded(path: Path, max_size: int) -> bytes:
    """Return the bytes of a file, a pipe or a device; raise FileTooLarge for more than `max_size`, or OSError."""
    with path.open("rb") as file:
        data = file.read(max_size + 1)
    if len(data) > max_size:
        raise FileTooLarge(f"is larger than {max_size // 1_000_000} MB")
    return data


BeforeMove = Callable[[Path], object]
"""A last check of a file that is replaced next, which raises what stops that; the file is locked meanwhile."""


def accept_any(path: Path) -> None:
    """Replace the file, whatever it is now."""


def identity(path: Path) -> tuple[int, ...] | None:
    """Return what differs when another program writes or replaces a file; None if there is none."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


def write_whole(path: Path | str, text: str, before_move: BeforeMove = accept_any) -> None:
    """Write a text as the whole content of a file, in UTF-8; raise OSError, naming the file, when that fails.

    Whatever ends the program, and if the disk is full, the file has its earlier content or the whole text. A file that
    another program records into is not replaced."""
    replace_whole(Path(path), partial(Path.write_text, data=text, encoding="utf-8", newline="\n"), before_move)


def replace_whole(path: Path, write: Callable[[Path], object], before_move: BeforeMove = accept_any) -> None:
    """Replace a file by the one that `write` writes to the path that it is given, if it raises nothing."""
    files = FileReplacements(before_move)
    try:
        temporary = files.temporary_path(path)
        with os_errors_naming(path):
            write(temporary)
        files.move_to_targets()
    finally:
        files.discard()


@define
class FileReplacements:
    """Replaces files when they are complete.

    `temporary_path` returns a file to write instead of the target. `move_to_targets` moves all temporary files to their
    targets, once the disk has them; `discard` removes them. A temporary file is in the directory of its target, so that
    a target is unchanged or complete, whatever ends the program, and after a power failure too. A path that is no
    regular file, such as a pipe, is written directly. A target that another program has locked, because it records
    into it, is not replaced, nor is one that `before_move` raises an error for."""

    before_move: BeforeMove = accept_any
    _targets: dict[Path, Path] = field(factory=dict, init=False)
    """Path that each temporary path was made for."""

    def temporary_path(self, path: Path) -> Path:
        """Make an empty file in the directory of `path` and return it; raise OSError, naming `path`, if that fails."""
        target = Path(os.path.realpath(path))  # a symbolic link stays; the file that it points to is replaced
        exists = target.exists()
        if target.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
        if exists and not target.is_file():
            return path
        if exists:
            target.open("ab").close()
        temporary = target.with_name(f".solepath-{os.urandom(8).hex()}.part")
        self._targets[temporary] = path  # before it exists: Ctrl-C may come between any two lines
        with os_errors_naming(path):
            temporary.open("xb").close()
            if exists:
                temporary.chmod(S_IMODE(target.stat().st_mode) | S_IWUSR)  # the permissions of now, if somebody looks
        return temporary

    def move_to_targets(self) -> None:
        """Move all temporary files to their targets; raise OSError, naming the path, when one cannot be moved."""
        for temporary, path in list(self._targets.items()):
            with os_errors_naming(path):
                with temporary.open("r+b") as file:
                    os.fsync(file.fileno())  # otherwise a power failure may leave the new name with no content
                while not self._try_to_move(temporary, path):
                    pass
            del self._targets[temporary]

    def _try_to_move(self, temporary: Path, path: Path) -> bool:
        """Move a temporary file; return False if the file at `path` appeared just now, so that it is checked again."""
        target = Path(os.path.realpath(path))
        with locked(target) as exists:
            self.before_move(path)
            if exists:
                temporary.chmod(S_IMODE(target.stat().st_mode))
                os.replace(temporary, target)
                return True
        try:
            os.link(temporary, target)  # unlike os.replace, this replaces nothing
        except FileExistsError:
            return False
        except (OSError, AttributeError):  # a file system, or a system, without hard links
            os.replace(temporary, target)
        else:
            temporary.unlink()
        return True

    def discard(self) -> None:
        """Remove all temporary files."""
        for temporary in self._targets:
            with suppress(OSError):
                temporary.unlink()
        self._targets.clear()


@contextmanager
def os_errors_naming(path: Path) -> Iterator[None]:
    """Name `path` in every OSError within the context: the system names a temporary file, or none on a full disk."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
