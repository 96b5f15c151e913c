"""The command line: one file a command.

Importing it brings the live path, because `import solepath` does (attrs and construct, no numpy). What a command needs
beyond that, numpy, rich, the emulator, the evaluation, is imported when it runs.
"""

from .main import main

__all__ = ["main"]
