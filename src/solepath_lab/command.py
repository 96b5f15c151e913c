"""`solepath-lab`: parses the command line and runs the command. Exit status and errors are those of `solepath`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from types import ModuleType

from solepath.cli.common.parser import Parser
from solepath.cli.completion import COMPLETING, complete
from solepath.cli.main import guarded

from .damage import clocks, losses, sensors
from .emulated import by_hand, evidence, north, reliability, runs
from .evaluate import command as evaluate
from .evaluate import sensitivity
from .reproduce import command as reproduce
from .train import activities, footstep_activity, turns

COMMANDS = (evaluate, reproduce, sensitivity)
GROUPS: dict[str, tuple[str, tuple[ModuleType, ...]]] = {
    "damage": (
        "damage recordings on purpose: what is noticed, and what is reported of whole ones",
        (sensors, clocks, losses),
    ),
    "emulated": ("tables of emulated wearers", (evidence, reliability, north, runs, by_hand)),
    "train": ("learn the parameters of a part again", (activities, turns, footstep_activity)),
}
"""Commands with kinds: what the help says of each, and its kinds."""


def parser() -> Parser:
    """Return the parser with all commands."""
    top = Parser(
        prog="solepath-lab",
        description="How good solepath is, and how its parameters were learnt: every table of the documents.",
        example="solepath-lab evaluate --emulated --walks 1",
    )
    commands = top.add_subparsers(metavar="COMMAND", dest="command", parser_class=Parser, required=True)
    for command in COMMANDS:
        command.add_to(commands)
    for name, (what, kinds) in GROUPS.items():
        group = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
        group_kinds = group.add_subparsers(metavar="KIND", dest="kind", parser_class=Parser, required=True)
        for kind in kinds:
            kind.add_to(group_kinds)
    return top


def run(arguments: Sequence[str] | None) -> int:
    """Run one command and return the exit status; errors are raised."""
    top = parser()
    if COMPLETING in os.environ:
        complete(top)
    options = top.parse_args(list(sys.argv[1:] if arguments is None else arguments))
    status: int = options.run(options)
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status; errors become a line on stderr."""
    return guarded(run, arguments)
