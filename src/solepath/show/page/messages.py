"""Encodes and parses the messages between server and page: JSON, checked in both directions (protocol/page.md)."""

from __future__ import annotations

import json
from enum import Enum
from math import isfinite
from typing import Any

import attrs
from attrs import frozen

from ...wire.receiver import PositionFrame, build_position

MIN_SPEED, MAX_SPEED = 0.1, 32.0
"""Bounds of the speed at which a recording is played, in multiples of real time."""
MAX_MESSAGE_SIZE = 4096
"""Size of the largest message from a page, bytes; chosen by hand."""


ENCODER = json.JSONEncoder(allow_nan=False, separators=(",", ":"))
NO_JSON = 1007
"""Close code for text that is not JSON."""


class CommandError(ValueError):
    """A text that is not a command; the message says why, and `code` is the close code of protocol/page.md."""

    def __init__(self, reason: str, code: int = 1008) -> None:
        super().__init__(reason)
        self.code = code


@frozen
class Command:
    """A checked request of a page (protocol/page.md), made by `parse_command`.

    `do` is "play", "pause", "speed", "seek" or "here". `value` is the speed in multiples of real time, or the time to
    seek, s, on the recording's clock; it is None for all others. `position` is what "here" reports, else None."""

    do: str
    value: float | None = None
    position: PositionFrame | None = None


def parse_command(text: str) -> Command:
    """Return the command that a text encodes; raise CommandError for any other text."""
    try:
        message = json.loads(text, parse_int=float, parse_constant=_no_number, object_pairs_hook=_unique_members)
    except CommandError:
        raise
    except (ValueError, RecursionError):
        raise CommandError("a message is not JSON", NO_JSON) from None
    if not isinstance(message, dict):
        raise CommandError("a message is not a JSON object")
    match len(message), message:
        case 1, {"do": "play" | "pause" as do}:
            return Command(do)
        case 2, {"do": "seek", "value": float(value)} if isfinite(value):
            return Command("seek", value)
        case 2, {"do": "speed", "value": float(value)}:
            if not MIN_SPEED <= value <= MAX_SPEED:
                raise CommandError(f"a message asks for another speed than {MIN_SPEED:g} to {MAX_SPEED:g}")
            return Command("speed", value)
        case 2, {"do": "here", "sigma": float(sigma)}:
            position = PositionFrame(None, sigma)
        case 3, {"do": "here", "sigma": float(sigma), "at": [float(x), float(y)]}:
            position = PositionFrame((x, y), sigma)
        case 4, {"do": "here", "sigma": float(sigma), "at": [float(x), float(y)], "level": str(level)} if level:
            position = PositionFrame((x, y), sigma, level=level)
        case _:
            raise CommandError("a message asks for nothing that there is, or has wrong members")
    try:
        build_position(position)
    except ValueError:
        raise CommandError("a message has a position that cannot be") from None
    return Command("here", position=position)


def encode(message: dict[str, Any]) -> str:
    """Return a message of the server as text; raise ValueError for a number that is not finite."""
    return ENCODER.encode(message)


def _no_number(text: str) -> None:
    raise CommandError(f"a message holds {text}, which is not JSON", NO_JSON)


def _unique_members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    message = dict(pairs)
    if len(message) != len(pairs):
        raise CommandError("a message has a member twice")
    return message


def plain(value: Any, digits: int = 3) -> Any:
    """Return a value as data for JSON: numbers with `digits` digits after the point, a record as an object."""
    match value:
        case float():
            return round(value, digits) if isfinite(value) else None  # JSON has no such numbers
        case None | bool() | int() | str():
            return value
        case Enum():
            return value.value
        case tuple() | list():
            return [plain(one, digits) for one in value]
    if attrs.has(type(value)):
        return members(value, *[one.name for one in attrs.fields(type(value))])
    return value


def members(record: Any, *names: str, **digits: int) -> dict[str, Any]:
    """Return fields of a record as members of a message; `digits` after the point are 3 where they are not named."""
    return {name: plain(getattr(record, name), digits.get(name, 3)) for name in names}
