"""Defines the errors that stop a command, and the checks of its options."""

from __future__ import annotations

import sys
from argparse import ArgumentTypeError, Namespace
from collections.abc import Iterable
from contextlib import suppress
from functools import partial
from importlib.util import find_spec
from math import inf, radians

from ...recording import printable
from ...recording.errors import finite
from ...show.tables.progress import print_above

PAGE_ADDRESS = "127.0.0.1:8765"
"""Address of the page where none is named."""
MAX_LENGTH = 2000
"""Largest number of characters of a sentence that are shown; chosen by hand."""


class Failure(Exception):
    """An error after which the command cannot go on: one sentence for stderr, exit status 2.

    Any other error of solepath that nobody catches, such as a RecordingError, has the same effect."""


def note(sentence: str) -> None:
    """Print one line on stderr and go on."""
    sys.stdout.flush()
    print_above(f"solepath: {printable(sentence, MAX_LENGTH)}")


def tell(sentence: str) -> None:
    """Print one line on stdout at once, without control codes of a name in it."""
    print(printable(sentence, MAX_LENGTH), flush=True)


def has_terminal() -> bool:
    """Return whether stdin or stdout is a terminal, from which a command can be ended."""
    return sys.stdin.isatty() or sys.stdout.isatty()


def is_installed(package: str) -> bool:
    """Return whether a package of an extra is installed, without importing it."""
    return find_spec(package) is not None


def require(what: str, extra: str, *packages: str) -> None:
    """Raise Failure, with the command that installs `extra`, when one of its packages is not installed.

    `what` is the start of the sentence, such as "Bluetooth needs"."""
    from ...types.extras import install_hint

    for package in packages:
        if not is_installed(package):
            raise Failure(f"{what} {package}: {install_hint(extra)}")


def reject_options(options: Namespace, names: Iterable[str], why: str) -> None:
    """Raise Failure if one of these options is given; `why` is the sentence after its name."""
    for name in names:
        if getattr(options, name, None) not in (None, False, []):
            raise Failure(f"--{name.replace('_', '-')} {why}")


def parse_number(what: str, least: float, most: float, text: str) -> float:
    """Parse an option of argparse: a number from `least` to `most`; other text "is not `what`"."""
    with suppress(ValueError):
        if least <= (value := finite(text)) <= most:
            return value
    raise ArgumentTypeError(f"{text[:40]!r} is not {what}")


def _whole(what: str, least: int, text: str) -> int:
    """Parse an option of argparse: a whole number from `least` on; other text "is not `what`"."""
    if text.isdecimal() and len(text) <= 18 and int(text) >= least:
        return int(text)
    raise ArgumentTypeError(f"{text[:40]!r} is not {what}")


parse_positive = partial(parse_number, "a positive number", 5e-324, inf)
parse_offset = partial(parse_number, "a number of seconds from -3600 to 3600", -3600.0, 3600.0)
parse_share = partial(parse_number, "a number from 0 to 1", 0.0, 1.0)
parse_seconds = partial(parse_number, "a number of seconds", 0.0, inf)
parse_count = partial(_whole, "a number of 1 or more", 1)
parse_whole_number = partial(_whole, "a whole number of 0 or more", 0)


def parse_degrees(text: str) -> float:
    """Parse an option of argparse: a finite angle in degrees, returned in rad."""
    return radians(parse_number("a number of degrees", -inf, inf, text))


def parse_span(what: str, text: str) -> tuple[float, float]:
    """Parse an option of argparse: two times in s, the earlier one first; other text "is not `what`"."""
    with suppress(ValueError):
        start, stop = map(finite, text.split(","))
        if start < stop:
            return start, stop
    raise ArgumentTypeError(f"{printable(text, 80)} is not {what}, as in 12.5,24.1")


def parse_port(text: str) -> int:
    """Parse an option of argparse: a port; 0 is any that is free."""
    if text.isascii() and text.isdecimal() and int(text) <= 65535:
        return int(text)
    raise ArgumentTypeError(f"{text[:40]!r} is not a port from 0 to 65535")


def parse_address(text: str) -> tuple[str, int]:
    """Parse an option of argparse: HOST:PORT, where an IPv6 host may have brackets."""
    host, _, port = text.rpartition(":")
    with suppress(ArgumentTypeError):
        if host:
            return host.removeprefix("[").removesuffix("]"), parse_port(port)
    raise ArgumentTypeError(f"{text[:80]!r} is not HOST:PORT, as in {PAGE_ADDRESS}")
