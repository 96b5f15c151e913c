"""The command line in this process, with nobody at a terminal."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout

from solepath.cli import main


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    """What a command ends with and prints."""
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
        status = main([str(argument) for argument in arguments])
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


def refused(*arguments: object) -> str:
    """The one line with which it ends."""
    done = run(*arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("solepath: ") and done.stderr.count("\n") == 1
    return done.stderr


def solepath(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    clean = {key: value for key, value in os.environ.items() if key != "SOLEPATH_DATA"}
    return subprocess.run(
        [sys.executable, "-m", "solepath", *map(str, arguments)],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        text=True,
        env=clean | environment,
        check=False,
    )


def no_control_codes(text: str) -> bool:
    return all(c.isprintable() or c == "\n" for c in text)


def one_line(done: subprocess.CompletedProcess[str]) -> str:
    """The one line on stderr of a command that failed with exit status 2."""
    assert done.returncode == 2, done.stderr
    line, end = done.stderr[:-1], done.stderr[-1:]
    assert end == "\n" and "\n" not in line and line.startswith("solepath: ") and no_control_codes(line)
    return line


in_this_process = run
"""The same as `solepath` without a process of its own, for what fails before it computes anything."""
