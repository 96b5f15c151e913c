"""Commands that a host writes to the control characteristic of an insole (protocol/insole.md)."""

from __future__ import annotations

from ..events import Rejection
from ..types.attrs import astuple, frozen
from .error import WireError
from .fields import Fields, build_whole, malformed, parse_whole


@frozen
class StartSampling:
    """Command to start sampling and notifications."""


@frozen
class StopSampling:
    """Command to stop sampling."""


@frozen
class SetInterval:
    """Command to take a sample every `interval` ticks (1 to 65535) from the next frame on."""

    interval: int


@frozen
class Resend:
    """Command to send `count` (1 to 255) frames from sequence number `first` again, if the insole still has them."""

    first: int
    count: int


Command = StartSampling | StopSampling | SetInterval | Resend
"""Any command of the control characteristic."""

_FORMATS: dict[int, tuple[type[Command], Fields]] = {
    1: (StartSampling, Fields("<B")),
    2: (StopSampling, Fields("<B")),
    3: (SetInterval, Fields("<BH")),
    4: (Resend, Fields("<BHB")),
}
"""Class and number format of each command, by opcode."""


def parse_control(data: bytes) -> Command:
    """Return the command in `data`; WireError for any other bytes."""
    data = bytes(data)
    if not data:
        raise WireError(Rejection.TRUNCATED, "no opcode")
    if data[0] not in _FORMATS:
        raise malformed(f"unknown opcode {data[0]:#04x}")
    kind, definition = _FORMATS[data[0]]
    _, *numbers = parse_whole(definition, data)
    command = kind(*numbers)
    problem = _find_problem(command)
    if problem:
        raise malformed(problem)
    return command


def build_control(command: Command) -> bytes:
    """Return the bytes of `command`; ValueError when it does not fit the format."""
    problem = _find_problem(command)
    if problem:
        raise ValueError(problem)
    (opcode,) = [opcode for opcode, (kind, _) in _FORMATS.items() if kind is type(command)]
    return build_whole(_FORMATS[opcode][1], (opcode, *astuple(command)))


def _find_problem(command: Command) -> str:
    """Return a description of a number that the format does not allow; "" when there is none."""
    match command:
        case SetInterval(interval=0):
            return "an interval of no ticks"
        case Resend(count=0):
            return "no frames to send again"
    return ""
