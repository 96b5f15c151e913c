"""The part of `solepath convert --validate`: other programs read what was written."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from ...recording import printable
from ..common.failure import Failure, require

BIDS_PROGRAM = "from bids_validator_deno import cli; cli()"
"""Program that runs the official validator of BIDS, which the package brings with its own runtime."""
MAX_ISSUES = 10
"""Largest number of issues that are printed."""


def need_validator(dataset: bool) -> None:
    """Raise Failure when the program that validates is not installed: for a dataset that of BIDS, else OpenSim."""
    if dataset:
        require("--validate needs", "bids", "bids_validator_deno")
    else:
        require("--validate needs", "opensim", "opensim")


def validate_dataset(root: Path) -> int:
    """Run the official validator over the whole dataset and print what it found; return 1 for an error, else 0."""
    words = [sys.executable, "-c", BIDS_PROGRAM, str(root), "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    try:
        report: dict[str, Any] = json.loads(done.stdout)
        issues = report["issues"]["issues"]
    except (ValueError, KeyError, TypeError):
        last = (done.stderr.strip().splitlines() or ["no output"])[-1]
        raise Failure(f"the validator of BIDS failed: {printable(last)}") from None
    errors = [issue for issue in issues if issue.get("severity") == "error"]
    for issue in errors[:MAX_ISSUES]:
        print(
            f"  {issue.get('code')} {issue.get('subCode') or ''} {printable(str(issue.get('location') or ''))}".rstrip()
        )
    print(f"the validator of BIDS: {len(errors)} errors, {len(issues) - len(errors)} warnings")
    return 1 if errors else 0


def validate_storage(path: Path, *, positions: bool) -> int:
    """Read a storage file with OpenSim and print what it found; return the exit status."""
    import opensim

    opensim.Logger.setLevelString("Off")
    table = (opensim.TimeSeriesTableVec3 if positions else opensim.TimeSeriesTableQuaternion)(str(path))
    labels = ", ".join(table.getColumnLabels())
    print(f"OpenSim {opensim.GetVersion()} reads {table.getNumRows()} rows of {labels}")
    return 0
