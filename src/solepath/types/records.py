"""Records that every package shares: feet and sites, packets and samples, vectors and layouts.

Units are SI (s, m/s^2, rad/s, N, Pa, T); times are floats in seconds on one clock."""

from __future__ import annotations

from enum import Enum
from functools import cached_property, lru_cache
from struct import pack
from typing import Any, SupportsIndex

from .attrs import field, frozen

Vec3 = tuple[float, float, float]
"""Vector (x, y, z) in the frame that the docstring of its user names."""

Quat = tuple[float, float, float, float]
"""Unit quaternion (w, x, y, z) that turns sensor coordinates into world coordinates."""


class Word(Enum):
    """A closed set of words.

    Each member is one object, and its identity is its hash: Enum's own hash is a call of Python code at every look-up,
    and the code that runs per sample looks up feet, sites and phases all the time."""

    __hash__ = object.__hash__

    def __str__(self) -> str:
        return str(self.value)


class Foot(Word):
    """One of the wearer's feet."""

    LEFT = "left"
    RIGHT = "right"


OTHER = {Foot.LEFT: Foot.RIGHT, Foot.RIGHT: Foot.LEFT}
"""The other foot of each foot."""


class OnBody(Word):
    """A place on the body."""

    foot: Foot | None
    """Foot that this site is, or None for the sites above the ankle."""


class Site(OnBody):
    """Place on the body at which a sensor sits."""

    LEFT_FOOT = "left_foot"
    RIGHT_FOOT = "right_foot"
    PELVIS = "pelvis"
    LEFT_THIGH = "left_thigh"
    RIGHT_THIGH = "right_thigh"
    LEFT_SHANK = "left_shank"
    RIGHT_SHANK = "right_shank"

    @property
    def words(self) -> str:
        """The site as in a sentence: "left foot"."""
        return self.value.replace("_", " ")


for _site in Site:
    _site.foot = {"left_foot": Foot.LEFT, "right_foot": Foot.RIGHT}.get(_site.value)

SITE_OF_FOOT = {Foot.LEFT: Site.LEFT_FOOT, Foot.RIGHT: Site.RIGHT_FOOT}
"""Site of each foot."""


class Phase(Word):
    """Phase of one foot; each phase starts with the event in brackets."""

    LOADING = "LOADING"  # HeelStrike
    STATIONARY = "STATIONARY"  # FootFlat
    PUSH_OFF = "PUSH_OFF"  # HeelOff
    SWING = "SWING"  # ToeOff


class Support(Word):
    """Feet that are on the ground: both, left, right, or none (flight)."""

    DOUBLE = "DOUBLE"
    LEFT = "LEFT"
    RIGHT = "RIGHT"
    FLIGHT = "FLIGHT"


class WalkingMode(Word):
    """Mode of walking: straight on, round a wide (4 m) or a tight (2 m) bend, or standing."""

    STRAIGHT = "STRAIGHT"
    LEFT_WIDE = "LEFT_WIDE"
    LEFT_TIGHT = "LEFT_TIGHT"
    RIGHT_WIDE = "RIGHT_WIDE"
    RIGHT_TIGHT = "RIGHT_TIGHT"
    STANDING = "STANDING"


class Activity(Word):
    """Activity of the wearer."""

    STANDING = "STANDING"
    """Standing, or sitting: sensors on a foot cannot distinguish them."""
    WALKING = "WALKING"
    RUNNING = "RUNNING"
    STAIRS_UP = "STAIRS_UP"
    STAIRS_DOWN = "STAIRS_DOWN"
    ELEVATOR_UP = "ELEVATOR_UP"
    ELEVATOR_DOWN = "ELEVATOR_DOWN"
    UNKNOWN = "UNKNOWN"


class Turn(Word):
    """Direction in which the wearer turned."""

    LEFT = "LEFT"
    RIGHT = "RIGHT"
    ABOUT = "ABOUT"


@frozen
class Packet:
    """One notification (or one value read from a device) as it came in.

    `t` is the arrival time in s on the receiver's clock; `channel` names the format of `data` ("insole/frame",
    "cc2650/movement", ...), so that a recording describes itself. `device`: the address of the device that it came
    from, "" when it is unknown."""

    t: float
    site: Site
    channel: str
    data: bytes = field(repr=lambda data: data.hex())
    device: str = ""

    def __reduce_ex__(self, protocol: SupportsIndex) -> str | tuple[Any, ...]:
        # takes a fifth of attrs' own time: stream engines pickle every packet that changes processes
        if type(self) is Packet:
            return Packet, (self.t, self.site, self.channel, self.data, self.device)
        return super().__reduce_ex__(protocol)


@frozen
class Sample:
    """The measurements of the sensors of one site at one instant; a value that was not measured is None.

    `t`: time of the measurement, s. `known_at`: time at which it was known, s; `t` when it is not given. `acc`:
    specific force in m/s^2, sensor frame (+9.81 upwards at rest). `gyro`: rad/s, sensor frame. `pressure`: one value
    per cell in the layout's order and unit (N when the device declares a scale, otherwise counts; more is more load).
    `quat`: the device's own attitude, where it sends one. `mag`: T, sensor frame. `air_pressure`: Pa. `saturated`: the
    device reports that a sensor was at the end of its range."""

    t: float
    site: Site
    acc: Vec3 | None = None
    gyro: Vec3 | None = None
    pressure: tuple[float, ...] | None = None
    quat: Quat | None = None
    mag: Vec3 | None = None
    air_pressure: float | None = None
    known_at: float = field()
    saturated: bool = False

    @known_at.default
    def _at_once(self) -> float:
        return self.t


@frozen
class Cell:
    """One pressure cell: its centre in the foot frame, m, and its area, m^2.

    The foot frame has x to the toe, y to the left, and its origin at the heel's rear end on the insole's midline."""

    x: float
    y: float
    area: float = 1e-4


@frozen
class Layout:
    """The pressure cells of one insole, in the order in which samples have them.

    `length`: heel to toe in m. `scale`: N per count of the wire (1.0 when the values are newtons already, None when it
    is unknown: then loads are in counts). `full_scale`: the largest value that a cell can report, in the unit of the
    samples."""

    id: int
    foot: Foot
    cells: tuple[Cell, ...]
    length: float
    scale: float | None = None
    full_scale: float = 4095.0

    @cached_property
    def xs(self) -> tuple[float, ...]:
        """Place of each cell along the foot's x axis, to the toe, m."""
        return tuple([cell.x for cell in self.cells])

    @cached_property
    def ys(self) -> tuple[float, ...]:
        """Place of each cell along the foot's y axis, to the left, m."""
        return tuple([cell.y for cell in self.cells])


def shared(layout: Layout) -> Layout:
    """Return the one object for all layouts that are the same to the bit.

    All wearers of one kind of insole share it, and hold it for hours."""
    numbers = [layout.length, layout.full_scale, 0.0 if layout.scale is None else layout.scale]
    for cell in layout.cells:
        numbers += (cell.x, cell.y, cell.area)
    # -0.0 and 0.0 are equal, but their bits differ
    bits = pack(f"<{len(numbers)}d", *numbers)
    return _intern(_Bits((layout.id, layout.foot, layout.scale is None, bits), layout))


@frozen
class _Bits:
    key: tuple[int, Foot, bool, bytes]
    layout: Layout = field(eq=False)


@lru_cache(maxsize=256)
def _intern(bits: _Bits) -> Layout:
    return bits.layout
