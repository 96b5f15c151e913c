"""Everything that a session can say.

Every event is frozen, compares with == and carries the same three times of truth: `t`, when it happened (s, sample
clock); `known_at`, when that was known (s, arrival of the packet that settled it); `final`, whether anything may still
revise it. Final events never change, however much data follows.
"""

from __future__ import annotations

from enum import Enum

from attrs import frozen

from .types import Foot, Layout, Phase, Site, Vec3


@frozen(kw_only=True)
class _Event:
    t: float
    """When it happened, s."""
    known_at: float
    """When it was known, s; never earlier than `t`."""
    final: bool = True
    """False only for what a later event may revise."""


# --- gait -----------------------------------------------------------------------------------------------------------


@frozen(kw_only=True)
class _Phase(_Event):
    foot: Foot
    inferred: bool = False
    """True when no sample was there to see it: it is what this foot does as a rule, dated within a gap."""


@frozen(kw_only=True)
class HeelStrike(_Phase):
    """The foot touched the ground; LOADING begins."""


@frozen(kw_only=True)
class FootFlat(_Phase):
    """The whole sole is on the ground and still; STATIONARY begins and a step may end."""


@frozen(kw_only=True)
class HeelOff(_Phase):
    """The heel lifted; PUSH_OFF begins."""


@frozen(kw_only=True)
class ToeOff(_Phase):
    """The toe left the ground; SWING begins."""


@frozen
class StepFeatures:
    """What was measured along one step, for whoever compares steps; None where the sensors could not tell.

    `clearance`: highest rise of the sensor above the higher end of the step, m. `peak_speed`: m/s. `swing_pitch`:
    range of the pitch angle over the step, rad. `contact_load`: mean load from foot-flat to toe-off, in the unit of the
    samples. `cop`: centre-of-pressure path (x, y) in the foot frame over the same time, m, at most 32
    points evenly spaced in samples.
    """

    clearance: float
    peak_speed: float
    swing_pitch: float
    contact_load: float | None = None
    cop: tuple[tuple[float, float], ...] = ()


@frozen(kw_only=True)
class StepTaken(_Event):
    """One foot went from foot-flat to its next foot-flat (clinically: a stride). Known at the second foot-flat.

    `t` is the second foot-flat. Vectors are in the world frame (z up, x along the first heading, y left), m.
    """

    foot: Foot
    number: int
    """1 for the first step of this foot, and so on."""
    t_start: float
    """The foot-flat at which the step began, s."""
    t_end: float
    """The foot-flat that ended it, s; the same as `t`."""
    displacement: Vec3
    """From the first to the second foot-flat, m."""
    position: Vec3
    """Where the foot stands after the step, m."""
    stride_length: float
    """Horizontal length of `displacement`, m."""
    heading_change: float
    """Turn of the foot about the vertical between the two foot-flats, rad, counter-clockwise positive, in (-pi, pi]."""
    height_change: float
    """Vertical part of `displacement`, m."""
    covariance: tuple[float, float, float, float, float, float]
    """Of `displacement`: xx, xy, xz, yy, yz, zz in m^2."""
    t_toe_off: float | None = None
    t_heel_strike: float | None = None
    degraded: bool = False
    """True when samples were missing or saturated within the step."""
    features: StepFeatures


@frozen(kw_only=True)
class FootMoved(_Event):
    """Where a foot is after one sample; only from a session made with `poses=True`.

    Live, so never final: the step that it belongs to says where the foot really went. World frame, m and m/s.
    """

    foot: Foot
    position: Vec3
    velocity: Vec3
    phase: Phase
    final: bool = False


# --- the link -------------------------------------------------------------------------------------------------------


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
class PacketRejected(_Event):
    """A packet could not be used; it changed nothing."""

    site: Site
    channel: str
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class SampleRejected(_Event):
    """A sample that was fed could not be used; it changed nothing."""

    site: Site
    reason: Rejection
    detail: str = ""


@frozen(kw_only=True)
class PacketsLost(_Event):
    """The device's counter says that packets never arrived. `t` is where the first missing one belongs."""

    site: Site
    channel: str
    count: int


@frozen(kw_only=True)
class SampleGap(_Event):
    """No samples for longer than the sensor's rate allows; the step that this falls in is marked degraded.

    `t` is the last sample before the gap.
    """

    site: Site
    duration: float


@frozen(kw_only=True)
class ClockReset(_Event):
    """The device's clock jumped or the device restarted; sample times start from a new fit."""

    site: Site
    restarted: bool
    """True when its sequence began anew as well."""


@frozen(kw_only=True)
class StreamStale(_Event):
    """Nothing came from a site for longer than its link allows."""

    site: Site
    silent_for: float


@frozen(kw_only=True)
class StreamResumed(_Event):
    """Data came again after StreamStale."""

    site: Site
    silent_for: float


@frozen(kw_only=True)
class Connected(_Event):
    """The receiver connected to a device, again perhaps; it is about to be set up."""

    site: Site
    device: str
    """Its address, "" when nobody knows."""
    name: str
    signal: int | None
    """With which it was last heard before, dBm; None when nobody knows."""


@frozen(kw_only=True)
class Disconnected(_Event):
    """The connection to the device is gone; the receiver looks for it."""

    site: Site


@frozen(kw_only=True)
class PacketsDropped(_Event):
    """Packets arrived and were thrown away, the oldest first, since nobody took them in time."""

    site: Site
    count: int


@frozen(kw_only=True)
class StreamRestarted(_Event):
    """A stream froze although the connection stands, and the receiver set the device up again."""

    site: Site
    channel: str


@frozen(kw_only=True)
class LinkTrouble(_Event):
    """The receiver cannot do what it should, in a sentence for the person who can do something about it."""

    site: Site
    what: str


@frozen(kw_only=True)
class ScaleSuspect(_Event):
    """The accelerometer does not read 1 g at rest: its range or scale is not what was assumed."""

    site: Site
    magnitude: float
    """Mean |acc| at rest, m/s^2."""
    suggestion: str = ""


@frozen(kw_only=True)
class LayoutKnown(_Event):
    """The device said how its pressure cells are laid out."""

    site: Site
    layout: Layout


@frozen(kw_only=True)
class BatteryLevel(_Event):
    """The device said how full its battery is."""

    site: Site
    level: float
    """0 to 1."""


@frozen(kw_only=True)
class KeysChanged(_Event):
    """Which of the device's keys are down now, by name (for instance "left", "right", "side")."""

    site: Site
    down: tuple[str, ...]


@frozen(kw_only=True)
class Limitation(_Event):
    """Said once: what the session must do without, given the sensors that there are."""

    site: Site | None
    what: str


GaitEvent = HeelStrike | FootFlat | HeelOff | ToeOff | StepTaken | FootMoved
LinkEvent = (
    PacketRejected
    | SampleRejected
    | PacketsLost
    | SampleGap
    | ClockReset
    | StreamStale
    | StreamResumed
    | Connected
    | Disconnected
    | PacketsDropped
    | StreamRestarted
    | LinkTrouble
    | ScaleSuspect
    | LayoutKnown
    | BatteryLevel
    | KeysChanged
    | Limitation
)
Event = GaitEvent | LinkEvent
"""All of them."""
