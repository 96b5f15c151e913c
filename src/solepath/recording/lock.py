"""An exclusive lock of an open file, which the operating system releases when the program ends, however it ends."""

from __future__ import annotations

import os
import sys
from errno import EACCES, EAGAIN, EDEADLK

TAKEN = frozenset((EACCES, EAGAIN, EDEADLK))
"""Errors with which a system reports that another program has the lock."""

if sys.platform == "win32":
    import msvcrt

    FAR_POSITION = 0x7FFF_0000_0000_0000
    """Position of the locked byte: a lock of Windows also forbids to read, so it is where no file has data."""

    def take_lock(descriptor: int) -> bool:
        """Lock an open file for this program; return False when another program has locked it.

        Where the system has no locks, as on some network drives, the file counts as locked for this program."""
        position = os.lseek(descriptor, 0, os.SEEK_CUR)
        try:
            os.lseek(descriptor, FAR_POSITION, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except OSError as error:
            return error.errno not in TAKEN
        finally:
            os.lseek(descriptor, position, os.SEEK_SET)
        return True

else:
    try:
        from fcntl import LOCK_EX, LOCK_NB, flock
    except ImportError:  # a browser

        def take_lock(descriptor: int) -> bool:
            """Return True, since no other program can write into the files of a browser's page."""
            return True

    else:

        def take_lock(descriptor: int) -> bool:
            """Lock an open file for this program; return False when another program has locked it.

            Where the system has no locks, as on some network drives, the file counts as locked for this program."""
            try:
                flock(descriptor, LOCK_EX | LOCK_NB)
            except OSError as error:
                return error.errno not in TAKEN
            return True
