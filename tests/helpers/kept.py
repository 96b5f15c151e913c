"""Results that take long and that many tests share: computed once a run, by one of the workers, and kept for the next.

A result is a file below `.pytest_cache/kept`, named by a hash of all on which it can depend: solepath, the helpers and
the golden corpus, `protocol/`, Python and its packages. So it is never that of other code. Workers that want the same
result wait for the first."""

from __future__ import annotations

import pickle
import platform
import sys
from collections.abc import Callable
from functools import cache, wraps
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from shutil import rmtree
from typing import ParamSpec, TypeVar
from zlib import ZLIB_RUNTIME_VERSION

import solepath

try:
    from fcntl import LOCK_EX, flock
except ImportError:  # Windows: two workers may compute the same
    LOCK_EX = 0

    def flock(file: object, operation: int) -> None:
        """Lock nothing."""


ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / ".pytest_cache" / "kept"
P = ParamSpec("P")
T = TypeVar("T")


def files() -> list[Path]:
    """Return the files on which a result can depend."""
    folders = (Path(solepath.__file__).parent, *map(ROOT.joinpath, ("tests/helpers", "tests/golden", "protocol")))
    return [
        path for folder in folders for path in sorted(folder.rglob("*")) if path.suffix != ".pyc" and path.is_file()
    ]


def hashed() -> str:
    """Return a hash of all on which a result can depend: names and contents of files, and versions."""
    versions = [version(name) for name in ("attrs", "construct", "numpy")]
    digest = sha256(f"{sys.version} {platform.platform()} {ZLIB_RUNTIME_VERSION} {versions}".encode())
    for path in files():
        data = path.read_bytes()
        digest.update(f"{path.parts[-4:]} {len(data)} ".encode() + data)
    return digest.hexdigest()[:16]


def written() -> list[int]:
    """Return when each of the files was written."""
    return [path.stat().st_mtime_ns for path in files()]


CODE, WRITTEN = hashed(), written()
"""Hash of what this process has loaded, or will, and when that was written."""


@cache
def clean() -> None:
    """Delete what is kept of other code."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for folder in FOLDER.iterdir():
        if folder.name != CODE:
            rmtree(folder, ignore_errors=True)


def kept(compute: Callable[P, T]) -> Callable[P, T]:
    """Return a function that computes each result once; its arguments have texts that tell them apart."""

    @cache
    @wraps(compute)
    def found(*arguments: P.args, **named: P.kwargs) -> T:
        clean()
        name = sha256(repr((compute.__module__, compute.__qualname__, arguments, named)).encode()).hexdigest()[:24]
        path = FOLDER / CODE / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.with_suffix(".lock").open("w") as lock:
            flock(lock, LOCK_EX)
            if not path.exists():
                computed = compute(*arguments, **named)
                if written() != WRITTEN:  # a file has changed meanwhile, and nobody knows which side was computed
                    return computed
                path.with_suffix(".new").write_bytes(pickle.dumps(computed))
                path.with_suffix(".new").rename(path)
        result: T = pickle.loads(path.read_bytes())
        return result

    return found
