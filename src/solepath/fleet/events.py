"""Events of a fleet, which runs one session per wearer on items that phones send (protocol/fleet.md).

They are not part of `solepath.Event`, because a session never reports them. An item is one Sent: a packet, a tick or an
end, with its wearer, the run of the phone's app and a number that counts the items of that run from 0. The time of an
event is the time of the newest packet used before it; 0 before any packet."""

from __future__ import annotations

from enum import Enum

from ..events.happening import BaseEvent
from ..types.attrs import frozen


class SentRejection(Enum):
    """Reason why an item is not used."""

    UNREADABLE = "unreadable"
    """The row does not follow protocol/fleet.md."""
    NOT_SENT = "not sent"
    """The item is not an object of the class Sent, is of another wearer, or has an impossible number or run."""
    MALFORMED = "malformed"
    """The item has a field of a wrong type."""
    OVERSIZED = "oversized"
    NOT_FINITE = "not finite"
    LATE = "late"
    """The item came after its number was reported missing, or after an item of a later run was used."""
    AFTER_END = "after the end"


@frozen(kw_only=True)
class StateRejected(BaseEvent):
    """The saved state of a wearer cannot be used, so a fresh session starts.

    The state is damaged, or was saved by a later release, or with another recipe or floor plan. The event is reported
    with the first item that comes after the state."""

    detail: str
    """Reason in words."""


@frozen(kw_only=True)
class NumbersMissing(BaseEvent):
    """Items with these numbers never came; it is reported when too many later items wait for them."""

    run: int
    """Run of the phone's app; numbers count from 0 in each run."""
    first: int
    """First number that is missing."""
    count: int
    """Number of missing items, at least 1."""


@frozen(kw_only=True)
class SentRejected(BaseEvent):
    """An item is not used, and changed nothing.

    It is reported in the order of the items' numbers, or at once for an item without a usable number. A packet that
    does not fit its format is reported as PacketRejected instead."""

    reason: SentRejection
    """Kind of fault."""
    run: int | None = None
    """Run of the phone's app; None when it cannot be read."""
    number: int | None = None
    """Number of the item in its run; None when it cannot be read."""
    detail: str = ""
    """Reason in words."""
    count: int = 1
    """Number of items of this run that were rejected as LATE or AFTER_END so far, with this one; 1 for other reasons.
    Only the counts 1, 2, 4, 8 and so on are reported, until an item of another run is late."""


@frozen(kw_only=True)
class WearerFailed(BaseEvent):
    """A reader or a detector of the app raised an exception, or held data that cannot be saved.

    A fresh session starts for this wearer; other wearers are not affected. It is reported with the packet that caused
    it, or with the first packet after the state was taken."""

    detail: str
    """Description of the failure."""


FleetEvent = StateRejected | NumbersMissing | SentRejected | WearerFailed
"""Any event of a fleet."""
