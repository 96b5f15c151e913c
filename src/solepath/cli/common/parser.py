"""The parser of the command line: one line for every mistake, with the name that was probably meant, and the help."""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn, TypeVar

from .closest import MIN_OPTION_SIMILARITY, closest, unknown
from .failure import note

WIDTH = 100
"""Largest number of characters in a line of the help."""
NAME_WIDTH = 26
"""Largest number of characters in the left column of the help."""
EXAMPLE = "example: "
"""Start of the text at the end of a help, which is printed as it is."""
OPTION_GROUPS = {
    "how to compute": ("--recipe", "--heading", "--calibration"),
    "floor plan": ("--floorplan", "--start"),
    "feet with separate clocks": ("--clock-offset", "--shared-event"),
    "clinical outcomes": ("--outcomes", "--six-minute-walk", "--timed-up-and-go", "--reference"),
    "sensors": ("--left", "--right", "--at", "--profile", "--pair", "--via", "--live"),
    "what is written": ("--out", "--record", "--report", "--json", "--figure", "--resume", "--force"),
    "page": ("--view", "--no-browser", "--speed", "--terminal"),
    "other programs": ("--lsl", "live --channels", "live --units"),
    "phone's log": ("--site", "--handle"),
    "OpenSim and Motion-BIDS": ("--positions", "convert --subject", "--session", "--task", "--run", "--validate"),
}
"""Headings of the help, and the options below each; where a name has several meanings, with its command."""
_TITLES = {option: title for title, options in OPTION_GROUPS.items() for option in options}
OPTION = re.compile(r"--?[A-Za-z]\S*")
DASHED_VALUE = re.compile(r"-[\d.]\S*,\S*")
"""A value such as -1,2 that argparse takes for an option."""


_Action = TypeVar("_Action", bound=argparse.Action)


class _Once(argparse.Action):
    """An option with a value, which may be given once: a second value would replace the first one silently."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        given: set[str] = namespace.__dict__.setdefault("given", set())
        if option_string is not None and self.dest in given:
            parser.error(f"{option_string} was given twice")
        given.add(self.dest)
        setattr(namespace, self.dest, values)


class _Commands(argparse._SubParsersAction):  # type: ignore[type-arg]
    """The commands of a parser, which remember what the help says about each."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.lines: dict[str, str] = {}
        super().__init__(*args, **kwargs)

    def add_parser(self, name: str, **kwargs: Any) -> Any:
        self.lines[name] = kwargs.get("help", "")
        return super().add_parser(name, **kwargs)


class _Help(argparse.HelpFormatter):
    """Help of at most WIDTH columns; an example keeps its lines."""

    def __init__(self, prog: str, **kwargs: Any) -> None:
        width = min(WIDTH, shutil.get_terminal_size((WIDTH, 24)).columns - 1)
        super().__init__(prog, max_help_position=NAME_WIDTH, width=max(40, width))

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith(EXAMPLE):
            return "\n".join([EXAMPLE.strip(), *(f"  {line}" for line in text.removeprefix(EXAMPLE).splitlines())])
        return super()._fill_text(text, width, indent)


class Parser(argparse.ArgumentParser):
    """A parser whose options, and those of its commands, may be given once; it ends the program with one line."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        kwargs.setdefault("formatter_class", _Help)
        super().__init__(*args, **kwargs)
        self._optionals.title, self._positionals.title = "options", "arguments"
        self.commands: _Commands | None = None
        self.register("action", None, _Once)
        self.register("action", "store", _Once)
        self.register("action", "parsers", _Commands)

    def _add_action(self, action: _Action) -> _Action:
        command = self.prog.rpartition(" ")[2]
        name = action.option_strings[0] if action.option_strings else ""
        title = _TITLES.get(name) or _TITLES.get(f"{command} {name}")
        if title is None:
            return super()._add_action(action)
        found = next((group for group in self._action_groups if group.title == title), None)
        return (found or self.add_argument_group(title))._add_action(action)

    def add_subparsers(self, **kwargs: Any) -> Any:
        """Add commands, or kinds, to the parser."""
        commands = super().add_subparsers(**kwargs)
        assert isinstance(commands, _Commands)
        self.commands = commands
        return commands

    def error(self, message: str) -> NoReturn:
        """Print one line about what is wrong with the command line, and exit with status 2."""
        text = message.removeprefix("argument ")
        if text.startswith("the following arguments are required: "):
            missing = text.partition(": ")[2]
            text = f"{missing} {'are' if ', ' in missing else 'is'} missing{self._as_in()}"
        elif text.endswith("expected one argument"):
            text = text.replace("expected one argument", f"needs a value ({self.prog} --help)")
        elif not text.endswith("?"):
            text += f" ({self.prog} --help)"
        note(text)
        self.exit(2)

    def _as_in(self) -> str:
        """Return the first line of the example, as the end of a sentence."""
        if self.epilog is None or not self.epilog.startswith(EXAMPLE):
            return f" ({self.prog} --help)"
        return f", as in: {self.epilog.removeprefix(EXAMPLE).splitlines()[0]}"

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments; end the program at an option that does not exist, before anything else is missing."""
        if args is not None:
            self._check_options(list(args))
        options, more = super().parse_known_args(args, namespace)
        if more and self.commands is None:
            self.error(f"too much on the command line: {' '.join(more)}{self._repeated(list(args or ()), more[0])}")
        return options, more

    def _repeated(self, words: list[str], extra: str) -> str:
        """Return the option before the word that is too much, if it may be given again, as the end of a sentence."""
        before = words[: words.index(extra)] if extra in words else []
        name = before[-2] if len(before) > 1 else ""
        action = self._option_string_actions.get(name)
        return f": give {name} again for the second" if isinstance(action, argparse._AppendAction) else ""

    def _check_options(self, words: Sequence[str]) -> None:
        for before, word in zip(["", *words], words, strict=False):
            if word == "" or (word.startswith("--") and word.endswith("=")):
                option = word.rstrip("=") or before
                self.error(f"{option + ': ' if option.startswith('-') else ''}nothing is given: is a variable empty?")
            if word == "--" or (self.commands is not None and not word.startswith("-")):
                return  # what follows belongs to a command
            if DASHED_VALUE.fullmatch(word) and before.startswith("--"):
                self.error(f"{before}: a value that starts with a dash is written {before}={word}")
            if not OPTION.fullmatch(word):
                continue
            name = word.partition("=")[0]
            known = self._option_string_actions
            if name in known or (name.startswith("--") and any(one.startswith(name) for one in known)):
                continue
            self.error(self._unknown_option(name))

    def _unknown_option(self, name: str) -> str:
        known = [one for one in self._option_string_actions if one.startswith("--")]
        bare = name.lstrip("-")
        starts = [one for one in known if one.startswith(f"--{bare}") or f"--{bare}".startswith(one)]
        meant = starts[0] if starts else closest(bare, [one.removeprefix("--") for one in known], MIN_OPTION_SIMILARITY)
        if self.commands is not None and meant is None:
            what = "the kind" if self.dest_of_commands == "kind" else "the command"
            return f"there is no option {name} here: options come after {what}"
        return f"there is no option {name}" + (f": did you mean --{meant.removeprefix('--')}?" if meant else "")

    @property
    def dest_of_commands(self) -> str:
        """Name under which the command, or the kind, is found."""
        return "" if self.commands is None else self.commands.dest

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            names: Iterable[str] = map(str, action.choices)
            if isinstance(action, _Commands):
                self.error(unknown(action.dest, str(value), names))
            raise argparse.ArgumentError(action, unknown("choice", str(value), names))
