"""The kinds of devices that a session knows, by the prefix of their channels, and the interface of their links.

A module of devices/ is imported when the first packet of its device arrives, so that a session loads only what it uses.
An app may add kinds. The table holds functions, so it is never part of a saved state."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from ..events import DefectFound, Limitation, LinkEvent
from ..types import Sample, Site
from ..types.attrs import field, frozen
from ..types.registry import TABLE, load

if TYPE_CHECKING:  # imported at run time only with a device that needs them
    from .driver import Driver
    from .profile import Profile

Output = list[Sample | LinkEvent | DefectFound]
"""Samples and link events in the order in which they are returned."""

MAX_PRESSURE_WAIT = 1.0
"""Time without inertial samples after which air pressure no longer waits for a sample, s."""

LONGEST_ADDRESS = 256
"""Largest length of a device's address; those of systems have 17 characters, or 36."""


def is_address(device: str) -> bool:
    """Return whether `device` can be saved as an address: printable text of at most LONGEST_ADDRESS characters."""
    return len(device) <= LONGEST_ADDRESS and device.isprintable()


class DeviceLink(Protocol):
    """A plain record that turns the values of one device's channels into samples on one clock."""

    site: Site
    limitation_reported: bool
    """True if a Limitation of the device was reported."""
    signature: str = ""
    """Signature of the driver that the link was made with; "" for devices without a driver."""

    @property
    def name(self) -> str:
        """Name of the device, as in its channels."""

    @property
    def may_be_silent(self) -> bool:
        """True if the device may send nothing for a long time, which is then no StreamStale."""

    @property
    def unsettled_until(self) -> float | None:
        """Time up to which sample times are not comparable with another device's, s; None when all are comparable."""

    @property
    def interval(self) -> float:
        """Time from one packet to the next, s, of a device without counters; 0 for others, which tell it themselves."""
        return 0.0

    def flush(self, known_at: float) -> Output:
        """Return the samples that still wait for other data, as known at `known_at`, s."""
        return []

    def restart_clock(self) -> None:
        """Discard the clock fit, because the receiver's clock restarted."""

    def handle_reconnection(self) -> None:
        """Prepare for counters that may have restarted, because the device was connected again."""
        return

    def set_firmware(self, firmware: str) -> None:
        """Set the firmware revision that the device reported, which most links ignore."""
        return

    def report_limitation(self, what: str, arrival: float) -> Output:
        """Return the Limitation of the device, in words, but only once; "" is none."""
        if not what or self.limitation_reported:
            return []
        self.limitation_reported = True
        return [Limitation(t=arrival, site=self.site, what=what)]


@frozen
class DeviceKind:
    """One kind of device: its profile and the functions that make and feed its links.

    `make_link(site)` returns a fresh link. `feed(link, channel, data, arrival)` returns the samples and events of a
    value, and raises WireError for a value that cannot be used. `signature`: driver numbers on which the state of the
    links depends; "" for a device that is not declared."""

    profile: Profile
    make_link: Callable[[Site], DeviceLink]
    feed: Callable[[Any, str, bytes, float], Output]
    signature: str = ""

    def accepts(self, link: DeviceLink) -> bool:
        """Return whether a saved link was made by this kind."""
        return link.name == self.profile.name and link.signature == self.signature


def _declared_kind(driver: Driver, built_in: bool) -> DeviceKind:
    link, signature = load("link", "StreamLink"), driver.signature(built_in)
    make_link = partial(link, driver.name, signature, driver.profile.nominal_rate)
    return DeviceKind(driver.profile, make_link, partial(link.feed, driver=driver), signature)


@frozen
class DeviceKinds:
    """The table of device kinds, by name."""

    loaded: dict[str, DeviceKind] = field(factory=dict)
    """Kinds that an app added, and built-in kinds that were used before."""
    drivers: list[Driver] = field(factory=list)
    """Drivers of the kinds that an app added."""

    def get(self, name: str) -> DeviceKind | None:
        """Return the kind of this name; None when there is none."""
        if name in TABLE["device"] and name not in self.loaded:
            found: DeviceKind | Driver = load("device", name)
            self.loaded[name] = found if isinstance(found, DeviceKind) else _declared_kind(found, built_in=True)
        return self.loaded.get(name)


_RESERVED_NAMES = {"insole", "cc2541", "device", "receiver"}
"""Names that an app's device cannot have."""


def make_kinds(drivers: Iterable[Driver] = ()) -> DeviceKinds:
    """Return the table with an app's own devices, which may replace declared devices of devices/.

    TypeError for an object that is no Driver, ValueError for a reserved name or a name that two drivers have."""
    table = DeviceKinds()
    for driver in drivers:
        from .driver import Driver

        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED_NAMES | table.loaded.keys():
            raise ValueError(f"there is a device {driver.name!r} already")
        table.drivers.append(driver)
        table.loaded[driver.name] = _declared_kind(driver, built_in=False)
    return table


BUILT_IN_KINDS = make_kinds()
"""The table without devices of an app."""
