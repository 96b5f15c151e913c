"""Device configs: which devices to connect to, their sites, and how they are distinguished."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import frozen

from ..link.catalogue import PROFILES
from ..link.profile import Profile
from ..types import SITE_OF_FOOT, Site


@frozen
class DeviceConfig:
    """The config of one device to connect to.

    `site` is where it is worn; None for an insole, which reports its own site. `which` is its address, or its name when
    no other device nearby has that name; "" accepts any device of its kind. `profile` is its kind, needed where the
    advertisement does not show it (20 Hz firmware of a CC2541, a device of your own) or `which` is "". Raises
    ValueError when nothing says which device is meant, or when a device that cannot report its site has none."""

    site: Site | None
    which: str = ""
    profile: Profile | None = None

    def __attrs_post_init__(self) -> None:
        if not self.which and self.profile is None:
            raise ValueError("say which device is wanted: its address, its name, or its profile")
        if self.site is None and self.profile is not None and not reports_site(self.profile):
            raise ValueError(f"a {self.profile.name} does not say where it is worn: name a site")

    @property
    def description(self) -> str:
        """Description of the device for use in a sentence."""
        kind = self.profile.name if self.profile is not None else "device"
        return f"{kind} {self.which!r}" if self.which else kind

    def matches(self, address: str, name: str, services: Sequence[str]) -> bool:
        """Return whether a device with this advertisement is the configured one."""
        if self.which:
            return self.is_named(address, name)
        return self.profile is not None and advertises(self.profile, name, services)

    def is_named(self, address: str, name: str) -> bool:
        """Return whether `which` is this name or address."""
        return bool(self.which) and (self.which == name or self.is_address(address))

    def is_address(self, address: str) -> bool:
        """Return whether `which` is this address, so that no other device can be meant."""
        return self.which.upper() == address.upper()


def reports_site(profile: Profile | None) -> bool:
    """Return whether a device of this kind can report where it is worn."""
    return profile is not None and "insole/info" in profile.reads


def check_configs(configs: Sequence[DeviceConfig]) -> None:
    """Raise ValueError when there is no config, two have one site, or nothing distinguishes two of them."""
    if not configs:
        raise ValueError("no device is wanted")
    sites = [one.site for one in configs if one.site is not None]
    if len(set(sites)) < len(sites):
        raise ValueError("two devices cannot be at one site")
    feet = len({*SITE_OF_FOOT.values()} - {*sites})
    if len(configs) - len(sites) > feet:
        raise ValueError("more insoles are wanted than there are feet for them")
    for k, one in enumerate(configs):
        for other in configs[:k]:
            if one.which.upper() == other.which.upper() and (one.which or one.profile == other.profile):
                if not one.which and reports_site(one.profile):
                    continue
                raise ValueError(f"nothing tells one {one.description} from the other: name them by their addresses")


def advertises(profile: Profile, name: str, services: Sequence[str]) -> bool:
    """Return whether this is an advertisement of a device of this kind."""
    return profile.matches_name(name) or not set(profile.services).isdisjoint(services)


def identify(name: str, services: Sequence[str]) -> Profile | None:
    """Return the kind of device that sends this advertisement; None for an unknown one."""
    return next((profile for profile in PROFILES if advertises(profile, name, services)), None)
