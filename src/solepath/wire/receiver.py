"""Packets in which the receiver reports connections, dropped packets and passing time (protocol/receiver.md).

The values of receiver/restarted (the name of a channel) and receiver/trouble (a sentence) are texts (fields.py)."""

from __future__ import annotations

from construct import Int8sl, Int32ul

from ..events import Rejection
from ..types import Vec2
from ..types.attrs import frozen
from .error import WireError
from .fields import Fields, build_whole, decode, malformed, parse_text, parse_whole

UNKNOWN_SIGNAL = 127
"""Signal strength that means unknown, as in the Bluetooth HCI; no receiver measures 127 dBm."""
MAX_NAME_SIZE = 248
"""Largest size of a device name, bytes (Bluetooth Core, vol 3 part C, 12.1)."""

_SIGMA_AND_KIND, _POSITION = Fields("<fB"), Fields("<2d")
_START, _WORLD, _PLAN, _PLACE = range(4)
MAX_COORDINATE, MAX_SIGMA = 1e6, 1e4
"""Largest size of a coordinate and largest standard deviation of a position that a person reports, m."""
MAX_PLACE_SIZE = 64
"""Largest size of the name of a place or a level, bytes."""


@frozen
class ConnectionFrame:
    """A new connection to a device that is not yet set up: its name, and its signal strength, dBm (None: unknown)."""

    name: str
    signal: int | None


def parse_connected(data: bytes) -> ConnectionFrame:
    """Return the content of receiver/connected; WireError when the bytes do not fit."""
    data = bytes(data)
    if not data:
        raise WireError(Rejection.TRUNCATED, "no signal strength")
    if len(data) > 1 + MAX_NAME_SIZE:
        raise WireError(Rejection.OVERSIZED, f"a name of {len(data) - 1} bytes, at most {MAX_NAME_SIZE}")
    signal: int = parse_whole(Int8sl, data[:1])
    return ConnectionFrame(decode(data[1:]), None if signal == UNKNOWN_SIGNAL else signal)


def build_connected(connection: ConnectionFrame) -> bytes:
    """Return the bytes of a connection; ValueError when the name is too long or the signal is no i8."""
    name = connection.name.encode("utf-8")
    if len(name) > MAX_NAME_SIZE or connection.signal == UNKNOWN_SIGNAL:
        raise ValueError(f"a name of {len(name)} bytes, a signal of {connection.signal} dBm")
    signal = UNKNOWN_SIGNAL if connection.signal is None else connection.signal
    return build_whole(Int8sl, signal) + name


def parse_dropped(data: bytes) -> int:
    """Return the number of packets that receiver/dropped reports, at least 1; WireError when the bytes do not fit."""
    count: int = parse_whole(Int32ul, bytes(data))
    if count == 0:
        raise malformed("nothing was dropped")
    return count


def build_dropped(count: int) -> bytes:
    """Return the bytes of a number of dropped packets; ValueError unless it is 1 to 2^32 - 1."""
    if count < 1:
        raise ValueError(f"{count} packets dropped")
    return build_whole(Int32ul, count)


@frozen
class PositionFrame:
    """The position that a person reports: x and y, the place of a name, or where the walk started."""

    position: Vec2 | None
    """Coordinates x and y, m; None at a named place, or where the walk started."""
    sigma: float
    """Standard deviation of the position on each axis, m."""
    place: str = ""
    """Name of the place; "" without one."""
    level: str = ""
    """Level of the floor plan, whose frame `position` is in; "" for the world frame."""


def parse_position(data: bytes) -> PositionFrame:
    """Return the content of receiver/position; WireError when the bytes do not fit."""
    data = bytes(data)
    (sigma, kind), rest = parse_whole(_SIGMA_AND_KIND, data[:5]), data[5:]
    position: Vec2 | None = None
    place = level = ""
    if kind in (_WORLD, _PLAN):
        x, y = position = parse_whole(_POSITION, rest[:16])
        rest = rest[16:]
        if not (abs(x) <= MAX_COORDINATE and abs(y) <= MAX_COORDINATE):
            raise malformed(f"a position {position} m")
    elif kind not in (_START, _PLACE):
        raise malformed(f"a position of kind {kind}")
    if kind == _PLAN:
        level, rest = _parse_name(rest), b""
    elif kind == _PLACE:
        place, rest = _parse_name(rest), b""
    parse_nothing(rest)
    if not 0.0 < sigma <= MAX_SIGMA:
        raise malformed(f"a position with a standard deviation of {sigma} m")
    return PositionFrame(position, sigma, place, level)


def _parse_name(data: bytes) -> str:
    if len(data) > MAX_PLACE_SIZE:
        raise WireError(Rejection.OVERSIZED, f"a name of {len(data)} bytes, at most {MAX_PLACE_SIZE}")
    return parse_text(data)


def build_position(frame: PositionFrame) -> bytes:
    """Return the bytes of a reported position; ValueError when its values are not possible."""
    kind, data = _START, b""
    if frame.place:
        kind, data = _PLACE, frame.place.encode("utf-8")
    elif frame.position is not None:
        level = frame.level.encode("utf-8")
        kind, data = _PLAN if level else _WORLD, build_whole(_POSITION, frame.position) + level
    data = build_whole(_SIGMA_AND_KIND, (frame.sigma, kind)) + data
    try:
        parsed = parse_position(data)
        if (parsed.position, parsed.place, parsed.level) != (frame.position, frame.place, frame.level):
            raise malformed("a position has x and y, or the name of a place, and only x and y have a level")
    except WireError as error:
        raise ValueError(str(error)) from error
    return data


def parse_nothing(data: bytes) -> None:
    """Check that a value of receiver/tick or receiver/disconnected is empty; WireError when it is not."""
    if data:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes, none expected")
