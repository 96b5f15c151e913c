"""The recording that a command reads, of which foot, whether it has what a recipe needs, and its calibration."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .failure import Failure, note

if TYPE_CHECKING:
    from ...recipes import Recipe
    from ...recording import Source
    from ...types import Foot


def add_foot(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--foot",
        choices=["left", "right"],
        help="whose the samples of a recording of one foot are (default: right); of other recordings, the foot to use",
    )


def foot_of(options: argparse.Namespace) -> Foot | None:
    from ...types import Foot

    return Foot(options.foot) if options.foot else None


def source_of(path: Path, foot: Foot | None = None) -> Source:
    """What a recording holds; its flaws are noted. RecordingError when it cannot be used."""
    from ...recording import open_source

    return open_source(path, foot, report=note)


def check_pressure(recipe: Recipe, source: Source) -> None:
    """Failure when the recipe needs pressure cells and nothing in the recording comes from any. It reads packets only
    until the first sample with pressure."""
    from ...recording import printable

    if recipe.needs_pressure and not _pressed(source):
        raise Failure(f"recipe {recipe.name} needs pressure cells; {printable(str(source.path))} has none")


def _pressed(source: Source) -> bool:
    from ...link.decoder import Decoder
    from ...recording import RecordingError, open_source
    from ...types import Packet, Sample, Site

    if source.samples is not None:
        return any("pressure" in table.columns for table in source.samples.tables)
    decoders: dict[Site, Decoder] = {}
    try:
        for item in open_source(source.path, source.foot, report=_said_later):
            if isinstance(item, Packet):
                found = decoders.setdefault(item.site, Decoder(item.site)).feed(item)
                if any(isinstance(one, Sample) and one.pressure for one in found):
                    return True
    except RecordingError:
        return True  # whatever is wrong with it is said when it is run
    return False


def _said_later(sentence: str) -> None:
    """The run itself reports it."""


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
    from ...calibration import CalibrationError
    from ...calibration.file import read_calibration
    from ...recording import printable

    if options.calibration is None:
        return None
    try:
        return read_calibration(options.calibration)
    except CalibrationError as error:
        raise Failure(printable(str(error), 2000)) from None
