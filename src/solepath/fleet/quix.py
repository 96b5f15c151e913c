"""A fleet on Quix Streams, for users of Kafka: one stateful step of a StreamingDataFrame. Needs the extra `quix`.

    app = Application("kafka:9092", consumer_group="gait", auto_offset_reset="earliest")
    sent = app.topic("sent", value_deserializer="bytes")                 # keyed by wearer; lines of `sent_line`
    events = app.topic("events", key_serializer="str")
    gait(app.dataframe(sent), Fleet(recipe)).to_topic(events, key=lambda row: row["wearer"])
    app.run()

A job that is killed at any moment and started again continues at the last commit and delivers later events again. So
delivery is at least once; a repeated event has the same bytes and the same (wearer, number). A program that consumes
the topic detects repeated events with `Once`."""

from __future__ import annotations

from typing import Any

from attrs import frozen
from quixstreams import State, message_context
from quixstreams.dataframe import StreamingDataFrame
from quixstreams.models.serializers.simple_types import BytesDeserializer

from .events import SentRejected, SentRejection
from .fleet import Fleet
from .rows import event_row, read_message
from .step.sent import MAX_NAME_LENGTH, NumberedEvent

UNKEYED = "unkeyed/"
"""Prefix of the wearer's name in events about messages whose key is no wearer's name.

The partition's number follows the prefix. The event's number is the message's offset."""
_NO_KEY = SentRejected(
    t=0.0, known_at=0.0, reason=SentRejection.UNREADABLE, detail="a message whose key is no wearer's name"
)


def gait(frame: StreamingDataFrame, fleet: Fleet) -> StreamingDataFrame:
    """Return the events of a fleet's sessions for the rows that phones sent, one message (`event_row`) for each event.

    `frame` is of a topic of bytes whose key is the wearer's name in UTF-8, 1 to 256 characters. A message holds one or
    more whole lines of `sent_line`; more lines cost less per line. A message that cannot be read, or has no such key,
    is reported as an event. The state of a wearer (Fleet.step) is one value in the frame's store. Raises ValueError
    when the topic's values are not left as bytes, since a value that is not JSON would stop the application."""
    for topic in frame.topics:
        if not isinstance(getattr(topic, "_value_deserializer", None), BytesDeserializer):
            raise ValueError(f'topic {topic.name!r} must be made with value_deserializer="bytes"')
    events = frame.apply(_GaitStep(fleet), stateful=True, expand=True, metadata=True)
    return events.set_headers(lambda *_: [])  # the headers of the input may be as long as a message can be


@frozen
class _GaitStep:
    """The stateful step."""

    fleet: Fleet

    def __call__(self, value: Any, key: Any, _t: int, _headers: Any, state: State[str, bytes]) -> list[dict[str, Any]]:
        wearer = _parse_wearer(key)
        if wearer is None:  # without a state: its key in the changelog would be this key, however long
            context = message_context()
            return [event_row(NumberedEvent(f"{UNKEYED}{context.partition}", context.offset, _NO_KEY))]
        old_state = state.get_bytes("state")
        new_state, events = self.fleet.step(wearer, old_state, read_message(wearer, value))
        if new_state != old_state:
            state.set_bytes("state", new_state)
        return [event_row(event) for event in events]


def _parse_wearer(key: Any) -> str | None:
    try:
        name = key.decode() if isinstance(key, bytes) else key
    except UnicodeDecodeError:
        return None
    return name if isinstance(name, str) and 0 < len(name) <= MAX_NAME_LENGTH and not name.startswith(UNKEYED) else None
