"""Opening of files that may be compressed: .gz, .bz2, .xz, and a .zip with one recording in it, within a bound.

A file that unpacks to far more than data of sensors do is rejected before it takes memory or time."""

from __future__ import annotations

import bz2
import gzip
import zlib
from collections.abc import Callable, Sequence
from io import BufferedReader, RawIOBase
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile

from .errors import SAMPLE_SUFFIXES, RecordingError, describe_error, open_file, printable

try:
    import lzma
except ImportError:  # Python in a browser has no lzma: .xz is not known there
    lzma = None  # type: ignore[assignment]

MAX_RATIO = 100.0
"""Largest ratio of unpacked to packed size. Tables of walks have 2 to 12, of a sensor that lies still 20; DEFLATE
itself ends at 1032."""
HARMLESS = 5_000_000
"""Size up to which the ratio does not matter, bytes; it is read in about a second."""
PACKED: dict[bytes, tuple[str, Callable[[BinaryIO], Any]]] = {
    b"\x1f\x8b": (".gz", lambda file: gzip.GzipFile(fileobj=file)),
    b"BZ": (".bz2", bz2.BZ2File),
}
"""Suffix and reader of each kind of compressed file, by its first bytes."""
ERRORS: tuple[type[Exception], ...] = (OSError, zlib.error, BadZipFile, NotImplementedError, RuntimeError)
"""Errors of these readers for damaged data; RuntimeError is for an archive with a password."""
if lzma is not None:
    PACKED[b"\xfd7"] = (".xz", lzma.LZMAFile)
    ERRORS = (*ERRORS, lzma.LZMAError)


def check_ratio(path: Path, unpacked: float, packed: float) -> None:
    """Raise RecordingError for a file that unpacks to far more bytes than it has."""
    if unpacked > HARMLESS and unpacked > MAX_RATIO * packed:
        what = f"unpacks to more than {unpacked / 1e6:.0f} MB, {unpacked / max(packed, 1.0):.0f} times its size"
        raise RecordingError(path, f"{what}: no recording of sensors does")


def content_name(path: Path) -> str:
    """Return the name of what a file holds: without the suffix of a compression, and with that of a .zip's recording.

    RecordingError for a .zip that does not hold one recording."""
    if path.suffix.lower() in [suffix for suffix, _ in PACKED.values()]:
        return path.stem
    if path.suffix.lower() == ".zip" and path.is_file():
        return f"{path.stem} {Path(_only_recording(path, names_in(path))).name}"
    return path.name


def size_of(path: Path) -> int:
    """Return the size of a file, bytes; 0 for one that is compressed, of which the size unpacked is not known."""
    with open_file(path) as file:
        is_packed = path.suffix.lower() == ".zip" or file.read(2) in PACKED
    return 0 if is_packed else path.stat().st_size


def names_in(path: Path) -> list[str]:
    """Return the names of the files in a .zip; RecordingError for a file that is none."""
    try:
        with open_file(path) as file, ZipFile(file) as archive:
            return [info.filename for info in archive.infolist() if not info.is_dir()]
    except ERRORS as error:
        raise _damaged(path, error) from None


def _only_recording(path: Path, names: Sequence[str]) -> str:
    suffixes = (".jsonl", *SAMPLE_SUFFIXES)
    found = [name for name in names if Path(name).suffix.lower() in suffixes and not name.startswith("__MACOSX/")]
    if len(found) != 1:
        which = f" ({printable(', '.join(found), 80)})" if found else ""
        what = f"holds {len(found) or 'no'} recordings{which}, not one"
        repair = "unpack it, and give the files that belong together; `solepath convert` takes a phone's bug report"
        raise RecordingError(path, what, repair=repair)
    return found[0]


def open_unpacked(path: Path, member: str = "") -> BinaryIO:
    """Return a file opened for reading its bytes, unpacked; `member` of a .zip, if it is not its only recording.

    Its end is where packed data were cut off. Reading raises RecordingError at damage, and for what unpacks to far
    more than a recording does."""
    if path.suffix.lower() == ".zip" and path.is_file():
        return open_member(path, member or _only_recording(path, names_in(path)))
    file = open_file(path)
    start = file.peek(2)[:2]  # type: ignore[attr-defined]
    if start not in PACKED:
        return file
    return BufferedReader(_Unpacked(path, file, PACKED[start][1](file)))


def open_member(path: Path, name: str, file: BinaryIO | None = None) -> BinaryIO:
    """Return one file of a .zip or a workbook, opened for reading its bytes; errors are those of `open_unpacked`.

    `file` holds the .zip if `path` holds it compressed."""
    file = file or open_file(path)
    try:
        archive = ZipFile(file)
        info = archive.getinfo(name)
        if info.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
            raise BadZipFile(f"{name} is compressed in another way than DEFLATE")
        check_ratio(path, info.file_size, info.compress_size)
        return BufferedReader(_Unpacked(path, file, archive.open(info)))
    except ERRORS as error:
        file.close()
        raise _damaged(path, error) from None
    except BaseException:
        file.close()
        raise


def _damaged(path: Path, error: BaseException) -> RecordingError:
    return RecordingError(path, f"cannot be unpacked: it is damaged ({describe_error(error, 80)})")


class _Unpacked(RawIOBase):
    """The unpacked bytes of a compressed file."""

    def __init__(self, path: Path, file: BinaryIO, unpacked: Any) -> None:
        self.path, self.file, self.unpacked, self.count = path, file, unpacked, 0

    def readable(self) -> bool:
        return True

    def tell(self) -> int:
        return self.count

    def readinto(self, buffer: Any) -> int:
        try:
            data: bytes = self.unpacked.read(len(buffer))
        except EOFError:
            data = b""  # cut off: what came before is used
        except ERRORS as error:
            raise _damaged(self.path, error) from None
        self.count += len(data)
        check_ratio(self.path, self.count, self.file.tell() if self.file.seekable() else self.count)
        buffer[: len(data)] = data
        return len(data)

    def close(self) -> None:
        self.unpacked.close()
        self.file.close()
        super().close()
