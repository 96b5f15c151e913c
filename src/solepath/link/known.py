"""The kinds of devices that a session knows, by the prefix of their channels: two with a link of their own, the
declared ones of devices/, each loaded when a channel of it is first heard, and what an app adds. This is a table of
functions, so nothing that is saved holds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from typing import Any

from attrs import field, frozen

from ..events import LinkEvent
from ..types import Sample, Site
from .devices import cc2541, insole
from .driver import Basis, Driver
from .profile import Profile
from .stream import StreamLink, stream_link

Output = list[Sample | LinkEvent]
DeviceLink = insole.InsoleLink | cc2541.Cc2541Link | StreamLink


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
        basis = link.basis if isinstance(link, StreamLink) else None
        return link.name == self.profile.name and basis == self.basis


def _declared(driver: Driver, ours: bool) -> DeviceKind:
    begin = partial(stream_link, driver, ours)
    return DeviceKind(driver.profile, begin, partial(StreamLink.feed, driver=driver), driver.basis(ours))


_OWN_LINK = {
    "insole": DeviceKind(insole.PROFILE, insole.insole_link, insole.InsoleLink.feed),
    "cc2541": DeviceKind(cc2541.PROFILE, cc2541.cc2541_link, cc2541.Cc2541Link.feed),
}
_MODULES = {
    "cc2650": "cc2650",
    "dot": "dot",
    "dot-orientation": "dot_orientation",
    "orphe": "orphe",
    "thingy": "thingy",
}
"""Name of a declared device -> its file in devices/."""
_RESERVED = {*_OWN_LINK, "device", "receiver"}


@frozen
class Kinds:
    """The table. `loaded`: as far as it was asked for; ours that are declared come into it then."""

    loaded: dict[str, DeviceKind] = field(factory=lambda: {**_OWN_LINK})

    def get(self, name: str) -> DeviceKind | None:
        """The kind of this name; None where there is none."""
        if name in _MODULES and name not in self.loaded:
            module = import_module(f"{__package__}.devices.{_MODULES[name]}")
            self.loaded[name] = _declared(module.DRIVER, ours=True)
        return self.loaded.get(name)


def kinds(drivers: Iterable[Driver] = ()) -> Kinds:
    """The table with an app's own devices in it, which may replace declared ones of ours. TypeError for what is no
    Driver, ValueError for a name that is taken."""
    table = Kinds()
    added: set[str] = set()
    for driver in drivers:
        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED or driver.name in added:
            raise ValueError(f"there is a device {driver.name!r} already")
        added.add(driver.name)
        table.loaded[driver.name] = _declared(driver, ours=False)
    return table


KINDS = kinds()
"""Without any that an app adds."""
