"""The kinds of devices that a session knows, by the prefix of their channels.

A module of devices/ is imported when the first packet of its device arrives, so that a session loads only what it uses.
An app may add kinds. The table holds functions, so it is never part of a saved state."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..types import Site
from ..types.attrs import field, frozen
from .device_link import DeviceLink, Output

if TYPE_CHECKING:  # imported at run time only with a device that needs them
    from .driver import Driver, DriverSignature
    from .profile import Profile


@frozen
class DeviceKind:
    """One kind of device: its profile and the functions that make and feed its links.

    `make_link(site, firmware)` returns a fresh link; `firmware` is "" when it is not known. `feed(link, channel, data,
    arrival)` returns the samples and events of a value, and raises WireError for a value that cannot be used.
    `signature`: driver numbers on which the state of the links depends; None for a device that is not declared."""

    profile: Profile
    make_link: Callable[[Site, str], DeviceLink]
    feed: Callable[[Any, str, bytes, float], Output]
    signature: DriverSignature | None = None

    def accepts(self, link: DeviceLink) -> bool:
        """Return whether a saved link was made by this kind."""
        return link.name == self.profile.name and link.driver_signature() == self.signature


def _declared_kind(driver: Driver, built_in: bool) -> DeviceKind:
    from .stream import StreamLink, make_stream_link

    make_link = partial(make_stream_link, driver, built_in)
    return DeviceKind(driver.profile, make_link, partial(StreamLink.feed, driver=driver), driver.signature(built_in))


_DEVICE_MODULES = {
    "insole": "insole",
    "cc2541": "cc2541",
    "cc2650": "cc2650",
    "dot": "dot",
    "dot-orientation": "dot_orientation",
    "orphe": "orphe",
    "thingy": "thingy",
}
"""Module in devices/ of each device, by the device's name."""
_RESERVED_NAMES = {"insole", "cc2541", "device", "receiver"}
"""Names that an app's device cannot have."""


@frozen
class DeviceKinds:
    """The table of device kinds, by name."""

    loaded: dict[str, DeviceKind] = field(factory=dict)
    """Kinds that an app added, and built-in kinds that were used before."""
    drivers: list[Driver] = field(factory=list)
    """Drivers of the kinds that an app added."""

    def get(self, name: str) -> DeviceKind | None:
        """Return the kind of this name; None when there is none."""
        if name in _DEVICE_MODULES and name not in self.loaded:
            module = import_module(f"{__package__}.devices.{_DEVICE_MODULES[name]}")
            own_kind: DeviceKind | None = None
            if hasattr(module, "LINK"):  # the device is not declared
                own_kind = DeviceKind(module.PROFILE, *module.LINK)
            self.loaded[name] = own_kind or _declared_kind(module.DRIVER, built_in=True)
        return self.loaded.get(name)


def make_kinds(drivers: Iterable[Driver] = ()) -> DeviceKinds:
    """Return the table with an app's own devices, which may replace declared devices of devices/.

    TypeError for an object that is no Driver, ValueError for a reserved name or a name that two drivers have."""
    table = DeviceKinds()
    added_names: set[str] = set()
    for driver in drivers:
        from .driver import Driver

        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED_NAMES or driver.name in added_names:
            raise ValueError(f"there is a device {driver.name!r} already")
        added_names.add(driver.name)
        table.drivers.append(driver)
        table.loaded[driver.name] = _declared_kind(driver, built_in=False)
    return table


BUILT_IN_KINDS = make_kinds()
"""The table without devices of an app."""
