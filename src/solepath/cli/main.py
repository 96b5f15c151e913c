"""`solepath`: parses the command line, runs the command and reports its errors.

Exit status: 0 for success; 1 if a check found something (`check`, `plan`, `batch`, `validate`, `fleet-demo`,
`convert`); 2 for an error in the command line or a file, with one line on stderr; 130 if interrupted before all input
was used.
"""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Callable, Container, Sequence
from importlib import import_module
from importlib.machinery import ExtensionFileLoader
from importlib.util import find_spec

from .common.failure import Failure, note
from .common.parser import Parser
from .completion import COMPLETING, complete

GROUPS = {
    "with your sensors": {
        "scan": ("bluetooth.scan", "list the sensors in range"),
        "live": ("bluetooth.live", "listen to sensors and show what they say"),
        "record": ("bluetooth.live", "write what sensors send into a file"),
        "calibrate": ("calibrate.command", "learn about a wearer, shoes and insoles"),
    },
    "with recordings": {
        "track": ("track", "run a recording and print a summary"),
        "check": ("check", "say what is wrong with a recording"),
        "batch": ("batch", "run all recordings of a study into one set of tables"),
        "validate": ("validate", "compare recordings with your own reference system"),
        "convert": ("convert", "import a phone's Bluetooth log; export to MCAP, OpenSim or Motion-BIDS"),
    },
    "with a floor plan": {"plan": ("plan", "draw and check a floor plan")},
    "without sensors": {
        "demo": ("demo", "walk an emulated route and compare with the truth"),
        "emulate": ("bluetooth.emulate", "serve emulated sensors over a true Bluetooth link"),
        "web": ("web", "write the page as a site that needs no server"),
        "fleet-demo": ("fleet_demo", "many emulated wearers through a stream engine that is killed"),
    },
    "this shell": {"completion": ("completion", "make the Tab key complete commands, options and recipes")},
}
"""Commands by their purpose, in the order of the help, each with its module and its line of help.

The module of `NAME` has a function `add_NAME`, which adds the command to the parser."""
COMMANDS = {name: found for group in GROUPS.values() for name, found in group.items()}
"""The same without the purposes."""
LABORATORY = {"agreement", "damage", "emulated", "evaluate", "reproduce", "sensitivity", "train"}
"""Commands of `solepath-lab`, which people may look for here."""
FIRST = """\
first steps:
  solepath demo                watch an emulated walk: no sensor is needed
  solepath track walk.csv      see how somebody walked, from your recording
  solepath live                see how you walk, with sensors on your feet"""
"""Three commands for a newcomer, with which the help starts."""


class _TopParser(Parser):
    """The parser of the program, whose help shows the first steps and the commands by their purpose."""

    def format_help(self) -> str:
        """Return the help of the program."""
        parts = ["solepath: gait events and indoor tracks from foot-worn sensors", FIRST]
        for title, group in GROUPS.items():
            parts.append("\n".join([f"{title}:", *(f"  {name:12}{what}" for name, (_, what) in group.items())]))
        parts.append("solepath COMMAND --help has the options of a command, solepath --version the version")
        return "\n\n".join(parts) + "\n"


def parser(words: Container[str] = COMMANDS) -> Parser:
    """Return the parser with all commands; one that is not among the `words` has its name and no options."""
    top = _TopParser(prog="solepath", example="solepath track walk.csv")
    top.add_argument("--version", action="store_true", help="print the version, compiled or pure, and exit")
    commands = top.add_subparsers(metavar="COMMAND", dest="command", parser_class=Parser)
    for name, (module, what) in COMMANDS.items():
        if name in words:
            getattr(import_module(f".{module}", __package__), f"add_{name.replace('-', '_')}")(commands, what)
        else:
            commands.add_parser(name, help=what)
    return top


def run(arguments: Sequence[str] | None) -> int:
    """Run one command and return the exit status; errors are raised."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] == ["help"]:
        words = [*words[1:], "--help"]
    if LABORATORY.intersection(words[:1]):
        raise Failure(f"there is no command {words[0]!r} here: it is one of solepath-lab")
    if COMPLETING in os.environ:
        complete(parser())
    top = parser(words)
    options = top.parse_args(words, Namespace(words=words))
    if options.version:
        from importlib.metadata import version

        print(f"solepath {version('solepath')}, {form()}")
    elif options.command is None:
        top.print_help()
    else:
        return int(options.run(options))
    return 0


def form() -> str:
    """Return "compiled" if the modules that run per sample are compiled (docs/hot-code.md), otherwise "pure"."""
    spec = find_spec("solepath.types.vector")
    return "compiled" if spec is not None and isinstance(spec.loader, ExtensionFileLoader) else "pure"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return the exit status; errors become a line on stderr."""
    return guarded(run, arguments)


def guarded(run: Callable[[Sequence[str] | None], int], arguments: Sequence[str] | None) -> int:
    """Run a program and return its exit status; errors become a line on stderr."""
    _replace_closed_streams()
    try:
        status = run(arguments)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # the other end of the pipe was closed; without this line Python would report that again when it closes stdout
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        from .common.sentences import sentences_of

        if not (sentences := sentences_of(error)):
            raise
        for sentence in sentences:
            note(sentence)
    return 2


def _replace_closed_streams() -> None:
    """Open /dev/null for each standard stream that was closed before the start; Python sets such a stream to None."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), mode, encoding="utf-8"))
