"""The state of one wearer between two calls, as bytes (protocol/fleet.md, "The state").

The first bytes (StateHead) hold the next numbers of rows and events. Their layout is the same in every version and they
have their own checksum: no event number is used twice, even if the other bytes are damaged or of an unknown version."""

from __future__ import annotations

from binascii import crc32
from io import BytesIO
from itertools import pairwise
from math import isfinite
from struct import Struct as Layout
from typing import Any

from attrs import astuple, field, frozen
from construct import (
    Byte,
    ConstructError,
    Error,
    ExprAdapter,
    Float64l,
    GreedyBytes,
    Prefixed,
    PrefixedArray,
    Sequence,
    Struct,
    Switch,
    VarInt,
    this,
)
from construct import Mapping as Named

from ...types import Packet, Site
from ..events import SentRejection
from .order import Payload, RejectedItem
from .sent import MAX_COUNT, End, Tick
from .unused import NumberSpan, StrayRows, UnusedNumbers

MAGIC, VERSION = b"spfl", 1
MAX_EVENTS = 2**62
"""Largest number of an event in a state: more than any wearer can have."""

_HEAD, _CHECKSUM = Layout("<4sBqQQd"), Layout("<I")
_ENDED, _SESSION = 1, 2
_BYTES: Any = Prefixed(VarInt, GreedyBytes)
_TEXT: Any = ExprAdapter(
    _BYTES, lambda data, _: data.decode("utf-8", "surrogatepass"), lambda text, _: text.encode("utf-8", "surrogatepass")
)
_SITE = Named(_TEXT, {site: site.value for site in Site})
_REASON = Named(_TEXT, {reason: reason.value for reason in SentRejection})
_KINDS: tuple[type, ...] = (Packet, Tick, End, RejectedItem)
_FIELDS: tuple[tuple[str, ...], ...] = (("t", "site", "channel", "device", "data"), ("t",), (), ("reason", "detail"))
_FORMS: Any = {
    0: Sequence(Float64l, _SITE, _TEXT, _TEXT, _BYTES),
    1: Sequence(Float64l),
    2: Sequence(),
    3: Sequence(_REASON, _TEXT),
}
"""Classes of what is held, and by their places in the list the fields and their form in a state."""
_NO_KIND: Any = Error
_REST = Struct(
    "flags" / Byte,
    "spans" / PrefixedArray(VarInt, Sequence(VarInt, VarInt, VarInt)),
    "forgotten" / PrefixedArray(VarInt, Sequence(VarInt, VarInt)),
    "strays" / Sequence(VarInt, VarInt, VarInt, VarInt),
    "held"
    / PrefixedArray(
        VarInt, Struct("run" / VarInt, "number" / VarInt, "kind" / Byte, "fields" / Switch(this.kind, _FORMS, _NO_KIND))
    ),
    "failure" / _TEXT,
)
"""What follows the first bytes, up to its checksum."""


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
    first = _HEAD.pack(MAGIC, VERSION, *astuple(head))
    held = []
    for (run, number), payload in sorted(rest.held_rows.items()):
        kind = _KINDS.index(type(payload))
        fields = [getattr(payload, name) for name in _FIELDS[kind]]
        held.append({"run": run, "number": number, "kind": kind, "fields": fields})
    other = _REST.build(
        {
            "flags": rest.ended * _ENDED + (rest.session is not None) * _SESSION,
            "spans": [astuple(span) for span in rest.unused.spans],
            "forgotten": rest.unused.forgotten,
            "strays": astuple(rest.strays),
            "held": held,
            "failure": rest.failure,
        }
    )
    return b"".join([first, _CHECKSUM.pack(crc32(first)), other, _CHECKSUM.pack(crc32(other)), rest.session or b""])


def read_head(state: bytes) -> StateHead | None:
    """Return the first part of a state of any version; None when it is damaged or no state."""
    first, rest = state[: _HEAD.size], state[_HEAD.size :]
    if len(first) < _HEAD.size or not first.startswith(MAGIC) or rest[: _CHECKSUM.size] != _CHECKSUM.pack(crc32(first)):
        return None
    head = StateHead(*_HEAD.unpack(first)[2:])
    is_possible = -1 <= head.run <= MAX_COUNT and head.next <= MAX_COUNT + 1 and head.next_event <= MAX_EVENTS
    return head if is_possible and isfinite(head.known) else None


def read_rest(state: bytes) -> StateRest:
    """Return the rest of a state whose first bytes are sound; raise StateError when it cannot be read."""
    _, version, run, number, *_ = _HEAD.unpack_from(state)
    if version != VERSION:
        raise StateError(f"a state of version {version}; this release reads {VERSION}")
    data = state[_HEAD.size + _CHECKSUM.size :]
    try:
        stream = BytesIO(data)
        rest = _REST.parse_stream(stream)
        size = stream.tell()
        if stream.read(_CHECKSUM.size) != _CHECKSUM.pack(crc32(data[:size])):
            raise StateError("the state was damaged: its checksum is another")
        held_rows = {
            (row.run, row.number): _KINDS[row.kind](**dict(zip(_FIELDS[row.kind], row.fields, strict=True)))
            for row in rest.held
        }
    except (ConstructError, ValueError, OverflowError) as error:
        raise StateError(str(error) if isinstance(error, StateError) else "the state was damaged") from None
    keys = [(run, number - 1), *[(row.run, row.number) for row in rest.held]]
    if not all(low < high for low, high in pairwise(keys)) or any(max(key) > MAX_COUNT for key in keys[1:]):
        raise StateError("the state holds what cannot be held")
    return StateRest(
        bool(rest.flags & _ENDED),
        UnusedNumbers([NumberSpan(*span) for span in rest.spans], [(first, last) for first, last in rest.forgotten]),
        StrayRows(*rest.strays),
        held_rows,
        rest.failure,
        stream.read() if rest.flags & _SESSION else None,
    )
