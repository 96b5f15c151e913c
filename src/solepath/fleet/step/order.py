"""What a phone sent, checked and in order: by run and number, whatever order it comes in.

What comes in its turn passes at once. What is ahead of its turn is held until what is missing has come, or until more
is held than `window` or HELD bytes of it: then what is missing is given up. What was used before is dropped without a
word. A run does not bind a reader for ever: when only rows of another, smaller one or one that was left, come, and more
than `window` of them, the phone's clock was put right, or one number was wild, and the reader goes over.
"""

from __future__ import annotations

from bisect import insort
from math import inf

from attrs import define, field, frozen

from ...events.fleet import SentRejection
from ...types import Packet, Site
from .left import Left, NumberSpan, Strays
from .sent import LATEST, LONGEST_DATA, LONGEST_DETAIL, LONGEST_NAME, MOST, End, Tick

HELD = 65_536
"""Bytes of packets, of their channels' names and devices' addresses."""


@frozen
class RejectedItem:
    """What stands in the place of what cannot be used."""

    reason: SentRejection
    detail: str = ""
    count: int = 1
    """So many of its run, this one among them; those between are not told."""


@frozen
class Missing:
    """So many numbers were given up, from this place on."""

    count: int


What = Packet | Tick | End | RejectedItem
Passed = list[tuple[int, int, What | Missing]]
"""(run, number, what), in order."""


@define
class Order:
    """What is next of one wearer."""

    window: int
    run: int = -1
    """-1: nothing has passed yet."""
    next: int = 0
    ended: bool = False
    """The End of this run has passed."""
    held: dict[tuple[int, int], What] = field(factory=dict)
    left: Left = field(factory=Left)
    strays: Strays = field(factory=Strays)
    _waiting: list[tuple[int, int]] = field(init=False)
    """Keys of `held` in order."""
    _size: int = field(init=False)
    """Bytes in `held`."""

    def __attrs_post_init__(self) -> None:
        self._waiting = sorted(self.held)
        self._size = sum(map(_size, self.held.values()))

    def take(self, run: int, number: int, what: What) -> Passed:
        """What passes now that this came. `run` and `number`: 0 to MOST."""
        if run == self.run:
            if number < self.next:
                return self._stray(run, number, SentRejection.LATE) if self.left.was_given_up(run, number) else []
            if self.ended:
                return self._stray(run, number, SentRejection.AFTER_END)
        elif run < self.run or self.left.was_left(run):
            return self._take_of_another(run, number, what)
        if (run, number) not in self.held:
            self.strays.straight = self.strays.number = 0
            self.held[run, number] = what
            insort(self._waiting, (run, number))
            self._size += _size(what)
        return self._release()

    def _take_of_another(self, run: int, number: int, what: What) -> Passed:
        """Of a run that was left, or of a smaller one that was never used."""
        left, strays = self.left, self.strays
        if left.was_used(run, number):
            return []
        if not left.may_go_on(run, number):
            return self._stray(run, number, SentRejection.LATE)
        if strays.with_this(run, number) > self.window:
            return self._go_over(run, number, what)
        passed = self._stray(run, number, SentRejection.LATE)
        strays.straight, strays.number = strays.with_this(run, number), max(number, strays.number)
        return passed

    def _go_over(self, run: int, number: int, what: What) -> Passed:
        """What is held passes before: it is waited for no longer."""
        first = self.left.take(run)
        passed = self._release(waits=False)
        self._enter(run, first)
        self.strays = Strays()
        self._pass(number, what, passed)
        return passed

    def _stray(self, run: int, number: int, reason: SentRejection) -> Passed:
        """What cannot be used, and is told now and then."""
        return [(run, number, RejectedItem(reason, count=self.strays.count))] if self.strays.add(run) else []

    def _release(self, waits: bool = True) -> Passed:
        """What is held and in its turn, or waited for too long."""
        passed: Passed = []
        while self._waiting:
            run, number = self._waiting[0]
            if run == self.run and self.ended:
                self._pop()
                passed += self._stray(run, number, SentRejection.AFTER_END)
                continue
            in_turn = number == self.next if run == self.run else number == 0
            if waits and not in_turn and len(self._waiting) <= self.window and self._size <= HELD:
                break
            if run != self.run:
                self._enter(run, 0)
            self._pass(number, self._pop(), passed)
        return passed

    def _pop(self) -> What:
        what = self.held.pop(self._waiting.pop(0))
        self._size -= _size(what)
        return what

    def _enter(self, run: int, number: int) -> None:
        """Another run, from this number on. How many were sent in the one before, nobody said."""
        if self.run >= 0:
            self.left.add(NumberSpan(self.run, self.next, MOST + 1))
        self.run, self.next, self.ended = run, number, False

    def _pass(self, number: int, what: What, passed: Passed) -> None:
        """What is used of the run; what is missing before it is given up."""
        if number > self.next:
            self.left.add(NumberSpan(self.run, self.next, number))
            passed.append((self.run, self.next, Missing(number - self.next)))
        self.next, self.ended = number + 1, isinstance(what, End)
        passed.append((self.run, number, what))


def _size(what: What) -> int:
    return len(what.data) + len(what.channel) + len(what.device) if isinstance(what, Packet) else 0


def is_sound(packet: Packet) -> bool:
    """Goes to a session, and into a state, as it is."""
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


def sound(what: object) -> What:
    """What a session takes and a state can hold, or why not."""
    if isinstance(what, Packet):
        return what if type(what) is Packet and is_sound(what) else _mended(what)
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


def _mended(packet: Packet) -> What:
    """Numbers and bytes of other kinds, and packets of an app's own class, as they are used here."""
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
    """An int may be too large for a float; then it is as good as infinite."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return None
    try:
        return float(value)
    except OverflowError:
        return inf
