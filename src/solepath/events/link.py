"""What became of packets and samples, and what a device says of itself."""

from __future__ import annotations

from enum import Enum

from ..types import Layout, Site
from ..types.attrs import frozen
from .happening import Happening


class Rejection(Enum):
    """Why a packet or a sample was not used."""

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
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class SampleRejected(Happening):
    """A sample that was fed could not be used; it changed nothing. Known when it is fed; `t` is the sample's, or that
    of the one before where its own is no time."""

    site: Site
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class PacketsLost(Happening):
    """The device's counter says that packets never arrived, or for a device without one the time between arrivals.
    `t` is where the first missing one belongs. Known at the arrival of the first packet after them."""

    site: Site
    channel: str
    count: int
    """Packets, at least 1."""


@frozen(kw_only=True)
class SampleGap(Happening):
    """No samples for longer than the sensor's rate allows; the step that this falls in is marked degraded.

    `t` is the last sample before the gap. Known with the first sample after it.
    """

    site: Site
    duration: float
    """From sample to sample, s."""


@frozen(kw_only=True)
class ClockReset(Happening):
    """The device's clock jumped or the device restarted; sample times start from a new fit. `t` is where they do.
    Known at the arrival of the packet that shows it."""

    site: Site
    restarted: bool
    """True when its sequence began anew as well."""


@frozen(kw_only=True)
class StreamStale(Happening):
    """Nothing came from a site for longer than its link allows (1 or 2 s, `Profile.stale_after`). `t` is when that was
    up. Known with the first `Session.advance` or packet of the site after that: latency is how often one calls it."""

    site: Site
    silent_for: float
    """From the arrival of the last data until it was known, s."""


@frozen(kw_only=True)
class StreamResumed(Happening):
    """Data came again after StreamStale. `t` is the arrival of the packet that ends the silence; known with it."""

    site: Site
    silent_for: float
    """From the arrival of the last data before it, s."""


@frozen(kw_only=True)
class Connected(Happening):
    """The receiver connected to a device, again perhaps; it is about to be set up. `t` is when, by the receiver's
    clock; known at once."""

    site: Site
    device: str
    """Its address, "" when nobody knows."""
    name: str
    signal: int | None
    """With which it was last heard before, dBm; None when nobody knows."""


@frozen(kw_only=True)
class Disconnected(Happening):
    """The connection to the device is gone; the receiver looks for it. `t` is when the receiver noticed, seconds after
    the device went out of reach; known at once."""

    site: Site


@frozen(kw_only=True)
class PacketsDropped(Happening):
    """Packets arrived and were thrown away, the oldest first, since nobody took them in time. Known when the next one
    is taken; `t` is the arrival of the newest of the site that was thrown away by then."""

    site: Site
    count: int
    """Packets, at least 1."""


@frozen(kw_only=True)
class StreamRestarted(Happening):
    """A stream froze although the connection stands, and the receiver set the device up again. `t` is when; known at
    once, after the silence that the device's profile allows (`Profile.stale_after`, s)."""

    site: Site
    channel: str


@frozen(kw_only=True)
class LinkTrouble(Happening):
    """The receiver cannot do what it should, in a sentence for the person who can do something about it. `t` is when
    it was noticed; known at once."""

    site: Site
    what: str


@frozen(kw_only=True)
class ScaleSuspect(Happening):
    """The accelerometer does not read 1 g at rest, but 15 % more or less: its range or scale is not what was assumed.
    Said once. Known at the end of a rest, which `t` is: of 1.5 s in packets, of 0.5 s in samples."""

    site: Site
    magnitude: float
    """Mean |acc| at rest, m/s^2."""
    suggestion: str = ""
    """What to multiply by, or which range the device may have, in words."""


@frozen(kw_only=True)
class LayoutKnown(Happening):
    """The device said how its pressure cells are laid out; or the calibration did, and samples have as many cells.
    Known with the packet that says so or the first such sample, whose time `t` is."""

    site: Site
    layout: Layout


@frozen(kw_only=True)
class BatteryLevel(Happening):
    """The device said how full its battery is. Known with that packet, whose arrival `t` is."""

    site: Site
    level: float
    """0 to 1."""


@frozen(kw_only=True)
class KeysChanged(Happening):
    """Which of the device's keys are down now, by name (for instance "left", "right", "side"). Known with the packet
    that says so, whose arrival `t` is."""

    site: Site
    down: tuple[str, ...]


@frozen(kw_only=True)
class Limitation(Happening):
    """Said once: what the session must do without, given the sensors that there are. Known with the packet or sample
    that shows it, whose time `t` is; what a sample lacks has to be lacking for a while."""

    site: Site | None
    what: str
