"""What the wearer does: activities, lift rides, flights of stairs, turns."""

from __future__ import annotations

from ..types import Activity, Turn
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class ActivityChanged(Happening):
    """From `t` on the wearer does `activity`, as the recipe's part for that has it.

    One that is not final may be replaced by a later one, which names it in `revises`; a final one never is. What the
    wearer did at some time is the activity of the last event with `t` up to then, without those that were replaced.

    Latency of the default: told 1 to 1.5 s after `t`, final mostly seconds later; standing that may be a ride in a lift
    stays open for up to a minute. Other recipes: the docstrings of their parts say it.
    """

    activity: Activity
    probability: float | None
    """Of the activity as against all others, when it was told; None where a method knows no probabilities."""
    revises: float | None = None
    """`t` of the event that this one replaces, s, with all that came after it; None when it replaces none."""


@frozen(kw_only=True)
class LiftRidden(Happening):
    """A ride in a lift has ended; `t` is when the lift came to rest.

    Known with the default once it is settled that this was its end, mostly seconds after `t` and up to 12 s; with
    `footstep-tracker` as soon as the jolt of its braking is over. Final.
    """

    t_start: float
    """When it set off, s."""
    up: bool
    height: float | None
    """How far, m, positive upwards; None when it cannot be told."""


@frozen(kw_only=True)
class FlightClimbed(Happening):
    """A flight of stairs was climbed or descended; `t` is the end of its last step.

    Known when as many level strides as feet are heard have followed it, about a second after `t`, with the first stride
    the other way, or when both feet have stood at one height for 3 s; where activities are told later than steps (the
    default: by 1 to 1.5 s), as much later. Final.
    """

    t_start: float
    """The beginning of its first step, s."""
    up: bool
    steps: int
    """Strides of all feet that were heard."""
    height: float
    """By the wearer's own track, m, positive upwards."""


@frozen(kw_only=True)
class TurnMade(Happening):
    """The wearer has turned, over one step or several that follow each other; `t` is the end of the last of them (Liu
    et al. 2015, IEEE MASS, section IV.D).

    Known when the feet have gone straight on for three steps (two where one foot is heard), or when none has come down
    for 2 to 4 s. Final.
    """

    t_start: float
    """The beginning of the first, s."""
    angle: float
    """Counter-clockwise positive, rad; more than pi for one who turned further."""
    turn: Turn | None
    """None for a bend that is too slight to be one of them."""
