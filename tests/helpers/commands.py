"""The command line in this process, with nobody at a terminal."""

from __future__ import annotations

import io
import subprocess
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
