"""The command line, with one file for each command.

Its import needs no more than `import solepath` (attrs and construct, not numpy). A command imports what else it needs,
such as numpy, rich, the emulator or the evaluation, when it runs."""

from .main import main

__all__ = ["main"]
