"""The state of one wearer between two calls, as bytes (protocol/fleet.md, "The state").

The first bytes, on which the identities of events and the order of packets depend, are the same in every version and
have a checksum of their own: even if the bytes after them are damaged or unknown, no identity is used twice."""

from __future__ import annotations

from binascii import crc32
from collections.abc import Callable, Mapping
from itertools import pairwise
from math import isfinite
from struct import Struct
from struct import error as StructError

from attrs import define, field, frozen

from ...events.fleet import SentRejection
from ...types import Packet, Site
from .order import Payload, RejectedItem
from .sent import MOST, End, Tick
from .unused import NumberSpan, Strays, UnusedNumbers

MAGIC, VERSION = b"spfl", 1
MOST_EVENTS = 2**62
"""Limit above the number of events of any wearer."""

_FIRST = Struct("<4sBqQQd")
_CHECK = Struct("<I")
_FLOAT = Struct("<d")
_ENDED, _SESSION = 1, 2
_PACKET, _TICK, _END, _REJECTED = range(4)


class StateError(ValueError):
    """Raised with the reason why a state cannot continue."""


@frozen
class Identity:
    """The first part of a state, which every version can read."""

    run: int
    next: int
    next_event: int
    """Number of the next event."""
    known: float
    """Newest time that is known, s."""


@frozen
class OtherState:
    """The rest of a state.

    `failure` is the exception of a part of the app's own when the session was to be saved; "" for none. `session` is
    None before the first packet and after the end."""

    ended: bool = False
    unused: UnusedNumbers = field(factory=UnusedNumbers)
    strays: Strays = field(factory=Strays)
    held: dict[tuple[int, int], Payload] = field(factory=dict)
    failure: str = ""
    session: bytes | None = None


def write_state(identity: Identity, rest: OtherState) -> bytes:
    """Return the bytes of a state."""
    first = _FIRST.pack(MAGIC, VERSION, identity.run, identity.next, identity.next_event, identity.known)
    unused, strays = rest.unused, rest.strays
    other = b"".join(
        [
            bytes([rest.ended * _ENDED + (rest.session is not None) * _SESSION]),
            _write_counts(len(unused.spans)),
            *[_write_counts(span.run, span.first, span.end) for span in unused.spans],
            _write_counts(len(unused.forgotten)),
            *[_write_counts(*runs) for runs in unused.forgotten],
            _write_counts(strays.run, strays.count, strays.consecutive, strays.number),
            _write_counts(len(rest.held)),
            *[_write_counts(*place) + _write_payload(rest.held[place]) for place in sorted(rest.held)],
            _write_pieces(_encoded(rest.failure)),
        ]
    )
    return b"".join([first, _CHECK.pack(crc32(first)), other, _CHECK.pack(crc32(other)), rest.session or b""])


def read_identity(state: bytes) -> Identity | None:
    """Return the first part of a state of any version; None when it is damaged or of something else."""
    end = _FIRST.size
    if len(state) < end + _CHECK.size or state[:4] != MAGIC or crc32(state[:end]) != _CHECK.unpack_from(state, end)[0]:
        return None
    _, _, run, number, next_event, known = _FIRST.unpack_from(state)
    if not (-1 <= run <= MOST and number <= MOST + 1 and next_event <= MOST_EVENTS and isfinite(known)):
        return None
    return Identity(run, number, next_event, known)


def read_rest(state: bytes) -> OtherState:
    """Return the rest of a state whose first bytes are sound; raise StateError when it cannot be read."""
    reader = READERS.get(state[4])
    if reader is None:
        raise StateError(f"a state of version {state[4]}; this release reads {', '.join(map(str, READERS))}")
    try:
        return reader(_StateReader(state, _FIRST.size + _CHECK.size))
    except (ValueError, IndexError, StructError, OverflowError) as error:
        raise StateError(str(error) if isinstance(error, StateError) else "the state was damaged") from None


def _read_1(data: _StateReader) -> OtherState:
    start = data.at
    flags = data.take(1)[0]
    spans = [NumberSpan(data.count(), data.count(), data.count()) for _ in range(data.count())]
    forgotten = [(data.count(), data.count()) for _ in range(data.count())]
    strays = Strays(data.count(), data.count(), data.count(), data.count())
    held = [((data.count(), data.count()), _read_payload(data)) for _ in range(data.count())]
    failure = data.text()
    checked = data.state[start : data.at]
    if data.take(4) != _CHECK.pack(crc32(checked)):
        raise StateError("the state was damaged: its checksum is another")
    _, _, run, number, _, _ = _FIRST.unpack_from(data.state)
    places = [(run, number - 1), *[place for place, _ in held]]
    if not all(low < high for low, high in pairwise(places)) or any(max(place) > MOST for place in places[1:]):
        raise StateError("the state holds what cannot be held")
    session = data.state[data.at :] if flags & _SESSION else None
    return OtherState(bool(flags & _ENDED), UnusedNumbers(spans, forgotten), strays, dict(held), failure, session)


def _write_payload(what: Payload) -> bytes:
    match what:
        case Packet(t, site, channel, data, device):
            texts = [_encoded(text) for text in (site.value, channel, device)]
            return bytes([_PACKET]) + _FLOAT.pack(t) + _write_pieces(*texts, data)
        case Tick(t):
            return bytes([_TICK]) + _FLOAT.pack(t)
        case End():
            return bytes([_END])
        case RejectedItem(reason, detail):
            return bytes([_REJECTED]) + _write_pieces(_encoded(reason.value), _encoded(detail))


def _write_counts(*numbers: int) -> bytes:
    """Return numbers with seven bits in each byte, the lowest first; the eighth bit says that more follow."""
    done = bytearray()
    for number in numbers:
        while number > 127:
            done.append(number & 127 | 128)
            number >>= 7
        done.append(number)
    return bytes(done)


def _write_pieces(*pieces: bytes) -> bytes:
    """Return each piece preceded by its length."""
    return b"".join([_write_counts(len(piece)) + piece for piece in pieces])


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _read_payload(data: _StateReader) -> Payload:
    kind = data.take(1)[0]
    if kind == _PACKET:
        t, site, channel, device = data.float(), Site(data.text()), data.text(), data.text()
        return Packet(t, site, channel, data.take(data.count()), device)
    if kind == _TICK:
        return Tick(data.float())
    if kind == _END:
        return End()
    if kind == _REJECTED:
        return RejectedItem(SentRejection(data.text()), data.text())
    raise StateError("the state was damaged")


@define
class _StateReader:
    state: bytes
    at: int

    def take(self, count: int) -> bytes:
        if self.at + count > len(self.state):
            raise StateError("the state was cut off")
        self.at += count
        return self.state[self.at - count : self.at]

    def count(self) -> int:
        number = 0
        for shift in range(0, 63, 7):
            byte = self.take(1)[0]
            number |= (byte & 127) << shift
            if byte < 128:
                return number
        raise StateError("the state was damaged")

    def float(self) -> float:
        number: float = _FLOAT.unpack(self.take(8))[0]
        return number

    def text(self) -> str:
        return self.take(self.count()).decode("utf-8", "surrogatepass")


READERS: Mapping[int, Callable[[_StateReader], OtherState]] = {1: _read_1}
"""Readers by version: each converts its layout to the newest.

The state of a session has a version of its own (session/state.py)."""
