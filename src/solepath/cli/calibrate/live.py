"""The option --live of a kind of calibration: a person at the terminal makes the file from which it is learnt."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Coroutine, Iterable
from typing import TYPE_CHECKING, Any

from ..bluetooth.devices import need_bleak
from ..common.failure import Failure
from ..common.files import Kind, OutputFile, check_outputs

if TYPE_CHECKING:
    import asyncio


def reject_live_options(options: argparse.Namespace, names: Iterable[str]) -> None:
    """Raise Failure if an option of these names is given: only --live uses them."""
    given = [name.replace("_", "-") for name in names if getattr(options, name) not in (None, False)]
    if given:
        raise Failure(f"--{given[0]} is an option of --live: without it nothing is measured now")


def check_live(options: argparse.Namespace, kind: Kind, purpose: str) -> None:
    """Raise Failure if there is no terminal, no Bluetooth, or no way to write the file.

    `kind` is that of the file, and `purpose` the command with what it needs a person for."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise Failure(f"{purpose}: it needs a terminal")
    check_outputs(options, [OutputFile(options.file, kind)], options.out)
    need_bleak()


def run_live(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> None:
    """Run `main`, which writes the file; raise SystemExit when it was stopped."""
    from ..bluetooth.backend import listen_to_end

    status = listen_to_end(main)
    if status != 0:
        raise SystemExit(status)
