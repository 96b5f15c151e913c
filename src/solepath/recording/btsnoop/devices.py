"""Identification of the devices of a log, of their attributes' channels, and of their sites."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from attrs import define, field, frozen

from ...link.catalogue import DECLARED, PROFILES
from ...link.driver import Driver
from ...link.kinds import make_kinds
from ...link.profile import Access, Channel, Profile
from ...types import SITE_OF_FOOT, Foot, Site
from ...wire.error import WireError
from .att import AttOperation
from .evidence import ValueEvidence

Handles = Mapping[tuple[str, int], str]
"""Channel names that the caller gives, by device address ("" for any device) and attribute handle."""

ACCESS_BY_OPERATION = {
    AttOperation.NOTIFIED: (Access.NOTIFY, Access.READ),
    AttOperation.READ: (Access.READ, Access.NOTIFY, Access.WRITE),
    AttOperation.WRITTEN: (Access.WRITE,),
}
"""Accesses of a channel that an operation in the log may belong to, the most probable first.

A characteristic may be one channel when it is read and another when it is written. The value of a channel for
notification or writing may be read as well."""


@frozen
class KnownDevices:
    """The devices that are looked for in a log."""

    profiles: tuple[Profile, ...]
    """Their profiles; those of an app's own devices are before the built-in ones."""
    drivers: Mapping[str, Driver]
    """Drivers of those that are declared, by name."""

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels of all of them."""
        return tuple(channel for profile in self.profiles for channel in profile.channels)

    @property
    def channel_names(self) -> frozenset[str]:
        """Names of all channels."""
        return frozenset(channel.name for channel in self.channels)

    def characteristic_of(self, name: str) -> list[Channel]:
        """Return the channels of the characteristic to which the channel of this name belongs."""
        profile = next(profile for profile in self.profiles if name in profile.channel_by_name)
        return [
            channel for channel in profile.channels if channel.characteristic == profile.channel(name).characteristic
        ]

    def find_profile(self, uuids: set[str]) -> Profile | None:
        """Return the profile with the most channels in `uuids`, at least one of them a stream; the first of several."""
        best_profile, most_matches = None, 0
        for profile in self.profiles:
            matches = sum(channel.characteristic in uuids for channel in profile.channels)
            if matches > most_matches and any(
                profile.channel(name).characteristic in uuids for name in profile.streams
            ):
                best_profile, most_matches = profile, matches
        return best_profile


def known_devices(own: Iterable[Driver] = ()) -> KnownDevices:
    """Return the built-in devices and an app's own, which replace built-in ones of their names.

    TypeError and ValueError as `Session(profiles=...)` raises them."""
    drivers = {driver.name: driver for driver in make_kinds(own).drivers}
    built_in = [profile for profile in PROFILES if profile.name not in drivers]
    profiles = (*[driver.profile for driver in drivers.values()], *built_in)
    return KnownDevices(profiles, {driver.name: driver for driver in DECLARED} | drivers)


@define
class LoggedDevice:
    """One device of a log."""

    address: str
    """Address, or the name of the connection (HciConnection.peer)."""
    site: Site | None = None
    """Site of the device; None if unknown."""
    profile: Profile | None = None
    """Profile of the device; None if the log does not hold its discovery, or for an unknown device."""
    channels: dict[tuple[int, AttOperation], str] = field(factory=dict)
    """Channel names by attribute handle and operation."""
    evidence_by_handle: dict[int, ValueEvidence] = field(factory=dict)
    """Summary of the values of each attribute handle."""

    @property
    def count(self) -> int:
        """Number of notified values on known channels."""
        return sum(
            evidence.count
            for handle, evidence in self.evidence_by_handle.items()
            if (handle, AttOperation.NOTIFIED) in self.channels
        )


def name_attributes(
    device: LoggedDevice, known: KnownDevices, types: Mapping[int, str], handles: Handles
) -> set[tuple[str, int]]:
    """Set the device's profile and channels from `handles`, discovery and values, and return the used `handles`.

    An entry of `handles` is not used if it contradicts the device's profile or a discovered channel. An entry for any
    device is not used for an attribute that was discovered with another type."""
    device.profile = known.find_profile(set(types.values()))
    used_handles: set[tuple[str, int]] = set()
    for handle, evidence in device.evidence_by_handle.items():
        channel_name = None
        for hint in ((device.address.upper(), handle), ("", handle)):
            if hint in handles and _is_compatible(handles[hint], hint, device, known, types):
                channel_name = channel_name or handles[hint]
                used_handles.add(hint)
        if channel_name is None and handle not in types:
            channel_name = evidence.channel
        if channel_name is not None:
            channels = known.characteristic_of(channel_name)
        elif device.profile is not None:
            channels = [channel for channel in device.profile.channels if channel.characteristic == types.get(handle)]
        else:
            channels = []
        for operation in AttOperation:
            accesses = ACCESS_BY_OPERATION[operation]
            name = next((channel.name for access in accesses for channel in channels if channel.access is access), None)
            if name is not None:
                device.channels[handle, operation] = name
    return used_handles


def _is_compatible(
    channel_name: str, hint: tuple[str, int], device: LoggedDevice, known: KnownDevices, types: Mapping[int, str]
) -> bool:
    """Return whether the attribute's discovery, if any, allows that it is the channel of this name."""
    address, handle = hint
    if device.profile is not None and channel_name not in device.profile.channel_by_name:
        return False
    characteristics = {channel.characteristic for channel in known.characteristic_of(channel_name)}
    uuid = types.get(handle)
    known_uuids = {channel.characteristic for channel in known.channels}
    return uuid is None or uuid in characteristics or (address != "" and uuid not in known_uuids)


