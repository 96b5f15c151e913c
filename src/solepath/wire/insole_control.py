"""What a host writes to an insole's control point (protocol/insole.md)."""

from __future__ import annotations

from attrs import frozen
from construct import Const, Int8ul, Int16ul, Struct, Terminated

from ..events import Rejection
from .error import WireError
from .fields import Record, build_whole, malformed, parse_whole


@frozen
class StartSampling:
    """Begin to sample and notify."""


@frozen
class StopSampling:
    """Cease to sample."""


@frozen
class SetInterval:
    """Sample every `interval` ticks (1 to 65535) from the next frame on."""

    interval: int


@frozen
class Resend:
    """Send `count` (1 to 255) frames from sequence `first` again, as far as the device still has them."""

    first: int
    count: int


Command = StartSampling | StopSampling | SetInterval | Resend

_START = Record(StartSampling, Struct(Const(b"\x01"), Terminated))
_STOP = Record(StopSampling, Struct(Const(b"\x02"), Terminated))
_SET_INTERVAL = Record(SetInterval, Struct(Const(b"\x03"), "interval" / Int16ul, Terminated))
_RESEND = Record(Resend, Struct(Const(b"\x04"), "first" / Int16ul, "count" / Int8ul, Terminated))

_BY_OPCODE = {1: _START, 2: _STOP, 3: _SET_INTERVAL, 4: _RESEND}
_BY_COMMAND = {StartSampling: _START, StopSampling: _STOP, SetInterval: _SET_INTERVAL, Resend: _RESEND}


def parse_control(data: bytes) -> Command:
    """The command in `data`. WireError when it is not one, whatever the bytes."""
    data = bytes(data)
    if not data:
        raise WireError(Rejection.TRUNCATED, "no opcode")
    definition = _BY_OPCODE.get(data[0])
    if definition is None:
        raise malformed(f"unknown opcode {data[0]:#04x}")
    command: Command = parse_whole(definition, data)
    problem = _problem(command)
    if problem:
        raise malformed(problem)
    return command


def build_control(command: Command) -> bytes:
    """The bytes of `command`. ValueError when it does not fit the format."""
    problem = _problem(command)
    if problem:
        raise ValueError(problem)
    return build_whole(_BY_COMMAND[type(command)], command)


def _problem(command: Command) -> str:
    match command:
        case SetInterval(interval=0):
            return "an interval of no ticks"
        case Resend(count=0):
            return "no frames to send again"
    return ""
