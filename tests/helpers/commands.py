"""Runs of the command line without a terminal, in this process or in another process."""

from __future__ import annotations

import csv
import io
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from solepath.cli import main

Program = Callable[[list[str]], int]


def run(*arguments: object, program: Program = main) -> subprocess.CompletedProcess[str]:
    """Return the exit status and the output of a command of solepath, or of another program."""
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
        try:
            status = program([str(argument) for argument in arguments])
        except SystemExit as stop:  # of argparse
            status = int(stop.code or 0)
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


def run_failing(*arguments: object, program: Program = main) -> str:
    """Return the one line with which the command fails."""
    process = run(*arguments, program=program)
    assert process.stdout == ""
    one_line(process)
    return process.stderr


def solepath(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Return the exit status and the output of a command in another process."""
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
    """Return the only line on stderr of a command that failed with exit status 2."""
    assert done.returncode == 2, done.stderr
    line, end = done.stderr[:-1], done.stderr[-1:]
    assert end == "\n" and "\n" not in line and line.startswith("solepath: ") and no_control_codes(line)
    return line


def rows_in(path: Path) -> list[dict[str, str]]:
    """Return the rows of a table that a command wrote."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))
