"""Emulated devices on a bench, run without a server and without waiting."""

from __future__ import annotations

from functools import cache

from solepath.emulate.devices.attributes import AttError, Outgoing
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.device import Device
from solepath.emulate.wearers.walker import Walker
from solepath.link.profile import Access, Profile
from solepath.types import Site

ROUTE = Route().stand(2.0).walk(8.0, 1.2).stop(2.0)
LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
Received = list[tuple[float, Outgoing]]


def worn(device: Device, site: Site = LEFT, *, faults: str = "") -> Peripheral:
    """Return one device on a walk."""
    return Bench(ROUTE, devices={site: device}, seed=3, faults=parse_faults(faults))[site]


@cache
def walker() -> Walker:
    """Return the walker of these benches."""
    return Walker(ROUTE, seed=3)


def start(device: Peripheral, *channels: str, now: float = 0.0, mtu: int = 247) -> Peripheral:
    """Connect and subscribe."""
    device.connected(now, min(mtu, device.mtu))
    for channel in channels:
        device.subscribe(channel, True, now)
    return device


def set_up(device: Peripheral, profile: Profile, now: float = 0.0, mtu: int = 247) -> Peripheral:
    """Connect, subscribe and write by the profile."""
    start(device, *(c.name for c in profile.channels if c.access is Access.NOTIFY), now=now, mtu=mtu)
    for write in profile.setup:
        assert device.write(write.channel, write.value, now)
    return device


def played(device: Peripheral, until: float, channel: str = "") -> Received:
    """Return the notifications until `until`, s, with their times; only those of `channel` if it is given."""
    received: Received = []
    while (due := device.next_due()) is not None and due <= until:
        received += [(due, outgoing) for outgoing in device.poll(due)]
        if device.must_hang_up(due):
            device.disconnected(due)
    return [(t, outgoing) for t, outgoing in received if channel in ("", outgoing.channel)]


def error_code(device: Peripheral, channel: str, value: bytes | None = None, now: float = 0.0) -> int:
    """Return the ATT error code of a write (or, without a value, of a read); 0 when the device accepts it."""
    try:
        if value is None:
            device.read(channel, now)
        else:
            device.write(channel, value, now)
    except AttError as error:
        return error.code
    return 0
