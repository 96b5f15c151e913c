"""The devices of a log: identification of what they are, of the channels of their attributes, and of their sites."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from enum import Enum
from functools import cached_property

from attrs import define, field, frozen

from ...link.catalogue import DECLARED, PROFILES
from ...link.driver import Driver
from ...link.kinds import make_kinds
from ...link.profile import Access, Channel, Profile
from ...types import SITE_OF_FOOT, Foot, Site
from ...wire.error import WireError
from ...wire.fragment import Reassembly, is_fragment, parse_fragment
from ...wire.insole import parse_frame
from ...wire.insole_info import parse_info

Handles = Mapping[tuple[str, int], str]
"""Channel names that the caller gives, by device address ("" for any device) and attribute handle."""

MAX_EXAMINED_VALUES = 300
"""Largest number of values of one attribute that are examined; a frame has at most 16 fragments."""
MIN_PROVING_FRAMES = 2
"""Smallest number of frames with a correct CRC that proves an insole.

Of 2^16 arbitrary values that start with the magic, about one has a correct CRC by chance."""
MOST_ATTRIBUTES = 500
"""Largest number of attributes of a device that are kept; chosen by hand, ten times those of a SensorTag."""
INSOLE_CHANNELS = {"insole/frame", "insole/info"}
"""Channels whose values report the foot of an insole."""


class AttOperation(Enum):
    """Operation that transferred a value of an attribute."""

    NOTIFIED = "notified"
    READ = "read"
    WRITTEN = "written"


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
class LoggedAttribute:
    """One attribute of a device, with a summary of its values.

    These may show that the device is an insole, when the log does not hold its discovery: only an insole's values prove
    what they are, because its frames and its INFO have a magic and a CRC."""

    uuid: str = ""
    """Type of the attribute; "" if it was not discovered."""
    has_values: bool = False
    """Flag: a value was notified, read or written."""
    count: int = 0
    """Number of values that were notified."""
    lengths: set[int] = field(factory=set)
    """Lengths of the values examined, bytes."""
    frame_count: int = 0
    """Number of values that are a correct insole frame, or whose fragment completes one."""
    foot: Foot | None = None
    """Foot that the insole reported; None without an insole."""
    is_info: bool = False
    """True if a value was an INFO record."""
    read: bytes | None = None
    """Newest value that was read, not notified."""
    channels: dict[AttOperation, str] = field(factory=dict)
    """Names of the channels of the operations."""
    _reassembly: Reassembly = field(factory=Reassembly)

    def add_value(self, operation: AttOperation, data: bytes) -> None:
        """Add a value and examine it."""
        self.has_values = True
        if operation is AttOperation.READ:
            self.read = data
            with suppress(WireError):
                self.foot = parse_info(data).foot
                self.is_info = True
        elif operation is AttOperation.NOTIFIED:
            self.count += 1
            if self.count <= MAX_EXAMINED_VALUES:
                self.lengths.add(len(data))
                with suppress(WireError):
                    frame = self._reassembly.feed(parse_fragment(data))[0] if is_fragment(data) else data
                    if frame is not None:
                        self.foot = parse_frame(frame).foot
                        self.frame_count += 1

    @property
    def proven_channel(self) -> str | None:
        """Name of the attribute's channel; None if the values do not prove it."""
        if self.is_info:
            return "insole/info"
        return "insole/frame" if self.frame_count >= MIN_PROVING_FRAMES else None

    def read_foot(self, known: KnownDevices) -> Foot | None:
        """Return the foot that the values report; None if they report none."""
        channel = self.channels.get(AttOperation.READ, "")
        driver = known.drivers.get(channel.partition("/")[0])
        if driver is not None and channel in driver.readers and self.read is not None:
            with suppress(WireError):
                return driver.read(channel, self.read, {}).foot
        return self.foot if INSOLE_CHANNELS & {*self.channels.values()} else None


@define
class LoggedDevice:
    """One device of a log."""

    address: str
    """Address, or the name of the connection (HciConnection.peer)."""
    site: Site | None = None
    """Site of the device; None if unknown."""
    profile: Profile | None = None
    """Profile of the device; None if the log does not hold its discovery, or for an unknown device."""
    attributes: dict[int, LoggedAttribute] = field(factory=dict)
    """Attributes by handle that were discovered or have values."""

    def attribute(self, handle: int, flaws: Counter[str]) -> LoggedAttribute:
        """Return an attribute; one beyond MOST_ATTRIBUTES is not kept, and counted among the flaws."""
        if handle not in self.attributes and len(self.attributes) >= MOST_ATTRIBUTES:
            flaws[f"what is known of more than {MOST_ATTRIBUTES} attributes of a device, left out"] += 1
            return LoggedAttribute()
        return self.attributes.setdefault(handle, LoggedAttribute())

    @property
    def count(self) -> int:
        """Number of notified values on known channels."""
        return sum([one.count for one in self.attributes.values() if AttOperation.NOTIFIED in one.channels])

    @property
    def noun(self) -> str:
        """Kind of the device, with its indefinite article."""
        name = "device" if self.profile is None else self.profile.name
        return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"

    def identify(self, known: KnownDevices, handles: Handles) -> Iterator[tuple[str, int]]:
        """Set profile, channels and site from `handles`, discovery and values, and yield the entries of `handles` used.

        An entry is for an attribute that was not discovered; one that says what the discovery says counts as used."""
        self.profile = known.find_profile({one.uuid for one in self.attributes.values()})
        own = () if self.profile is None else self.profile.channels
        for handle, one in self.attributes.items():
            hints = [(address, handle) for address in (self.address.upper(), "") if (address, handle) in handles]
            named = "" if one.uuid else handles[hints[0]] if hints else one.proven_channel
            channels = known.channels[named] if named else [each for each in own if each.characteristic == one.uuid]
            for operation, accesses in ACCESS_BY_OPERATION.items():
                if names := [each.name for access in accesses for each in channels if each.access is access]:
                    one.channels[operation] = names[0]
            found = {named, *one.channels.values()}
            yield from [hint for hint in hints if one.has_values and handles[hint] in found]
            foot = one.read_foot(known)
            if self.site is None and foot is not None:
                self.site = SITE_OF_FOOT[foot]


def explain_unused(hint: tuple[str, int], channel: str, devices: Iterable[LoggedDevice]) -> str:
    """Return one sentence on why an entry of `handles` is not used."""
    address, handle = hint
    for device in devices:
        attribute = device.attributes.get(handle)
        if address in ("", device.address.upper()) and attribute is not None and attribute.has_values:
            kind = attribute.uuid if device.profile is None else f"of {device.noun}"
            kind = " and ".join(sorted({*attribute.channels.values()})) or kind
            return f"{handle:#06x} of {device.address} is {kind}, as its discovery says, not {channel}"
    of = f" of {address}" if address else ""
    return f"holds no value of an attribute {handle:#06x}{of}, which was said to be {channel}"
