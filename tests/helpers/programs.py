"""Commands of solepath as separate processes."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

SOLEPATH = [sys.executable, "-m", "solepath"]
TAKES = 30.0
"""Time limit for a program to print or do something, s."""


@contextmanager
def started(*arguments: object, code: str = "", **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Yield the process of a command, which is killed at the end of the context; `code` runs before the command."""
    words = [str(argument) for argument in arguments]
    program = ["-c", f"{code}from solepath.cli import main; raise SystemExit(main({words!r}))"]
    piped = dict.fromkeys(("stdout", "stderr"), subprocess.PIPE) | {"stdin": subprocess.DEVNULL}
    command = [sys.executable, *program] if code else [*SOLEPATH, *words]
    process = subprocess.Popen(command, text=True, **(piped | options))
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@contextmanager
def in_terminal(*arguments: object, **options: Any) -> Iterator[tuple[int, subprocess.Popen[str]]]:
    """Yield our end of a terminal, and the process of a command that runs in it as `started` does."""
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    with started(*arguments, **dict.fromkeys(("stdin", "stdout", "stderr"), theirs), **options) as process:
        os.close(theirs)
        yield ours, process
    os.close(ours)


@contextmanager
def emulator(*arguments: object) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Yield the process of emulated devices, and their address tcp:HOST:PORT."""
    with started("emulate", "--listen", "127.0.0.1:0", *arguments) as process:
        assert process.stdout is not None
        text, address = process.stdout.readline().rsplit(maxsplit=1)
        assert text == "serving at"
        yield process, address


def run(*arguments: object, expect: int = 0) -> subprocess.CompletedProcess[str]:
    command = [*SOLEPATH, *map(str, arguments)]
    process = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    assert process.returncode == expect, process.stderr
    return process


def wait_for(path: Path, what: str) -> None:
    """Wait until `what` occurs in the file; fail after TAKES."""
    end = time.monotonic() + TAKES
    while not path.exists() or what not in path.read_text(encoding="utf-8"):
        assert time.monotonic() < end, f"{what} did not come"
        time.sleep(0.05)


def drawn(terminal: int, until: str = "") -> str:
    """Return the output on a terminal, up to the words `until` or to its end."""
    data = b""
    try:
        while (not until or until not in data.decode()) and (part := os.read(terminal, 65536)):
            data += part
    except OSError:  # on Linux: the other end of the terminal was closed
        pass
    return data.decode()
