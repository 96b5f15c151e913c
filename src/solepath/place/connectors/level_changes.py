"""Changes of level on stairs and in elevators, as references (references.py) report them."""

from __future__ import annotations

from ...floorplan.plan import ConnectorKind
from ...types.attrs import frozen

SURE_CERTAINTY, FAIR_CERTAINTY, HALF_CERTAINTY, RIDE_CERTAINTY = 0.97, 0.9, 0.1, 0.99
"""Certainties of an arrival: the height fits a storey; it is large enough; it is about half a storey; it is a ride."""


@frozen
class LevelChangePossible:
    """The reference that the wearer may be on stairs or in an elevator from `t`, s, on."""

    kind: ConnectorKind
    t: float


@frozen
class LevelChangeCancelled:
    """The reference that a possible change of level did not happen."""


@frozen
class LevelReached:
    """The reference that the wearer left stairs or an elevator on another level at `t`, s."""

    kind: ConnectorKind
    up: bool
    height: float | None
    """Height of the climb, m, not negative; None when it is not known."""
    t_start: float
    """Time at which the stairs or the elevator were entered, s."""
    t: float
    opposite_share: float = 0.0
    """Share of the strides that were reported in the other direction."""
    certainty: float = SURE_CERTAINTY
    """Probability that the wearer is on another level now; less than 1."""
    flights: int | None = None
    """Number of flights that were climbed; None when none was reported."""


@frozen
class DirectionRevised:
    """The reference that the newest stairs, which were left already, led in the other direction."""


Reference = LevelChangePossible | LevelChangeCancelled | LevelReached | DirectionRevised
