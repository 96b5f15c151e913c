"""`solepath emulate`: serves virtual Bluetooth controllers with emulated devices over TCP."""

from __future__ import annotations

from argparse import Namespace
from functools import partial
from pathlib import Path

from ..common.failure import parse_address, parse_number, require
from ..common.parser import add_seed, command, option
from .devices import SERVE_TIME, duration_option

DEFAULT_ADDRESS = "127.0.0.1:9735"
DEVICE_KINDS = ("insole", "cc2650", "cc2541", "cc2541-20hz")
DEFAULT_DISTANCE = 300.0
"""Distance that the wearer walks by default, m: about four minutes."""


def parse_mtu(text: str) -> int:
    """Parse an option of argparse: an MTU, bytes."""
    return int(parse_number("an MTU from 23 to 517", 23.0, 517.0, text))


def run(options: Namespace) -> int:
    """Serve the devices; return the exit status."""
    require("emulated Bluetooth needs", "loopback", "bleak", "bumble")
    from ..common.loop import run_to_end
    from .emulate_run import prepare_bench, serve_devices

    # the walk is computed before the loop starts, so that Ctrl-C can end the computing at once
    return run_to_end(partial(serve_devices, options, prepare_bench(options)))


add_emulate = command(
    "emulate",
    "Serve emulated sensors on the feet of an emulated wearer: virtual Bluetooth controllers with the "
    "true services of the devices, spoken to in HCI over TCP. The wearer begins to walk when the first device is "
    "connected, and again when none was connected for ten seconds.",
    "solepath emulate --listen 127.0.0.1:9735\nsolepath live --via tcp:127.0.0.1:9735            in another terminal",
    option(
        "--listen",
        metavar="HOST:PORT",
        type=parse_address,
        default=DEFAULT_ADDRESS,
        help=f"where to (default: {DEFAULT_ADDRESS}; port 0: any that is free)",
    ),
    option("--device", choices=DEVICE_KINDS, default="insole", help="what is worn on both feet (default: insole)"),
    option(
        "--distance",
        metavar="M",
        type=partial(parse_number, "a distance of at most 5000 m, as far as emulated wearers walk", 5e-324, 5000.0),
        default=DEFAULT_DISTANCE,
        help="how far to walk, m (default: 300)",
    ),
    option(
        "--postures",
        metavar="S",
        type=partial(parse_number, "a time of at most 600 s for each posture", 5e-324, 600.0),
        help="instead of walking, hold the shoes flat and in the postures of `calibrate shoe`, S seconds each",
    ),
    add_seed,
    option("--mtu", metavar="N", type=parse_mtu, default=247, help="MTU of insoles, bytes (default: 247)"),
    option("--faults", metavar="FILE", type=Path, help="a script of what goes wrong"),
    duration_option(SERVE_TIME),
    run=run,
)
