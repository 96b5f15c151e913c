"""The kinds of devices that are known, by the prefix of their channels: three with a machine of their own, the declared
ones of devices/, and what an app adds. This is a table of functions, so nothing that is saved holds it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Protocol

from attrs import frozen

from ..events import LinkEvent
from ..types import Sample, Site
from .devices import DECLARED
from .devices.cc2541 import Cc2541Link, cc2541_link
from .devices.cc2650 import Cc2650Link
from .devices.insole import InsoleLink
from .driver import Driver
from .profile import CC2541, CC2650, INSOLE, Profile
from .profile import PROFILES as OWN
from .stream import StreamLink, stream_link

Output = list[Sample | LinkEvent]
DeviceLink = InsoleLink | Cc2650Link | Cc2541Link | StreamLink


class DeviceKind(Protocol):
    """One kind of device: what is known of it, and how its link begins and is fed."""

    @property
    def profile(self) -> Profile: ...

    def begin(self, site: Site, firmware: str) -> DeviceLink:
        """A fresh device at `site`; `firmware` as far as it is known."""

    def feed(self, link: DeviceLink, channel: str, data: bytes, arrival: float) -> Output:
        """What a value makes of its link. WireError when it cannot be used."""

    def fits(self, link: DeviceLink) -> bool:
        """Whether this link, which was saved, is one that this kind began."""


Kinds = Mapping[str, DeviceKind]


@frozen
class _Programmed:
    """A device with a machine of its own."""

    profile: Profile
    make: Callable[[Site, str], InsoleLink | Cc2650Link | Cc2541Link]

    def begin(self, site: Site, firmware: str) -> DeviceLink:
        return self.make(site, firmware)

    def feed(self, link: DeviceLink, channel: str, data: bytes, arrival: float) -> Output:
        if isinstance(link, StreamLink):
            raise TypeError(f"{link.name} is declared")
        return link.feed(channel, data, arrival)

    def fits(self, link: DeviceLink) -> bool:
        return link.name == self.profile.name


@frozen
class _Declared:
    """A device that is declared, by us or by an app."""

    driver: Driver
    ours: bool

    @property
    def profile(self) -> Profile:
        return self.driver.profile

    def begin(self, site: Site, firmware: str) -> DeviceLink:
        return stream_link(self.driver, site, self.ours)

    def feed(self, link: DeviceLink, channel: str, data: bytes, arrival: float) -> Output:
        if not isinstance(link, StreamLink):
            raise TypeError(f"{link.name} is not declared")
        return link.feed(self.driver, channel, data, arrival)

    def fits(self, link: DeviceLink) -> bool:
        return isinstance(link, StreamLink) and link.basis == self.driver.basis(self.ours)


def _insole(site: Site, firmware: str) -> InsoleLink:
    return InsoleLink(site)


def _cc2650(site: Site, firmware: str) -> Cc2650Link:
    return Cc2650Link(site)


_PROGRAMMED: dict[str, DeviceKind] = {
    "insole": _Programmed(INSOLE, _insole),
    "cc2650": _Programmed(CC2650, _cc2650),
    "cc2541": _Programmed(CC2541, cc2541_link),
}
_RESERVED = {*_PROGRAMMED, "device", "receiver"}


def kinds(drivers: Iterable[Driver] = ()) -> dict[str, DeviceKind]:
    """The table with an app's own devices in it, which may replace declared ones of ours. TypeError for what is no
    Driver, ValueError for a name that is taken."""
    table: dict[str, DeviceKind] = {**_PROGRAMMED, **{driver.name: _Declared(driver, True) for driver in DECLARED}}
    added: set[str] = set()
    for driver in drivers:
        if not isinstance(driver, Driver):
            raise TypeError(f"a device is added by its Driver, not by a {type(driver).__name__}")
        if driver.name in _RESERVED or driver.name in added:
            raise ValueError(f"there is a device {driver.name!r} already")
        added.add(driver.name)
        table[driver.name] = _Declared(driver, False)
    return table


KINDS: Kinds = kinds()
"""Without any that an app adds."""
PROFILES = OWN + tuple(driver.profile for driver in DECLARED)
"""Of every device that is known without being told."""
BY_NAME = {profile.name: profile for profile in PROFILES}
