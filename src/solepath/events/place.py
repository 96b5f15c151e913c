"""Where on the floor plan the wearer is."""

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
    """Plan frame, m; z is the height above the plan's zero, or the track's own where the plan knows no heights."""
    heading: float | None
    """Of the track's x axis in the plan frame, counter-clockwise from the plan's x axis, rad; None while unknown."""
    weight: float
    """Share of the belief, 0 to 1; the weights of all candidates add up to 1."""
    origin: str
    """Name of the stairs, lift or start that it came from."""


@frozen(kw_only=True)
class Placed(Happening):
    """Where the wearer is on the plan after a step, or after stairs or a lift (Liu et al. 2015, IEEE MASS, section
    IV.E). Known with the StrideTaken, or the event that tells of the arrival; `t` is the newest sample then. Live:
    more steps may show that it was somewhere else."""

    level: str
    """Of the best candidate."""
    position: Vec3
    """Mean over the best candidate, plan frame, m."""
    spread: float
    """Root mean square distance of the whole belief from `position`, m."""
    candidates: tuple[Candidate, ...]
    """Heaviest first; one when it is decided."""
    final: bool = False


@frozen(kw_only=True)
class PlaceLost(Happening):
    """The plan is of no use from here on; the track goes on without it. `what` says why, in a sentence. Known with the
    sample or step that shows it; `t` is the newest sample then. A later Placed ends it."""

    what: str
