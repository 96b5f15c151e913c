"""What became of packets and samples, and what a device says of itself."""

from __future__ import annotations

from enum import Enum

from attrs import frozen

from ..types import Layout, Site
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
    """A packet could not be used; it changed nothing."""

    site: Site
    channel: str
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class SampleRejected(Happening):
    """A sample that was fed could not be used; it changed nothing."""

    site: Site
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class PacketsLost(Happening):
    """The device's counter says that packets never arrived. `t` is where the first missing one belongs."""

    site: Site
    channel: str
    count: int


@frozen(kw_only=True)
class SampleGap(Happening):
    """No samples for longer than the sensor's rate allows; the step that this falls in is marked degraded.

    `t` is the last sample before the gap.
    """

    site: Site
    duration: float


@frozen(kw_only=True)
class ClockReset(Happening):
    """The device's clock jumped or the device restarted; sample times start from a new fit."""

    site: Site
    restarted: bool
    """True when its sequence began anew as well."""


@frozen(kw_only=True)
class StreamStale(Happening):
    """Nothing came from a site for longer than its link allows."""

    site: Site
    silent_for: float


@frozen(kw_only=True)
class StreamResumed(Happening):
    """Data came again after StreamStale."""

    site: Site
    silent_for: float


@frozen(kw_only=True)
class Connected(Happening):
    """The receiver connected to a device, again perhaps; it is about to be set up."""

    site: Site
    device: str
    """Its address, "" when nobody knows."""
    name: str
    signal: int | None
    """With which it was last heard before, dBm; None when nobody knows."""


@frozen(kw_only=True)
class Disconnected(Happening):
    """The connection to the device is gone; the receiver looks for it."""

    site: Site


@frozen(kw_only=True)
class PacketsDropped(Happening):
    """Packets arrived and were thrown away, the oldest first, since nobody took them in time."""

    site: Site
    count: int


@frozen(kw_only=True)
class StreamRestarted(Happening):
    """A stream froze although the connection stands, and the receiver set the device up again."""

    site: Site
    channel: str


@frozen(kw_only=True)
class LinkTrouble(Happening):
    """The receiver cannot do what it should, in a sentence for the person who can do something about it."""

    site: Site
    what: str


@frozen(kw_only=True)
class ScaleSuspect(Happening):
    """The accelerometer does not read 1 g at rest: its range or scale is not what was assumed."""

    site: Site
    magnitude: float
    """Mean |acc| at rest, m/s^2."""
    suggestion: str = ""


@frozen(kw_only=True)
class LayoutKnown(Happening):
    """The device said how its pressure cells are laid out; or the calibration did, and samples have as many cells."""

    site: Site
    layout: Layout


@frozen(kw_only=True)
class BatteryLevel(Happening):
    """The device said how full its battery is."""

    site: Site
    level: float
    """0 to 1."""


@frozen(kw_only=True)
class KeysChanged(Happening):
    """Which of the device's keys are down now, by name (for instance "left", "right", "side")."""

    site: Site
    down: tuple[str, ...]


@frozen(kw_only=True)
class Limitation(Happening):
    """Said once: what the session must do without, given the sensors that there are."""

    site: Site | None
    what: str
