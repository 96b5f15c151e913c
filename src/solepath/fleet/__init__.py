"""Many wearers on a stream engine: one pure step per wearer, whose state the engine keeps, moves and recovers.

    fleet = Fleet(recipes.DEFAULT)
    state, events = fleet.step("w-17", None, [Sent("w-17", 0, packet), ...])

protocol/fleet.md says what a phone sends, in what order it is used, and what a state holds."""

from ..events.fleet import FleetEvent, NumbersMissing, SentRejected, SentRejection, StateRejected, WearerFailed
from .fleet import Fleet
from .rows import EVENT_COLUMNS, SENT_COLUMNS, event_row, read_line, read_sent, sent_line, sent_row
from .step.keyed import Keyed
from .step.once import Once
from .step.sent import End, NumberedEvent, Sent, Tick, Unreadable

__all__ = [
    "SENT_COLUMNS",
    "EVENT_COLUMNS",
    "End",
    "Fleet",
    "FleetEvent",
    "Keyed",
    "NumbersMissing",
    "Once",
    "SentRejection",
    "Sent",
    "SentRejected",
    "StateRejected",
    "Tick",
    "NumberedEvent",
    "Unreadable",
    "WearerFailed",
    "read_line",
    "read_sent",
    "sent_line",
    "sent_row",
    "event_row",
]
