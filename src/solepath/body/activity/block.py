"""Records of half a second of one foot, and of a stride."""

from __future__ import annotations

from ...types.attrs import define


@define
class ActivityBlock:
    """Means and shares over the samples of one block."""

    index: int
    """Number of the block."""
    count: int
    """Number of samples."""
    force: float
    """Mean |acc|, m/s^2."""
    variance: float
    """Variance of |acc|, (m/s^2)^2."""
    acc_bins: tuple[int, ...]
    """Number of samples in each bin of |acc|, limited to 255."""
    rates: int
    """Number of samples with a gyroscope."""
    rate: float
    """Mean square of |gyro|, (rad/s)^2."""
    gyro_bins: tuple[int, ...]
    """Number of samples in each bin of |gyro|, limited to 255."""
    tracked: bool
    """Flag: the foot has a track."""
    climb: float
    """Largest upward velocity, m/s."""
    sink: float
    """Largest downward velocity, m/s, negative."""
    speed: float
    """Largest horizontal speed, m/s."""


@define
class BlockStride:
    """The features of a stride: times in s, lengths in m, speed in m/s, pitch in rad."""

    start: float
    end: float
    length: float
    rise: float
    """Height change, m."""
    clearance: float
    speed: float
    pitch: float
    """Pitch of the swing, rad."""
    top: float
    """Greatest height above the start of the stride, m."""
    bottom: float
    """Lowest height above the start of the stride, m."""
    strike: float
    """Height at heel-strike above the start of the stride, m."""
