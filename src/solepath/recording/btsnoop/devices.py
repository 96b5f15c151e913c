"""Identification of the devices of a log, of their attributes' channels, and of their sites."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cached_property

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


@frozen(slots=False)
class KnownDevices:
    """The devices that are looked for in a log."""

    profiles: tuple[Profile, ...]
    """Their profiles; those of an app's own devices are before the built-in ones."""
    drivers: Mapping[str, Driver]
    """Drivers of those that are declared, by name."""

    @cached_property
    def channels(self) -> dict[str, list[Channel]]:
        """All channels of the characteristic to which each channel belongs, by its name."""
        return {
            channel.name: [one for one in profile.channels if one.characteristic == channel.characteristic]
            for profile in reversed(self.profiles)
            for channel in profile.channels
        }

    @property
    def channel_names(self) -> frozenset[str]:
        """Names of all channels."""
        return frozenset(self.channels)

    def find_profile(self, uuids: set[str]) -> Profile | None:
        """Return the profile with the most channels in `uuids`, at least one of them a stream; the first of several."""

        def count(profile: Profile) -> int:
            return sum(channel.characteristic in uuids for channel in profile.channels)  # whole numbers

        found = [p for p in self.profiles if any(p.channel(name).characteristic in uuids for name in p.streams)]
        return max(found, key=count, default=None)


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
    types: Mapping[int, str] = field(factory=dict)
    """Discovered UUIDs by attribute handle."""
    channels: dict[tuple[int, AttOperation], str] = field(factory=dict)
    """Channel names by attribute handle and operation."""
    evidence_by_handle: dict[int, ValueEvidence] = field(factory=dict)
    """Summary of the values of each attribute handle."""

    @property
    def count(self) -> int:
        """Number of notified values on known channels."""
        notified = [handle for handle, operation in self.channels if operation is AttOperation.NOTIFIED]
        return sum([self.evidence_by_handle[handle].count for handle in notified])

    @property
    def noun(self) -> str:
        """Kind of the device, with its indefinite article."""
        name = "device" if self.profile is None else self.profile.name
        return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


def name_attributes(device: LoggedDevice, known: KnownDevices, handles: Handles) -> set[tuple[str, int]]:
    """Set the device's profile and channels from `handles`, discovery and values, and return the used `handles`.

    An entry of `handles` is not used if it contradicts the device's profile or a discovered channel. An entry for any
    device is not used for an attribute that was discovered with another type."""
    device.profile = known.find_profile(set(device.types.values()))
    used: set[tuple[str, int]] = set()
    for handle, evidence in device.evidence_by_handle.items():
        hints = [hint for hint in ((device.address.upper(), handle), ("", handle)) if hint in handles]
        fitting = [hint for hint in hints if _is_compatible(handles[hint], hint, device, known)]
        used.update(fitting)
        named = handles[fitting[0]] if fitting else evidence.channel if handle not in device.types else None
        if named is not None:
            channels = known.channels[named]
        else:
            uuid, own = device.types.get(handle), () if device.profile is None else device.profile.channels
            channels = [channel for channel in own if channel.characteristic == uuid]
        for operation, accesses in ACCESS_BY_OPERATION.items():
            names = [channel.name for access in accesses for channel in channels if channel.access is access]
            if names:
                device.channels[handle, operation] = names[0]
    return used


def _is_compatible(channel: str, hint: tuple[str, int], device: LoggedDevice, known: KnownDevices) -> bool:
    """Return whether the attribute's discovery, if any, allows that it is the channel of this name."""
    address, handle = hint
    if device.profile is not None and channel not in device.profile.channel_by_name:
        return False
    uuid = device.types.get(handle)
    if uuid is None or uuid == known.channels[channel][0].characteristic:
        return True
    return address != "" and all(uuid != channels[0].characteristic for channels in known.channels.values())


def explain_unused(hint: tuple[str, int], channel: str, devices: Mapping[str, LoggedDevice]) -> str:
    """Return one sentence on why an entry of `handles` is not used."""
    address, handle = hint
    logged = [device for device in devices.values() if address in ("", device.address.upper())]
    if not logged:
        return f"holds no device {address}, whose {handle:#06x} was said to be {channel}"
    device = next((device for device in logged if handle in device.evidence_by_handle), None)
    if device is None:
        of = f" of {logged[0].address}" if address else ""
        return f"holds no value of an attribute {handle:#06x}{of}, which was said to be {channel}"
    names = sorted({name for (number, _), name in device.channels.items() if number == handle})
    kind = f"is {device.types.get(handle)}" if device.profile is None else f"is of {device.noun}"
    if handle in device.types and names:
        kind = f"is {' and '.join(names)}"
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
    if operation is AttOperation.READ and driver and channel in driver.readers and evidence.read is not None:
        with suppress(WireError):
            return driver.read(channel, evidence.read, {}).foot
    return None
