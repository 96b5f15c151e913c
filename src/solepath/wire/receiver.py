"""Packets in which the receiver reports connections, dropped packets and passing time (protocol/receiver.md).

The values of receiver/restarted (the name of a channel) and receiver/trouble (a sentence) are texts (fields.py)."""

from __future__ import annotations

from construct import Float32l, Float64l, Int8sl, Int32ul, Struct, Terminated

from ..events import Rejection
from ..types.attrs import frozen
from .error import WireError
from .fields import build_whole, malformed, parse_whole

UNKNOWN_SIGNAL = 127
"""Signal strength that means unknown, as in the Bluetooth HCI; no receiver measures 127 dBm."""
MAX_NAME_SIZE = 248
"""Largest size of a device name, bytes (Bluetooth Core, vol 3 part C, 12.1)."""

_SIGNAL = Struct("signal" / Int8sl)
_COUNT = Struct("count" / Int32ul, Terminated)
_SIGMA = Struct("sigma" / Float32l)
_POSITION = Struct("x" / Float64l, "y" / Float64l, Terminated)
MAX_COORDINATE, MAX_SIGMA = 1e6, 1e4
"""Largest size of a coordinate and largest standard deviation of a position that a person reports, m."""


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
    signal: int = parse_whole(_SIGNAL, data[:1]).signal
    try:
        name = data[1:].decode("utf-8")
    except UnicodeDecodeError as error:
        raise malformed(f"not UTF-8: {error}") from error
    return ConnectionFrame(name, None if signal == UNKNOWN_SIGNAL else signal)


def build_connected(connection: ConnectionFrame) -> bytes:
    """Return the bytes of a connection; ValueError when the name is too long or the signal is no i8."""
    name = connection.name.encode("utf-8")
    if len(name) > MAX_NAME_SIZE or connection.signal == UNKNOWN_SIGNAL:
        raise ValueError(f"a name of {len(name)} bytes, a signal of {connection.signal} dBm")
    signal = UNKNOWN_SIGNAL if connection.signal is None else connection.signal
    return build_whole(_SIGNAL, {"signal": signal}) + name


def parse_dropped(data: bytes) -> int:
    """Return the number of packets that receiver/dropped reports, at least 1; WireError when the bytes do not fit."""
    count: int = parse_whole(_COUNT, bytes(data)).count
    if count == 0:
        raise malformed("nothing was dropped")
    return count


def build_dropped(count: int) -> bytes:
    """Return the bytes of a number of dropped packets; ValueError unless it is 1 to 2^32 - 1."""
    if count < 1:
        raise ValueError(f"{count} packets dropped")
    return build_whole(_COUNT, {"count": count})


@frozen
class PositionFrame:
    """A position that a person has reported: x and y in the world frame, m (None: where the walk started)."""

    position: tuple[float, float] | None
    sigma: float
    """Standard deviation of the position on each axis, m."""


def parse_position(data: bytes) -> PositionFrame:
    """Return the content of receiver/position; WireError when the bytes do not fit."""
    data = bytes(data)
    sigma: float = parse_whole(_SIGMA, data[:4]).sigma
    position = None
    if len(data) > 4:
        parsed = parse_whole(_POSITION, data[4:])
        position = (parsed.x, parsed.y)
    if not 0.0 < sigma <= MAX_SIGMA or not all([abs(value) <= MAX_COORDINATE for value in position or ()]):
        raise malformed(f"a position {position} m with a standard deviation of {sigma} m")
    return PositionFrame(position, sigma)


def build_position(frame: PositionFrame) -> bytes:
    """Return the bytes of a reported position; ValueError when its numbers are not possible."""
    data = build_whole(_SIGMA, {"sigma": frame.sigma})
    if frame.position is not None:
        x, y = frame.position
        data += build_whole(_POSITION, {"x": x, "y": y})
    try:
        parse_position(data)
    except WireError as error:
        raise ValueError(str(error)) from error
    return data


def parse_nothing(data: bytes) -> None:
    """Check that a value of receiver/tick or receiver/disconnected is empty; WireError when it is not."""
    if data:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes, none expected")
