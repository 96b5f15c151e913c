"""Commands of solepath as programs of their own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

SOLEPATH = [sys.executable, "-m", "solepath"]


@contextmanager
def started(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    """A command that runs until the test is through with it."""
    command = [*SOLEPATH, *map(str, arguments)]
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@contextmanager
def emulator(*arguments: object, port: int = 0) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Emulated devices, and where they are: tcp:HOST:PORT."""
    with started("emulate", "--listen", f"127.0.0.1:{port}", *arguments) as process:
        assert process.stdout is not None
        said, where = process.stdout.readline().rsplit(maxsplit=1)
        assert said == "serving at"
        yield process, where


def run(*arguments: object, expect: int = 0) -> subprocess.CompletedProcess[str]:
    command = [*SOLEPATH, *map(str, arguments)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == expect, done.stderr
    return done
