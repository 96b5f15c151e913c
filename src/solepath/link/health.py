"""The health of a link: what came, what was lost and what was rejected in its last seconds."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from math import floor

from ..types import Packet, Sample
from ..types.attrs import define, field, frozen
from ..types.records import MAX_TIME
from .kinds import DeviceKinds

LOSS_WINDOW = 10
"""Time over which the recent loss is counted, in whole seconds."""


def is_whole(packet: Packet, items: Iterable[object], kinds: DeviceKinds) -> bool:
    """Return whether a packet has samples, which are among its `items`, or could have had some.

    The fragments of a frame count as one packet."""
    for item in items:
        if isinstance(item, Sample):
            return True
    return is_sample_channel(packet.channel, kinds) and not is_frame_fragment(packet)


def is_sample_channel(channel: str, kinds: DeviceKinds) -> bool:
    """Return whether samples come on this channel of a device."""
    kind = kinds.get(channel.partition("/")[0])
    return kind is not None and channel in kind.profile.streams


def is_frame_fragment(packet: Packet) -> bool:
    """Return whether the packet is a fragment of a frame that was too long for one packet."""
    if packet.channel != "insole/frame":
        return False
    from ..wire.fragment import is_fragment  # an app that feeds samples needs none

    return is_fragment(packet.data)


def missing_samples(lost: int, samples: int, packets: int) -> float:
    """Return how many samples are missing if `lost` were counted, and these came in so many packets.

    A CC2541 sends acceleration and angular rate in packets of their own, two for a sample, and counts both."""
    return lost * samples / packets if packets > samples > 0 else lost


@frozen
class LinkHealth:
    """How good the link of a site is: what came of it in the LOSS_WINDOW, 10 s, before the newest known time."""

    last_arrival: float | None
    """Arrival of its newest packet that was used, or of its newest sample that was fed without one, s; None before
    any."""
    missing: float | None
    """Share, 0 to 1, of the samples of this time that did not arrive; None when none arrived."""
    rejected: float | None
    """Share, 0 to 1, of the packets or samples that came in this time and could not be used; None when none came."""


@define
class RecentLink:
    """The numbers of packets, samples, missing samples and rejections in the last LOSS_WINDOW seconds."""

    seconds: deque[tuple[int, int, int, int, int]] = field(factory=lambda: deque(maxlen=LOSS_WINDOW))
    """Second, packets, samples, missing samples and rejections of each earlier second in which there were any."""
    second: int | None = None
    """The newest second in which there were any, whose numbers follow; None before any."""
    packets: int = 0
    samples: int = 0
    missing: int = 0
    rejected: int = 0
    since: float = MAX_TIME
    """Time from which on what comes counts for the newest second, s: a second before it, because some comes late."""
    until: float = -MAX_TIME
    """End of the newest second, s."""
    last_arrival: float | None = None
    """Arrival of the newest packet or sample that was used, s; None before any."""

    def add(self, t: float, packets: int = 0, samples: int = 0, missing: int = 0, rejected: int = 0) -> None:
        """Add what came, was lost or was rejected at `t` s."""
        if not self.since <= t < self.until:
            self._start_second(t)
        self.packets += packets
        self.samples += samples
        self.missing += missing
        self.rejected += rejected

    def add_sample(self, t: float) -> None:
        """Add a sample that was used, and that came without a packet at `t` s."""
        if not self.since <= t < self.until:
            self._start_second(t)
        self.samples += 1
        self.last_arrival = t

    def _start_second(self, t: float) -> None:
        self.seconds.extend(self._newest)
        self.second = floor(t)
        self.since, self.until = self.second - 1.0, self.second + 1.0
        self.packets = self.samples = self.missing = self.rejected = 0

    @property
    def _newest(self) -> list[tuple[int, int, int, int, int]]:
        """The newest second as one of `seconds`; empty before any."""
        newest = self.second
        return [] if newest is None else [(newest, self.packets, self.samples, self.missing, self.rejected)]

    def share(self, now: float) -> float | None:
        """Return the share, 0 to 1, of the samples in the window before `now`, s, that are missing."""
        packets, samples, missing, _ = self._counts(now)
        lost = missing_samples(missing, samples, packets)
        return lost / (lost + (samples or packets)) if samples or packets else None

    def health(self, now: float) -> LinkHealth:
        """Return the health of the link at `now`, s."""
        packets, samples, _, rejected = self._counts(now)
        came = rejected + (packets or samples)
        return LinkHealth(self.last_arrival, self.share(now), rejected / came if came else None)

    def _counts(self, now: float) -> tuple[int, ...]:
        """Return the numbers of packets, samples, missing samples and rejections in the window before `now`, s."""
        seconds = (*self.seconds, *self._newest)
        recent = [counts for second, *counts in seconds if now - LOSS_WINDOW - 1.0 < second <= now]
        return tuple([sum(column) for column in zip(*recent, strict=True)]) or (0, 0, 0, 0)  # whole numbers
