"""Defines the errors that stop a command, and the checks of its options."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from importlib.util import find_spec
from math import isfinite, nan, radians
from typing import TYPE_CHECKING

from ...recording import printable
from ...types.extras import install_hint
from .closest import unknown

if TYPE_CHECKING:
    from ...recipes import Recipe

MAX_LENGTH = 2000
"""Largest number of characters of a sentence that are shown; chosen by hand."""


class Failure(Exception):
    """An error after which the command cannot go on: one sentence for stderr, exit status 2.

    A RecordingError or CalibrationError that nobody catches has the same effect."""


def note(sentence: str) -> None:
    """Print one line on stderr and go on."""
    sys.stdout.flush()
    print(f"solepath: {printable(sentence, MAX_LENGTH)}", file=sys.stderr)


def has_terminal() -> bool:
    """Return whether stdin or stdout is a terminal, from which a command can be ended."""
    return sys.stdin.isatty() or sys.stdout.isatty()


def is_installed(package: str) -> bool:
    """Return whether a package of an extra is installed, without importing it."""
    return find_spec(package) is not None


def require(what: str, extra: str, *packages: str) -> None:
    """Raise Failure, with the command that installs `extra`, when one of its packages is not installed.

    `what` is the start of the sentence, such as "Bluetooth needs"."""
    for package in packages:
        if not is_installed(package):
            raise Failure(f"{what} {package}: {install_hint(extra)}")


def host_and_port(option: str, text: str, hint: str = "") -> tuple[str, int]:
    """Return host and port of HOST:PORT, where an IPv6 host may have brackets; raise Failure for other text."""
    host, colon, port = text.rpartition(":")
    if not colon or not host or not (port.isascii() and port.isdecimal()) or int(port) > 65535:
        raise Failure(f"{option} {printable(text, 80)}: that is not HOST:PORT{hint}")
    return host.removeprefix("[").removesuffix("]"), int(port)


def _number(text: str, what: str, is_valid: Callable[[float], bool]) -> float:
    """Return the finite number in `text`; raise ArgumentTypeError with "is not `what`" for any other."""
    try:
        value = float(text)
    except ValueError:
        value = nan
    if not (isfinite(value) and is_valid(value)):
        raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
    return value


def parse_positive(text: str) -> float:
    """Parse an option of argparse: a finite number above 0."""
    return _number(text, "a positive number", lambda value: value > 0.0)


def parse_offset(text: str) -> float:
    """Parse an option of argparse: an offset of a clock of at most an hour, s."""
    return _number(text, "a number of seconds from -3600 to 3600", lambda value: abs(value) <= 3600.0)


def parse_count(text: str) -> int:
    """Parse an option of argparse: a whole number above 0."""
    value = int(text) if text.isdecimal() and len(text) < 10 else 0
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of 1 or more")
    return value


def parse_whole_number(text: str) -> int:
    """Parse an option of argparse: a whole number of 0 or more."""
    if not text.isdecimal() or len(text) > 18:
        raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a whole number of 0 or more")
    return int(text)


def parse_share(text: str) -> float:
    """Parse an option of argparse: a number from 0 to 1."""
    return _number(text, "a number from 0 to 1", lambda value: 0.0 <= value <= 1.0)


def parse_seconds(text: str) -> float:
    """Parse an option of argparse: a finite number of seconds, 0 or more."""
    return _number(text, "a number of seconds", lambda value: value >= 0.0)


def parse_degrees(text: str) -> float:
    """Parse an option of argparse: a finite angle in degrees, returned in rad."""
    return radians(_number(text, "a number of degrees", lambda _: True))


def recipe_named(name: str) -> Recipe:
    """Return the recipe of this name; raise Failure when there is none."""
    from ...recipes import NAMES, by_name

    if name not in NAMES:
        raise Failure(unknown("recipe", name, NAMES))
    return by_name(name)
