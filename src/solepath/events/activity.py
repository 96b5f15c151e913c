"""Events of the wearer's activity: activities, lift rides, flights of stairs, turns."""

from __future__ import annotations

from ..types import Activity, Turn
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class ActivityChanged(Happening):
    """The wearer does `activity` from `t` on, by the recipe's activity part.

    An event that is not final may be replaced by a later one, which names it in `revises`; a final one never is. The
    wearer's activity at some time is that of the last event with `t` up to then, without those that were replaced.

    Latency of the default: reported 1 to 1.5 s after `t`, final mostly seconds later; standing that may be a ride in a
    lift stays open for up to a minute. Other recipes: see the docstrings of their parts."""

    activity: Activity
    """The new activity."""
    probability: float | None
    """Probability of the activity against all others when it was reported; None where a method has no probabilities."""
    revises: float | None = None
    """`t` of the event that this one replaces, with all that came after it, s; None when it replaces none."""


@frozen(kw_only=True)
class LiftRidden(Happening):
    """A ride in a lift ended; `t` is when the lift came to rest.

    Known with the default once it is settled that this was its end, mostly seconds after `t` and up to 12 s; with
    `footstep-tracker` as soon as the jolt of its braking is over. Final."""

    t_start: float
    """Start of the ride, s."""
    up: bool
    """True for a ride upwards."""
    height: float | None
    """Height of the ride, m, positive upwards; None when it cannot be measured."""


@frozen(kw_only=True)
class FlightClimbed(Happening):
    """A flight of stairs was climbed or descended; `t` is the end of its last stride.

    Known when as many level strides as there are feet with data have followed it, about a second after `t`, with the
    first stride the other way, or when both feet have stood at one height for 3 s; where activities are reported later
    than strides (the default: by 1 to 1.5 s), as much later. Final."""

    t_start: float
    """Start of its first stride, s."""
    up: bool
    """True for a flight upwards."""
    steps: int
    """Number of strides of all feet with data."""
    height: float
    """Height of the flight by the wearer's own track, m, positive upwards."""


@frozen(kw_only=True)
class TurnMade(Happening):
    """The wearer turned, over one stride or several in a row; `t` is the end of the last of them.

    Source: Liu et al. 2015, IEEE MASS, section IV.D. Known when the feet have gone straight on for three strides (two
    where only one foot has data), or when no foot has touched down for 2 to 4 s. Final."""

    t_start: float
    """Start of the first stride, s."""
    angle: float
    """Angle of the turn, counter-clockwise positive, rad; more than pi for a longer turn."""
    turn: Turn | None
    """Class of the turn; None for a bend that is too slight for one."""
