"""`solepath calibrate KIND INPUT --out FILE`: makes a calibration from a recording or from measurements by hand."""

from __future__ import annotations

from argparse import Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from ...calibration import Calibration
from ...calibration.records import merged
from ...recording import printable
from ...saving.files import identity
from ..common.failure import Failure
from ..common.files import CALIBRATION, OutputFile, check_outputs
from ..common.parser import command
from .kinds import KINDS

MERGE_NOTE = "What FILE holds already of other kinds, or of the other foot, stays."
"""Sentence of the help text."""


def add_calibrate(commands: Any, what: str) -> None:
    """Add the command to the parser."""
    added = command(
        "calibrate",
        f"Make a calibration for `track`, `live` and `evaluate` (--calibration FILE). {MERGE_NOTE}",
        "solepath calibrate walk corridor.jsonl --out me.json\nsolepath calibrate walk --help",
    )(commands, what)
    kinds = added.add_subparsers(metavar="KIND", dest="kind", required=True)
    for add, line in KINDS.items():
        add(kinds, line)
    for kind in kinds.choices.values():
        kind.add_argument("--out", metavar="FILE", type=Path, required=True, help="the calibration file")
        kind.set_defaults(run=run)


def run(options: Namespace) -> int:
    """Make the calibration and write it; return the exit status."""
    from ...show.tables.progress import progress_bar

    if options.out.exists() and not options.out.is_file() and not options.out.is_dir():  # a folder gets an OSError
        raise Failure(f"{options.out}: is no regular file")
    check_outputs(options, [OutputFile(options.out, CALIBRATION)])
    with progress_bar("calibrating") if not getattr(options, "live", False) else nullcontext():
        learnt, lines = options.learn(options, _read(options.out))
    while not _try_to_complete(options.out, learnt):
        pass
    print("\n".join([*lines, f"written to {printable(str(options.out))}"]))
    return 0


def _read(path: Path) -> Calibration:
    """Return the calibration in a file, which may be empty or missing."""
    from ...calibration.file import read_calibration

    return read_calibration(path) if path.exists() and path.stat().st_size else Calibration()


class _FileChanged(Exception):
    """Error for a calibration file that another program wrote after it was read."""


def _try_to_complete(path: Path, learnt: Calibration) -> bool:
    """Add what was learnt to what the file holds; return False when another `calibrate` wrote it just now."""
    from ...calibration.file import write_calibration
    from ...types.checking import find_fault

    found = identity(path)
    whole = merged(_read(path), learnt)
    fault = find_fault(whole, Calibration)
    if fault is not None:
        raise Failure(f"nothing is written, for this cannot be: {fault}")

    def check_again(path: Path) -> None:
        if identity(path) != found:
            raise _FileChanged

    try:
        write_calibration(path, whole, check_again)
    except _FileChanged:
        return False
    return True
