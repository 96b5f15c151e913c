"""Options that several commands of the laboratory share, each with the same name, unit and default everywhere."""

from __future__ import annotations

import os
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from solepath.cli.common.failure import parse_count, parse_whole_number


def add_command(commands: Any, name: str, what: str, text: str) -> ArgumentParser:
    """Add a command with `what` as its line of help and the first paragraph of `text` below it; return its parser."""
    parser: ArgumentParser = commands.add_parser(name, help=what, description=text.partition("\n\n")[0])
    return parser


def add_folder(command: ArgumentParser) -> None:
    """Add the folder of recorded data."""
    command.add_argument("dir", metavar="DIR", type=Path, help="the recorded data")


def add_only(command: ArgumentParser, what: str = "data set") -> None:
    """Add the option that chooses data sets, or something else that has a name."""
    command.add_argument(
        "--only", metavar="NAME", action="append", default=[], help=f"this {what} only; may be given again"
    )


def add_seeds(
    command: ArgumentParser, count: int, first: int, counted: str = "walks", may_be_none: bool = False
) -> None:
    """Add the number of emulated walks, or of something else that is counted, and the seed of the first one.

    `may_be_none`: the number may be 0, which leaves their table out."""
    command.add_argument(
        f"--{counted}",
        metavar="N",
        type=parse_whole_number if may_be_none else parse_count,
        default=count,
        help=f"number of {counted}{', or 0' * may_be_none} (default: {count})",
    )
    command.add_argument(
        "--seed", metavar="K", type=parse_whole_number, default=first, help=f"the first one's seed (default: {first})"
    )


def add_processes(command: ArgumentParser) -> None:
    """Add the number of processes."""
    command.add_argument(
        "--processes",
        metavar="N",
        type=parse_count,
        default=os.cpu_count() or 1,
        help="jobs at a time (default: one for each processor)",
    )


def add_json(command: ArgumentParser) -> None:
    """Add the file that receives the figures as JSON."""
    command.add_argument("--json", metavar="FILE", type=Path, help="write the figures as JSON too")
