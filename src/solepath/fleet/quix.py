"""A fleet on Quix Streams, where there is Kafka already: one stateful step of anybody's StreamingDataFrame. Needs the
extra `quix`.

    app = Application("kafka:9092", consumer_group="gait", auto_offset_reset="earliest")
    sent = app.topic("sent", value_deserializer="bytes")                 # keyed by wearer; lines of `sent_line`
    told = app.topic("told", key_serializer="str")
    gait(app.dataframe(sent), Fleet(recipe)).to_topic(told, key=lambda row: row["wearer"])
    app.run()

Killed at any moment and started again, it goes on at the last commit, and delivers again what it told after that: at
least once, the same bytes under the same (wearer, number). Who reads the topic hears each event once with `Once`.
"""

from __future__ import annotations

from typing import Any

from quixstreams import State, message_context
from quixstreams.dataframe import StreamingDataFrame
from quixstreams.models.serializers.simple_types import BytesDeserializer

from ..events.fleet import SentRejected, SentRejection
from .fleet import Fleet
from .rows import event_row, read_line
from .step.keyed import Keyed
from .step.sent import LONGEST_NAME, NumberedEvent, Sent, Unreadable

MOST_LINES = 4096
"""Of one message; one that has more is refused whole, since every line that cannot be read is told of."""
UNKEYED = "unkeyed/"
"""With the number of the partition behind it: who is told of messages whose key is no wearer's name. The number of such
an event is the message's offset."""
_NO_KEY = SentRejected(
    t=0.0, known_at=0.0, reason=SentRejection.UNREADABLE, detail="a message whose key is no wearer's name"
)


def gait(frame: StreamingDataFrame, fleet: Fleet, keep: int = 256) -> StreamingDataFrame:
    """What the sessions of a fleet tell of what phones sent: of every event a message of its own, a `event_row`.

    `frame`: of a topic of bytes whose key is the wearer's name in UTF-8, 1 to 256 characters. A message holds one line
    of `sent_line` or several, whole: the more, the less it costs. What cannot be read, or has no such key, is an event
    as well and stops nothing. The state of a wearer is one value in the frame's store, that of Fleet.step. `keep`:
    sessions of so many wearers stay in memory too, which changes the speed and not a single event.
    ValueError when the topic's values are not left as bytes, since one that is no JSON would stop the application.
    """
    for topic in frame.topics:
        if not isinstance(getattr(topic, "_value_deserializer", None), BytesDeserializer):
            raise ValueError(f'topic {topic.name!r} must be made with value_deserializer="bytes"')
    told = frame.apply(_Sessions(fleet, keep), stateful=True, expand=True, metadata=True)
    return told.set_headers(lambda *_: [])  # those of what came in may be as long as a message can be


class _Sessions:
    """The stateful step. A session in memory stands for the state that it gave, as long as the store holds that: the
    partition may have been elsewhere meanwhile, or the messages since may be repeated."""

    def __init__(self, fleet: Fleet, keep: int) -> None:
        self._fleet, self._keep = fleet, keep
        self._kept: dict[str, tuple[bytes, Keyed]] = {}
        """By wearer, the one heard of last at the end."""

    def __call__(self, value: Any, key: Any, _at: int, _headers: Any, state: State[str, bytes]) -> list[dict[str, Any]]:
        wearer = _wearer(key)
        if wearer is None:  # nor has it a state, whose key in the changelog would be this one, however long
            at = message_context()
            return [event_row(NumberedEvent(f"{UNKEYED}{at.partition}", at.offset, _NO_KEY))]
        told, now = self._step(wearer, state.get_bytes("state"), _sent(wearer, value))
        state.set_bytes("state", now)
        return [event_row(one) for one in told]

    def _step(
        self, wearer: str, before: bytes | None, sent: list[Sent | Unreadable]
    ) -> tuple[list[NumberedEvent], bytes]:
        held, keyed = self._kept.pop(wearer, (None, None))
        if keyed is None or held != before:
            keyed = self._fleet.open(wearer, before)
        told = keyed.feed(sent)
        now = keyed.state()
        if self._keep > 0:
            self._kept[wearer] = (now, keyed)
            if len(self._kept) > self._keep:
                del self._kept[next(iter(self._kept))]
        return told, now


def _wearer(key: Any) -> str | None:
    try:
        name = key.decode() if isinstance(key, bytes) else key
    except UnicodeDecodeError:
        return None
    return name if isinstance(name, str) and 0 < len(name) <= LONGEST_NAME and not name.startswith(UNKEYED) else None


def _sent(wearer: str, value: Any) -> list[Sent | Unreadable]:
    lines = [line for line in value.split(b"\n") if line.strip()] if isinstance(value, bytes) else []
    if not 0 < len(lines) <= MOST_LINES:
        return [Unreadable(wearer, f"a message of {len(lines)} lines; 1 to {MOST_LINES} can be read")]
    sent = [read_line(line) for line in lines]
    strange = Unreadable(wearer, "a line of another wearer than its message")  # not in the place of one of this wearer
    return [one if one.wearer in (wearer, "") else strange for one in sent]
