"""The parser of the command line: one line for every mistake, with the name that was probably meant, and the help."""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NoReturn, TypeVar

from .closest import closest, unknown
from .failure import note, parse_whole_number

WIDTH = 100
"""Largest number of characters in a line of the help."""
NAME_WIDTH = 26
"""Largest number of characters in the left column of the help."""
REQUIRED = "the following arguments are required: "
"""Start of the message of argparse."""
OPTION_GROUPS = {
    "how to compute": ("--recipe", "--heading", "--calibration"),
    "floor plan": ("--floorplan", "--start"),
    "feet with separate clocks": ("--clock-offset", "--shared-event"),
    "tables of samples": (
        "--columns",
        "track --units",
        "check --units",
        "convert --units",
        "--scale",
        "--rows",
        "--rate",
        "--format",
        "--mapping",
    ),
    "the report": ("--title", "track --subject", "--date", "track --device", "--compare"),
    "clinical outcomes": ("--outcomes", "--test", "--test-before", "--reference"),
    "sensors": ("--left", "--right", "--at", "--profile", "--pair", "--via", "--live"),
    "what is written": ("--out", "--record", "--report", "--export", "--json", "--figure", "--resume", "--force"),
    "page": ("--view", "--no-browser", "--speed", "--terminal"),
    "other programs": ("--lsl", "live --channels", "live --units"),
    "phone's log": ("--site", "--handle"),
    "OpenSim and Motion-BIDS": ("--positions", "convert --subject", "--session", "--task", "--run", "--validate"),
}
"""Headings of the help, and the options below each; where a name has several meanings, with its command."""
_TITLES = {option: title for title, options in OPTION_GROUPS.items() for option in options}
OPTION = re.compile(r"--?[A-Za-z]\S*")
MIN_OPTION_SIMILARITY = 0.7
"""Least similarity of an option that is suggested; options are short, and a command has many; chosen by hand."""


_Action = TypeVar("_Action", bound=argparse.Action)


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Return a formatter of a help of at most WIDTH columns."""
    width = min(WIDTH, shutil.get_terminal_size((WIDTH, 24)).columns - 1)
    return argparse.HelpFormatter(prog, max_help_position=NAME_WIDTH, width=width)


class Parser(argparse.ArgumentParser):
    """A parser whose options, and those of its commands, may be given once; it ends the program with one line."""

    def __init__(self, *, example: str = "", **kwargs: Any) -> None:
        """Make a parser with `example`, lines of commands, at the end of its help."""
        super().__init__(formatter_class=_formatter, allow_abbrev=False, **kwargs)
        self._optionals.title, self._positionals.title = "options", "arguments"
        self._negative_number_matcher = re.compile(r"-[\d.]")  # so that -1,2 is a value
        self.example = example
        self.commands: Any = None
        """The action that has the commands, or the kinds; None without any."""

    def format_help(self) -> str:
        """Return the help, with the example at its end."""
        lines = [f"  {line}\n" for line in self.example.splitlines()]
        return super().format_help() + "".join(["\nexample:\n", *lines] if lines else [])

    def _add_action(self, action: _Action) -> _Action:
        command = self.prog.rpartition(" ")[2]
        name = action.option_strings[0] if action.option_strings else ""
        title = _TITLES.get(f"{command} {name}") or _TITLES.get(name)
        if title is None:
            return super()._add_action(action)
        found = next((group for group in self._action_groups if group.title == title), None)
        return (found or self.add_argument_group(title))._add_action(action)

    def add_subparsers(self, **kwargs: Any) -> Any:
        """Add commands, or kinds, to the parser."""
        self.commands = super().add_subparsers(**kwargs)
        return self.commands

    def error(self, message: str) -> NoReturn:
        """Print one line about what is wrong with the command line, and exit with status 2."""
        text, hint = message.removeprefix("argument "), f" ({self.prog} --help)"
        if text.startswith(REQUIRED):
            missing = text.removeprefix(REQUIRED)
            text = f"{missing} {'are' if ', ' in missing else 'is'} missing"
            if self.example:
                hint = f", as in: {self.example.splitlines()[0]}"
        text = text.replace("expected one argument", "needs a value")
        note(text if text.endswith("?") else text + hint)
        self.exit(2)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments; end the program at an option that does not exist, before anything else is missing."""
        words = list(args or ())
        self._check_options(words)
        options, more = super().parse_known_args(args, namespace)
        if more and self.commands is None:
            before = ["", "", *words][words.index(more[0])] if more[0] in words else ""
            is_repeated = isinstance(self._option_string_actions.get(before), argparse._AppendAction)
            again = f": give {before} again for the second" if is_repeated else ""
            self.error(f"too much on the command line: {' '.join(more)}{again}")
        return options, more

    def _check_options(self, words: Sequence[str]) -> None:
        known = [one for one in self._option_string_actions if one.startswith("--")]
        for number, (before, word) in enumerate(pairwise(["", *words])):
            if word == "" or (word.startswith("--") and word.endswith("=")):
                option = word.rstrip("=") or before
                self.error(f"{option + ': ' if option.startswith('-') else ''}nothing is given: is a variable empty?")
            if word == "--" or (self.commands is not None and not word.startswith("-")):
                return  # what follows belongs to a command
            name = word.partition("=")[0]
            action = self._option_string_actions.get(name)
            if isinstance(action, argparse._StoreAction) and name in words[:number]:
                self.error(f"{name} was given twice")
            if action is not None or not OPTION.fullmatch(word):
                continue
            bare = name.lstrip("-")
            meant = closest(bare, [one.removeprefix("--") for one in known], MIN_OPTION_SIMILARITY)
            if meant is not None:
                self.error(f"there is no option {name}: did you mean --{meant}?")
            here = "" if self.commands is None else f" here: options come after the {self.commands.dest}"
            self.error(f"there is no option {name}{here}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            text = unknown(action.dest, str(value), map(str, action.choices))
            if action is self.commands:
                self.error(text)
            raise argparse.ArgumentError(action, text)


Option = Callable[[Any], object]
"""Function that adds an option, or several, to the parser of a command."""


def option(*names: str, **settings: Any) -> Option:
    """Return an option with the arguments of `ArgumentParser.add_argument`."""
    return lambda command: command.add_argument(*names, **settings)


def together(*options: Option) -> Option:
    """Return several options as one."""
    return lambda command: [one(command) for one in options]


def one_of(*options: Option) -> Option:
    """Return options of which one may be given."""
    return lambda command: together(*options)(command.add_mutually_exclusive_group())


def command(
    name: str, description: str, example: str, *options: Option, **defaults: Any
) -> Callable[[Any, str], Parser]:
    """Return the function that adds a command, or a kind of one, to a parser.

    It takes the parser's commands and the line of help, `what`, and returns the parser of the command."""

    def add(commands: Any, what: str) -> Parser:
        added: Parser = commands.add_parser(name, help=what, description=description, example=example)
        together(*options)(added)
        added.set_defaults(**defaults)
        return added

    return add


add_seed = option(
    "--seed", metavar="N", type=parse_whole_number, default=1, help="another walk of this route (default: 1)"
)
"""--seed of an emulated walk."""
