"""The option --live of a kind of calibration: a person at the terminal makes the file from which it is learnt."""

from __future__ import annotations

import sys
from argparse import Namespace
from functools import partial

from ..bluetooth.devices import add_feet, need_bleak
from ..common.failure import Failure, reject_options
from ..common.files import CALIBRATION, Kind, OutputFile, add_force, check_outputs
from ..common.parser import Option, option, together
from ..common.view import add_no_browser, page_address_of, view_option

OF_LIVE = ("height", "heel", "via", "left", "right", "profile", "pair", "view", "no_browser")
"""Options that only --live uses."""


def live_options(what: str, shown: str) -> Option:
    """Return --live, and the options that go with it; `shown` says what the page shows."""
    view = view_option(f"with --live: show {shown}")
    return together(option("--live", action="store_true", help=what), add_feet, view, add_no_browser, add_force)


def measure_live(options: Namespace, kind: Kind, purpose: str) -> None:
    """Make the file, of this `kind`, with a person at the terminal, if --live is given.

    `purpose` is the command with what it needs a person for. Failure is raised for an option of --live without it, or
    if there is no terminal, no Bluetooth, or no way to write the file; SystemExit when the person stopped."""
    if not options.live:
        reject_options(options, OF_LIVE, "is an option of --live: without it nothing is measured now")
        return
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise Failure(f"{purpose}: it needs a terminal")
    check_outputs(options, [OutputFile(options.files[0], kind), OutputFile(options.out, CALIBRATION)])
    need_bleak()
    address = page_address_of(options)
    from ..common.loop import run_to_end
    from .shoe_live import measure

    status = run_to_end(partial(measure, options, address))
    if status != 0:
        raise SystemExit(status)
