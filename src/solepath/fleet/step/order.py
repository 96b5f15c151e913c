"""Rows that a phone sent, checked and put in order by run and number, whatever order they come in.

A row in its turn passes at once. A row ahead of its turn is held until the missing rows have come, or until more than
`window` rows or HELD bytes are held: then the missing rows are given up. A row that was used before is dropped without
a report. A reader can leave a run: when only rows of a smaller run, or of one that was left, come, and more than
`window` of them, then the phone's clock was corrected or one number was wrong, and the reader switches to that run."""

from __future__ import annotations

from bisect import insort
from math import inf

from attrs import define, field, frozen

from ...events.fleet import SentRejection
from ...types import Packet, Site
from .sent import LATEST, LONGEST_DATA, LONGEST_DETAIL, LONGEST_NAME, MOST, End, Tick
from .unused import NumberSpan, Strays, UnusedNumbers

HELD = 65_536
"""Largest total of held bytes: packets, names of their channels and addresses of their devices."""


@frozen
class RejectedItem:
    """Stands in the place of a row that cannot be used."""

    reason: SentRejection
    detail: str = ""
    count: int = 1
    """Number of such rows of its run, this one included; not all of them are reported."""


@frozen
class Missing:
    """A count of numbers that were given up, from this place on."""

    count: int


Payload = Packet | Tick | End | RejectedItem
Passed = list[tuple[int, int, Payload | Missing]]
"""(run, number, payload), in order."""


@define
class Order:
    """Order of one wearer's rows and the next expected number."""

    window: int
    run: int = -1
    """Current run; -1 before anything has passed."""
    next: int = 0
    ended: bool = False
    """True if the End of this run has passed."""
    held: dict[tuple[int, int], Payload] = field(factory=dict)
    unused: UnusedNumbers = field(factory=UnusedNumbers)
    strays: Strays = field(factory=Strays)
    _waiting: list[tuple[int, int]] = field(init=False)
    """Keys of `held` in order."""
    _size: int = field(init=False)
    """Size of `held`, bytes."""

    def __attrs_post_init__(self) -> None:
        self._waiting = sorted(self.held)
        self._size = sum(map(_size, self.held.values()))

    def take(self, run: int, number: int, what: Payload) -> Passed:
        """Add one row and return the rows that pass now; `run` and `number` are from 0 to MOST."""
        if run == self.run:
            if number < self.next:
                return self._reject(run, number, SentRejection.LATE) if self.unused.was_given_up(run, number) else []
            if self.ended:
                return self._reject(run, number, SentRejection.AFTER_END)
        elif run < self.run or self.unused.was_left(run):
            return self._take_other_run(run, number, what)
        if (run, number) not in self.held:
            self.strays.consecutive = self.strays.number = 0
            self.held[run, number] = what
            insort(self._waiting, (run, number))
            self._size += _size(what)
        return self._release()

    def _take_other_run(self, run: int, number: int, what: Payload) -> Passed:
        """Add a row of a run that was left, or of a smaller one that was never used."""
        unused, strays = self.unused, self.strays
        if unused.was_used(run, number):
            return []
        if not unused.may_go_on(run, number):
            return self._reject(run, number, SentRejection.LATE)
        if strays.count_consecutive(run, number) > self.window:
            return self._switch_run(run, number, what)
        passed = self._reject(run, number, SentRejection.LATE)
        strays.consecutive, strays.number = strays.count_consecutive(run, number), max(number, strays.number)
        return passed

    def _switch_run(self, run: int, number: int, what: Payload) -> Passed:
        """Switch to the run of this row; the held rows pass first, since they are waited for no longer."""
        first = self.unused.reenter(run)
        passed = self._release(waits=False)
        self._enter(run, first)
        self.strays = Strays()
        self._pass(number, what, passed)
        return passed

    def _reject(self, run: int, number: int, reason: SentRejection) -> Passed:
        """Count a row that cannot be used; return its rejection if it is one that is reported."""
        return [(run, number, RejectedItem(reason, count=self.strays.count))] if self.strays.add(run) else []

    def _release(self, waits: bool = True) -> Passed:
        """Return the held rows that are in their turn or were waited for too long."""
        passed: Passed = []
        while self._waiting:
            run, number = self._waiting[0]
            if run == self.run and self.ended:
                self._pop()
                passed += self._reject(run, number, SentRejection.AFTER_END)
                continue
            in_turn = number == self.next if run == self.run else number == 0
            if waits and not in_turn and len(self._waiting) <= self.window and self._size <= HELD:
                break
            if run != self.run:
                self._enter(run, 0)
            self._pass(number, self._pop(), passed)
        return passed

    def _pop(self) -> Payload:
        what = self.held.pop(self._waiting.pop(0))
        self._size -= _size(what)
        return what

    def _enter(self, run: int, number: int) -> None:
        """Enter another run at this number; the number of rows in the run before is unknown."""
        if self.run >= 0:
            self.unused.add(NumberSpan(self.run, self.next, MOST + 1))
        self.run, self.next, self.ended = run, number, False

    def _pass(self, number: int, what: Payload, passed: Passed) -> None:
        """Pass one row of the current run; give up the missing rows before it."""
        if number > self.next:
            self.unused.add(NumberSpan(self.run, self.next, number))
            passed.append((self.run, self.next, Missing(number - self.next)))
        self.next, self.ended = number + 1, isinstance(what, End)
        passed.append((self.run, number, what))


