"""What goes into the keyed step of a fleet, and what comes out."""

from __future__ import annotations

from typing import Any, SupportsIndex

from attrs import frozen

from ...events import Event
from ...events.fleet import FleetEvent
from ...types import Packet

MOST = 2**53 - 1
"""Largest run and number: every language's JSON reads it exactly."""
LONGEST_DATA = 4096
"""Bytes of a packet; Bluetooth carries 512 at the most."""
LONGEST_NAME = 256
"""Characters of a channel's name, of a device's address, and, in rows, of a wearer's name."""
LONGEST_DETAIL = 200
"""Characters of what is told of something wrong."""
LATEST = 1e11
"""s; a time beyond this (or before minus this) is no time."""


@frozen
class Tick:
    """Nothing was heard, but it is `t` (s, the clock of the packets)."""

    t: float


@frozen
class End:
    """The wearer takes the sensors off: what a session held back comes out. A new run begins a new session."""


@frozen
class Sent:
    """What the phone of `wearer` sends: a packet as it arrived there, that time has passed, or that it was the last.

    `number`: 0, 1, 2, ... without holes within a `run`. A phone that cannot go on counting where it stopped begins a
    new run, at 0, under a larger number (the time in ms, or the last run + 1 where that is more); the session goes on.
    """

    wearer: str
    number: int
    what: Packet | Tick | End
    run: int = 0

    def __reduce_ex__(self, protocol: SupportsIndex) -> str | tuple[Any, ...]:
        if type(self) is Sent:  # as Packet's
            return Sent, (self.wearer, self.number, self.what, self.run)
        return super().__reduce_ex__(protocol)


@frozen
class Unreadable:
    """A row that is no Sent, and why. `run` and `number` where they can be read: then nothing is waited for in its
    place. `wearer`: "" where that cannot be read either."""

    wearer: str
    what: str
    run: int = 0
    number: int | None = None


@frozen
class NumberedEvent:
    """An event of a wearer. (wearer, number) is its identity: who gets it twice has it twice. Numbers begin at 0 and
    have no holes, but behind a StateRejected (protocol/fleet.md)."""

    wearer: str
    number: int
    event: Event | FleetEvent
