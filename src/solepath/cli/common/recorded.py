"""The recording that a command reads, of which foot, whether it has what a recipe needs, and its calibration."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...calibration import Calibration
from ...link.decoder import Decoder
from ...recipes import Recipe
from ...recording import RecordingError, Source, open_source, printable
from ...types import Foot, Packet, Sample, Site
from .failure import Failure, note


def add_foot(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--foot",
        choices=["left", "right"],
        help="whose the samples of a recording of one foot are (default: right); of other recordings, the foot to use",
    )


def foot_of(options: argparse.Namespace) -> Foot | None:
    return Foot(options.foot) if options.foot else None


def source_of(path: Path, foot: Foot | None = None) -> Source:
    """What a recording holds; its flaws are noted. RecordingError when it cannot be used."""
    return open_source(path, foot, report=note)


def check_pressure(recipe: Recipe, source: Source) -> None:
    """Failure when the recipe needs pressure cells and nothing in the recording comes from any. It reads packets only
    until the first sample with pressure."""
    if recipe.needs_pressure and not _pressed(source):
        raise Failure(f"recipe {recipe.name} needs pressure cells; {printable(str(source.path))} has none")


def _pressed(source: Source) -> bool:
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


def add_calibration(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--calibration",
        metavar="FILE",
        type=Path,
        help="what is known of wearer, shoes and insoles, as `solepath calibrate` writes it",
    )


def calibration_of(options: argparse.Namespace) -> Calibration | None:
    """What --calibration names; None without it. CalibrationError when that is none."""
    from ...calibration.file import read_calibration

    return None if options.calibration is None else read_calibration(options.calibration)
