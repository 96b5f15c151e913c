"""The health of a link: what came, what was lost and what was rejected in its last seconds."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from math import floor

from ..types import Packet, Sample
from ..types.attrs import define, field, frozen
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

    seconds: deque[list[int]] = field(factory=lambda: deque(maxlen=LOSS_WINDOW + 1))
    """Lists [second, packets, samples, missing samples, rejections] for each second in which there were any."""
    last_arrival: float | None = None
    """Arrival of the newest packet or sample that was used, s; None before any."""

    def add(self, t: float, packets: int = 0, samples: int = 0, missing: int = 0, rejected: int = 0) -> None:
        """Add what came, was lost or was rejected at `t` s."""
        if not self.seconds or not self.seconds[-1][0] - 1 <= t < self.seconds[-1][0] + 1:
            self.seconds.append([floor(t), 0, 0, 0, 0])
        newest = self.seconds[-1]
        newest[1] += packets
        newest[2] += samples
        newest[3] += missing
        newest[4] += rejected

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
        recent = [counts[1:] for counts in self.seconds if now - LOSS_WINDOW - 1.0 < counts[0] <= now]
        return tuple([sum(column) for column in zip(*recent, strict=True)]) or (0, 0, 0, 0)  # whole numbers
