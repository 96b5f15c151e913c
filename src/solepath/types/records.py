"""Records that every package shares: feet and sites, packets and samples, vectors.

Units are SI (s, m/s^2, rad/s, N, Pa, T); times are floats in seconds on one clock."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import Any, SupportsIndex, TypeVar

from .attrs import field, frozen

MAX_TIME = 1e11
"""Largest magnitude of a time of a packet, sample or event, s: three thousand years."""

Vec3 = tuple[float, float, float]
"""Vector (x, y, z), in the frame that the docstring of the field or argument names."""

Vec2 = tuple[float, float]
"""Vector (x, y) in the horizontal plane, in the frame that the docstring of the field or argument names."""

Quat = tuple[float, float, float, float]
"""Unit quaternion (w, x, y, z) that turns sensor coordinates into world coordinates."""

Floats = tuple[float, ...]
"""Numbers, as many as the docstring of the field or argument says."""


class ValueEnum(Enum):
    """An enum whose members are printed as their values and hashed by identity.

    The hash of Enum is a call of Python code at every look-up, and code that runs per sample looks up feet, sites and
    phases all the time."""

    __hash__ = object.__hash__

    def __str__(self) -> str:
        return str(self.value)


class Foot(ValueEnum):
    """One of the wearer's feet."""

    LEFT = "left"
    RIGHT = "right"


OTHER = {Foot.LEFT: Foot.RIGHT, Foot.RIGHT: Foot.LEFT}
"""The other foot of each foot."""

_Value = TypeVar("_Value")
PerFoot = dict[Foot, _Value]
"""One value for each foot, the left one first."""


def per_foot(make: Callable[[], _Value]) -> PerFoot[_Value]:
    """Return a new value for each foot."""
    return {foot: make() for foot in Foot}


class OnBody(ValueEnum):
    """A place on the body; the base class of `Site`."""

    foot: Foot | None
    """Foot at which this site is; None for the sites above the ankle."""


class Site(OnBody):
    """A place on the body at which a sensor sits."""

    LEFT_FOOT = "left_foot"
    RIGHT_FOOT = "right_foot"
    PELVIS = "pelvis"
    LEFT_THIGH = "left_thigh"
    RIGHT_THIGH = "right_thigh"
    LEFT_SHANK = "left_shank"
    RIGHT_SHANK = "right_shank"

    @property
    def words(self) -> str:
        """Name of the site in a sentence: "left foot"."""
        return self.value.replace("_", " ")


for _site in Site:
    _site.foot = {"left_foot": Foot.LEFT, "right_foot": Foot.RIGHT}.get(_site.value)

SITE_OF_FOOT = {Foot.LEFT: Site.LEFT_FOOT, Foot.RIGHT: Site.RIGHT_FOOT}
"""Site of each foot."""


class Phase(ValueEnum):
    """A phase of one foot."""

    LOADING = "LOADING"
    """From HeelStrike to FootFlat."""
    STATIONARY = "STATIONARY"
    """From FootFlat to HeelOff."""
    PUSH_OFF = "PUSH_OFF"
    """From HeelOff to ToeOff."""
    SWING = "SWING"
    """From ToeOff to HeelStrike."""


class Support(ValueEnum):
    """The feet that are on the ground: both, left, right, or none (flight)."""

    DOUBLE = "DOUBLE"
    LEFT = "LEFT"
    RIGHT = "RIGHT"
    FLIGHT = "FLIGHT"


class WalkingMode(ValueEnum):
    """A mode of walking: straight on, round a bend of wide (4 m) or tight (2 m) radius, or standing."""

    STRAIGHT = "STRAIGHT"
    LEFT_WIDE = "LEFT_WIDE"
    LEFT_TIGHT = "LEFT_TIGHT"
    RIGHT_WIDE = "RIGHT_WIDE"
    RIGHT_TIGHT = "RIGHT_TIGHT"
    STANDING = "STANDING"


class Activity(ValueEnum):
    """An activity of the wearer."""

    STANDING = "STANDING"
    """Standing, or sitting: sensors on a foot cannot distinguish them."""
    WALKING = "WALKING"
    RUNNING = "RUNNING"
    STAIRS_UP = "STAIRS_UP"
    STAIRS_DOWN = "STAIRS_DOWN"
    ELEVATOR_UP = "ELEVATOR_UP"
    ELEVATOR_DOWN = "ELEVATOR_DOWN"
    UNKNOWN = "UNKNOWN"


class Turn(ValueEnum):
    """A direction in which the wearer turned."""

    LEFT = "LEFT"
    RIGHT = "RIGHT"
    ABOUT = "ABOUT"


@frozen
class Packet:
    """A notification of a device, or a value read from it, as it was received."""

    t: float
    """Arrival time on the receiver's clock, s."""
    site: Site
    """Site of the device."""
    channel: str
    """Name of the format of `data` ("insole/frame", "cc2650/movement", ...), so that a recording describes itself."""
    data: bytes = field(repr=lambda data: data.hex())
    """Data of the notification or of the value, as received."""
    device: str = ""
    """Address of the device; "" when it is unknown."""

    def __reduce_ex__(self, protocol: SupportsIndex) -> str | tuple[Any, ...]:
        # takes a fifth of attrs' own time: stream engines pickle every packet that changes processes
        if type(self) is Packet:
            return Packet, (self.t, self.site, self.channel, self.data, self.device)
        return super().__reduce_ex__(protocol)


@frozen
class Sample:
    """The measurements of the sensors of one site at one instant; a value that was not measured is None."""

    t: float
    """Time of the measurement, s."""
    site: Site
    """Site of the sensors."""
    acc: Vec3 | None = None
    """Specific force, m/s^2, sensor frame (+9.81 upwards at rest)."""
    gyro: Vec3 | None = None
    """Angular rate, rad/s, sensor frame."""
    pressure: Floats | None = None
    """One value per cell in the order of the layout: N when the device declares a scale, otherwise counts; more is more
    load."""
    quat: Quat | None = None
    """Attitude that the device itself estimates, sensor to world, as a unit quaternion."""
    mag: Vec3 | None = None
    """Magnetic flux density, T, sensor frame."""
    air_pressure: float | None = None
    """Air pressure, Pa."""
    known_at: float = field()
    """Time at which the measurement was known, s, by default `t`."""
    saturated: bool = False
    """True when the device reports that a sensor was at the end of its range."""

    @known_at.default
    def _at_once(self) -> float:
        return self.t
