"""Input and output of the keyed step of a fleet."""

from __future__ import annotations

from typing import Any, SupportsIndex

from attrs import frozen

from ...events import Event
from ...events.fleet import FleetEvent
from ...types import Packet

MOST = 2**53 - 1
"""Largest run and number: the JSON of every language reads it exactly."""
LONGEST_DATA = 4096
"""Longest data of a packet, bytes; Bluetooth carries 512 at most."""
LONGEST_NAME = 256
"""Longest name of a channel, address of a device and, in rows, name of a wearer, characters."""
LONGEST_DETAIL = 200
"""Longest text that describes an error, characters."""
LATEST = 1e11
"""Largest absolute value of a time, s; a value beyond it is no time."""


@frozen
class Tick:
    """A time at which nothing has arrived: `t`, s, on the clock of the packets."""

    t: float


@frozen
class End:
    """The wearer takes the sensors off.

    The session emits what it held back. A new run starts a new session."""


@frozen
class Sent:
    """An item that the phone of `wearer` sends: a packet as it arrived there, a Tick that time has passed, or the End.

    `number` counts 0, 1, 2, ... without holes within a `run`. A phone that cannot continue its count starts a new run,
    at 0, under a larger number (the time in ms, or the last run + 1 if that is more); the session goes on."""

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
    """A row that is no Sent, and the reason.

    `run` and `number` are given if they can be read: then nothing is waited for in its place. `wearer` is "" if that
    cannot be read either."""

    wearer: str
    what: str
    run: int = 0
    number: int | None = None


@frozen
class NumberedEvent:
    """An event of a wearer; (wearer, number) is its identity, and a repeated identity is a repeated delivery.

    Numbers start at 0 and have no holes, except after a StateRejected (protocol/fleet.md)."""

    wearer: str
    number: int
    event: Event | FleetEvent
