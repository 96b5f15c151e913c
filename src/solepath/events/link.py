"""Events of the links: packets and samples that were lost or rejected, and reports of the devices."""

from __future__ import annotations

from enum import Enum

from ..types import Layout, Site
from ..types.attrs import frozen
from .happening import Happening


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
class PacketRejected(Happening):
    """A packet could not be used; it changed nothing. Known when it is fed; `t` is its arrival."""

    site: Site
    channel: str
    """Channel of the packet."""
    reason: Rejection
    """Kind of fault."""
    detail: str = ""
    """Reason in words."""


@frozen(kw_only=True)
class SampleRejected(Happening):
    """A sample that was fed could not be used; it changed nothing.

    Known when it is fed; `t` is the sample's, or that of the one before where its own time cannot be used."""

    site: Site
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class PacketsLost(Happening):
    """Packets never arrived, by the device's counter, or by the time between arrivals where it has none.

    `t` is the time of the first missing one. Known at the arrival of the first packet after them."""

    site: Site
    channel: str
    count: int
    """Number of packets, at least 1."""


@frozen(kw_only=True)
class SampleGap(Happening):
    """No samples came for longer than the sensor's rate allows; the stride that this falls in is marked degraded.

    `t` is the last sample before the gap. Known with the first sample after it."""

    site: Site
    duration: float
    """Time from the sample before the gap to the one after it, s."""


@frozen(kw_only=True)
class ClockReset(Happening):
    """The device's clock jumped or the device restarted; sample times start from a new fit.

    `t` is the start of the new fit. Known at the arrival of the packet that shows it."""

    site: Site
    restarted: bool
    """True when the device's sequence restarted as well."""


@frozen(kw_only=True)
class StreamStale(Happening):
    """Nothing came from a site for longer than its link allows (1 or 2 s, `Profile.stale_after`).

    `t` is the end of that time. Known with the first `Session.advance` or packet of the site after that, so the latency
    is the interval between these calls."""

    site: Site
    silent_for: float
    """Time from the arrival of the last data until the event was known, s."""


@frozen(kw_only=True)
class StreamResumed(Happening):
    """Data came again after StreamStale. `t` is the arrival of the packet that ends the silence; known with it."""

    site: Site
    silent_for: float
    """Time from the arrival of the last data before the silence to `t`, s."""


@frozen(kw_only=True)
class Connected(Happening):
    """The receiver connected to a device, for the first time or again; the device is about to be set up.

    `t` is the time by the receiver's clock; known at once."""

    site: Site
    device: str
    """Address of the device; "" when it is unknown."""
    name: str
    """Name of the device."""
    signal: int | None
    """Newest signal strength before the connection, dBm; None when it is unknown."""


@frozen(kw_only=True)
class Disconnected(Happening):
    """The connection to the device is lost; the receiver searches for it.

    `t` is when the receiver noticed, seconds after the device went out of reach; known at once."""

    site: Site


@frozen(kw_only=True)
class PacketsDropped(Happening):
    """Packets arrived and were dropped, the oldest first, because they were not taken in time.

    Known when the next one is taken; `t` is the arrival of the newest of the site that was dropped by then."""

    site: Site
    count: int
    """Number of packets, at least 1."""


@frozen(kw_only=True)
class StreamRestarted(Happening):
    """A stream stopped although the connection stands, and the receiver set the device up again.

    `t` is the time of the restart; known at once, after the silence that the device's profile allows
    (`Profile.stale_after`, s)."""

    site: Site
    channel: str
    """Channel of the stream."""


@frozen(kw_only=True)
class LinkTrouble(Happening):
    """The receiver cannot do its work; `what` is a sentence for a person who can help.

    `t` is when the trouble was noticed; known at once."""

    site: Site
    what: str
    """Description in one sentence."""


@frozen(kw_only=True)
class ScaleSuspect(Happening):
    """The accelerometer does not read 1 g at rest, but 15 % more or less: its assumed range or scale is wrong.

    Reported once. Known at the end of a rest, which `t` is: of 1.5 s in packets, of 0.5 s in samples."""

    site: Site
    magnitude: float
    """Mean |acc| at rest, m/s^2."""
    suggestion: str = ""
    """Factor to multiply by, or range that the device may have, in words."""


@frozen(kw_only=True)
class LayoutKnown(Happening):
    """The layout of the pressure cells is known, from the device or from the calibration.

    A layout of the calibration applies when samples have as many cells. Known with the packet that has it or the first
    such sample, whose time `t` is."""

    site: Site
    layout: Layout
    """Layout of the cells."""


@frozen(kw_only=True)
class BatteryLevel(Happening):
    """The device reported its battery level. Known with that packet, whose arrival `t` is."""

    site: Site
    level: float
    """Battery level, 0 to 1."""


@frozen(kw_only=True)
class KeysChanged(Happening):
    """The keys of the device that are down changed. Known with the packet that reports it, whose arrival `t` is."""

    site: Site
    down: tuple[str, ...]
    """Names of the keys that are down (for instance "left", "right", "side")."""


@frozen(kw_only=True)
class Limitation(Happening):
    """A limitation of the session by the sensors that it has, reported once.

    Known with the packet or sample that shows it, whose time `t` is; a value of a sample counts as missing when it has
    been missing for a while."""

    site: Site | None
    """Site whose sensor is the reason; None for the whole session."""
    what: str
    """Description in one sentence."""
