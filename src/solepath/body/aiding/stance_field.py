"""The magnetic field that one foot measures while it stands, when neither timing nor rotation blurs it."""

from __future__ import annotations

from typing import NamedTuple

from ...foot.view import FootView
from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, heading_turned, rotate

MICRO = 1e6
"""Microteslas of a tesla, as everything in this room is in microteslas."""
ABSURD_FLUX = 1e4
"""Largest flux density, uT, two hundred times that of the earth; more is no number or another unit."""


class StanceFlux(NamedTuple):
    """The magnetic flux density of one stance."""

    flux: Vec3
    """Mean flux density, world frame of the foot, uT."""
    yaw: float
    """Angle about the vertical by which the foot is turned against its first stance, rad."""


@define
class StanceField:
    """The samples of the newest stance of one foot."""

    count: int = field(default=0, init=False)
    sum: Vec3 = field(default=ZERO, init=False)
    """Sum of the flux densities, navigation frame, uT."""
    attitude: Quat | None = field(default=None, init=False)
    """Attitude at the newest of them, sensor to navigation frame; None before any."""
    north: tuple[float, float] = field(default=(1.0, 0.0), init=False)
    """Cosine and sine of the angle from navigation to world frame."""
    first: Quat | None = field(default=None, init=False)
    """Attitude in the first stance; None before any."""

    def add_sample(self, view: FootView, mag: Vec3) -> None:
        """Add a sample of a foot that stands, with the flux density `mag`, T, sensor frame."""
        x, y, z = mag
        x, y, z = rotate(view.attitude, (MICRO * x, MICRO * y, MICRO * z))
        if not x * x + y * y + z * z < ABSURD_FLUX * ABSURD_FLUX:
            x, y, z = ABSURD_FLUX, 0.0, 0.0
        sx, sy, sz = self.sum
        if view.north is not None:
            self.north = view.north
        self.count, self.sum, self.attitude = self.count + 1, (sx + x, sy + y, sz + z), view.attitude

    def take(self) -> StanceFlux | None:
        """Return the stance that has ended and forget its samples; None if it had none."""
        if not self.count or self.attitude is None:
            return None
        k, (x, y, z), (c, s) = 1.0 / self.count, self.sum, self.north
        if self.first is None:
            self.first = self.attitude
        self.count, self.sum = 0, ZERO
        flux = (k * (c * x - s * y), k * (s * x + c * y), k * z)
        return StanceFlux(flux, heading_turned(self.first, self.attitude))
