"""The radio channel between a device and its receiver: loss, duplicates, bit errors and delay.

Bluetooth Low Energy keeps the order of notifications, and its link layer repeats a packet until it arrives. A bad
channel therefore shows as delay, and a late packet delays all packets behind it. Losses happen in higher layers: full
queues, lossy relays and dropped callbacks. `in_order=False` is for relays that do not keep the order."""

from __future__ import annotations

from math import ceil
from operator import attrgetter

import numpy as np
from attrs import field, frozen
from attrs.validators import and_, ge, le

from ..types import Packet, Site
from .sensors.device import Notification
from .wearers.curves import Rng

_SHARE = and_(ge(0.0), le(1.0))


@frozen
class Radio:
    """The settings of a radio channel; shares are from 0 to 1, times in s."""

    loss: float = field(default=0.0, validator=_SHARE)
    """Share of notifications that never arrive."""
    duplicate: float = field(default=0.0, validator=_SHARE)
    """Share of notifications that arrive twice."""
    corrupt: float = field(default=0.0, validator=_SHARE)
    """Share of notifications that arrive with up to three inverted bits."""
    truncate: float = field(default=0.0, validator=_SHARE)
    """Share of notifications that arrive cut short."""
    latency: float = 0.005
    """Least transmission time, s."""
    jitter: float = 0.004
    """Largest additional transmission time, s; uniformly distributed from 0."""
    interval: float = 0.0
    """Time between the connection events at which packets are sent, s; 0: packets do not wait for events."""
    in_order: bool = True
    """True when no packet overtakes another one."""

    def transmit(self, sent: list[Notification], site: Site, rng: Rng) -> list[Packet]:
        """Return the packets that arrive of `sent`, in the order of arrival; acknowledged values stay intact."""
        chances = rng.uniform(size=(len(sent), 6))
        phase = self.interval * float(rng.uniform())
        packets: list[Packet] = []
        last_arrival = -np.inf
        for notification, (loss, duplicate, corrupt, truncate, delay, second_delay) in zip(
            sent, chances.tolist(), strict=True
        ):
            if notification.acknowledged:
                last_arrival = max(last_arrival, notification.t)
                packets.append(Packet(notification.t, site, notification.channel, notification.data))
                continue
            if loss < self.loss:
                continue
            data = notification.data
            if corrupt < self.corrupt:
                data = _flip(data, rng)
            if truncate < self.truncate:
                data = data[: int(rng.integers(0, len(data)))]
            delays = (delay, second_delay) if duplicate < self.duplicate else (delay,)
            for share in delays:
                arrival = notification.t + self.latency + self.jitter * share
                if self.interval > 0.0:
                    arrival = phase + self.interval * ceil((arrival - phase) / self.interval)
                if self.in_order:
                    arrival = last_arrival = max(last_arrival, arrival)
                packets.append(Packet(float(arrival), site, notification.channel, data))
        return packets if self.in_order else sorted(packets, key=attrgetter("t"))


CLEAN = Radio()
"""A good channel: no loss, and transmission times from 5 to 9 ms."""


def _flip(data: bytes, rng: Rng) -> bytes:
    damaged = bytearray(data)
    for bit in rng.integers(0, 8 * len(data), size=int(rng.integers(1, 4))):
        damaged[int(bit) // 8] ^= 1 << (int(bit) % 8)
    return bytes(damaged)
