"""Events of the wearer's place, which is level and position on a floor plan.

Plan frame: x and y in the plan's plane, z up, right handed, m (protocol/floorplan.md)."""

from __future__ import annotations

from math import fsum

from ..types import Vec3
from ..types.attrs import frozen
from .happening import BaseEvent


@frozen
class Candidate:
    """One place at which the wearer may be."""

    level: str
    """Level of the candidate, a `Level.id` of the plan."""
    position: Vec3
    """Position in the plan frame, m; z is the height above the plan's zero, or if unknown, the track's z."""
    heading: float | None
    """Turn of the track's frame on the plan, not the direction in which the wearer walks: the direction of the track's
    x axis (its first heading) in the plan frame, rad, counter-clockwise from the plan's x axis; None while it is
    unknown, as without a first heading until walls have shown it. The wearer walks in this direction plus that of the
    newest StrideTaken's `displacement`."""
    weight: float
    """Probability of the candidate, 0 to 1; the weights of all candidates add up to 1."""
    origin: str
    """Name of the stairs, elevator or start position from which the candidate was derived."""


DECIDED_WEIGHT = 0.995
"""Least weight with which the heaviest candidate is the place: unlikely ones would make a mark flicker."""


@frozen(kw_only=True)
class Placed(BaseEvent):
    """The wearer's place on the plan after a stride, or on arrival by stairs or elevator.

    Source: Liu et al. 2015, IEEE MASS, section IV.E. It is reported with the StrideTaken, or with the event of the
    arrival. `t` is the newest sample at that moment. It is never final: later strides may show another place."""

    level: str
    """Level of the best candidate."""
    position: Vec3
    """Mean position of the best candidate, plan frame, m."""
    room: str | None = None
    """Name of the room at `position`; None outside of all named rooms, and on a level without names of rooms."""
    door: str | None = None
    """Name of the nearest door within 1.5 m of `position` that has one and is not behind a wall; None without one."""
    spread: float
    """Root mean square distance from `position`, weighted by the probability of all candidates, m."""
    candidates: tuple[Candidate, ...]
    """Candidates, the most probable first; one candidate when the place is certain."""
    final: bool = False

    @property
    def decided(self) -> bool:
        """True when one candidate has 99.5 % of the weight, so that level, position and room are the wearer's."""
        return any([candidate.weight >= DECIDED_WEIGHT for candidate in self.candidates])

    @property
    def level_decided(self) -> bool:
        """True when the candidates on `level` together have 99.5 % of the weight, so that the level is the wearer's."""
        return fsum([one.weight for one in self.candidates if one.level == self.level]) >= DECIDED_WEIGHT


@frozen(kw_only=True)
class PlanContradicted(BaseEvent):
    """A heading that was given or is the compass's, or the height of a ride, does not fit the plan; the place goes on.

    `t` is the newest sample, or the end of the ride. It is reported with the stride after which no candidate has the
    heading, or with the ride. From then on the heading is not used, and the candidates stay where they were as well as
    at the nearest landing."""

    what: str
    """Sentences for the person who gave the heading, or who maintains the plan."""
    heading_off: float | None = None
    """Angle to add to the heading that was given or to that by the compass, rad, counter-clockwise; None for a ride."""
    height_off: float | None = None
    """Height of the ride minus that of the nearest one which the plan allows, m, both without sign; None if no lift
    leads in its direction, and for a heading."""


@frozen(kw_only=True)
class PlaceLost(BaseEvent):
    """The place on the plan is unknown from `t` on, until a later Placed; the track continues without the plan.

    It is reported with the sample or stride that shows it. `t` is the newest sample at that moment."""

    what: str
    """Reason in one sentence."""
