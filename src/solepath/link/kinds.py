"""The kinds of devices that a session knows, by the prefix of their channels.

These are the devices of devices/, each loaded when the first packet of one of its channels arrives, and those that an
app adds. The table holds functions, so nothing that is saved holds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..types import Site
from ..types.attrs import field, frozen
from .device_link import DeviceLink, Output

if TYPE_CHECKING:  # loaded with a device that needs them
    from .driver import Driver, DriverSignature
    from .profile import Profile


@frozen
class DeviceKind:
    """One kind of device.

    `make_link`: returns a fresh link at a site, for a device with this firmware as far as that is known. `feed`:
    returns the samples and events of a value (link, channel, data, arrival); WireError when it cannot be used.
    `signature`: driver numbers on which the state of its links depends; None for devices that are not declared."""

    profile: Profile
    make_link: Callable[[Site, str], DeviceLink]
    feed: Callable[[Any, str, bytes, float], Output]
    signature: DriverSignature | None = None

    def accepts(self, link: DeviceLink) -> bool:
        """Return whether this saved link is one that this kind made."""
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
"""File in devices/ of each device, by the device's name."""
_RESERVED_NAMES = {"insole", "cc2541", "device", "receiver"}


@frozen
class DeviceKinds:
    """The table of device kinds. `loaded`: those used so far; devices of devices/ are added at first use."""

    loaded: dict[str, DeviceKind] = field(factory=dict)

    def get(self, name: str) -> DeviceKind | None:
        """Return the kind of this name; None where there is none."""
        if name in _DEVICE_MODULES and name not in self.loaded:
            module = import_module(f"{__package__}.devices.{_DEVICE_MODULES[name]}")
            own: DeviceKind | None = None
            if hasattr(module, "LINK"):  # it has a link of its own
                own = DeviceKind(module.PROFILE, *module.LINK)
            self.loaded[name] = own or _declared_kind(module.DRIVER, built_in=True)
        return self.loaded.get(name)


def make_kinds(drivers: Iterable[Driver] = ()) -> DeviceKinds:
    """Return the table with an app's own devices in it, which may replace declared ones of devices/.

    TypeError for an object that is no Driver, ValueError for a name that is taken."""
    table = DeviceKinds()
    added: set[str] = set()
    for driver in drivers:
        from .driver import Driver

        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED_NAMES or driver.name in added:
            raise ValueError(f"there is a device {driver.name!r} already")
        added.add(driver.name)
        table.loaded[driver.name] = _declared_kind(driver, built_in=False)
    return table


BUILT_IN_KINDS = make_kinds()
"""The table without any device of an app."""
