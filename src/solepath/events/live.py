"""Events of the newest positions and pressures for live display; they are never final, and emitted only on request."""

from __future__ import annotations

from ..types import Floats, Foot, Phase, Vec2, Vec3
from ..types.attrs import frozen
from .happening import BaseEvent


@frozen(kw_only=True)
class FootMoved(BaseEvent):
    """The position of a foot after one sample, reported with that sample; only from a session with `poses=True`.

    It is never final: the StrideTaken of the stride has the foot's final displacement."""

    foot: Foot
    position: Vec3
    """Position of the foot, world frame, m."""
    velocity: Vec3
    """Velocity of the foot, world frame, m/s."""
    phase: Phase
    """Phase of the foot."""
    final: bool = False


@frozen(kw_only=True)
class WearerMoved(BaseEvent):
    """The position of the wearer after a stride, as in `Session.position`; only from a session with `poses=True`.

    `t` is the newest sample of either foot. It is reported once for each sample that ends a stride, after the
    StrideTaken. It is never final, because later strides may move earlier positions as well."""

    position: Vec3
    """Position of the wearer, world frame, m."""
    covariance: tuple[float, float, float, float, float, float]
    """Covariance of `position`: xx, xy, xz, yy, yz, zz, m^2."""
    heading_sigma: float | None = None
    """Standard deviation of the angle by which the whole track may be turned, rad; None if it is not known."""
    north: tuple[float, float] | None = None
    """Direction of magnetic north in the world frame and its standard deviation, rad; None if it is not known."""
    final: bool = False


@frozen(kw_only=True)
class FootPressed(BaseEvent):
    """The values of an insole's cells in one sample; only from a session with `pressures=True`.

    It is reported with every sample that has usable cells. It is never final."""

    foot: Foot
    values: Floats
    """Value of each cell in the layout's order, in the unit of the samples (N if a calibration converts counts to N).
    The cell's noise is subtracted, and after the first swing also its tare. A failed cell has 0."""
    force: float
    """Sum of `values`, in their unit (N or counts)."""
    centre: Vec2 | None
    """Centre of pressure: mean position of the cells weighted by `values`, foot frame, m. None while there is hardly
    any load, and while the positions of the cells are not known from the device or a calibration (LayoutKnown)."""
    final: bool = False
