"""`solepath`: parses the command line, runs the command and reports its errors.

Exit status: 0 for success; 1 if `fleet-demo` found different events or `check` something to mend, such as another unit;
2 for an error in the command line or a file, with one line on stderr; 130 if interrupted before all input was used.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib.machinery import ExtensionFileLoader
from importlib.util import find_spec
from typing import Any

from ..calibration import CalibrationError
from ..recording import RecordingError
from ..types.extras import install_hint
from . import check, convert, demo, evaluate, fleet_demo, reproduce, track, web
from .bluetooth import emulate, live, scan
from .calibrate import command as calibrate
from .common.failure import Failure, note

COMMANDS = (
    demo,
    track,
    check,
    scan,
    live,
    emulate,
    convert,
    calibrate,
    evaluate,
    reproduce,
    fleet_demo,
    web,
)  # live adds record


class _Once(argparse.Action):
    """An option with a value, which may be given once: a second value would replace the first one silently."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        given: set[str] = namespace.__dict__.setdefault("given", set())
        if option_string is not None and self.dest in given:
            parser.error(f"{option_string} was given twice")
        given.add(self.dest)
        setattr(namespace, self.dest, values)


class _Parser(argparse.ArgumentParser):
    """A parser whose options, and those of its commands, may be given once."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.register("action", None, _Once)
        self.register("action", "store", _Once)


def parser() -> argparse.ArgumentParser:
    """Return the parser with all commands."""
    top = _Parser(
        prog="solepath", description="Gait events and indoor tracks from foot-worn sensors: bytes in, strides out."
    )
    top.add_argument("--version", action="store_true", help="print the version, compiled or pure, and exit")
    commands = top.add_subparsers(metavar="COMMAND", dest="command")
    for command in COMMANDS:
        command.add_to(commands)
    return top


def run(arguments: Sequence[str] | None) -> int:
    """Run one command and return the exit status; errors are raised."""
    top = parser()
    options = top.parse_args(arguments)
    if options.version:
        from importlib.metadata import version

        print(f"solepath {version('solepath')}, {form()}")
        return 0
    if options.command is None:
        top.print_help()
        return 0
    status: int = options.run(options)
    return status


def form() -> str:
    """Return "compiled" if the modules that run per sample are compiled (docs/hot-code.md), otherwise "pure"."""
    spec = find_spec("solepath.types.vector")
    return "compiled" if spec is not None and isinstance(spec.loader, ExtensionFileLoader) else "pure"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status; errors become a line on stderr."""
    _replace_closed_streams()
    try:
        status = run(arguments)
        sys.stdout.flush()
        return status
    except RecordingError as error:
        for problem in error.problems:
            note(str(problem))
    except (Failure, CalibrationError) as error:
        note(str(error))
    except ModuleNotFoundError as error:
        if error.name != "numpy":
            raise
        note(f"this needs numpy: {install_hint('arrays')}")
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # the other end of the pipe was closed; without this line Python would report that again when it closes stdout
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        note(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    return 2


def _replace_closed_streams() -> None:
    """Open /dev/null for each standard stream that was closed before the start; Python sets such a stream to None."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), mode, encoding="utf-8"))
