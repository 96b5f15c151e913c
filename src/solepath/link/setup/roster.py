"""List of the configured devices with their sites: no two of them have the same site or are the same device."""

from __future__ import annotations

from collections.abc import Iterable

from ...types import Site
from ...types.attrs import define, field
from .config import DeviceConfig, check_configs

RECHECK_TIME = 60.0
"""Time after which a wrong device is tried again, s: its owner may have corrected it. Chosen by hand."""


class WrongDevice(Exception):
    """Error for a device that is not the configured one, or not of the kind that it seemed to be."""


@define(eq=False)
class Member:
    """One configured device of a roster.

    `address` is "" until a device was accepted; from then on no other device is accepted."""

    config: DeviceConfig
    site: Site
    """Site of the packets; provisional until a device that reports its own site was read."""
    address: str = ""
    name: str = ""
    """Advertised name of the accepted device, "" when unknown."""
    current_address: str = ""
    """Address of the device that is in use now, accepted or not; "" for none."""
    wrong_since: dict[str, float] = field(factory=dict)
    """Time at which each wrong device was detected, s, by its address."""

    def claims(self, address: str, name: str) -> bool:
        """Return whether no other member may use this device."""
        if self.address or self.current_address:
            return address in (self.address, self.current_address)
        return self.config.is_named(address, name)


@define(eq=False)
class Roster:
    """All configured devices. Raises ValueError when two of them may mean one device or share a site."""

    members: list[Member] = field(factory=list)

    def add(self, configs: Iterable[DeviceConfig]) -> list[Member]:
        """Add configured devices and return their members; on ValueError nothing is added."""
        configs = tuple(configs)
        check_configs([*(member.config for member in self.members), *configs])
        used = {config.site for config in configs} | {member.site for member in self.members}
        free_sites = [site for site in Site if site not in used]
        added = [Member(one, free_sites.pop(0) if one.site is None else one.site) for one in configs]
        self.members += added
        return added

    def remove(self, member: Member) -> None:
        """Remove a member, whose site and device become free."""
        self.members.remove(member)

    def is_excluded(self, member: Member, address: str, name: str, now: float) -> bool:
        """Return whether a device belongs to another member or is known to be wrong; `now` in s."""
        member.wrong_since = {one: t for one, t in member.wrong_since.items() if now - t < RECHECK_TIME}
        others = (other for other in self.members if other is not member)
        return address in member.wrong_since or any(other.claims(address, name) for other in others)

    def assign(self, member: Member, reported: Site | None, address: str, advertised_name: str) -> None:
        """Assign a device to the site that it reports; raise WrongDevice when it cannot be worn there."""
        site, requested = reported or member.config.site, member.config.site
        name = advertised_name or address
        if site is None:
            raise WrongDevice(f"{name} does not say where it is worn: name a site")
        if requested is not None and site is not requested:
            raise WrongDevice(f"{name} is a {site.words} one: expected at the {requested.words}")
        same_site = [other for other in self.members if other is not member and other.site is site]
        if any(other.address or other.config.site is not None for other in same_site):
            raise WrongDevice(f"{name} is one more for the {site.words}")
        for other in same_site:  # both sites are provisional, so they can be exchanged
            other.site = member.site
        member.site, member.address, member.name = site, address, advertised_name
