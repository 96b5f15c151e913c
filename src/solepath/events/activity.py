"""Events of the wearer's activity: activities, elevator rides, flights of stairs, turns."""

from __future__ import annotations

from ..types import Activity, Turn
from ..types.attrs import frozen
from .happening import BaseEvent


@frozen(kw_only=True)
class ActivityChanged(BaseEvent):
    """The wearer's activity is `activity` from `t` on, as the recipe's activity part reports it.

    An event that is not final may be replaced by a later event, which names it in `revises`. The activity at a time is
    that of the newest event with `t` at or before it, leaving out replaced events.

    The default recipe reports an activity up to half a second after it shows, an elevator at its first pulse. It is
    confirmed or revised 1 to 1.5 s after `t` and becomes final mostly some seconds later; standing that may be an
    elevator ride becomes final after up to a minute. Parts of other recipes state their own latency."""

    activity: Activity
    """The new activity."""
    probability: float | None
    """Probability of the activity when it was reported, 0 to 1; None for a method without probabilities."""
    revises: float | None = None
    """Time `t` of the event that this event replaces, with all events after it, s; None when it replaces none."""


@frozen(kw_only=True)
class LiftRidden(BaseEvent):
    """An elevator ride ended; `t` is the time at which the elevator stopped.

    The default recipe reports it when the end is certain: mostly some seconds after `t`, at most 12 s. The recipe
    `footstep-tracker` reports it as soon as the acceleration of the braking is over. The event is final."""

    t_start: float
    """Start of the ride, s."""
    up: bool
    """True for a ride upwards."""
    height: float | None
    """Height of the ride, m, positive upwards; None when it cannot be measured."""


@frozen(kw_only=True)
class EscalatorRidden(BaseEvent):
    """The wearer has stood on an escalator; `t` is the time at which its steps stopped rising or falling.

    The wearer stands meanwhile, so the activity is STANDING. The default recipe alone reports it, with the latency of
    `LiftRidden`. A wearer who walks on an escalator climbs flights (`FlightClimbed`). The event is final."""

    t_start: float
    """Time at which the steps began to rise or to fall, s."""
    up: bool
    """True for a ride upwards."""
    height: float | None
    """Height of the ride, m, positive upwards; None when it cannot be measured."""


Ride = LiftRidden | EscalatorRidden
"""A ride on ground that rises or falls under the standing wearer."""


@frozen(kw_only=True)
class FlightClimbed(BaseEvent):
    """A flight of stairs was climbed or descended; `t` is the end of its last stride.

    It is reported after as many level strides as there are feet with data (about 1 s after `t`), after the first stride
    in the other vertical direction, or when both feet have stood at one height for 3 s. If the recipe reports
    activities later than strides (by 1 to 1.5 s in the default), it is reported that much later. The event is final."""

    t_start: float
    """Start of the flight's first stride, s."""
    up: bool
    """True for a flight upwards."""
    steps: int
    """Number of strides on the flight, counted over all feet that have data."""
    height: float
    """Height of the flight as the feet's tracks measure it, m, positive upwards."""


@frozen(kw_only=True)
class TurnMade(BaseEvent):
    """The wearer turned during one stride or several strides in a row; `t` is the end of the last of them.

    Source: Liu et al. 2015, IEEE MASS, section IV.D. It is reported after three straight strides (two if only one foot
    has data), or when no foot has touched down for 2 to 4 s. The event is final."""

    t_start: float
    """Start of the first stride, s."""
    angle: float
    """Angle of the turn about the vertical, counter-clockwise positive, rad; it may be larger than pi."""
    turn: Turn | None
    """Class of the turn; None for a turn that is too slight for any class."""
