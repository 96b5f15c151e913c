"""What is kept of half a second of one foot, and of a step."""

from __future__ import annotations

from ...types.attrs import define


@define
class ActivityBlock:
    """Means and shares over the samples of one block."""

    index: int
    count: int
    force: float
    """Mean |acc|, m/s^2."""
    variance: float
    """Of |acc|, (m/s^2)^2."""
    acc_bins: tuple[int, ...]
    """Samples in each bin of |acc|; 255 is as many or more."""
    rates: int
    """Samples with a gyroscope."""
    rate: float
    """Mean square of |gyro|, (rad/s)^2."""
    gyro_bins: tuple[int, ...]
    tracked: bool
    climb: float
    """Largest velocity upwards, m/s,"""
    sink: float
    """downwards, negative,"""
    speed: float
    """and in all."""


@define
class BlockStride:
    """What counts of a step: times in s, lengths in m, m/s, rad."""

    start: float
    end: float
    length: float
    rise: float
    clearance: float
    speed: float
    pitch: float
    top: float
    """Highest above where it began,"""
    bottom: float
    """lowest,"""
    strike: float
    """and at heel-strike."""
