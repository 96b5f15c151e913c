"""Loads devices of one's own (--driver FILE.py)."""

from __future__ import annotations

import sys
from argparse import Namespace
from contextlib import redirect_stdout
from pathlib import Path
from runpy import run_path
from traceback import extract_tb
from typing import TYPE_CHECKING, Any

from ...link.kinds import make_kinds
from ...recording import printable
from .failure import Failure
from .os_errors import file_error_text
from .parser import option

if TYPE_CHECKING:
    from ...link.driver import Driver

_RUN: set[str] = set()
"""Files of devices of one's own that were run."""


add_own_devices = option(
    "--driver",
    metavar="FILE.py",
    dest="driver_files",
    type=Path,
    action="append",
    default=[],
    help="a device of your own: a Python program whose variables hold its Driver (docs/device.md); it is"
    " run; may be given again",
)
"""--driver."""


def drivers_of(options: Namespace) -> tuple[Driver, ...]:
    """Return the drivers of all files of --driver; raise Failure for a file without one, or that cannot be run."""
    drivers: list[Driver] = []
    for path in getattr(options, "driver_files", []):
        drivers += load_drivers(path)
        try:
            make_kinds(drivers)
        except ValueError as error:
            raise Failure(f"--driver {path}: {error}") from None
    return tuple(drivers)


def load_drivers(path: Path) -> list[Driver]:
    """Run a Python file and return each Driver that a variable of it holds, except the built-in ones.

    What the file prints goes to stderr. Failure is raised for a file that raises, or that has no driver."""
    from ...link.catalogue import DECLARED
    from ...link.driver import Driver

    file = str(path.absolute())  # as Python names the file in errors
    if path.suffix != ".py":
        raise Failure(f"--driver {path}: is no Python file (.py)")
    _RUN.add(file)
    values, fault = dict[str, Any](), ""
    try:
        with redirect_stdout(sys.stderr):
            values = run_path(file)
    except (Exception, SystemExit) as error:
        fault = f"{path}: {_describe(error, file)}"
        if isinstance(error, OSError) and error.filename == file:
            fault = file_error_text(error, path)
    if fault:  # raised here, so that no error of the system in the file takes the place of this sentence
        raise Failure(f"--driver {fault}")
    found = {id(value): value for value in values.values() if isinstance(value, Driver)}
    drivers = [driver for driver in found.values() if not any(driver is one for one in DECLARED)]
    if not drivers:
        raise Failure(f"--driver {path}: no variable of it holds a Driver (docs/device.md)")
    return drivers


def own_fault(error: BaseException) -> str | None:
    """Return file, line and text of an error that a function of a device of one's own raised; None for any other."""
    files = _RUN.intersection(frame.filename for frame in extract_tb(error.__traceback__))
    return next((f"--driver {printable(Path(file).name)}: {_describe(error, file)}" for file in files), None)


def _describe(error: BaseException, file: str) -> str:
    """Return the line of the file that led to the error, type and text, and the place where other code raised it."""
    frames = [(frame.filename, frame.lineno) for frame in extract_tb(error.__traceback__)]
    text = str(error)
    if isinstance(error, SyntaxError):
        frames, text = [*frames, (error.filename or "", error.lineno)], error.msg
    lines = [number for name, number in frames if name == file]
    where = f"line {lines[-1]}: " if lines else ""
    raised = f" (raised at {frames[-1][0]}:{frames[-1][1]})" if lines and frames[-1][0] != file else ""
    return f"{where}{type(error).__name__}{f': {text}' if text else ''}{raised}"
