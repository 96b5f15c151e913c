"""Puts errors of the operating system into words: which file or folder, what is wrong with it, and what helps."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from ...recording import os_error_text
from .closest import closest_file

WORDS = {
    errno.EEXIST: "exists already",
    errno.EISDIR: "is a folder, not a file",
    errno.ENOTDIR: "is a file, not a folder",
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "your share of the disk is full",
    errno.EROFS: "this disk can be read only",
    errno.EFBIG: "is larger than this disk allows",
    errno.ENAMETOOLONG: "the name is too long",
    errno.ELOOP: "links lead in a circle",
    errno.EIO: "the disk failed: it cannot be read or written there",
    errno.EMFILE: "too many files are open",
    errno.ENXIO: "nobody reads or writes the other end of this pipe",
}
"""Fault of a file by the number of the error; other numbers keep the words of the system."""
ADDRESS_WORDS = {
    errno.EADDRINUSE: "another program has this port: name another one, or 0 for any that is free",
    errno.EADDRNOTAVAIL: "this machine has no such address",
    errno.EACCES: "only an administrator may use this port: name one above 1023",
    errno.ECONNREFUSED: "nothing answers there",
    errno.ETIMEDOUT: "nothing answers there",
    errno.EHOSTUNREACH: "there is no way to this machine",
    errno.ENETUNREACH: "there is no way to this machine",
}
"""Fault of an address of the network by the number of the error."""


def file_error_text(error: OSError, path: Path | str | None = None) -> str:
    """Return one sentence about a file that cannot be used; `path` is it, where the error does not name it."""
    name = error.filename if path is None else path
    if name is None or isinstance(name, int):
        return WORDS.get(error.errno or 0, os_error_text(error))
    given = Path(os.fsdecode(name))
    found = _find_fault(error.errno or 0, given)
    return f"{found[0]}: {found[1]}" if found else f"{given}: {os_error_text(error)}"


def in_words(error: Exception) -> str:
    """Return the sentence of an error; where it ends with the words of the system, with those for a person."""
    text, cause = str(error), error.__cause__ or error.__context__
    while cause is not None:
        system = cause.strerror if isinstance(cause, OSError) else None
        if isinstance(cause, OSError) and system and system.lower() in text.lower():
            start = text.lower().rindex(system.lower())
            end = text[start + len(system) :]
            path = getattr(error, "path", None) or cause.filename or text[:start].removesuffix(": ")
            return file_error_text(cause, path) + end
        cause = cause.__cause__ or cause.__context__
    return text


def address_error_text(error: OSError) -> str:
    """Return what is wrong with an address, by the error of the system or of the name server."""
    from socket import gaierror

    if isinstance(error, gaierror):
        return "no machine of this name is found"
    if error.errno in ADDRESS_WORDS:
        return ADDRESS_WORDS[error.errno]
    has_number = error.errno is not None and error.errno > 0
    return (os.strerror(error.errno or 0) if has_number else error.strerror or str(error)).lower()


def _find_fault(number: int, path: Path) -> tuple[Path, str] | None:
    """Return the file or folder that is to blame, and what is wrong with it; None for an error without words."""
    above = next((one for one in path.parents if os.path.exists(one)), path.parent)
    if number in (errno.ENOENT, errno.ENOTDIR) and above.is_file():
        return above, "is a file, not a folder"
    if number == errno.ENOENT:
        if above == path.parent or os.path.lexists(path):
            is_link = path.is_symlink()
            return path, "is a link to nothing" if is_link else f"there is no such file{closest_file(path)}"
        missing = above / path.relative_to(above).parts[0]
        return path, f"there is no folder {missing}{closest_file(missing) or ': make it first'}"
    if number in (errno.EACCES, errno.EPERM):
        if path.exists() and not os.access(path, os.R_OK):
            return path, "you have no permission to read it"
        if path.exists() and not os.access(path, os.W_OK):
            return path, "you have no permission to write it"
        return path, f"you have no permission for the folder {above}"
    return (path, WORDS[number]) if number in WORDS else None
