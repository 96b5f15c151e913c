"""Results that take long and that many tests share: computed once a run, by one of the workers, and kept for the next.

A result is a file below `.pytest_cache/kept`, named by a hash of all code of solepath and of the helpers, so that it is
never that of other code. Workers that want the same result wait for the first."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from functools import cache, wraps
from hashlib import sha256
from pathlib import Path
from shutil import rmtree
from typing import ParamSpec, TypeVar

import solepath

try:
    from fcntl import LOCK_EX, flock
except ImportError:  # Windows: two workers may compute the same
    LOCK_EX = 0

    def flock(file: object, operation: int) -> None:
        """Lock nothing."""


HELPERS = Path(__file__).resolve().parent
FOLDER = HELPERS.parents[1] / ".pytest_cache" / "kept"
P = ParamSpec("P")
T = TypeVar("T")


@cache
def code() -> str:
    """Return a hash of all code on which a result can depend."""
    digest = sha256()
    for folder in (Path(solepath.__file__).parent, HELPERS):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def clean() -> None:
    """Delete what is kept of other code."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for folder in FOLDER.iterdir():
        if folder.name != code():
            rmtree(folder, ignore_errors=True)


def kept(compute: Callable[P, T]) -> Callable[P, T]:
    """Return a function that computes each result once; its arguments have texts that tell them apart."""

    @cache
    @wraps(compute)
    def found(*arguments: P.args, **named: P.kwargs) -> T:
        clean()
        name = sha256(repr((compute.__module__, compute.__qualname__, arguments, named)).encode()).hexdigest()[:24]
        path = FOLDER / code() / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.with_suffix(".lock").open("w") as lock:
            flock(lock, LOCK_EX)
            if not path.exists():
                path.with_suffix(".new").write_bytes(pickle.dumps(compute(*arguments, **named)))
                path.with_suffix(".new").rename(path)
        result: T = pickle.loads(path.read_bytes())
        return result

    return found
