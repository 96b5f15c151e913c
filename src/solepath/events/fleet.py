"""What the keyed step of a fleet says of a wearer beside what the session says: no session can know it.

They stand apart from `solepath.Event`, since an app with one session never sees them. Their time is that of the newest
packet that was used before, 0 before any.
"""

from __future__ import annotations

from enum import Enum

from ..types.attrs import frozen
from .happening import Happening


class SentRejection(Enum):
    """Why something that was sent is not used."""

    UNREADABLE = "unreadable"
    """Its row is none of protocol/fleet.md."""
    NOT_SENT = "not sent"
    """No Sent, of another wearer, or with a number or a run that cannot be."""
    MALFORMED = "malformed"
    """What was sent has a field of another kind than it must be."""
    OVERSIZED = "oversized"
    NOT_FINITE = "not finite"
    LATE = "late"
    """Its number was given up before it came, or its run was left."""
    AFTER_END = "after the end"


@frozen(kw_only=True)
class StateRejected(Happening):
    """The state of a wearer cannot go on: it is damaged, of a release to come, of another recipe or floor plan. A fresh
    session follows. Known with the first thing that is sent after it."""

    detail: str


@frozen(kw_only=True)
class NumbersMissing(Happening):
    """What was sent under these numbers never came; it is waited for no longer. Known when too much waits behind it."""

    run: int
    """Of the phone, which counts from 0 in each."""
    first: int
    """The first number that is missing."""
    count: int
    """How many are, at least 1."""


@frozen(kw_only=True)
class SentRejected(Happening):
    """Something that was sent is not used; it changed nothing. Known in its turn, or as soon as it comes where it has
    none. What a packet's own format forbids is a PacketRejected."""

    reason: SentRejection
    run: int | None = None
    """Of the phone; None where that cannot be read."""
    number: int | None = None
    """Which of the run it is; None where that cannot be read."""
    detail: str = ""
    count: int = 1
    """LATE and AFTER_END: so many came of this run, this one among them. The first, the second, the fourth, the eighth
    are told, and so on, until something of another run is late; 1 for all others."""


@frozen(kw_only=True)
class WearerFailed(Happening):
    """A reader or a detector of the app's own raised an exception, or held what cannot be saved when a state was taken.
    This wearer begins afresh; no other notices. Known with the packet that did it, or the first after the state."""

    detail: str


FleetEvent = StateRejected | NumbersMissing | SentRejected | WearerFailed
"""All of them."""
