"""Where the wearer is, of both feet."""

from __future__ import annotations

from collections.abc import Iterable

from attrs import frozen

from ..foot.tracker import FootTracker
from ..foot.world import Covariance3
from ..types import Vec3


@frozen
class Position:
    """Where the wearer is: world frame, m, with covariance xx, xy, xz, yy, yz, zz in m^2, at `t` s."""

    t: float
    position: Vec3
    covariance: Covariance3


def mean_of(feet: Iterable[FootTracker]) -> Position | None:
    """The mean of the feet that were heard of, each in the world frame of its own first heading; None of none."""
    known = [foot for foot in feet if foot.t is not None]
    if not known:
        return None
    k = 1.0 / len(known)
    x, y, z = (sum([foot.position[axis] for foot in known]) * k for axis in range(3))
    covariances = [foot.covariance for foot in known]
    xx, xy, xz, yy, yz, zz = (sum([c[i] for c in covariances]) * k * k for i in range(6))
    t = max([foot.t for foot in known if foot.t is not None])
    return Position(t, (x, y, z), (xx, xy, xz, yy, yz, zz))