def _size(what: Payload) -> int:
    return len(what.data) + len(what.channel) + len(what.device) if isinstance(what, Packet) else 0


def is_valid(packet: Packet) -> bool:
    """Return whether a packet can go to a session, and into a state, unchanged."""
    return (
        type(packet.t) is float
        and type(packet.site) is Site
        and type(packet.channel) is str
        and type(packet.data) is bytes
        and type(packet.device) is str
        and len(packet.data) <= LONGEST_DATA
        and len(packet.channel) <= LONGEST_NAME
        and len(packet.device) <= LONGEST_NAME
    )


def check_payload(what: object) -> Payload:
    """Return a payload that a session takes and a state can hold, or its rejection."""
    if isinstance(what, Packet):
        return what if type(what) is Packet and is_valid(what) else _convert_packet(what)
    if isinstance(what, Tick):
        t = _number(what.t)
        if t is None:
            return RejectedItem(SentRejection.MALFORMED, "a Tick without a time")
        return Tick(t) if -LATEST <= t <= LATEST else RejectedItem(SentRejection.NOT_FINITE, f"a Tick at {t:g} s")
    return (
        End()
        if isinstance(what, End)
        else RejectedItem(SentRejection.MALFORMED, f"a {type(what).__name__}"[:LONGEST_DETAIL])
    )


def _convert_packet(packet: Packet) -> Payload:
    """Return the packet with numbers and bytes of the standard types, also for an app's own class."""
    t, data = _number(packet.t), packet.data
    if isinstance(data, bytearray | memoryview):
        data = bytes(data)
    if t is None or not isinstance(data, bytes) or not isinstance(packet.site, Site):
        return RejectedItem(SentRejection.MALFORMED, "a packet holds a time, a Site and bytes")
    if not isinstance(packet.channel, str) or not isinstance(packet.device, str):
        return RejectedItem(SentRejection.MALFORMED, "a packet names its channel and its device")
    for name, size, most in (
        ("data", len(data), LONGEST_DATA),
        ("channel", len(packet.channel), LONGEST_NAME),
        ("device", len(packet.device), LONGEST_NAME),
    ):
        if size > most:
            return RejectedItem(SentRejection.OVERSIZED, f"{name} of {size}; {most} are the most")
    return Packet(t, packet.site, str(packet.channel), bytes(data), str(packet.device))


def _number(value: object) -> float | None:
    """Return a float or None; an int that is too large for a float counts as infinite."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return None
    try:
        return float(value)
    except OverflowError:
        return inf