def explain_unused(
    hint: tuple[str, int], channel: str, devices: Mapping[str, LoggedDevice], types: Mapping[str, Mapping[int, str]]
) -> str:
    """Return one sentence on why an entry of `handles` is not used."""
    address, handle = hint
    logged_devices = [device for device in devices.values() if address in ("", device.address.upper())]
    if not logged_devices:
        return f"holds no device {address}, whose {handle:#06x} was said to be {channel}"
    devices_with_handle = [device for device in logged_devices if handle in device.evidence_by_handle]
    if not devices_with_handle:
        of = f" of {logged_devices[0].address}" if address else ""
        return f"holds no value of an attribute {handle:#06x}{of}, which was said to be {channel}"
    device = devices_with_handle[0]
    uuid = types.get(device.address, {}).get(handle)
    kind = f"is of {with_article(device.profile.name)}" if device.profile is not None else f"is {uuid}"
    channel_names = sorted({name for (number, _), name in device.channels.items() if number == handle})
    if uuid is not None and channel_names:
        kind = f"is {' and '.join(channel_names)}"
    return f"{handle:#06x} of {device.address} {kind}, as its discovery says, not {channel}"


def assign_site(device: LoggedDevice, known: KnownDevices, site_by_address: Mapping[str, Site]) -> None:
    """Set the device's site from `site_by_address`, else from the foot that the device reports."""
    device.site = site_by_address.get(device.address.upper())
    for (handle, operation), channel in device.channels.items():
        foot = _read_foot(channel, operation, device.evidence_by_handle[handle], known)
        if device.site is None and foot is not None:
            device.site = SITE_OF_FOOT[foot]


def _read_foot(channel: str, operation: AttOperation, evidence: ValueEvidence, known: KnownDevices) -> Foot | None:
    """Return the foot that a channel's values report; None if they report none."""
    if channel in ("insole/frame", "insole/info"):
        return evidence.foot
    driver = known.drivers.get(channel.partition("/")[0])
    if operation is not AttOperation.READ or driver is None or channel not in driver.readers or evidence.read is None:
        return None
    try:
        return driver.read(channel, evidence.read, {}).foot
    except WireError:
        return None


def with_article(noun: str) -> str:
    """Return the noun with its indefinite article."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
