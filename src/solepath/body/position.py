"""Where the wearer is, of both feet."""

from __future__ import annotations

from collections.abc import Mapping

from attrs import define, frozen

from ..events import Event
from ..foot.tracker import FootTracker
from ..foot.world import Covariance3
from ..types import Foot, Sample, Site, Vec3


@frozen
class Position:
    """Where the wearer is: world frame, m, with covariance xx, xy, xz, yy, yz, zz in m^2, at `t` s."""

    t: float
    position: Vec3
    covariance: Covariance3


@define
class MeanOfFeet:
    """The mean of the feet that were heard of, each in the world frame of its own first heading."""

    @property
    def sites(self) -> tuple[Site, ...]:
        """None: it takes feet only."""
        return ()

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """Nothing follows."""
        return []

    def limb_moved(self, sample: Sample) -> list[Event]:
        """Never called: it has no such sites."""
        return []

    def interrupt(self, site: Site) -> None:
        """Nothing is kept here."""

    def position(self, feet: Mapping[Foot, FootTracker]) -> Position | None:
        """None before any sample."""
        known = [foot for foot in feet.values() if foot.t is not None]
        if not known:
            return None
        k = 1.0 / len(known)
        x, y, z = (sum([foot.position[axis] for foot in known]) * k for axis in range(3))
        covariances = [foot.covariance for foot in known]
        xx, xy, xz, yy, yz, zz = (sum([c[i] for c in covariances]) * k * k for i in range(6))
        t = max([foot.t for foot in known if foot.t is not None])
        return Position(t, (x, y, z), (xx, xy, xz, yy, yz, zz))
