"""Which devices are wanted, where on the body, and how they are told apart."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import frozen

from ..link.catalogue import PROFILES
from ..link.profile import Profile
from ..types import SITE_OF_FOOT, Site


@frozen
class DeviceConfig:
    """One device that is looked for. `site`: where it is worn; None for an insole, which says itself whose it is.

    `which`: its address, or its name when no other device nearby has it; "" for any one of its kind. `profile`: its
    kind, where the advertisement does not tell (20 Hz firmware of a CC2541, a device of your own) or `which` is "".
    ValueError when nothing tells which device is wanted, or when a device that cannot say where it is worn has no site.
    """

    site: Site | None
    which: str = ""
    profile: Profile | None = None

    def __attrs_post_init__(self) -> None:
        if not self.which and self.profile is None:
            raise ValueError("say which device is wanted: its address, its name, or its profile")
        if self.site is None and self.profile is not None and not says_its_site(self.profile):
            raise ValueError(f"a {self.profile.name} does not say where it is worn: name a site")

    @property
    def words(self) -> str:
        """The device, as in a sentence."""
        kind = self.profile.name if self.profile is not None else "device"
        return f"{kind} {self.which!r}" if self.which else kind

    def fits(self, address: str, name: str, services: Sequence[str]) -> bool:
        """Is a device that advertises so the one?"""
        if self.which:
            return self.names(address, name)
        return self.profile is not None and advertises(self.profile, name, services)

    def names(self, address: str, name: str) -> bool:
        """Is it this device that was asked for, by its name or its address?"""
        return bool(self.which) and (self.which == name or self.is_address(address))

    def is_address(self, address: str) -> bool:
        """Is the device with this address the one, whoever else is near?"""
        return self.which.upper() == address.upper()


def says_its_site(profile: Profile | None) -> bool:
    """Can a device of this kind be asked where it is worn?"""
    return profile is not None and "insole/info" in profile.reads


def check(wanted: Sequence[DeviceConfig]) -> None:
    """ValueError when there is none, when two are to be at one site, or when nothing tells two apart."""
    if not wanted:
        raise ValueError("no device is wanted")
    sites = [one.site for one in wanted if one.site is not None]
    if len(set(sites)) < len(sites):
        raise ValueError("two devices cannot be at one site")
    feet = len({*SITE_OF_FOOT.values()} - {*sites})
    if len(wanted) - len(sites) > feet:
        raise ValueError("more insoles are wanted than there are feet for them")
    for k, one in enumerate(wanted):
        for other in wanted[:k]:
            if one.which.upper() == other.which.upper() and (one.which or one.profile == other.profile):
                if not one.which and says_its_site(one.profile):
                    continue
                raise ValueError(f"nothing tells one {one.words} from the other: name them by their addresses")


def advertises(profile: Profile, name: str, services: Sequence[str]) -> bool:
    """Is this the advertisement of such a device?"""
    return profile.matches_name(name) or not set(profile.services).isdisjoint(services)


def identify(name: str, services: Sequence[str]) -> Profile | None:
    """The kind of device that advertises so; None for a stranger."""
    return next((profile for profile in PROFILES if advertises(profile, name, services)), None)
