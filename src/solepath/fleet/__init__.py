"""Processing of many wearers on a stream engine, which stores, moves and recovers the state of each wearer.

    fleet = Fleet(recipes.DEFAULT)
    state, events = fleet.step("w-17", None, [Sent("w-17", 0, packet), ...])

protocol/fleet.md describes the rows that a phone sends, the order in which they are used, and the state."""

from .events import FleetEvent, NumbersMissing, SentRejected, SentRejection, StateRejected, WearerFailed
from .fleet import Fleet
from .rows import EVENT_COLUMNS, SENT_COLUMNS, event_row, read_line, read_message, read_sent, sent_line, sent_row
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
    "read_message",
    "read_sent",
    "sent_line",
    "sent_row",
    "event_row",
]
