"""Events of present positions, for drawing: never final, and only on request."""

from __future__ import annotations

from ..types import Foot, Phase, Vec3
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class FootMoved(Happening):
    """The position of a foot after one sample; only from a session made with `poses=True`.

    Known with that sample. Live, so never final: the stride that it belongs to has the foot's final path. World frame,
    m and m/s."""

    foot: Foot
    position: Vec3
    """Position of the foot, world frame, m."""
    velocity: Vec3
    """Velocity of the foot, world frame, m/s."""
    phase: Phase
    """Phase of the foot."""
    final: bool = False


@frozen(kw_only=True)
class WearerMoved(Happening):
    """The position of the wearer after a stride, the same as `Session.position`; only with `poses=True`.

    `t` is the newest sample of either foot. Known once with each sample that ends a stride, after its StrideTaken.
    Live, so never final: later strides may move earlier positions as well. World frame."""

    position: Vec3
    """Position of the wearer, world frame, m."""
    covariance: tuple[float, float, float, float, float, float]
    """Covariance of `position`: xx, xy, xz, yy, yz, zz in m^2."""
    final: bool = False


@frozen(kw_only=True)
class FootPressed(Happening):
    """The values of an insole's cells in one sample; only from a session made with `pressures=True`.

    One for each sample with cells that can be used, from the first on, and known with it. Live, so never final."""

    foot: Foot
    values: tuple[float, ...]
    """Value of each cell, in the layout's order and the unit of the samples (N if a calibration turns counts into N).
    Its noise is subtracted and, once the foot has been in the air, its value there; 0 where a cell has failed."""
    force: float
    """Sum of `values`, in their unit."""
    centre: tuple[float, float] | None
    """Centre of pressure, the mean of the cells' places weighted by `values`, foot frame, m. None while there is hardly
    any load, and as long as neither the device nor a calibration has given the places of the cells (LayoutKnown)."""
    final: bool = False
