"""The profile of a device: the GATT ids, channels, setup writes and rates that a receiver needs to connect to it.

Each module of devices/ has the profile of its device, as a document in protocol/ describes it. To start a device, read
the channels of `reads`, make the writes of `setup` that are needed before, subscribe to every `notify` channel, then
make the other writes in order. After each write read the channels of its `then_read`. The order matters: some systems
deliver a value twice when a characteristic is read while it is subscribed, and a device that is started before the
subscription sends its first values to nobody. Values read and written are recorded as packets of the same channels, so
that a decoder knows the ranges and periods that are set."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from functools import cached_property
from math import inf

from ..types.attrs import field, frozen

BASE_UUID = "-0000-1000-8000-00805f9b34fb"
"""End of every UUID that Bluetooth itself assigns (Bluetooth Core, vol 3 part B, 2.5.1)."""


def whole_uuid(uuid: str) -> str:
    """Return a UUID with all its digits in lower case; a short one is one of Bluetooth's own."""
    digits = uuid.lower()
    return f"{digits:0>8}{BASE_UUID}" if len(digits) in (4, 8) else digits


def _whole_uuids(uuids: Iterable[str]) -> tuple[str, ...]:
    return tuple([whole_uuid(uuid) for uuid in uuids])


class Access(Enum):
    """The operation by which a host uses a characteristic."""

    NOTIFY = "notify"
    READ = "read"
    WRITE = "write"


@frozen
class Channel:
    """One characteristic and the channel name of its packets; UUIDs may be short, and in any case."""

    name: str
    service: str = field(converter=whole_uuid)
    characteristic: str = field(converter=whole_uuid)
    access: Access


@frozen
class Write:
    """One value to be written, after all subscriptions, and the channels to be read directly after it."""

    channel: str
    value: bytes
    then_read: tuple[str, ...] = ()
    before_subscribing: bool = False
    """True for a value without which the device rejects a subscription, such as a key or a mode. A value that starts
    the stream stays behind the subscriptions."""


@frozen
class Profile:
    """The profile of one kind of device.

    ValueError when its fields contradict each other."""

    name: str
    """Prefix of the names of its channels."""
    names: tuple[str, ...]
    """Complete names that it may advertise."""
    services: tuple[str, ...] = field(converter=_whole_uuids)
    """UUIDs of the services that it advertises."""
    channels: tuple[Channel, ...]
    """Channels of the device."""
    nominal_rate: float
    """Samples a second after `setup`, Hz."""
    streams: tuple[str, ...]
    """Channels that must not fall silent."""
    stale_after: float
    """Time after which a stream counts as silent, s."""
    setup: tuple[Write, ...] = ()
    """Writes that start the device, in order; they follow the subscriptions, except those `before_subscribing`."""
    reads: tuple[str, ...] = ()
    """Channels to be read once after connecting, if the device has them."""
    prefixes: tuple[str, ...] = ()
    """Starts of names that it may advertise."""

    @cached_property
    def channel_by_name(self) -> dict[str, Channel]:
        """All channels by their names."""
        return {channel.name: channel for channel in self.channels}

    def __attrs_post_init__(self) -> None:
        if not self.name or "/" in self.name:
            raise ValueError(f"a profile's name is what stands before the first '/' of its channels, not {self.name!r}")
        used_names = {*self.streams, *self.reads}.union(*[(write.channel, *write.then_read) for write in self.setup])
        foreign_names = used_names - self.channel_by_name.keys()
        notified = {channel.name for channel in self.channels if channel.access is Access.NOTIFY}
        is_finite = 0.0 < self.nominal_rate < inf and 0.0 < self.stale_after < inf
        for is_wrong, what in (
            (len(self.channel_by_name) != len(self.channels), "two channels have one name"),
            (foreign_names, f"no channel of its own: {sorted(foreign_names)}"),
            ({*self.streams} - notified, f"a stream is notified, and {sorted({*self.streams} - notified)} are not"),
            (not is_finite, "nominal_rate and stale_after are finite and above 0"),
        ):
            if is_wrong:
                raise ValueError(f"{self.name}: {what}")

    def matches_name(self, name: str) -> bool:
        """Return whether a device of this kind may advertise this name."""
        return name in self.names or (name != "" and name.startswith(self.prefixes))

    def channel(self, name: str) -> Channel:
        """Return the channel of this name; KeyError when there is none."""
        return self.channel_by_name[name]


def ti_uuid(short: int) -> str:
    """Return the complete UUID of a 16-bit id of Texas Instruments."""
    return f"f000{short:04x}-0451-4000-b000-000000000000"


def ti_sensor(device: str, name: str, service: int, period: int = 3) -> tuple[Channel, ...]:
    """Return the channels of a sensor of a TI tag: its values, and its configuration and its period, which are written.

    The short ids follow that of the service: 1 for the values, 2 for the configuration, `period` for the period."""
    uses = (("", 1, Access.NOTIFY), ("-config", 2, Access.WRITE), ("-period", period, Access.WRITE))
    ids = [(f"{device}/{name}{suffix}", service + short, access) for suffix, short, access in uses]
    return tuple([Channel(full_name, ti_uuid(service), ti_uuid(short), access) for full_name, short, access in ids])


def standard_uuid(short: int) -> str:
    """Return the complete UUID of a 16-bit id that the Bluetooth SIG has assigned."""
    return f"{short:08x}{BASE_UUID}"


FIRMWARE = Channel("device/firmware", standard_uuid(0x180A), standard_uuid(0x2A26), Access.READ)
"""Channel of the firmware revision, which any device may have."""
BATTERY = Channel("device/battery", standard_uuid(0x180F), standard_uuid(0x2A19), Access.NOTIFY)
"""Channel of the battery level, which any device may have."""
