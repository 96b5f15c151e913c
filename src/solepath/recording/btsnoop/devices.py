"""Identification of the devices of a log, of their attributes' channels, and of their sites."""

from __future__ import annotations

from collections.abc import Mapping

from attrs import define, field

from ...link.catalogue import DECLARED, PROFILES
from ...link.profile import Access as Use
from ...link.profile import Channel, Profile
from ...types import SITE_OF_FOOT, Foot, Site
from ...wire.error import WireError
from .att import AttOperation
from .evidence import ValueEvidence

Handles = Mapping[tuple[str, int], str]
"""Channel by device (or "" for any) and attribute handle."""

CHANNELS = frozenset(channel.name for profile in PROFILES for channel in profile.channels)
"""Names of all channels of built-in devices."""
CHARACTERISTICS = frozenset(channel.characteristic for profile in PROFILES for channel in profile.channels)
"""UUIDs of all characteristics of built-in devices."""
DRIVERS = {driver.name: driver for driver in DECLARED}
"""Declared devices by name."""
USES = {
    AttOperation.NOTIFIED: (Use.NOTIFY, Use.READ),
    AttOperation.READ: (Use.READ, Use.NOTIFY, Use.WRITE),
    AttOperation.WRITTEN: (Use.WRITE,),
}
"""Uses of a channel that fit an operation on its value, the likeliest first.

A characteristic may be one channel where it is read and another where it is written, and one that is subscribed or
written may be read as well."""


@define
class LoggedDevice:
    """One device of a log.

    `address`: or another name that identifies it. `profile`: None when its discovery is not in the log, or it is no
    known device. `channels`: channel by attribute handle and operation."""

    address: str
    site: Site | None = None
    profile: Profile | None = None
    channels: dict[tuple[int, AttOperation], str] = field(factory=dict)
    seen: dict[int, ValueEvidence] = field(factory=dict)
    """Evidence from the values, by attribute handle."""

    @property
    def count(self) -> int:
        """Number of notified values of channels."""
        return sum(
            evidence.count for handle, evidence in self.seen.items() if (handle, AttOperation.NOTIFIED) in self.channels
        )


def name_attributes(device: LoggedDevice, types: Mapping[int, str], handles: Handles) -> set[tuple[str, int]]:
    """Find the channels of the device's attributes: by `handles`, by discovery, by proof. Return the used `handles`.

    An entry for any device counts only where discovery has no type for the attribute, and no entry turns one device
    into another."""
    device.profile = _profile(set(types.values()))
    used: set[tuple[str, int]] = set()
    for handle, evidence in device.seen.items():
        channel_name = None
        for hint in ((device.address.upper(), handle), ("", handle)):
            if hint in handles and _is_compatible(handles[hint], hint, device, types):
                channel_name = channel_name or handles[hint]
                used.add(hint)
        if channel_name is None and handle not in types:
            channel_name = evidence.channel
        if channel_name is not None:
            same = _same_characteristic(channel_name)
        elif device.profile is not None:
            same = [each for each in device.profile.channels if each.characteristic == types.get(handle)]
        else:
            same = []
        for operation in AttOperation:
            channel = next((each.name for use in USES[operation] for each in same if each.access is use), None)
            if channel is not None:
                device.channels[handle, operation] = channel
    return used


def _is_compatible(channel: str, hint: tuple[str, int], device: LoggedDevice, types: Mapping[int, str]) -> bool:
    """Return whether discovery permits, or confirms, that the attribute is this channel."""
    address, handle = hint
    if device.profile is not None and channel not in device.profile.channel_names:
        return False
    same = {each.characteristic for each in _same_characteristic(channel)}
    uuid = types.get(handle)
    return uuid is None or uuid in same or (address != "" and uuid not in CHARACTERISTICS)


def explain_unused(
    hint: tuple[str, int], channel: str, devices: Mapping[str, LoggedDevice], types: Mapping[str, Mapping[int, str]]
) -> str:
    """Return the reason why an entry of `handles` cannot be used, in one sentence."""
    address, handle = hint
    there = [device for device in devices.values() if address in ("", device.address.upper())]
    if not there:
        return f"holds no device {address}, whose {handle:#06x} was said to be {channel}"
    with_it = [device for device in there if handle in device.seen]
    if not with_it:
        of = f" of {there[0].address}" if address else ""
        return f"holds no value of an attribute {handle:#06x}{of}, which was said to be {channel}"
    device = with_it[0]
    uuid = types.get(device.address, {}).get(handle)
    kind = f"is of {with_article(device.profile.name)}" if device.profile is not None else f"is {uuid}"
    found = sorted({name for (number, _), name in device.channels.items() if number == handle})
    if uuid is not None and found:
        kind = f"is {' and '.join(found)}"
    return f"{handle:#06x} of {device.address} {kind}, as its discovery says, not {channel}"


def _same_characteristic(name: str) -> list[Channel]:
    """Return the channels, of the device that has this one, that share its characteristic."""
    profile = next(profile for profile in PROFILES if name in profile.channel_names)
    return [each for each in profile.channels if each.characteristic == profile.channel(name).characteristic]


def _profile(uuids: set[str]) -> Profile | None:
    """Return the device that has most of these characteristics, and at least one stream; the first of equals."""
    best, most = None, 0
    for profile in PROFILES:
        matches = sum(channel.characteristic in uuids for channel in profile.channels)
        if matches > most and any(profile.channel(name).characteristic in uuids for name in profile.streams):
            best, most = profile, matches
    return best


def assign_site(device: LoggedDevice, places: Mapping[str, Site]) -> None:
    """Set the device's site: the caller's, else that of the foot that the device reports."""
    device.site = places.get(device.address.upper())
    for (handle, operation), channel in device.channels.items():
        foot = _foot(channel, operation, device.seen[handle])
        if device.site is None and foot is not None:
            device.site = SITE_OF_FOOT[foot]


def _foot(channel: str, operation: AttOperation, evidence: ValueEvidence) -> Foot | None:
    """Return the foot of the insole, where a channel's values report it."""
    if channel in ("insole/frame", "insole/info"):
        return evidence.foot
    driver = DRIVERS.get(channel.partition("/")[0])
    if operation is not AttOperation.READ or driver is None or channel not in driver.readers or evidence.read is None:
        return None
    try:
        return driver.read(channel, evidence.read, {}).foot
    except WireError:
        return None


def with_article(noun: str) -> str:
    """Return the noun with its indefinite article."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
