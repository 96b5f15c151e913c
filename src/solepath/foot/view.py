"""Read-only view of one foot at one sample, for the parts of the body."""

from __future__ import annotations

from typing import Final, NamedTuple

from ..types import Floats, Foot, Layout, Phase, Quat, Sample, Vec2, Vec3
from ..types.attrs import define
from .navigate.bias import Bias
from .world import Covariance3

FASTEST_RUN = 12.5
"""Largest mean speed of a stride that is possible, m/s.

It is that of the fastest 20 m of the world record of 100 m, 1.61 s from 60 to 80 m (Berlin 2009), rounded up."""
LONGEST_STRIDE = 5.6
"""Length of the longest strides, m: two steps of 2.8 m.

The mean step of the world record of 100 m, 41 steps, is 2.44 m; the rest is an allowance, chosen by hand."""


class PressedCells(NamedTuple):
    """The values of the pressure cells of one sample, calibrated and without noise."""

    values: Floats
    """Value of each cell, N or in the unit of the samples."""
    layout: Layout | None
    """Layout of the cells; None when it is unknown."""
    in_newtons: bool
    """The values are in N."""
    centre_alone: Vec2 | None
    """Centre of pressure (x, y) of an insole without inertial sensor, foot frame, m; None otherwise."""


class AfterEvents(NamedTuple):
    """The data that a view has in addition if its sample caused events of the foot."""

    flat_attitude: Quat
    """Attitude at the start of the current stride, its foot-flat, sensor to navigation frame."""
    layout: Layout | None
    """Layout of the pressure cells; None when it is unknown."""
    other_t: float | None
    """Time of the newest sample of the other foot, s; None before any."""
    takes_shifts: bool
    """The corrector can be turned and moved by a `Shift` (body/part.py); given with a stride."""
    covariance: Covariance3 | None
    """Covariance of the position, world frame, m^2; None without a stride, because it is costly."""
    bias: Bias
    """Gyroscope bias by the rests of the foot, and its variances."""
    velocity_error: Vec3
    """Integrated velocity of the foot when it came to stand, world frame, m/s; 0 if it was right or is not known."""
    bears_none: bool = False
    """Flag: the foot is known not to carry its walker (bearing.py)."""


@define(eq=False)
class FootView:
    """The state of one foot right after one of its samples.

    Vectors are in the navigation frame of this foot: z up, with the heading that the sensor had when its first attitude
    was found. `north` turns them into the world frame. The view is read only: type checkers reject assignments, and an
    assignment has no effect on the foot."""

    foot: Final[Foot]
    """Foot of the sample."""
    sample: Final[Sample]
    """Sample as it came from the link or the app, without calibration."""
    t: Final[float]
    """Time of the sample, s."""
    known_at: Final[float]
    """Time at which the sample was known, s; never earlier than `t`."""
    moved_at: Final[float | None]
    """Time of the newest sample with both acc and gyro, s; `t` if this one has both; None before any."""
    levelled: Final[bool]
    """The first attitude is known, so the foot is tracked."""
    phase: Final[Phase]
    """Phase of the foot after the sample."""
    position: Final[Vec3]
    """Position of the sensor, navigation frame, m."""
    velocity: Final[Vec3]
    """Velocity of the sensor, navigation frame, m/s."""
    attitude: Final[Quat]
    """Attitude, sensor to navigation frame."""
    north: Final[Vec2 | None]
    """Cosine and sine of the angle from navigation to world frame; None until the first heading is known."""
    gyro_bias: Final[Vec3]
    """Gyroscope bias, sensor frame, rad/s."""
    acc_grain: Final[float]
    """Value of one accelerometer count, m/s^2; 0 when it is unknown."""
    pressed: Final[PressedCells | None]
    """Pressure cells of the sample; None if it has no cells that can be used."""
    after: Final[AfterEvents | None]
    """Additional data if the sample caused events of the foot; None otherwise."""


class FootPose(NamedTuple):
    """The live position of one foot."""

    foot: Foot
    t: float
    """Time of the newest sample, s."""
    moved_at: float | None
    """Time of the newest sample with both acc and gyro, s; None before any."""
    position: Vec3
    """Position of the sensor, world frame, m."""
    covariance: Covariance3
    """Covariance of `position`, world frame, m^2."""
