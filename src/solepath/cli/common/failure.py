"""What stops a command, and how its options are checked."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from math import isfinite, nan, radians
from pathlib import Path

from ...recording import printable

LONGEST = 2000
"""Characters of a sentence that are shown."""


class Failure(Exception):
    """The command cannot go on: one sentence for stderr, exit status 2."""


def note(sentence: str) -> None:
    """One line on stderr that does not stop anything."""
    sys.stdout.flush()
    print(f"solepath: {printable(sentence, LONGEST)}", file=sys.stderr)


def check_writable(path: Path) -> None:
    """OSError now, not after a long recording was read. What is in the file stays."""
    there = path.exists()
    if not there or not path.is_fifo():  # a pipe would take it for the end
        path.open("ab").close()
    if not there:
        path.unlink()


def positive(text: str) -> float:
    """An argparse type: a finite number above 0."""
    value = _number(text)
    if not isfinite(value) or value <= 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def count(text: str) -> int:
    """An argparse type: a whole number above 0."""
    value = int(text) if text.isdecimal() and len(text) < 10 else 0
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of 1 or more")
    return value


def seed(text: str) -> int:
    """An argparse type: a whole number of 0 or more."""
    if not text.isdecimal() or len(text) > 18:
        raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a whole number of 0 or more")
    return int(text)


def share(text: str) -> float:
    """An argparse type: a number from 0 to 1."""
    value = _number(text)
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 0 to 1")
    return value


def seconds(text: str) -> float:
    """An argparse type: a finite number of seconds, 0 or more."""
    value = _number(text)
    if not isfinite(value) or value < 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of seconds")
    return value


def degrees_of(text: str) -> float:
    """An argparse type: a finite angle in degrees, as rad."""
    value = _number(text)
    if not isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of degrees")
    return radians(value)


def _number(text: str) -> float:
    """NaN for what is no number."""
    try:
        return float(text)
    except ValueError:
        return nan


def known_recipe(name: str, names: Sequence[str]) -> str:
    if name not in names:
        raise Failure(f"there is no recipe {name!r}; there are: {', '.join(names)}")
    return name
