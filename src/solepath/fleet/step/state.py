"""The state of one wearer between two calls, as bytes (protocol/fleet.md, "The state").

The first bytes (StateHead) hold the next numbers of rows and events. Their layout is the same in every version and they
have their own checksum: no event number is used twice, even if the other bytes are damaged or of an unknown version."""

from __future__ import annotations

from binascii import crc32
from collections.abc import Callable, Mapping
from itertools import pairwise
from math import isfinite
from struct import Struct
from struct import error as StructError

from attrs import define, field, frozen

from ...types import Packet, Site
from ..events import SentRejection
from .order import Payload, RejectedItem
from .sent import MAX_COUNT, End, Tick
from .unused import NumberSpan, StrayRows, UnusedNumbers

MAGIC, VERSION = b"spfl", 1
MAX_EVENTS = 2**62
"""Largest number of an event in a state: more than any wearer can have."""

_HEAD_FORMAT = Struct("<4sBqQQd")
_CHECKSUM = Struct("<I")
_FLOAT_FORMAT = Struct("<d")
_ENDED, _SESSION = 1, 2
_PACKET_CODE, _TICK_CODE, _END_CODE, _REJECTED_CODE = range(4)


class StateError(ValueError):
    """Raised with the reason why a state cannot continue."""


@frozen
class StateHead:
    """The first part of a state, which every version can read; `run` and `next` say which row is next."""

    run: int
    next: int
    next_event: int
    """Number of the next event."""
    known: float
    """Newest known time, s, packets' clock."""


@frozen
class StateRest:
    """The rest of a state.

    `failure` is the text of the exception that an app's part raised when the session was saved; "" for none. `session`
    is the packed session, None before the first packet and after the end."""

    ended: bool = False
    unused: UnusedNumbers = field(factory=UnusedNumbers)
    strays: StrayRows = field(factory=StrayRows)
    held_rows: dict[tuple[int, int], Payload] = field(factory=dict)
    failure: str = ""
    session: bytes | None = None


def write_state(head: StateHead, rest: StateRest) -> bytes:
    """Return the bytes of a state."""
    first = _HEAD_FORMAT.pack(MAGIC, VERSION, head.run, head.next, head.next_event, head.known)
    unused, strays = rest.unused, rest.strays
    other = b"".join(
        [
            bytes([rest.ended * _ENDED + (rest.session is not None) * _SESSION]),
            _encode_counts(len(unused.spans)),
            *[_encode_counts(span.run, span.first, span.end) for span in unused.spans],
            _encode_counts(len(unused.forgotten)),
            *[_encode_counts(*runs) for runs in unused.forgotten],
            _encode_counts(strays.run, strays.count, strays.rising_rows, strays.number),
            _encode_counts(len(rest.held_rows)),
            *[_encode_counts(*key) + _encode_payload(rest.held_rows[key]) for key in sorted(rest.held_rows)],
            _encode_pieces(_encode_text(rest.failure)),
        ]
    )
    return b"".join([first, _CHECKSUM.pack(crc32(first)), other, _CHECKSUM.pack(crc32(other)), rest.session or b""])


def read_head(state: bytes) -> StateHead | None:
    """Return the first part of a state of any version; None when it is damaged or no state."""
    end = _HEAD_FORMAT.size
    if (
        len(state) < end + _CHECKSUM.size
        or state[:4] != MAGIC
        or crc32(state[:end]) != _CHECKSUM.unpack_from(state, end)[0]
    ):
        return None
    _, _, run, number, next_event, known = _HEAD_FORMAT.unpack_from(state)
    if not (-1 <= run <= MAX_COUNT and number <= MAX_COUNT + 1 and next_event <= MAX_EVENTS and isfinite(known)):
        return None
    return StateHead(run, number, next_event, known)


def read_rest(state: bytes) -> StateRest:
    """Return the rest of a state whose first bytes are sound; raise StateError when it cannot be read."""
    reader = READERS.get(state[4])
    if reader is None:
        raise StateError(f"a state of version {state[4]}; this release reads {', '.join(map(str, READERS))}")
    try:
        return reader(_StateReader(state, _HEAD_FORMAT.size + _CHECKSUM.size))
    except (ValueError, IndexError, StructError, OverflowError) as error:
        raise StateError(str(error) if isinstance(error, StateError) else "the state was damaged") from None


