"""`solepath-lab`: parses the command line and runs the command. Exit status and errors are those of `solepath`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from types import ModuleType
from typing import Any

from solepath.cli.common.parser import Parser
from solepath.cli.completion import COMPLETING, complete
from solepath.cli.main import form, guarded

from . import options
from .damage import clocks, faults, losses, sensors
from .emulated import by_hand, evidence, north, reliability, runs
from .evaluate import command as evaluate
from .evaluate import sensitivity
from .options import FOLDER, ONLY, PROCESSES, Option, option
from .reproduce import command as reproduce
from .train import activities, footstep_activity, turns

Command = tuple[str, ModuleType, tuple[Option, ...]]
"""What the help says of a command, its module, whose `run` is called, and its options."""
COMMANDS: dict[str, Command] = {
    "evaluate": (
        "score recipes on recorded data with a truth, and on emulated walks", evaluate, evaluate.OPTIONS
    ),
    "reproduce": ("walk a paper's experiment again on the emulator", reproduce, reproduce.OPTIONS),
    "sensitivity": (
        "each number of the default recipe at half and at twice", sensitivity,
        (FOLDER, ONLY, option("--number", metavar="NAME", action="append", default=[], help="only this number"),
         PROCESSES),
    ),
}  # fmt: skip
GROUPS: dict[str, tuple[str, dict[str, Command]]] = {
    "damage": (
        "damage recordings on purpose: what is noticed, and what is reported of whole ones",
        {
            "sensors": ("damaged sensors", sensors, (FOLDER, ONLY, PROCESSES)),
            "clocks": ("separate clocks of the feet", clocks, (FOLDER, ONLY, PROCESSES)),
            "losses": ("lengths of strides with samples cut out", losses, (FOLDER, PROCESSES)),
            "faults": ("sensors that fail in mid-walk", faults, (FOLDER, ONLY, options.seeds(3, 9001), PROCESSES)),
        },
    ),
    "emulated": (
        "tables of emulated wearers",
        {
            "evidence": (
                "activities and place with evidence taken away", evidence,
                (options.seeds(12, 5001), options.only("row, such as 'everything'"), PROCESSES),
            ),
            "reliability": (
                "weights of candidates and how often they are true", reliability, (options.seeds(25, 5001),)
            ),
            "north": ("worth of a compass on a plan that knows its north", north, (options.seeds(24, 7001),)),
            "runs": ("measures of runners against the truth", runs, (options.seeds(12, 1, "runs"),)),
            "by-hand": ("worth of a calibration by hand", by_hand, (*by_hand.OPTIONS, PROCESSES)),
        },
    ),
    "train": (
        "learn the parameters of a part again",
        {
            "activities": ("network of the activities", activities, (FOLDER,)),
            "turns": (
                "weights of the classifier of turns", turns,
                (option("--emulate", action="store_true", help="write turns.csv again"),),
            ),
            "footstep-activity": ("thresholds and model of TwoSecondWindows", footstep_activity, (FOLDER,)),
        },
    ),
}  # fmt: skip
"""Commands with kinds: what the help says of each, and its kinds. First seeds are none of those for training."""


def parser() -> Parser:
    """Return the parser with all commands."""
    top = Parser(
        prog="solepath-lab",
        description="How good solepath is, and how its parameters were learnt: every table of the documents.",
        example="solepath-lab evaluate --emulated --walks 1",
    )
    top.add_argument("--version", action="version", version=f"solepath-lab {version('solepath')}, {form()}")
    commands = top.add_subparsers(metavar="COMMAND", dest="command", parser_class=Parser, required=True)
    _add(commands, COMMANDS)
    for name, (what, kinds) in GROUPS.items():
        group = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
        _add(group.add_subparsers(metavar="KIND", dest="kind", parser_class=Parser, required=True), kinds)
    return top


def _add(commands: Any, added: dict[str, Command]) -> None:
    """Add commands, whose descriptions are the first paragraphs of their modules."""
    for name, (what, module, its_options) in added.items():
        text = (module.__doc__ or "").partition("\n\n")[0]
        command = commands.add_parser(name, help=what, description=text, example=getattr(module, "EXAMPLE", ""))
        for one in its_options:
            one(command)
        command.set_defaults(run=module.run)


def run(arguments: Sequence[str] | None) -> int:
    """Run one command and return the exit status; errors are raised."""
    top = parser()
    if COMPLETING in os.environ:
        complete(top)
    given = top.parse_args(list(sys.argv[1:] if arguments is None else arguments))
    status: int = given.run(given)
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status; errors become a line on stderr."""
    return guarded(run, arguments)
