"""`solepath completion SHELL`: prints what makes a shell complete commands, options and names."""

from __future__ import annotations

from argparse import Action, ArgumentParser, Namespace
from collections.abc import Callable, Iterable

from .common.failure import require
from .common.parser import command, option

COMPLETING = "_ARGCOMPLETE"
"""Environment variable that a shell sets when it runs the program to complete a word."""
SHELLS = ("bash", "zsh", "fish", "powershell")


def run(options: Namespace) -> int:
    """Print the code for the shell; return the exit status."""
    require("completion needs", "completion", "argcomplete")
    from argcomplete.shell_integration import shellcode

    print(shellcode(["solepath", "solepath-lab"], shell=options.shell))
    return 0


def complete(parser: ArgumentParser) -> None:
    """Print the completions of the word that a shell asks for, and end the program; without argcomplete, do nothing."""
    try:
        from argcomplete import autocomplete
    except ImportError:
        return
    autocomplete(parser)


def complete_with(action: Action, names: Callable[[], Iterable[str]]) -> None:
    """Complete the value of an option with the names that a function returns."""
    vars(action)["completer"] = lambda **_: names()


add_completion = command(
    "completion",
    "Print what makes a shell complete commands, options, recipes and files at the Tab key (extra "
    "completion). One line in the file that the shell reads at its start is enough.",
    """eval "$(solepath completion bash)"        in ~/.bashrc
eval "$(solepath completion zsh)"         in ~/.zshrc
solepath completion fish | source         in ~/.config/fish/config.fish""",
    option("shell", metavar="SHELL", choices=SHELLS, help=", ".join(SHELLS)),
    run=run,
)
