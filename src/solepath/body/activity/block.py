"""Records of a block (half a second) of one foot, and of a stride."""

from __future__ import annotations

from ...types.attrs import define


@define
class ActivityBlock:
    """Statistics of the samples of one foot in one block."""

    index: int
    """Number of the block."""
    count: int
    """Number of samples."""
    force: float
    """Mean |acc|, the length of the specific force, m/s^2."""
    variance: float
    """Variance of |acc|, (m/s^2)^2."""
    acc_bins: tuple[int, ...]
    """Number of samples in each bin of |acc|, at most 255 each (features.py has the bins)."""
    gyro_count: int
    """Number of samples with a gyroscope."""
    gyro_mean_square: float
    """Mean square of |gyro|, (rad/s)^2."""
    gyro_bins: tuple[int, ...]
    """Number of samples in each bin of |gyro|, at most 255 each."""
    tracked: bool
    """Flag: velocity and position of the foot are known."""
    climb: float
    """Largest upward velocity, m/s."""
    sink: float
    """Largest downward velocity, m/s, negative."""
    speed: float
    """Largest horizontal speed, m/s."""


@define
class BlockStride:
    """A stride of one foot, as the activity features need it: times in s, lengths in m."""

    start: float
    end: float
    length: float
    rise: float
    """Height change, m."""
    clearance: float
    speed: float
    """Peak speed, m/s."""
    pitch: float
    """Pitch of the swing, rad."""
    top: float
    """Greatest height in the stride above its start, m."""
    bottom: float
    """Lowest height in the stride above its start, m; 0 or negative."""
    strike_height: float
    """Height at heel-strike above the start of the stride, m."""
