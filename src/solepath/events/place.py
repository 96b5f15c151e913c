"""Events of the wearer's place on the floor plan."""

from __future__ import annotations

from ..types import Vec3
from ..types.attrs import frozen
from .happening import Happening


@frozen
class Candidate:
    """One place at which the wearer may be."""

    level: str
    """Level.id of the plan."""
    position: Vec3
    """Position in the plan frame, m; z is the height above the plan's zero, or the track's own if that is unknown."""
    heading: float | None
    """Direction of the track's x axis in the plan frame, rad; None while unknown. Counter-clockwise from the plan's x
    axis."""
    weight: float
    """Share of the probability, 0 to 1; the weights of all candidates add up to 1."""
    origin: str
    """Name of the stairs, lift or start that it came from."""


@frozen(kw_only=True)
class Placed(Happening):
    """The wearer's place on the plan after a stride, or after stairs or a lift.

    Source: Liu et al. 2015, IEEE MASS, section IV.E. Known with the StrideTaken, or the event that reports the arrival;
    `t` is the newest sample then. Live: later strides may show another place."""

    level: str
    """Level of the best candidate."""
    position: Vec3
    """Mean of the best candidate, plan frame, m."""
    spread: float
    """Root mean square distance of all candidates' probability from `position`, m."""
    candidates: tuple[Candidate, ...]
    """Candidates, the heaviest first; only one when the place is certain."""
    final: bool = False


@frozen(kw_only=True)
class PlaceLost(Happening):
    """The place on the plan is unknown from here on; the track goes on without the plan.

    Known with the sample or stride that shows it; `t` is the newest sample then. A later Placed ends it."""

    what: str
    """Reason in one sentence."""
