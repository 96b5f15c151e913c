"""Where things are at this moment, for whoever draws them: never final, and only for those who ask."""

from __future__ import annotations

from ..types import Foot, Phase, Vec3
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class FootMoved(Happening):
    """Where a foot is after one sample; only from a session made with `poses=True`.

    Known with that sample. Live, so never final: the step that it belongs to says where the foot really went. World
    frame, m and m/s.
    """

    foot: Foot
    position: Vec3
    velocity: Vec3
    phase: Phase
    final: bool = False


@frozen(kw_only=True)
class WearerMoved(Happening):
    """Where the wearer is after a step, the same as `Session.position` then; only from a session made with
    `poses=True`. `t` is the newest sample of either foot.

    Known once with each sample that ends a step, after its StrideTaken. Live, so never final: steps to come may move
    what is behind as well. World frame.
    """

    position: Vec3
    """m."""
    covariance: tuple[float, float, float, float, float, float]
    """Of `position`: xx, xy, xz, yy, yz, zz in m^2."""
    final: bool = False


@frozen(kw_only=True)
class FootPressed(Happening):
    """What the cells of an insole show in one sample; only from a session made with `pressures=True`.

    One for each sample with cells that can be used, from the first on, and known with it. Live, so never final.
    """

    foot: Foot
    values: tuple[float, ...]
    """Of each cell, in the layout's order and the unit of the samples (N by a calibration that turns counts into N):
    less its noise and, once the foot has been in the air, less what it shows there; 0 where a cell has failed."""
    force: float
    """The sum of `values`."""
    centre: tuple[float, float] | None
    """Centre of pressure, the mean of the cells' places weighted by `values`: foot frame, m. None while there is hardly
    any load, and as long as neither the device nor a calibration has said where the cells are (LayoutKnown)."""
    final: bool = False
