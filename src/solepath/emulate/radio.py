"""The air between a device and its receiver: loss, duplicates, damage, delay.

Bluetooth Low Energy keeps the order of notifications and repeats what the link layer loses, so there a bad channel
shows as delay: what is late holds up everything behind it. Loss happens above that: full queues, lossy relays, dropped
callbacks. Reordering does not happen on one Bluetooth link; it is here for what is relayed otherwise.
"""

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
    """Shares of notifications, and times in s.

    `loss`: never arrive. `duplicate`: arrive twice. `corrupt`: arrive with one to three bits turned. `truncate`: arrive
    cut short. `latency`: least time on the way. `jitter`: up to so much more, evenly spread. `interval`: of connection
    events; what is ready waits for the next one (0: none). `in_order`: nothing overtakes.
    """

    loss: float = field(default=0.0, validator=_share)
    duplicate: float = field(default=0.0, validator=_share)
    corrupt: float = field(default=0.0, validator=_share)
    truncate: float = field(default=0.0, validator=_share)
    latency: float = 0.005
    jitter: float = 0.004
    interval: float = 0.0
    in_order: bool = True

    def transmit(self, sent: list[Notification], site: Site, rng: Rng) -> list[Packet]:
        """What arrives of what was sent, by time of arrival."""
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
"""A good link: nothing lost, 5 to 9 ms."""


def _flip(data: bytes, rng: Rng) -> bytes:
    damaged = bytearray(data)
    for bit in rng.integers(0, 8 * len(data), size=int(rng.integers(1, 4))):
        damaged[int(bit) // 8] ^= 1 << (int(bit) % 8)
    return bytes(damaged)
