"""Reads the options of `solepath live` for sensors that come as streams of the lab streaming layer."""

from __future__ import annotations

from argparse import Namespace

from ...types import Site
from ..common.failure import Failure, require

PREFIX = "lsl:"
"""Start of the name of a device that stands for a stream."""


def stream_names_of(options: Namespace) -> dict[Site, str]:
    """Return the names of the streams of --left and --right, by site; raise Failure for a stream beside a device."""
    given = {Site.LEFT_FOOT: options.left, Site.RIGHT_FOOT: options.right}
    names = {site: text.removeprefix(PREFIX) for site, text in given.items() if text and text.startswith(PREFIX)}
    if names and len(names) < len([text for text in (*given.values(), *options.at) if text]):
        raise Failure("streams of LSL and devices cannot be mixed: sensors of both feet come the same way")
    if "" in names.values():
        raise Failure(f"{PREFIX} names no stream: `solepath scan --lsl` lists those in the network")
    if names and any(one is not None for one in (options.view, options.record, options.floorplan)):
        raise Failure("streams of LSL: --view, --record and --floorplan are for sensors over Bluetooth")
    return names


def need_lsl(what: str) -> None:
    """Raise Failure when the lab streaming layer cannot be used; `what` starts the sentence, such as "--lsl needs"."""
    require(what, "lsl", "pylsl")
    try:
        import pylsl  # noqa: F401
    except (RuntimeError, OSError):  # the wheels for some machines have no liblsl
        raise Failure(f"{what} liblsl, which pylsl does not find: install it, or name its file in PYLSL_LIB") from None


def stated(options: Namespace) -> tuple[list[str] | None, dict[str, str] | None]:
    """Return what --channels and --units say; None for what is not given."""
    channels = None if options.channels is None else [name.strip() for name in options.channels.split(",")]
    if options.units is None:
        return channels, None
    acc, comma, gyro = options.units.partition(",")
    if not comma:
        raise Failure(f"--units {options.units}: that is not ACC,GYRO, as in g,deg/s")
    return channels, {"acc": acc.strip(), "gyro": gyro.strip()}
