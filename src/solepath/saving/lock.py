"""An exclusive lock of a file, which the operating system releases when the program ends, however it ends.

A child that the program made by fork has the lock too: then it is free when both have ended or closed the file."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from errno import EACCES, EAGAIN, EDEADLK
from pathlib import Path
from time import sleep

TAKEN = frozenset((EACCES, EAGAIN, EDEADLK))
"""Errors with which a system reports that another program has the lock."""
LOCKED = "another program is recording into it"
"""Text of the error for a file that another program has locked."""
RETRY_INTERVAL, MAX_TRIES = 0.01, 50
"""Time between two tries to lock a file that is replaced, s, and their number; chosen by hand.

A recorder holds the lock for a walk, a program that replaces the file for much less than one interval."""

if sys.platform == "win32":
    import msvcrt

    FAR_POSITION = 0x7FFF_0000_0000_0000
    """Position of the locked byte: a lock of Windows also forbids to read, so it is where no file has data."""

    def _lock(descriptor: int) -> None:
        position = os.lseek(descriptor, 0, os.SEEK_CUR)
        try:
            os.lseek(descriptor, FAR_POSITION, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        finally:
            os.lseek(descriptor, position, os.SEEK_SET)

else:
    try:
        from fcntl import LOCK_EX, LOCK_NB, flock
    except ImportError:  # a browser, where no other program can write into the files of a page

        def _lock(descriptor: int) -> None:
            pass

    else:

        def _lock(descriptor: int) -> None:
            flock(descriptor, LOCK_EX | LOCK_NB)


def take_lock(descriptor: int) -> bool:
    """Lock an open file for this program; return False when another program has locked it.

    Where the system has no locks, as on some network drives, the file counts as locked for this program."""
    try:
        _lock(descriptor)
    except OSError as error:
        return error.errno not in TAKEN
    return True


@contextmanager
def locked(path: Path) -> Iterator[bool]:
    """Lock the file at `path` and yield True; yield False when there is none.

    BlockingIOError when another program keeps the lock, OSError when the file cannot be opened. On Windows, which
    replaces no open file, the lock is only tried: there nobody replaces a file that a recorder has open anyway."""
    for _ in range(MAX_TRIES):
        try:
            descriptor = os.open(path, os.O_RDONLY)
        except FileNotFoundError:
            yield False
            return
        with os.fdopen(descriptor, "rb") as file:
            if take_lock(descriptor) and _is_at(path, descriptor):
                if sys.platform == "win32":
                    file.close()
                yield True
                return
        sleep(RETRY_INTERVAL)
    raise BlockingIOError(EAGAIN, LOCKED, str(path))


def _is_at(path: Path, descriptor: int) -> bool:
    """Return whether the open file is still the one at `path`: a lock of a replaced file protects nothing."""
    with suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(descriptor), path.stat())
    return False
