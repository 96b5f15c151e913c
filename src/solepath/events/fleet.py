"""Events that the keyed step of a fleet reports beside those of the session, which cannot know them.

They are not part of `solepath.Event`, since an app with one session never sees them. Their time is that of the newest
packet that was used before, 0 before any."""

from __future__ import annotations

from enum import Enum

from ..types.attrs import frozen
from .happening import Happening


class SentRejection(Enum):
    """Reason why an item that was sent is not used."""

    UNREADABLE = "unreadable"
    """The row does not follow protocol/fleet.md."""
    NOT_SENT = "not sent"
    """The item is no Sent, is of another wearer, or has an impossible number or run."""
    MALFORMED = "malformed"
    """The item has a field of a wrong type."""
    OVERSIZED = "oversized"
    NOT_FINITE = "not finite"
    LATE = "late"
    """The number was given up before the item came, or its run was left."""
    AFTER_END = "after the end"


@frozen(kw_only=True)
class StateRejected(Happening):
    """The state of a wearer cannot be used: it is damaged, of a later release, of another recipe or floor plan.

    A fresh session follows. Known with the first item that is sent after it."""

    detail: str
    """Reason in words."""


@frozen(kw_only=True)
class NumbersMissing(Happening):
    """Items with these numbers never came and are no longer waited for. Known when too much waits behind them."""

    run: int
    """Run of the phone, which counts from 0 in each."""
    first: int
    """First number that is missing."""
    count: int
    """Number of missing items, at least 1."""


@frozen(kw_only=True)
class SentRejected(Happening):
    """An item that was sent is not used; it changed nothing.

    Known in its turn, or as soon as it comes where it has none. A packet that its own format forbids is a
    PacketRejected."""

    reason: SentRejection
    """Reason in one word."""
    run: int | None = None
    """Run of the phone; None where it cannot be read."""
    number: int | None = None
    """Number of the item in its run; None where it cannot be read."""
    detail: str = ""
    """Reason in words."""
    count: int = 1
    """Number of items of this run rejected as LATE or AFTER_END so far, with this one; 1 for other reasons. The first,
    the second, the fourth, the eighth are reported, and so on, until an item of another run is late."""


@frozen(kw_only=True)
class WearerFailed(Happening):
    """A reader or a detector of the app raised an exception, or held data that could not be saved.

    This wearer restarts with a fresh session; no other wearer is affected. Known with the packet that caused it, or the
    first after the state was taken."""

    detail: str
    """Description of the failure."""


FleetEvent = StateRejected | NumbersMissing | SentRejected | WearerFailed
"""Any event of a fleet."""
