"""The radio channel between a device and its receiver: loss, duplicates, bit errors and delay.

Bluetooth Low Energy keeps the order of notifications, and its link layer repeats lost packets. A bad channel therefore
shows as delay: a late packet holds up all packets behind it. Loss happens in higher layers: full queues, lossy relays,
dropped callbacks. Packets do not change their order on one Bluetooth link; `in_order=False` is for other relays."""

from __future__ import annotations

from math import ceil
from operator import attrgetter

import numpy as np
from attrs import field, frozen

from ..types import Packet, Site
from .sensors.device import Notification
from .wearers.curves import Rng


def _share(_: object, attribute: object, value: float) -> None:
    if not 0.0 <= value <= 1.0:
        raise ValueError(f"a share must be between 0 and 1, got {value}")


@frozen
class Radio:
    """Settings of a radio channel: shares of notifications from 0 to 1, and times in s."""

    loss: float = field(default=0.0, validator=_share)
    """Share of notifications that never arrive."""
    duplicate: float = field(default=0.0, validator=_share)
    """Share of notifications that arrive twice."""
    corrupt: float = field(default=0.0, validator=_share)
    """Share of notifications that arrive with one to three inverted bits."""
    truncate: float = field(default=0.0, validator=_share)
    """Share of notifications that arrive cut short."""
    latency: float = 0.005
    """Least transmission time, s."""
    jitter: float = 0.004
    """Largest additional transmission time, s; uniformly distributed from 0."""
    interval: float = 0.0
    """Time between connection events, s: packets wait for the next event. 0: packets do not wait."""
    in_order: bool = True
    """No packet overtakes another one."""

    def transmit(self, sent: list[Notification], site: Site, rng: Rng) -> list[Packet]:
        """Return the packets that arrive when a device sends `sent`, sorted by time of arrival."""
        chances = rng.uniform(size=(len(sent), 6))
        phase = self.interval * float(rng.uniform())
        found: list[Packet] = []
        newest = -np.inf
        for item, (lost, twice, damaged, cut, delay, again) in zip(sent, chances.tolist(), strict=True):
            if item.acknowledged:
                newest = max(newest, item.t)
                found.append(Packet(item.t, site, item.channel, item.data))
                continue
            if lost < self.loss:
                continue
            data = item.data
            if damaged < self.corrupt:
                data = _flip(data, rng)
            if cut < self.truncate:
                data = data[: int(rng.integers(0, len(data)))]
            copies = (delay, again) if twice < self.duplicate else (delay,)
            for part in copies:
                arrival = item.t + self.latency + self.jitter * part
                if self.interval > 0.0:
                    arrival = phase + self.interval * ceil((arrival - phase) / self.interval)
                if self.in_order:
                    arrival = newest = max(newest, arrival)
                found.append(Packet(float(arrival), site, item.channel, data))
        return found if self.in_order else sorted(found, key=attrgetter("t"))


CLEAN = Radio()
"""A good link: no loss, latency from 5 to 9 ms."""


def _flip(data: bytes, rng: Rng) -> bytes:
    damaged = bytearray(data)
    for bit in rng.integers(0, 8 * len(data), size=int(rng.integers(1, 4))):
        damaged[int(bit) // 8] ^= 1 << (int(bit) % 8)
    return bytes(damaged)
