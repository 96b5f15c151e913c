"""Events of the links: packets and samples that were lost or rejected, connections, and values of the devices."""

from __future__ import annotations

from enum import Enum

from ..types import Layout, Site, Vec2
from ..types.attrs import field, frozen
from .defect import Defect
from .foot import is_harmless
from .happening import BaseEvent


class Rejection(Enum):
    """Reason why a packet or a sample was not used."""

    TRUNCATED = "truncated"
    OVERSIZED = "oversized"
    CHECKSUM = "checksum"
    MALFORMED = "malformed"
    UNKNOWN_CHANNEL = "unknown channel"
    WRONG_SITE = "wrong site"
    WRONG_LAYOUT = "wrong layout"
    DUPLICATE = "duplicate"
    LATE = "late"
    NOT_FINITE = "not finite"
    ABSURD = "absurd value"
    TIME_BACKWARDS = "time runs backwards"
    WRONG_DEVICE = "wrong device"


@frozen(kw_only=True)
class PacketRejected(BaseEvent):
    """A packet could not be used, and changed nothing; `t` is its arrival, with which it is reported.

    Further ones of the same site, channel and reason within 10 s are reported together after that time, as one event
    with their `count` and the `t` and `detail` of the first of them; `Session(losses=True)` reports each by itself."""

    site: Site
    channel: str
    """Channel of the packet."""
    reason: Rejection
    """Kind of fault."""
    detail: str = ""
    """Reason in words."""
    count: int = 1
    """Number of packets that are reported together."""


@frozen(kw_only=True)
class SampleRejected(BaseEvent):
    """A sample could not be used, and changed no estimate.

    It is reported at once. `t` is the sample's time, or the previous sample's if the sample's time cannot be used.
    Further ones of the same site and reason are reported together, as for PacketRejected."""

    site: Site
    reason: Rejection
    detail: str = ""
    """Reason in words."""
    defect: Defect | None = None
    """Wrong unit that the size of the value suggests; DefectFound reports it if the foot has no usable samples."""
    count: int = 1
    """Number of samples that are reported together."""


@frozen(kw_only=True)
class SampleGap(BaseEvent):
    """Samples did not arrive, or none was taken for a while; the stride says what is missing of it.

    `t` is the last sample before the gap. It is reported with the first sample after the gap. Short gaps, those that
    are no flaw of a stride, are reported together when they follow another of the site within 10 s: after that time, as
    one event whose `t` is that of the first of them. `Session(losses=True)` reports each by itself."""

    site: Site
    duration: float
    """Time from the last sample before the gap to the first sample after it, s; the sum of several gaps."""
    count: int
    """Number of samples that the device took and that did not arrive; of a CC2541, values of either of its two streams.

    The device's counters give it, or the times of arrival if the device has no counters; for samples that were fed
    without packets, the usual interval between them, which is twice as long if every second one is always lost. It is 0
    for an absence: the device was not connected, restarted, was silent for longer than its profile allows (rows: 20
    intervals, but 1 to 2 s, which is the same), or took no samples."""
    gaps: int = 1
    """Number of gaps that are reported together."""
    longest: float = field()
    """Longest of these gaps, s, by default `duration`."""

    @longest.default
    def _only_one(self) -> float:
        return self.duration


def is_harmless_loss(gap: SampleGap) -> bool:
    """Return whether samples were lost, and in each gap so few that it is no flaw of a stride."""
    return gap.count > 0 and is_harmless(gap.longest, gap.duration / (gap.count + gap.gaps))


@frozen(kw_only=True)
class ClockReset(BaseEvent):
    """The device's clock jumped, the device restarted, or the receiver's clock did; sample times start from a new fit.

    A fit converts the device's ticks to time (link/clock.py). `t` is the first time of the new fit. It is reported at
    the arrival of the packet that shows it, or by `Session.restart_clock`."""

    site: Site
    restarted: bool
    """True when the device's sequence numbers restarted as well."""


