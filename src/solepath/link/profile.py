"""What there is to know about each device before it is connected: GATT ids, channels, setup writes, rates. Only data.

The ids and values are those of protocol/insole.md, protocol/cc2650.md and protocol/cc2541.md. To start a device: read
`reads`, subscribe to every `notify` channel that is wanted, then make the writes of `setup` in order, each followed by
its own reads. In this order, because a characteristic that is read while it is subscribed gives its value twice on
some systems. What was read and written is recorded as packets of the same channels, so that a decoder (and a
recording) knows the ranges and periods in force.
"""

from __future__ import annotations

from enum import Enum
from math import inf

from attrs import field, frozen


class Access(Enum):
    """What a host does with a characteristic."""

    NOTIFY = "notify"
    READ = "read"
    WRITE = "write"


@frozen
class Channel:
    """One characteristic and the name that its packets carry. UUIDs in full, lower case."""

    name: str
    service: str
    characteristic: str
    how: Access


@frozen
class Write:
    """One value to be written; `then_read` names channels to be read right after it."""

    channel: str
    value: bytes
    then_read: tuple[str, ...] = ()


@frozen
class Profile:
    """One kind of device.

    `names`, `services`: what its advertisement may say (complete names; service UUIDs); `prefixes`: what its name may
    begin with instead. `setup`: writes in order.
    `reads`: channels to be read once after connecting, where the device has them. `nominal_rate`: samples a second
    after `setup`. `streams`: the channels that must not fall silent, and `stale_after`: s after which they have.
    ValueError when these do not fit together.
    """

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
    _names: frozenset[str] = field(init=False, repr=False, eq=False)

    def __attrs_post_init__(self) -> None:
        object.__setattr__(self, "_names", frozenset(channel.name for channel in self.channels))
        if not self.name or "/" in self.name:
            raise ValueError(f"a profile's name is what stands before the first '/' of its channels, not {self.name!r}")
        if len(self._names) != len(self.channels):
            raise ValueError(f"{self.name}: two channels have one name")
        named = {*self.streams, *self.reads}.union(*[(write.channel, *write.then_read) for write in self.setup])
        if named - self._names:
            raise ValueError(f"{self.name}: no channel of its own: {sorted(named - self._names)}")
        silent = [name for name in self.streams if self.channel(name).how is not Access.NOTIFY]
        if silent:
            raise ValueError(f"{self.name}: a stream is notified, and {silent} are not")
        if not (0.0 < self.nominal_rate < inf and 0.0 < self.stale_after < inf):
            raise ValueError(f"{self.name}: nominal_rate and stale_after are finite and above 0")

    def has(self, name: str) -> bool:
        """Whether there is a channel of this name."""
        return name in self._names

    def answers_to(self, name: str) -> bool:
        """Whether a device of this kind may advertise this name."""
        return name in self.names or (name != "" and name.startswith(self.prefixes))

    def channel(self, name: str) -> Channel:
        """The channel of this name. KeyError when there is none."""
        for channel in self.channels:
            if channel.name == name:
                return channel
        raise KeyError(name)


def _insole(short: int) -> str:
    return f"6016{short:04x}-c8fb-4908-9b03-31fbe15925c4"


def _ti(short: int) -> str:
    return f"f000{short:04x}-0451-4000-b000-000000000000"


def standard(short: int) -> str:
    """A UUID that the Bluetooth SIG has assigned."""
    return f"0000{short:04x}-0000-1000-8000-00805f9b34fb"


FIRMWARE = Channel("device/firmware", standard(0x180A), standard(0x2A26), Access.READ)
BATTERY = Channel("device/battery", standard(0x180F), standard(0x2A19), Access.NOTIFY)
"""What any device may have."""

INSOLE = Profile(
    name="insole",
    names=(),
    services=(_insole(1),),
    channels=(
        Channel("insole/frame", _insole(1), _insole(2), Access.NOTIFY),
        Channel("insole/info", _insole(1), _insole(3), Access.READ),
        Channel("insole/control", _insole(1), _insole(4), Access.WRITE),
        BATTERY,
        FIRMWARE,
    ),
    setup=(Write("insole/control", b"\x01"),),
    reads=("insole/info", "device/firmware", "device/battery"),
    nominal_rate=100.0,
    streams=("insole/frame",),
    stale_after=1.0,
)

