"""Many wearers on a stream engine: one pure step per wearer, whose state the engine keeps, moves and recovers.

    fleet = Fleet(recipes.DEFAULT)
    state, told = fleet.step("w-17", None, [Sent("w-17", 0, packet), ...])

protocol/fleet.md says what a phone sends, in what order it is used, and what a state holds.
"""

from ..events.fleet import FleetEvent, NumbersMissing, Refusal, SentRejected, StateRefused, WearerFailed
from .fleet import Fleet
from .rows import SENT_COLUMNS, TOLD_COLUMNS, read_line, read_sent, sent_line, sent_row, told_row
from .step.keyed import Keyed
from .step.once import Once
from .step.sent import End, NumberedEvent, Sent, Tick, Unreadable

__all__ = [
    "SENT_COLUMNS",
    "TOLD_COLUMNS",
    "End",
    "Fleet",
    "FleetEvent",
    "Keyed",
    "NumbersMissing",
    "Once",
    "Refusal",
    "Sent",
    "SentRejected",
    "StateRefused",
    "Tick",
    "NumberedEvent",
    "Unreadable",
    "WearerFailed",
    "read_line",
    "read_sent",
    "sent_line",
    "sent_row",
    "told_row",
]
