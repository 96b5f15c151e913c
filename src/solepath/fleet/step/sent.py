"""Input and output of the keyed step of a fleet."""

from __future__ import annotations

from typing import Any, SupportsIndex

from attrs import frozen

from ...events import Event
from ...types import Packet
from ..events import FleetEvent

MAX_COUNT = 2**53 - 1
"""Largest run and number: the JSON of every language reads it exactly."""
MAX_DATA_LENGTH = 4096
"""Longest data of a packet, bytes; a Bluetooth notification has 512 at most."""
MAX_NAME_LENGTH = 256
"""Longest name of a channel, address of a device and, in tables and lines, name of a wearer, characters."""
MAX_DETAIL_LENGTH = 200
"""Longest text that describes an error, characters."""


@frozen
class Tick:
    """A time at which nothing has arrived: `t`, s, on the clock of the packets."""

    t: float


@frozen
class End:
    """The end of a session, since the wearer takes the sensors off; a new run starts a new session."""


@frozen
class Sent:
    """A row that the phone of `wearer` sends: a packet as it arrived there, a Tick for time without data, or the End.

    `number` counts 0, 1, 2, ... without gaps within a `run`. A phone that cannot continue its count starts again at 0
    in a larger run (the time in ms, or the last run + 1 if that is more); the session continues."""

    wearer: str
    number: int
    what: Packet | Tick | End
    run: int = 0

    def __reduce_ex__(self, protocol: SupportsIndex) -> str | tuple[Any, ...]:
        if type(self) is Sent:  # as in Packet
            return Sent, (self.wearer, self.number, self.what, self.run)
        return super().__reduce_ex__(protocol)


@frozen
class Unreadable:
    """A row that cannot be read as a Sent; `what` is the reason.

    `run` and `number` are those of the row, if readable: then it does not count as missing. `wearer` is "" if
    unreadable."""

    wearer: str
    what: str
    run: int = 0
    number: int | None = None


@frozen
class NumberedEvent:
    """An event of a wearer; (wearer, number) is its identity, and a repeated identity is a repeated delivery.

    Numbers start at 0 and have no gaps, except after a StateRejected (protocol/fleet.md)."""

    wearer: str
    number: int
    event: Event | FleetEvent
