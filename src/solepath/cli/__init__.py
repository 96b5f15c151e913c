"""The command line: one file a command. What a command needs beyond argparse is imported when it runs."""

from .main import main

__all__ = ["main"]