@frozen(kw_only=True)
class StreamStale(BaseEvent):
    """Nothing came from a site for longer than its device allows (`Profile.stale_after`; built-in devices: 1 or 2 s).

    `t` is the end of the allowed time. It is reported by the first `Session.advance` or packet of the site after `t`,
    so the latency is the interval between these calls."""

    site: Site
    silent_for: float
    """Time from the arrival of the last data until the event was reported, s."""


@frozen(kw_only=True)
class StreamResumed(BaseEvent):
    """Data came again after StreamStale; `t` is the arrival of the first packet, with which it is reported."""

    site: Site
    silent_for: float
    """Time from the arrival of the last data before the silence to `t`, s."""


@frozen(kw_only=True)
class Connected(BaseEvent):
    """The receiver connected to a device, for the first time or again, and sets it up next.

    `t` is the time of the connection on the receiver's clock. It is reported at once."""

    site: Site
    device: str
    """Address of the device; "" when it is unknown."""
    name: str
    """Name of the device."""
    signal: int | None
    """Newest signal strength before the connection, dBm; None when it is unknown."""


@frozen(kw_only=True)
class Disconnected(BaseEvent):
    """The connection to the device is lost; the receiver searches for it.

    `t` is the time at which the receiver noticed it, some seconds after the device went out of reach. It is reported
    at once."""

    site: Site


@frozen(kw_only=True)
class PacketsDropped(BaseEvent):
    """Packets arrived and were dropped, the oldest first, because the app did not take them in time.

    It is reported when the next packet is taken. `t` is the arrival of the site's newest dropped packet."""

    site: Site
    count: int
    """Number of dropped packets, at least 1."""


@frozen(kw_only=True)
class StreamRestarted(BaseEvent):
    """A stream stopped while the device stayed connected, and the receiver set the device up again.

    `t` is the time of that setup, after the silence that the device's profile allows (`Profile.stale_after`, s). It is
    reported at once."""

    site: Site
    channel: str
    """Channel of the stream."""


@frozen(kw_only=True)
class PositionReported(BaseEvent):
    """A person has reported where the wearer is at `t`; what the track makes of it follows at once.

    That is TrackRevised or PositionRejected. Nothing follows if a named place is noted for the first time, or if the
    track cannot use it (docs/app.md)."""

    site: Site
    """Any site of the session."""
    position: Vec2 | None
    """Position, x and y, m; None at a named place, or where the walk started."""
    place: str = ""
    """Name of the place, which has the same position whenever it is reported; "" without one."""
    level: str = ""
    """Level of the floor plan, whose frame `position` is in; "" if it is in the world frame."""
    sigma: float
    """Standard deviation of the position on each axis, m."""


@frozen(kw_only=True)
class LinkTrouble(BaseEvent):
    """The receiver cannot work, and a person has to help.

    `t` is the time at which the receiver noticed it. It is reported at once."""

    site: Site
    what: str
    """Description in one sentence for that person."""


@frozen(kw_only=True)
class LayoutKnown(BaseEvent):
    """The layout of the pressure cells is known from the device or from the calibration.

    A layout of the calibration is used if it has as many cells as the samples. `t` is the time of the packet with the
    layout, or of the first sample with as many cells, with which it is reported. A layout that a declared device
    repeats is reported once."""

    site: Site
    layout: Layout
    """Layout of the cells."""


@frozen(kw_only=True)
class BatteryLevel(BaseEvent):
    """The device reported its battery level; `t` is the arrival of the packet, with which it is reported."""

    site: Site
    level: float
    """Battery level, 0 to 1."""


@frozen(kw_only=True)
class KeysChanged(BaseEvent):
    """A key of the device was pressed or released; `t` is the arrival of the packet, with which it is reported."""

    site: Site
    down: tuple[str, ...]
    """Names of the keys that are down (for instance "left", "right", "side")."""


@frozen(kw_only=True)
class Limitation(BaseEvent):
    """The session cannot measure something with the sensors that it has; it is reported once.

    `t` is the time of the packet or sample that shows it, with which it is reported. A value that is missing in samples
    is reported only after it was missing for some time."""

    site: Site | None
    """Site whose sensor causes the limitation; None for the whole session."""
    what: str
    """Description in one sentence."""