def _read_version_1(data: _StateReader) -> StateRest:
    start = data.position
    flags = data.take(1)[0]
    spans = [NumberSpan(data.read_count(), data.read_count(), data.read_count()) for _ in range(data.read_count())]
    forgotten = [(data.read_count(), data.read_count()) for _ in range(data.read_count())]
    strays = StrayRows(data.read_count(), data.read_count(), data.read_count(), data.read_count())
    held_rows = [((data.read_count(), data.read_count()), _read_payload(data)) for _ in range(data.read_count())]
    failure = data.read_text()
    checked = data.state[start : data.position]
    if data.take(4) != _CHECKSUM.pack(crc32(checked)):
        raise StateError("the state was damaged: its checksum is another")
    _, _, run, number, _, _ = _HEAD_FORMAT.unpack_from(data.state)
    keys = [(run, number - 1), *[key for key, _ in held_rows]]
    if not all(low < high for low, high in pairwise(keys)) or any(max(key) > MAX_COUNT for key in keys[1:]):
        raise StateError("the state holds what cannot be held")
    session = data.state[data.position :] if flags & _SESSION else None
    return StateRest(bool(flags & _ENDED), UnusedNumbers(spans, forgotten), strays, dict(held_rows), failure, session)


def _encode_payload(payload: Payload) -> bytes:
    match payload:
        case Packet(t, site, channel, data, device):
            texts = [_encode_text(text) for text in (site.value, channel, device)]
            return bytes([_PACKET_CODE]) + _FLOAT_FORMAT.pack(t) + _encode_pieces(*texts, data)
        case Tick(t):
            return bytes([_TICK_CODE]) + _FLOAT_FORMAT.pack(t)
        case End():
            return bytes([_END_CODE])
        case RejectedItem(reason, detail):
            return bytes([_REJECTED_CODE]) + _encode_pieces(_encode_text(reason.value), _encode_text(detail))


def _encode_counts(*numbers: int) -> bytes:
    """Return numbers with seven bits in each byte, the lowest first; the eighth bit is set if more bytes follow."""
    encoded = bytearray()
    for number in numbers:
        while number > 127:
            encoded.append(number & 127 | 128)
            number >>= 7
        encoded.append(number)
    return bytes(encoded)


def _encode_pieces(*pieces: bytes) -> bytes:
    """Return each piece preceded by its length."""
    return b"".join([_encode_counts(len(piece)) + piece for piece in pieces])


def _encode_text(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _read_payload(data: _StateReader) -> Payload:
    kind = data.take(1)[0]
    if kind == _PACKET_CODE:
        t, site, channel, device = data.read_float(), Site(data.read_text()), data.read_text(), data.read_text()
        return Packet(t, site, channel, data.take(data.read_count()), device)
    if kind == _TICK_CODE:
        return Tick(data.read_float())
    if kind == _END_CODE:
        return End()
    if kind == _REJECTED_CODE:
        return RejectedItem(SentRejection(data.read_text()), data.read_text())
    raise StateError("the state was damaged")


@define
class _StateReader:
    state: bytes
    position: int

    def take(self, count: int) -> bytes:
        if self.position + count > len(self.state):
            raise StateError("the state was cut off")
        self.position += count
        return self.state[self.position - count : self.position]

    def read_count(self) -> int:
        number = 0
        for shift in range(0, 63, 7):
            byte = self.take(1)[0]
            number |= (byte & 127) << shift
            if byte < 128:
                return number
        raise StateError("the state was damaged")

    def read_float(self) -> float:
        number: float = _FLOAT_FORMAT.unpack(self.take(8))[0]
        return number

    def read_text(self) -> str:
        return self.take(self.read_count()).decode("utf-8", "surrogatepass")


READERS: Mapping[int, Callable[[_StateReader], StateRest]] = {1: _read_version_1}
"""Functions that read a StateRest, by version; the packed session has its own version (session/state.py)."""
