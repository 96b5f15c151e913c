"""`solepath-lab`: parses the command line and runs the command. Exit status and errors are those of `solepath`.

Only the modules of the command that is run are imported, so that the version and the list of commands need no numpy."""

from __future__ import annotations

import os
import sys
from collections.abc import Container, Mapping, Sequence
from importlib.metadata import version
from types import ModuleType

from solepath.cli.common.parser import Option, Parser, option
from solepath.cli.completion import COMPLETING, complete
from solepath.cli.main import form, guarded

from .options import EVERY, FOLDER, ONLY, PROCESSES, only, seeds

Kinds = Mapping[str, tuple[str, tuple[Option, ...]]]
"""What the help says of each command, or of each kind of one, and its options beside the OPTIONS of its module."""
COMMANDS: Kinds = {
    "evaluate": ("score recipes on recorded data with a truth, and on emulated walks", ()),
    "agreement": ("bias and limits of reported times and lengths, on recorded data", (FOLDER, ONLY, PROCESSES)),
    "reproduce": ("walk a paper's experiment again on the emulator", ()),
    "sensitivity": (
        "each number of the default recipe at half and at twice",
        (FOLDER, ONLY, option("--number", metavar="NAME", action="append", default=[], help="only this number"),
         PROCESSES),
    ),
}  # fmt: skip
GROUPS: dict[str, tuple[str, Kinds]] = {
    "damage": (
        "damage recordings on purpose: what is noticed, and what is reported of whole ones",
        {
            "sensors": ("damaged sensors", (FOLDER, ONLY, EVERY, PROCESSES)),
            "clocks": ("separate clocks of the feet", (FOLDER, ONLY, PROCESSES)),
            "losses": ("lengths of strides with samples cut out", (FOLDER, PROCESSES)),
            "faults": ("sensors that fail in mid-walk", (FOLDER, ONLY, seeds(3, 9001), PROCESSES)),
        },
    ),
    "emulated": (
        "tables of emulated wearers",
        {
            "evidence": (
                "activities and place with evidence taken away",
                (seeds(12, 5001), only("row, such as 'everything'"), PROCESSES),
            ),
            "reliability": ("weights of candidates and how often they are true", (seeds(25, 5001),)),
            "floors": (
                "the right floor after stairs, escalators and lifts",
                (seeds(100, 5901), only("way, such as 'lift'"), PROCESSES),
            ),
            "places": ("place without a start and with a heading, on two plans", (seeds(12, 6001), PROCESSES)),
            "north": ("worth of a compass on a plan that knows its north", (seeds(24, 7001),)),
            "runs": ("measures of runners against the truth", (seeds(12, 1, "runs"),)),
            "other-motions": ("what is reported of motions that are not walking", ()),
            "slow-walkers": ("what is found of patients who walk slowly", ()),
            "by-hand": ("worth of a calibration by hand", (PROCESSES,)),
        },
    ),
    "train": (
        "learn the parameters of a part again",
        {
            "activities": ("curves of the activities", (FOLDER, PROCESSES)),
            "bearing": ("weights of what tells strides from other motions", (FOLDER, PROCESSES)),
            "turns": (
                "weights of the classifier of turns",
                (option("--emulate", action="store_true", help="write turns.csv again"),),
            ),
            "footstep-activity": ("thresholds and model of TwoSecondWindows", (FOLDER,)),
        },
    ),
}  # fmt: skip
"""Commands with kinds: what the help says of each, and its kinds. First seeds are none of those for training."""


def _modules(group: str) -> dict[str, ModuleType]:
    """Return the modules whose `run` is called: of the kinds of a command of GROUPS, or of the other commands."""
    match group:
        case "damage":
            from .damage import clocks, faults, losses, sensors

            return {"sensors": sensors, "clocks": clocks, "losses": losses, "faults": faults}
        case "emulated":
            from .emulated import (
                by_hand,
                evidence,
                floors,
                north,
                other_motions,
                places,
                reliability,
                runs,
                slow_walkers,
            )

            return {
                "evidence": evidence, "reliability": reliability, "north": north, "runs": runs, "by-hand": by_hand,
                "floors": floors, "places": places, "other-motions": other_motions, "slow-walkers": slow_walkers,
            }  # fmt: skip
        case "train":
            from .train import activities, bearing, footstep_activity, turns

            return {
                "activities": activities, "bearing": bearing, "turns": turns, "footstep-activity": footstep_activity
            }  # fmt: skip
    from .evaluate import agreement, sensitivity
    from .evaluate import command as evaluate
    from .reproduce import command as reproduce

    return {"evaluate": evaluate, "agreement": agreement, "reproduce": reproduce, "sensitivity": sensitivity}


def parser(words: Container[str] | None = None) -> Parser:
    """Return the parser with all commands; a command that is not among the `words` has only its name and its kinds."""
    top = Parser(
        prog="solepath-lab",
        description="How good solepath is, and how its parameters were learnt: every table of the documents.",
        example="solepath-lab evaluate --emulated --walks 1",
    )
    top.add_argument("--version", action="version", version=f"solepath-lab {version('solepath')}, {form()}")
    commands = top.add_subparsers(metavar="COMMAND", dest="command", parser_class=Parser, required=True)
    _add(top, "", COMMANDS, words)
    for name, (what, kinds) in GROUPS.items():
        group = commands.add_parser(name, help=what, description=f"{what[0].upper()}{what[1:]}.")
        group.add_subparsers(metavar="KIND", dest="kind", parser_class=Parser, required=True)
        _add(group, name, kinds, words)
    return top


def _add(parser: Parser, group: str, kinds: Kinds, words: Container[str] | None) -> None:
    """Add commands, or kinds of one, whose descriptions are the first paragraphs of their modules."""
    for name, (what, its_options) in kinds.items():
        if words is not None and name not in words:
            parser.commands.add_parser(name, help=what)
            continue
        module = _modules(group)[name]
        text = (module.__doc__ or "").partition("\n\n")[0]
        example = getattr(module, "EXAMPLE", "")
        command = parser.commands.add_parser(name, help=what, description=text, example=example)
        for one in (*getattr(module, "OPTIONS", ()), *its_options):
            one(command)
        command.set_defaults(run=module.run)


def run(arguments: Sequence[str] | None) -> int:
    """Run one command and return the exit status; errors are raised."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if COMPLETING in os.environ:
        complete(parser(os.environ.get("COMP_LINE", "").split()))
    given = parser(words).parse_args(words)
    status: int = given.run(given)
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status; errors become a line on stderr."""
    return guarded(run, arguments)
