"""Options that several commands of the laboratory share, each with the same name, unit and default everywhere."""

from __future__ import annotations

from pathlib import Path

from solepath.cli.common.failure import parse_count, parse_whole_number
from solepath.cli.common.parser import Option, option
from solepath.cli.common.processes import add_processes


def seeds(count: int, first: int, counted: str = "walks", may_be_none: bool = False) -> Option:
    """Return the number of emulated walks, or of something else that is counted, and the seed of the first one.

    `may_be_none`: the number may be 0, which leaves their table out."""
    number = option(
        f"--{counted}",
        metavar="N",
        type=parse_whole_number if may_be_none else parse_count,
        default=count,
        help=f"number of {counted}{', or 0' * may_be_none} (default: {count})",
    )
    seed = option(
        "--seed", metavar="K", type=parse_whole_number, default=first, help=f"the first one's seed (default: {first})"
    )
    return lambda parser: (number(parser), seed(parser))


def only(what: str = "data set") -> Option:
    """Return the option that chooses data sets, or something else that has a name."""
    return option("--only", metavar="NAME", action="append", default=[], help=f"this {what} only; may be given again")


FOLDER = option("dir", metavar="DIR", type=Path, help="the recorded data")
ONLY = only()
PROCESSES = add_processes
EVERY = option("--every", metavar="N", type=parse_count, default=1, help="one in N of them (default: all)")
JSON = option("--json", metavar="FILE", type=Path, help="write the figures as JSON too")
