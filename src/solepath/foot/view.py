"""What a part of the body may see of a foot: a record of one foot at one sample, and nothing that it could change."""

from __future__ import annotations

from typing import Final, NamedTuple

from ..events import Event
from ..types import Foot, Layout, Phase, Quat, Sample, Vec3
from ..types.attrs import define
from ..types.vector import IDENTITY
from .world import Covariance3


class PressedCells(NamedTuple):
    """What the pressure cells of one sample show, calibrated and noise taken off."""

    values: tuple[float, ...]
    """N, or in the unit of the samples."""
    layout: Layout | None
    """Where the cells are; None when nobody knows."""
    in_newtons: bool
    """Which of the two."""
    highest: float
    """The most loaded cell of late, as `values`."""
    centre_alone: tuple[float, float] | None
    """Centre of pressure (x, y), foot frame, m, of an insole without an inertial sensor; None otherwise."""


class AfterEvents(NamedTuple):
    """Of a foot of which a sample had events."""

    stood: Quat
    """Its attitude when it was last flat, sensor to navigation frame."""
    layout: Layout | None
    """Where its pressure cells are; None when nobody knows."""
    other_t: float | None
    """The newest sample of the other foot, s; None before any."""
    takes_shifts: bool
    """Whether its corrector can be turned and moved by a `Shift` (body/part.py); given with a stride."""
    covariance: Covariance3 | None
    """Of its position, world frame, m^2; None but with a stride: it takes long."""


NOTHING_HAPPENED: Final = AfterEvents(IDENTITY, None, None, False, None)


@define(eq=False)
class FootView:
    """One foot right after one of its samples. Vectors are in the foot's own navigation frame, z up, whose heading is
    that of the moment when the foot was levelled; `north` turns them into the world frame. Read only: type
    checkers refuse to write into it, and what is written all the same the foot never sees."""

    foot: Final[Foot]
    """Whose sample it is."""
    sample: Final[Sample]
    """The sample as the link or the app gave it, calibration not applied."""
    t: Final[float]
    """Its time, s."""
    known_at: Final[float]
    """When the sample was known, s; never earlier than `t`."""
    events: Final[tuple[Event, ...]]
    """What the foot said of this sample, in order."""
    moved_at: Final[float | None]
    """The newest sample with both acc and gyro, s; `t` where this one has both; None before any."""
    levelled: Final[bool]
    """Which way is up is known: the foot is followed."""
    phase: Final[Phase]
    """What the foot is doing after `events`."""
    position: Final[Vec3]
    """Of the sensor, m."""
    velocity: Final[Vec3]
    """Of the sensor, m/s."""
    attitude: Final[Quat]
    """Sensor to navigation frame."""
    north: Final[tuple[float, float] | None]
    """cos and sin of the turn from the navigation frame to the world frame; None until the first heading is known."""
    gyro_bias: Final[Vec3]
    """What the gyroscope shows at rest, rad/s, sensor frame."""
    acc_grain: Final[float]
    """What a count of the accelerometer is worth, m/s^2; 0 when nobody knows."""
    pressed: Final[PressedCells | None]
    """Of a sample with pressure cells that can be used; None otherwise."""
    after: Final[AfterEvents]
    """What is asked for when something happened; NOTHING_HAPPENED otherwise."""


class FootPose(NamedTuple):
    """Where one foot is now."""

    foot: Foot
    t: float
    """The newest sample, s."""
    moved_at: float | None
    """The newest sample with both acc and gyro, s; None before any."""
    position: Vec3
    """Of the sensor, world frame, m."""
    covariance: Covariance3
    """Of `position`, m^2."""
