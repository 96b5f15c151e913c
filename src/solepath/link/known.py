"""The kinds of devices that a session knows, by the prefix of their channels: those of devices/, each loaded when a
channel of it is first heard, and what an app adds. This is a table of functions, so nothing that is saved holds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..types import Site
from ..types.attrs import field, frozen
from .device_link import DeviceLink, Output

if TYPE_CHECKING:  # loaded with a device that has them
    from .driver import Basis, Driver
    from .profile import Profile


@frozen
class DeviceKind:
    """One kind of device. `begin`: a fresh link at a site, of a device with this firmware as far as that is known.
    `feed`: what a value of a channel (link, channel, data, arrival) makes of it; WireError when it cannot be used.
    `basis`: what the state of its links stands on; None for those that are not declared."""

    profile: Profile
    begin: Callable[[Site, str], DeviceLink]
    feed: Callable[[Any, str, bytes, float], Output]
    basis: Basis | None = None

    def fits(self, link: DeviceLink) -> bool:
        """Whether this link, which was saved, is one that this kind began."""
        return link.name == self.profile.name and link.stands_on() == self.basis


def _declared(driver: Driver, ours: bool) -> DeviceKind:
    from .stream import StreamLink, stream_link

    begin = partial(stream_link, driver, ours)
    return DeviceKind(driver.profile, begin, partial(StreamLink.feed, driver=driver), driver.basis(ours))


_MODULES = {
    "insole": "insole",
    "cc2541": "cc2541",
    "cc2650": "cc2650",
    "dot": "dot",
    "dot-orientation": "dot_orientation",
    "orphe": "orphe",
    "thingy": "thingy",
}
"""Name of a device -> its file in devices/."""
_RESERVED = {"insole", "cc2541", "device", "receiver"}


@frozen
class Kinds:
    """The table. `loaded`: as far as it was asked for; ours come into it then."""

    loaded: dict[str, DeviceKind] = field(factory=dict)

    def get(self, name: str) -> DeviceKind | None:
        """The kind of this name; None where there is none."""
        if name in _MODULES and name not in self.loaded:
            module = import_module(f"{__package__}.devices.{_MODULES[name]}")
            own: DeviceKind | None = None
            if hasattr(module, "LINK"):  # it has a link of its own
                own = DeviceKind(module.PROFILE, *module.LINK)
            self.loaded[name] = own or _declared(module.DRIVER, ours=True)
        return self.loaded.get(name)


def kinds(drivers: Iterable[Driver] = ()) -> Kinds:
    """The table with an app's own devices in it, which may replace declared ones of ours. TypeError for what is no
    Driver, ValueError for a name that is taken."""
    table = Kinds()
    added: set[str] = set()
    for driver in drivers:
        from .driver import Driver

        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED or driver.name in added:
            raise ValueError(f"there is a device {driver.name!r} already")
        added.add(driver.name)
        table.loaded[driver.name] = _declared(driver, ours=False)
    return table


KINDS = kinds()
"""Without any that an app adds."""
