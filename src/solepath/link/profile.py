"""Declaration of a device before it is connected: GATT ids, channels, setup writes, rates. Only data.

Each file of devices/ has the profile of its device, as its document in protocol/ describes it. To start a device: read
`reads`, subscribe to every required `notify` channel, then make the writes of `setup` in order, each followed by its
own reads. The order matters, because a characteristic that is read while it is subscribed gives its value twice on some
systems. Values read and written are recorded as packets of the same channels, so that a decoder (and a recording) knows
the ranges and periods in force."""

from __future__ import annotations

from enum import Enum
from functools import cached_property
from math import inf

from ..types.attrs import frozen


class Access(Enum):
    """The way in which a host uses a characteristic."""

    NOTIFY = "notify"
    READ = "read"
    WRITE = "write"


@frozen
class Channel:
    """One characteristic and the channel name of its packets. UUIDs in full, lower case."""

    name: str
    service: str
    characteristic: str
    access: Access


@frozen
class Write:
    """One value to be written; `then_read` names channels to be read right after it."""

    channel: str
    value: bytes
    then_read: tuple[str, ...] = ()


@frozen
class Profile:
    """One kind of device.

    `names`, `services`: values of its advertisement (complete names; service UUIDs); `prefixes`: possible starts of its
    name instead. `setup`: writes in order. `reads`: channels to be read once after connecting, where the device has
    them. `nominal_rate`: samples a second after `setup`. `streams`: the channels that must not fall silent, and
    `stale_after`: s after which one counts as silent. ValueError when these do not fit together."""

    name: str
    names: tuple[str, ...]
    services: tuple[str, ...]
    channels: tuple[Channel, ...]
    setup: tuple[Write, ...]
    reads: tuple[str, ...]
    nominal_rate: float
    streams: tuple[str, ...]
    stale_after: float
    prefixes: tuple[str, ...] = ()

    @cached_property
    def channel_names(self) -> frozenset[str]:
        """Names of all its channels."""
        return frozenset(channel.name for channel in self.channels)

    def __attrs_post_init__(self) -> None:
        if not self.name or "/" in self.name:
            raise ValueError(f"a profile's name is what stands before the first '/' of its channels, not {self.name!r}")
        if len(self.channel_names) != len(self.channels):
            raise ValueError(f"{self.name}: two channels have one name")
        named = {*self.streams, *self.reads}.union(*[(write.channel, *write.then_read) for write in self.setup])
        if named - self.channel_names:
            raise ValueError(f"{self.name}: no channel of its own: {sorted(named - self.channel_names)}")
        silent = [name for name in self.streams if self.channel(name).access is not Access.NOTIFY]
        if silent:
            raise ValueError(f"{self.name}: a stream is notified, and {silent} are not")
        if not (0.0 < self.nominal_rate < inf and 0.0 < self.stale_after < inf):
            raise ValueError(f"{self.name}: nominal_rate and stale_after are finite and above 0")

    def matches_name(self, name: str) -> bool:
        """Return whether a device of this kind may advertise this name."""
        return name in self.names or (name != "" and name.startswith(self.prefixes))

    def channel(self, name: str) -> Channel:
        """Return the channel of this name. KeyError when there is none."""
        for channel in self.channels:
            if channel.name == name:
                return channel
        raise KeyError(name)


def ti_uuid(short: int) -> str:
    """Return the full UUID of a 16-bit id of Texas Instruments."""
    return f"f000{short:04x}-0451-4000-b000-000000000000"


def standard_uuid(short: int) -> str:
    """Return the full UUID of a 16-bit id that the Bluetooth SIG has assigned."""
    return f"0000{short:04x}-0000-1000-8000-00805f9b34fb"


FIRMWARE = Channel("device/firmware", standard_uuid(0x180A), standard_uuid(0x2A26), Access.READ)
"""Channel of the firmware revision, which any device may have."""
BATTERY = Channel("device/battery", standard_uuid(0x180F), standard_uuid(0x2A19), Access.NOTIFY)
"""Channel of the battery level, which any device may have."""
