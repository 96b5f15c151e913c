"""The calibration that a command runs with."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .failure import Failure

if TYPE_CHECKING:
    from ...calibration import Calibration


def add_calibration(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--calibration",
        metavar="FILE",
        type=Path,
        help="what is known of wearer, shoes and insoles, as `solepath calibrate` writes it",
    )


def calibration_of(options: argparse.Namespace) -> Calibration | None:
    """What --calibration names; None without it. Failure when that is no calibration."""
    from ...calibration import CalibrationError, read_calibration
    from ...recording import printable

    if options.calibration is None:
        return None
    try:
        return read_calibration(options.calibration)
    except CalibrationError as error:
        raise Failure(printable(str(error), 2000)) from None
