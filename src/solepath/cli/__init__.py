"""The command line, with one file for each command.

Importing it imports the live path, as `import solepath` does (attrs and construct, no numpy). A command imports what it
needs beyond that, such as numpy, rich, the emulator or the evaluation, when it runs."""

from .main import main

__all__ = ["main"]
