"""Device configs: the devices to connect to, and their sites."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from string import hexdigits

from ...types import SITE_OF_FOOT, Site
from ...types.attrs import frozen
from ..catalogue import PROFILES
from ..profile import Profile, whole_uuid


@frozen
class DeviceConfig:
    """The config of one device to connect to.

    `site` is where it is worn; None for an insole, which reports its own site. `which` is its address, in any spelling
    (dashes, upper or lower case, the identifier of macOS and iOS), or its name when no other device nearby has that
    name; "" accepts any device of its profile. `profile` is needed when the
    advertisement does not show it (20 Hz firmware of a CC2541, a device of your own) and when `which` is "". Raises
    ValueError when `which` and `profile` are both missing, or when a device that cannot report its site has none."""

    site: Site | None
    which: str = ""
    profile: Profile | None = None

    def __attrs_post_init__(self) -> None:
        if not self.which and self.profile is None:
            raise ValueError("say which device is requested: its address, its name, or its profile")
        if self.site is None and self.profile is not None and not reports_site(self.profile):
            raise ValueError(f"the {self.profile.name} does not say where it is worn: name a site")

    @property
    def description(self) -> str:
        """Words for the device in an error message: its profile, its address or name."""
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
        """Return whether `which` is this address, in any spelling."""
        return plain_address(self.which) == plain_address(address)


def plain_address(text: str) -> str:
    """Return the digits of an address or an identifier in one spelling; any other text in upper case."""
    digits = text.strip().translate(SEPARATORS).upper()
    return digits if len(digits) in ADDRESS_LENGTHS and set(digits) <= set(hexdigits) else text.upper()


SEPARATORS = str.maketrans("", "", "-:._ {}")
"""Characters that systems write between and around the digits of an address, and that are left out."""
ADDRESS_LENGTHS = (12, 32)
"""Numbers of digits of a Bluetooth address, and of the identifier of macOS and iOS."""


INFO_CHANNEL = "insole/info"
"""Channel of the record that holds the site of a device."""


def reports_site(profile: Profile | None) -> bool:
    """Return whether a device of this profile can report where it is worn."""
    return profile is not None and INFO_CHANNEL in profile.reads


def check_configs(configs: Sequence[DeviceConfig]) -> None:
    """Raise ValueError without a config, or if two share a site or may mean one device, or insoles exceed free feet."""
    if not configs:
        raise ValueError("no device is requested")
    sites = [config.site for config in configs if config.site is not None]
    if len(set(sites)) < len(sites):
        raise ValueError("two devices cannot be at one site")
    free_feet = len({*SITE_OF_FOOT.values()} - {*sites})
    if len(configs) - len(sites) > free_feet:
        raise ValueError("more insoles are requested than there are feet for them")
    for earlier, config in combinations(configs, 2):
        same_profile = config.profile == earlier.profile and not reports_site(config.profile)
        if config.is_address(earlier.which) and (config.which or same_profile):
            raise ValueError(
                f"nothing distinguishes one {config.description} from the other: name them by their addresses"
            )


def advertises(profile: Profile, name: str, services: Sequence[str]) -> bool:
    """Return whether a device of this profile advertises this name or one of these service UUIDs."""
    return profile.matches_name(name) or not set(profile.services).isdisjoint([whole_uuid(one) for one in services])


def identify(name: str, services: Sequence[str], own: Iterable[Profile] = ()) -> Profile | None:
    """Return the profile of the device that sends this advertisement; None for an unknown device.

    Profiles of an app's `own` devices go before the built-in ones."""
    return next((profile for profile in (*own, *PROFILES) if advertises(profile, name, services)), None)
