"""What stops a command, and how its options are checked."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from math import isfinite


class Failure(Exception):
    """The command cannot go on: one sentence for stderr, exit status 2."""


def note(sentence: str) -> None:
    """One line on stderr that does not stop anything."""
    sys.stdout.flush()
    print(f"solepath: {sentence}", file=sys.stderr)


def positive(text: str) -> float:
    """An argparse type: a finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not isfinite(value) or value <= 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def known_recipe(name: str, names: Sequence[str]) -> str:
    if name not in names:
        raise Failure(f"there is no recipe {name!r}; there are: {', '.join(names)}")
    return name
