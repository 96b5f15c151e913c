"""Defines the options of commands that use Bluetooth: the devices, the Bluetooth itself, and the time.

The times below were chosen by hand and not swept."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ...types import Site
from ..common.closest import unknown
from ..common.failure import Failure, has_terminal, note, parse_positive, require
from ..common.own_devices import add_own_devices
from ..common.parser import Option, option, together
from ..completion import complete_with

if TYPE_CHECKING:
    from ...ble import Advertisement, DeviceConfig
    from ...link.driver import Driver
    from ...link.profile import Profile

SCAN_TIME = 4.0
"""Time of the search for devices, s."""
LISTEN_TIME = 30.0
"""Time for which a command listens without a terminal and without --duration, s."""
SERVE_TIME = 600.0
"""Time for which emulated devices are served without a terminal and without --duration, s."""


def parse_at(text: str) -> tuple[Site, str]:
    """Parse a value of --at: a site, and the device there."""
    site, _, device = text.partition("=")
    sites = [one.value for one in Site]
    if site not in sites or not device:
        raise ArgumentTypeError(f"{text!r} is not SITE=DEVICE: {unknown('site', site, sites)}")
    return Site(site), device


add_via = option(
    "--via",
    metavar="tcp:HOST:PORT",
    help="the emulated devices of `solepath emulate` there, instead of this machine's Bluetooth",
)
"""--via, the Bluetooth to use,."""


def _profile_names() -> Iterable[str]:
    from ...link.catalogue import DEVICES

    return DEVICES


def _add_profile(command: Any) -> None:
    what = "the kind of all these devices, where their names do not say it"
    complete_with(command.add_argument("--profile", metavar="NAME", help=what), _profile_names)


def duration_option(unattended: float) -> Option:
    """Return --duration; `unattended` is the time without a terminal, s."""
    return option(
        "--duration",
        metavar="S",
        type=parse_positive,
        help=f"end by itself after so many seconds (default: at Ctrl-C; {unattended:g} s without a terminal)",
    )


add_feet = together(
    add_via,
    option("--left", metavar="DEVICE", help="address or name of the device on the left foot"),
    option("--right", metavar="DEVICE", help="address or name of the device on the right foot"),
    lambda command: command.set_defaults(at=[]),
    _add_profile,
    option("--pair", action="store_true", help="pair with the devices"),
)
"""Options of the devices on the feet."""
add_devices = together(
    add_feet,
    add_own_devices,
    option(
        "--at",
        metavar="SITE=DEVICE",
        type=parse_at,
        action="append",
        default=[],
        help="a device elsewhere, for instance pelvis=NAME",
    ),
    duration_option(LISTEN_TIME),
)
"""Options of the devices and of the time."""


def profile_named(name: str | None, own: Iterable[Driver] = ()) -> Profile | None:
    """Return the profile of this name, of one's `own` devices or a built-in one; raise Failure when there is none."""
    from ...link.catalogue import DEVICES

    profiles = DEVICES | {driver.name: driver.profile for driver in own}
    if name is not None and name not in profiles:
        raise Failure(unknown("profile", name, profiles))
    return None if name is None else profiles[name]


def named_devices(options: Namespace, own: Iterable[Driver] = ()) -> list[DeviceConfig]:
    """Return the devices that the options name; raise Failure for a site or profile that does not exist.

    `own` are the drivers of devices of one's own."""
    from ...ble import DeviceConfig
    from ...link.setup.config import check_configs

    named = [(Site.LEFT_FOOT, options.left), (Site.RIGHT_FOOT, options.right), *options.at]
    profile = profile_named(options.profile, own)
    devices = [DeviceConfig(site, device, profile) for site, device in named if device]
    try:
        if devices:
            check_configs(devices)
    except ValueError as error:
        raise Failure(str(error)) from None
    return devices


def choose_devices(found: list[Advertisement], kind: str | None, own: Sequence[Driver] = ()) -> list[DeviceConfig]:
    """Return the devices to listen to when none was named; raise Failure where the choice is not clear.

    If an insole is found, they are two insoles, which report their feet themselves. Otherwise it is the only device
    that is found, on the right foot as in `track`. `kind` is the name of the profile; None for any. `own` are the
    drivers of devices of one's own."""
    from ...ble import DeviceConfig
    from ...ble.candidates import describe_seen
    from ...link.devices.insole import PROFILE as INSOLE
    from ...link.setup.config import advertises, identify

    named = profile_named(kind, own)

    def profile_of(one: Advertisement) -> Profile | None:
        if named is None:
            return identify(one.name, one.services, [driver.profile for driver in own])
        return named if advertises(named, one.name, one.services) else None

    known = [(one, profile) for one in found if (profile := profile_of(one)) is not None]
    if any(profile is INSOLE for _, profile in known):
        return [DeviceConfig(None, profile=INSOLE), DeviceConfig(None, profile=INSOLE)]
    if not known:
        what = "device that is known here" if named is None else named.name
        seen = describe_seen(found)
        advice = "switch it on, or say which device it is with --left and --right"
        raise Failure(f"no {what} is in range: {advice}{seen and '; ' + seen}")
    if len(known) == 1:
        ((one, profile),) = known
        note(f"{one.name}: taken for the right foot's (--left {one.address} says otherwise)")
        return [DeviceConfig(Site.RIGHT_FOOT, one.address, profile)]
    names = ", ".join(f"{one.address} ({one.name})" for one, _ in known)
    raise Failure(f"{len(known)} devices are in range, {names}: say which is where with --left and --right")


def need_bleak() -> None:
    """Raise Failure if the `ble` extra is not installed."""
    require("Bluetooth needs", "ble", "bleak", "bleak_retry_connector")


def listening_time(options: Namespace) -> float | None:
    """Return --duration or its default, s; None to listen until Ctrl-C."""
    if options.duration is not None:
        return float(options.duration)
    if has_terminal():
        return None
    print(f"no terminal to end this from: it ends after {LISTEN_TIME:g} s (--duration says otherwise)", flush=True)
    return LISTEN_TIME