CC2650 = Profile(
    name="cc2650",
    names=("CC2650 SensorTag", "SensorTag 2.0"),
    services=(standard(0xAA80),),
    channels=(
        Channel("cc2650/movement", _ti(0xAA80), _ti(0xAA81), Access.NOTIFY),
        Channel("cc2650/movement-config", _ti(0xAA80), _ti(0xAA82), Access.WRITE),
        Channel("cc2650/movement-period", _ti(0xAA80), _ti(0xAA83), Access.WRITE),
        Channel("cc2650/barometer", _ti(0xAA40), _ti(0xAA41), Access.NOTIFY),
        Channel("cc2650/barometer-config", _ti(0xAA40), _ti(0xAA42), Access.WRITE),
        Channel("cc2650/barometer-period", _ti(0xAA40), _ti(0xAA44), Access.WRITE),
        Channel("cc2650/keys", standard(0xFFE0), standard(0xFFE1), Access.NOTIFY),
        BATTERY,
        FIRMWARE,
    ),
    setup=(
        Write("cc2650/movement-period", b"\x0a"),
        Write("cc2650/movement-config", b"\x7f\x02"),  # all axes, 8 g
        Write("cc2650/barometer-period", b"\x64"),
        Write("cc2650/barometer-config", b"\x01"),
    ),
    reads=("device/firmware", "device/battery"),
    nominal_rate=10.0,
    streams=("cc2650/movement",),
    stale_after=2.0,
)


def _cc2541(name: str, period: bytes, nominal_rate: float) -> Profile:
    return Profile(
        name=name,
        names=("SensorTag", "TI BLE Sensor Tag"),
        services=(),
        channels=(
            Channel("cc2541/accelerometer", _ti(0xAA10), _ti(0xAA11), Access.NOTIFY),
            Channel("cc2541/accelerometer-config", _ti(0xAA10), _ti(0xAA12), Access.WRITE),
            Channel("cc2541/accelerometer-period", _ti(0xAA10), _ti(0xAA13), Access.WRITE),
            Channel("cc2541/magnetometer", _ti(0xAA30), _ti(0xAA31), Access.NOTIFY),
            Channel("cc2541/magnetometer-config", _ti(0xAA30), _ti(0xAA32), Access.WRITE),
            Channel("cc2541/magnetometer-period", _ti(0xAA30), _ti(0xAA33), Access.WRITE),
            Channel("cc2541/barometer", _ti(0xAA40), _ti(0xAA41), Access.NOTIFY),
            Channel("cc2541/barometer-config", _ti(0xAA40), _ti(0xAA42), Access.WRITE),
            Channel("cc2541/barometer-calibration", _ti(0xAA40), _ti(0xAA43), Access.READ),
            Channel("cc2541/barometer-period", _ti(0xAA40), _ti(0xAA44), Access.WRITE),
            Channel("cc2541/gyroscope", _ti(0xAA50), _ti(0xAA51), Access.NOTIFY),
            Channel("cc2541/gyroscope-config", _ti(0xAA50), _ti(0xAA52), Access.WRITE),
            Channel("cc2541/gyroscope-period", _ti(0xAA50), _ti(0xAA53), Access.WRITE),
            Channel("cc2541/keys", standard(0xFFE0), standard(0xFFE1), Access.NOTIFY),
            FIRMWARE,
        ),
        setup=(
            Write("cc2541/accelerometer-period", period),
            Write("cc2541/accelerometer-config", b"\x03"),  # 8 g: the one value on which drivers agree most
            Write("cc2541/gyroscope-period", period),
            Write("cc2541/gyroscope-config", b"\x07"),
            Write("cc2541/magnetometer-period", b"\x64"),
            Write("cc2541/magnetometer-config", b"\x01"),
            Write("cc2541/barometer-period", b"\x64"),
            Write("cc2541/barometer-config", b"\x02", then_read=("cc2541/barometer-calibration",)),
            Write("cc2541/barometer-config", b"\x01"),
        ),
        reads=("device/firmware",),
        nominal_rate=nominal_rate,
        streams=("cc2541/accelerometer", "cc2541/gyroscope"),
        stale_after=2.0,
    )


CC2541 = _cc2541("cc2541", b"\x0a", 10.0)
CC2541_20HZ = _cc2541("cc2541-20hz", b"\x05", 20.0)
"""Firmware rebuilt with a lower minimum period; from its advertisement it cannot be told from the stock one."""

PROFILES = (INSOLE, CC2650, CC2541, CC2541_20HZ)
BY_NAME = {profile.name: profile for profile in PROFILES}
