"""The state of one wearer between two calls, as bytes: protocol/fleet.md, "The state".

The first bytes, what the identities of events and the order of packets hang on, are the same in every version, and have
a checksum of their own: what comes after them may be damaged or unknown, and no identity is used twice all the same.
"""

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
from .left import Left, NumberSpan, Strays
from .order import RejectedItem, What
from .sent import MOST, End, Tick

MAGIC, VERSION = b"spfl", 1
MOST_TOLD = 2**62
"""More events than any wearer has."""

_FIRST = Struct("<4sBqQQd")
_CHECK = Struct("<I")
_FLOAT = Struct("<d")
_ENDED, _SESSION = 1, 2
_PACKET, _TICK, _END, _REFUSED = range(4)


class StateError(ValueError):
    """A state that cannot go on, and why."""


@frozen
class Identity:
    """What every version can read."""

    run: int
    next: int
    told: int
    """The number of the next event."""
    known: float
    """s; the newest moment that anything is known of."""


@frozen
class OtherState:
    """What else there is. `failure`: what a part of the app's own raised when the session was to be saved; "" for
    nothing. `session`: None before the first packet and after the end."""

    ended: bool = False
    left: Left = field(factory=Left)
    strays: Strays = field(factory=Strays)
    held: dict[tuple[int, int], What] = field(factory=dict)
    failure: str = ""
    session: bytes | None = None


def write_state(identity: Identity, rest: OtherState) -> bytes:
    """The bytes of a state."""
    first = _FIRST.pack(MAGIC, VERSION, identity.run, identity.next, identity.told, identity.known)
    left, strays = rest.left, rest.strays
    other = b"".join(
        [
            bytes([rest.ended * _ENDED + (rest.session is not None) * _SESSION]),
            _counts(len(left.spans)),
            *[_counts(span.run, span.first, span.end) for span in left.spans],
            _counts(len(left.forgotten)),
            *[_counts(*runs) for runs in left.forgotten],
            _counts(strays.run, strays.count, strays.straight, strays.number),
            _counts(len(rest.held)),
            *[_counts(*place) + _held(rest.held[place]) for place in sorted(rest.held)],
            _counted(_encoded(rest.failure)),
        ]
    )
    return b"".join([first, _CHECK.pack(crc32(first)), other, _CHECK.pack(crc32(other)), rest.session or b""])


def read_identity(state: bytes) -> Identity | None:
    """The first bytes of a state of any version; None when they are damaged or those of something else."""
    end = _FIRST.size
    if len(state) < end + _CHECK.size or state[:4] != MAGIC or crc32(state[:end]) != _CHECK.unpack_from(state, end)[0]:
        return None
    _, _, run, number, told, known = _FIRST.unpack_from(state)
    if not (-1 <= run <= MOST and number <= MOST + 1 and told <= MOST_TOLD and isfinite(known)):
        return None
    return Identity(run, number, told, known)


def read_rest(state: bytes) -> OtherState:
    """What comes after the first bytes, which are sound. StateError when it cannot be read."""
    reader = READERS.get(state[4])
    if reader is None:
        raise StateError(f"a state of version {state[4]}; this release reads {', '.join(map(str, READERS))}")
    try:
        return reader(_StateReader(state, _FIRST.size + _CHECK.size))
    except (ValueError, IndexError, StructError, OverflowError) as error:
        raise StateError(str(error) if isinstance(error, StateError) else "the state was damaged") from None


def _read_1(data: _StateReader) -> OtherState:
    begin = data.at
    flags = data.take(1)[0]
    spans = [NumberSpan(data.count(), data.count(), data.count()) for _ in range(data.count())]
    forgotten = [(data.count(), data.count()) for _ in range(data.count())]
    strays = Strays(data.count(), data.count(), data.count(), data.count())
    held = [((data.count(), data.count()), _read_what(data)) for _ in range(data.count())]
    failure = data.text()
    checked = data.state[begin : data.at]
    if data.take(4) != _CHECK.pack(crc32(checked)):
        raise StateError("the state was damaged: its checksum is another")
    _, _, run, number, _, _ = _FIRST.unpack_from(data.state)
    places = [(run, number - 1), *[place for place, _ in held]]
    if not all(low < high for low, high in pairwise(places)) or any(max(place) > MOST for place in places[1:]):
        raise StateError("the state holds what cannot be held")
    session = data.state[data.at :] if flags & _SESSION else None
    return OtherState(bool(flags & _ENDED), Left(spans, forgotten), strays, dict(held), failure, session)


def _held(what: What) -> bytes:
    match what:
        case Packet(t, site, channel, data, device):
            texts = [_encoded(text) for text in (site.value, channel, device)]
            return bytes([_PACKET]) + _FLOAT.pack(t) + _counted(*texts, data)
        case Tick(t):
            return bytes([_TICK]) + _FLOAT.pack(t)
        case End():
            return bytes([_END])
        case RejectedItem(reason, detail):
            return bytes([_REFUSED]) + _counted(_encoded(reason.value), _encoded(detail))


def _counts(*numbers: int) -> bytes:
    """Seven bits a byte, the lowest first; the eighth says that more follow."""
    done = bytearray()
    for number in numbers:
        while number > 127:
            done.append(number & 127 | 128)
            number >>= 7
        done.append(number)
    return bytes(done)


def _counted(*pieces: bytes) -> bytes:
    """Each behind its length."""
    return b"".join([_counts(len(piece)) + piece for piece in pieces])


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _read_what(data: _StateReader) -> What:
    kind = data.take(1)[0]
    if kind == _PACKET:
        t, site, channel, device = data.float(), Site(data.text()), data.text(), data.text()
        return Packet(t, site, channel, data.take(data.count()), device)
    if kind == _TICK:
        return Tick(data.float())
    if kind == _END:
        return End()
    if kind == _REFUSED:
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
"""By version: each makes of its layout what the newest has. What a session remembers has a version of its own
(session/state.py)."""
